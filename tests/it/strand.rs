//! Strands: their lattice, their waves, and that space has no preferred side.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{
        Particles, SpringId, Springs, Strand, StrandSpring, TravelingWave, TravelingWaves, Wave, WaveDirection,
        WaveKind,
    },
    creatures::Pose,
    mechanics::{
        integrators::Method,
        metrics::{cell_volume, strains},
        rest_lengths,
    },
    physics::{Clock, Frozen, Restart, body_parts},
};

use crate::{
    animal::{Animal, Ran, strand},
    support::{bits, center, in_space, particles, run_until, stepping_app},
};

#[test]
fn every_spring_has_the_role_that_its_ends_say() {
    let mut app = stepping_app(0.02, 1);
    let worm = Animal::worm().spawn(app.world_mut());
    let (lattice, springs) = (strand(&app, worm), app.world().get::<Springs>(worm).unwrap());
    assert_eq!((springs.len(), lattice.particles()), (186, 44));
    for (i, spring) in (0..).zip(springs.iter()) {
        let [(p, c), (q, d)] = spring.ends.map(|end| (end.0 / 4, end.0 % 4));
        let role = lattice.role(SpringId(i));
        match role {
            StrandSpring::Axial { segment, corner } => assert_eq!([p, q, c, d], [segment, segment + 1, corner, corner]),
            StrandSpring::Circumference { section, corner } => {
                assert_eq!([p, q, c, d], [section, section, corner, (corner + 1) % 4]);
            }
            StrandSpring::SectionDiagonal { section } => assert_eq!([p, q, c + 2], [section, section, d]),
            StrandSpring::SideDiagonal { segment, corner } => {
                assert_eq!([p, q], [segment, segment + 1]);
                assert_eq!([c.min(d), c.max(d)], [corner.min((corner + 1) % 4), corner.max((corner + 1) % 4)]);
            }
        }
    }
    assert_eq!((0..10).map(|j| cell_volume(particles(&app, worm), lattice, j)).collect::<Vec<_>>(), vec![1.0; 10]);
}

#[test]
fn at_rest_nothing_pulls() {
    for bulge in [false, true] {
        let mut app = stepping_app(0.02, 50);
        let worm = Animal::worm().with(|worm| {
            (worm.plan.bulge, worm.gravity) = (bulge, 0.0);
            worm.plan.waves.clear();
        });
        let worm = worm.spawn(app.world_mut());
        let before: Vec<_> = particles(&app, worm).positions().collect();
        app.update();
        let moved = particles(&app, worm).positions().zip(before).map(|(now, before)| now.distance(before));
        assert!(moved.fold(0.0, f64::max) < 1e-12);
        assert!(app.world().get::<Frozen>(worm).is_none());
    }
}

#[test]
fn rest_lengths_obey_the_law_of_the_waves() {
    let mut app = stepping_app(0.05, 1);
    let snake = Animal::sidewinder().with(|snake| snake.plan.steering = 0.07).spawn(app.world_mut());
    run_until(&mut app, 31.0);
    let parts = body_parts(app.world().entity(snake)).unwrap();
    let (rest, lattice, time) = (rest_lengths(&parts, 31.0), parts.strand.unwrap(), 31.0);
    for segment in 0..14 {
        for (corner, (side, height)) in [(1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].into_iter().enumerate() {
            let theta = core::f64::consts::TAU * (time / 80.0 - (14.0 - segment as f64 - 0.5) / 10.0);
            let ramp = time / 80.0;
            let drive = side * (0.3 * libm::sin(theta) + 0.07) + height * 0.2 * libm::cos(theta);
            let expected = (1.0 + ramp * drive).max(0.2);
            let is = rest[lattice.axial(segment, corner).index()];
            assert!((is - expected).abs() < 1e-12, "segment {segment}, corner {corner}: {is}, expected {expected}");
        }
    }
}

#[test]
fn circumference_and_diagonals_follow_the_axial_edges_of_now() {
    let (mut app, worm) = Animal::worm().app();
    run_until(&mut app, 40.0);
    let parts = body_parts(app.world().entity(worm)).unwrap();
    let (rest, lattice) = (rest_lengths(&parts, app.world().resource::<Clock>().time()), parts.strand.unwrap());
    let length = |segment| wriggle::mechanics::metrics::segment_length(parts.particles, lattice, segment);
    for (i, &is) in rest.iter().enumerate() {
        let around = |section: usize| {
            let (behind, ahead) = (length(section.saturating_sub(1)), length(section.min(9)));
            1.0 / (0.5 * (behind + ahead)).sqrt()
        };
        let expected = match lattice.role(SpringId(i as u32)) {
            StrandSpring::Axial { .. } => continue,
            StrandSpring::Circumference { section, .. } => around(section as usize),
            StrandSpring::SectionDiagonal { section } => around(section as usize) * 2.0_f64.sqrt(),
            StrandSpring::SideDiagonal { segment, corner } => {
                let axial = |corner: u32| rest[lattice.axial(segment as usize, (corner % 4) as usize).index()];
                let section = segment as usize;
                (axial(corner) * axial(corner + 1) + around(section) * around(section + 1)).sqrt()
            }
        };
        assert!((is - expected).abs() < 1e-12, "spring {i}: {is}, expected {expected}");
    }
}

#[test]
fn a_new_period_does_not_make_the_wave_jump() {
    let (mut app, snake) = Animal::snake().app();
    run_until(&mut app, 40.2);
    let time = app.world().resource::<Clock>().time();
    let rest = |app: &App| rest_lengths(&body_parts(app.world().entity(snake)).unwrap(), time);
    let before = rest(&app);
    let mut waves = app.world_mut().get_mut::<TravelingWaves>(snake).unwrap();
    let wave = waves.get(0).unwrap();
    waves.set(0, TravelingWave { period: 83.0, ..wave }, time).unwrap();
    for (before, after) in before.into_iter().zip(rest(&app)) {
        assert!((before - after).abs() < 1e-12, "{before} became {after}");
    }
}

#[test]
fn told_to_rest_the_animals_ramp_out_and_brake() {
    for (animal, bound) in [(Animal::snake(), 0.15), (Animal::worm(), 0.1)] {
        let (mut app, body) = animal.app();
        let mut ran = Ran::start(&mut app, body);
        ran.go_on(&mut app, 4);
        let time = app.world().resource::<Clock>().time();
        let period = ran.gait.period();
        app.world_mut().get_mut::<TravelingWaves>(body).unwrap().set_active(false, time);
        // The ramp is as smooth as at the start.
        let active = |app: &App, time| app.world().get::<TravelingWaves>(body).unwrap().activity_at(time);
        assert_eq!(active(&app, time), 1.0);
        assert!((active(&app, time + 0.25 * period) - 0.75).abs() < 1e-12);
        assert_eq!(active(&app, time + 1.5 * period), 0.0);
        run_until(&mut app, time + period);
        let stopped = particles(&app, body).center();
        run_until(&mut app, time + 6.0 * period);
        let coasted = particles(&app, body).center().distance(stopped) / animal.plan.segments as f64;
        assert!(coasted < bound, "coasts {coasted} of its length");
        let speed = particles(&app, body).velocities().map(|v| v.length()).fold(0.0, f64::max);
        assert!(speed < 1e-3, "still moves at {speed}");
    }
}

#[test]
fn a_restart_gives_the_same_run_again() {
    let (mut app, body) = Animal::caterpillar().app();
    run_until(&mut app, 50.0);
    let first = bits(particles(&app, body));
    app.world_mut().write_message(Restart);
    app.update();
    run_until(&mut app, 50.0);
    assert_eq!(bits(particles(&app, body)), first);
}

/// Five of an animal that differ, one of each kind of ground.
fn herd(animal: &Animal) -> Vec<Animal> {
    let differ = |i: usize| {
        animal.clone().with(|animal| {
            animal.plan.stiffness *= 1.0 + 0.01 * i as f64;
            animal.plan.steering = 0.01 * i as f64;
            animal.plan.waves[0].period += i as f64;
            animal.friction.grip += 0.1 * i as f64;
            animal.friction.isotropic = 0.01 * i as f64;
            animal.pose.at = DVec3::Z * (20 * i) as f64;
        })
    };
    (0..5).map(differ).collect()
}

#[test]
fn a_strand_has_the_same_bits_in_a_lane_and_alone() {
    let cliff = wriggle::body::Surface::Cliff { edge: 12.0, radius: 3.0, drop: Some(3.0) };
    let sand = wriggle::body::Patch::Disc { center: (10.0, 0.0), radius: 4.0, grip: 3.0 };
    let terrain = wriggle::body::Terrain::new([cliff]).unwrap().with_patches([sand]).unwrap();
    let ground = wriggle::body::Ground::Terrain(terrain.into());
    for animal in [Animal::worm().with(|worm| worm.ground = Some(ground)), Animal::sidewinder()] {
        for method in in_space() {
            let run = |animals: &[Animal]| {
                let mut app = stepping_app(animal.dt, 100);
                let bodies: Vec<_> = animals.iter().map(|animal| animal.spawn(app.world_mut())).collect();
                for _ in 0..4 {
                    app.update();
                }
                assert!(bodies.iter().all(|body| app.world().get::<Frozen>(*body).is_none()), "{method:?}");
                bodies.into_iter().map(|body| bits(particles(&app, body))).collect::<Vec<_>>()
            };
            let herd: Vec<_> = herd(&animal).into_iter().map(|one| one.with(|one| one.method = method)).collect();
            let together = run(&herd);
            for (i, one) in herd.iter().enumerate().step_by(2) {
                assert_eq!(run(core::slice::from_ref(one))[0], together[i], "{method:?}, animal {i}");
            }
        }
    }
}

#[test]
fn every_method_in_space_steps_a_strand_to_the_same_place() {
    let run = |method, dt| {
        let worm = Animal::worm().with(|worm| (worm.method, worm.dt) = (method, dt));
        let mut app = stepping_app(dt, 100);
        let body = worm.spawn(app.world_mut());
        run_until(&mut app, 30.0);
        assert!(app.world().get::<Frozen>(body).is_none(), "{method:?}");
        particles(&app, body).clone()
    };
    let apart =
        |a: &Particles, b: &Particles| a.positions().zip(b.positions()).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
    let reference = run(Method::RungeKutta4, 0.005);
    for method in in_space() {
        let off = apart(&run(method, 0.02), &reference);
        assert!(off < 0.08, "{method:?} ends {off} away");
    }
}

#[test]
fn the_exact_flow_says_that_it_cannot() {
    let mut app = stepping_app(0.02, 1);
    let worm = Animal::worm().with(|worm| worm.method = Method::ExactFlow).spawn(app.world_mut());
    app.update();
    let frozen = app.world().get::<Frozen>(worm).unwrap();
    assert!(frozen.reason.contains("not on an axis"), "{}", frozen.reason);
}

/// Where the masses are after so many cycles.
fn after(cycles: f64, animal: &Animal) -> Vec<DVec3> {
    let (mut app, body) = animal.app();
    run_until(&mut app, cycles * animal.period());
    particles(&app, body).positions().collect()
}

#[test]
fn a_mirrored_animal_moves_in_the_mirror_image() {
    let mirrored = |animal: &Animal| {
        animal.clone().with(|animal| {
            animal.plan.steering = -animal.plan.steering;
            for wave in animal.plan.waves.iter_mut().filter(|wave| wave.kind == WaveKind::Lateral) {
                wave.lead += 0.5;
            }
        })
    };
    let steered = |animal: Animal| animal.with(|animal| animal.plan.steering = 0.03);
    let caterpillar = Animal::shipped("caterpillar-steered", 0.1);
    for animal in [steered(Animal::snake()), steered(Animal::worm()), steered(caterpillar), Animal::sidewinder()] {
        let (one, other) = (after(3.0, &animal), after(3.0, &mirrored(&animal)));
        let aside = one.iter().map(|x| x.z.abs()).fold(0.0, f64::max);
        assert!(aside > 0.55, "the animal does go aside: {aside}");
        for (i, x) in one.iter().enumerate() {
            // Left and right corners change places.
            let mirror = other[4 * (i / 4) + [1, 0, 3, 2][i % 4]] * DVec3::new(1.0, 1.0, -1.0);
            assert!((*x - mirror).length() < 1e-6, "mass {i} at {x} and {mirror}");
        }
    }
}

#[test]
fn turning_the_scene_turns_the_trajectories_with_it() {
    for animal in [Animal::worm(), Animal::snake(), Animal::caterpillar()] {
        let straight = after(1.0, &animal);
        for heading in [37.0, 90.0, -143.0] {
            let turned = after(1.0, &animal.clone().with(|animal| animal.pose = Pose { heading, ..animal.pose }));
            let back = bevy::math::DQuat::from_rotation_y(f64::to_radians(heading));
            for (i, (x, y)) in straight.iter().zip(turned).enumerate() {
                let off = (*x - back * y).length();
                assert!(off < 1e-6, "mass {i} is {off} away at a heading of {heading}°");
            }
        }
    }
}

#[test]
fn strains_are_against_the_driven_rest_lengths() {
    let (mut app, body) = Animal::worm().app();
    run_until(&mut app, 30.0);
    let parts = body_parts(app.world().entity(body)).unwrap();
    let time = app.world().resource::<Clock>().time();
    let worst = strains(&parts, time).into_iter().map(f64::abs).fold(0.0, f64::max);
    assert!((0.05..0.25).contains(&worst), "{worst}");
    assert!(center(&app, body) > 5.0);
}

#[test]
fn what_is_no_strand_is_refused() {
    let mut app = stepping_app(0.02, 1);
    let worm = Animal::worm().spawn(app.world_mut());
    let springs = app.world().get::<Springs>(worm).unwrap();
    let say = |segments| Strand::new(segments, springs).unwrap_err().to_string();
    assert_eq!(say(1), "segments: 1 is not allowed; a strand has 2 segments or more");
    assert_eq!(say(9), "springs: are 186 springs; a strand of 9 segments has 168");
    let wave = TravelingWave {
        kind: WaveKind::Lateral,
        form: Wave::Sine,
        amplitude: 0.3,
        period: 10.0,
        wavelength: 0.0,
        direction: WaveDirection::HeadToTail,
        lead: 0.0,
    };
    let error = TravelingWaves::new([wave]).unwrap_err().to_string();
    assert!(error.starts_with("waves[0].wavelength: 0 is not allowed"), "{error}");
    // Waves without a strand, put together by hand.
    let waves = app.world().get::<TravelingWaves>(worm).unwrap().clone();
    app.world_mut().entity_mut(worm).remove::<Strand>().insert(waves);
    app.update();
    assert!(app.world().get::<Frozen>(worm).unwrap().reason.contains("need a strand"));
}
