//! Miller's animals on the floor and over the cliff, held to numbers: B, C, S, D and K3 of their acceptance tests.

use std::sync::Arc;

use bevy::math::DVec3;
use wriggle::{
    body::{Ground, ParticleId, Surface, Terrain, WaveDirection},
    mechanics::{
        ground_distance,
        metrics::{GaitMetrics, strains},
    },
    physics::{Frozen, body_parts},
};

use crate::{
    animal::{Animal, Ran, strand},
    support::stepping_app,
};

#[track_caller]
fn near(what: &str, value: f64, expected: f64, part: f64) {
    assert!((value / expected - 1.0).abs() <= part, "{what}: {value}, expected {expected} ± {} %", 100.0 * part);
}

/// The worm at the step to which its numbers belong.
fn worm() -> Animal {
    Animal::shipped("worm", 0.02)
}

#[test]
fn b1_the_worm_crawls_straight_on() {
    let (mut app, body) = worm().app();
    let (mut ran, mut aside) = (Ran::start(&mut app, body), 0.0_f64);
    ran.go_on_seeing(&mut app, 20, |particles| aside = aside.max(particles.center().z.abs()));
    let gait = ran.metrics();
    near("distance", gait.distance, 1.324, 0.04);
    near("body lengths", gait.body_lengths, 0.1324, 0.04);
    assert!(gait.angle.abs() < 0.1, "goes {}° off its axis", gait.angle);
    assert!(gait.worst_strain <= 0.25, "worst strain {}", gait.worst_strain);
    assert!(gait.smallest_cell >= 0.75, "smallest cell {}", gait.smallest_cell);
    assert!(aside < 0.01, "its middle comes {aside} off its axis");
}

#[test]
fn b2_a_square_wave_is_faster_and_tears() {
    let (sine, square) = (worm().run(20).metrics(), Animal::shipped("worm-square", 0.02).run(20).metrics());
    near("distance", square.distance, 1.80, 0.05);
    assert!(square.worst_strain >= 3.0 * sine.worst_strain, "{} and {}", square.worst_strain, sine.worst_strain);
    assert!(square.harmonic >= 4.0 * sine.harmonic, "{} and {}", square.harmonic, sine.harmonic);
}

#[test]
fn b3_without_scales_the_worm_stays_where_it_is() {
    // Drag that works against forward sliding alone would drive it backwards.
    let smooth = worm().with(|worm| {
        worm.friction.ratchet = false;
        worm.friction.drag = Some(0.0);
    });
    let smooth = smooth.run(20).metrics();
    assert!(smooth.distance < 0.01, "without the ratchet {}", smooth.distance);
    let rough = worm().with(|worm| {
        worm.friction.ratchet = false;
        worm.friction.drag = Some(0.0);
        worm.friction.isotropic = 1.0;
    });
    let rough = rough.run(20).metrics();
    assert!(rough.distance < 0.05, "with isotropic friction {}", rough.distance);
}

#[test]
fn drag_without_scales_drives_the_worm_backwards() {
    let back = Animal::worm().with(|worm| worm.friction.ratchet = false).run(20).metrics();
    near("forward", back.forward, -2.22, 0.05);
}

#[test]
fn b4_what_bulges_changes_its_width() {
    let swing = |bulge| worm().with(|worm| worm.plan.bulge = bulge).run(20).metrics().width_swing;
    assert!(swing(true) >= 0.30, "{}", swing(true));
    assert!(swing(false) <= 0.12, "{}", swing(false));
}

#[test]
fn b5_the_worm_climbs_down_the_cliff_and_crawls_on() {
    let cliff = Surface::Cliff { edge: 12.0, radius: 3.0, drop: Some(3.0) };
    let ground = Ground::Terrain(Arc::new(Terrain::new([cliff]).unwrap()));
    let (mut app, body) = worm().with(|worm| worm.ground = Some(ground.clone())).app();
    let mut ran = Ran::start(&mut app, body);
    let strand = strand(&app, body);
    let mut deepest = 0.0_f64;
    // Only masses meet the ground; the edges between them may cut its round, which begins at the edge and ends a radius behind it.
    ran.go_on_seeing(&mut app, 30, |particles| {
        for [a, b] in wriggle::body::Strand::ends(strand.segments() as u32) {
            let [a, b] = [a, b].map(|end: ParticleId| particles.position(end).unwrap());
            if a.x.max(b.x) < 12.0 || a.x.min(b.x) > 15.0 {
                continue;
            }
            for part in 1..10 {
                deepest = deepest.max(-ground_distance(&ground, a.lerp(b, f64::from(part) / 10.0)).0);
            }
        }
    });
    println!("an edge cuts the ground by {deepest}");
    let particles = body_parts(app.world().entity(body)).unwrap().particles;
    assert!(particles.positions().all(|position| position.y < -1.5), "the whole body is down");
    let gait = ran.metrics();
    assert!(gait.smallest_cell >= 0.7, "smallest cell {}", gait.smallest_cell);
    assert!(deepest <= 0.09, "an edge cuts the ground by {deepest}");
    near("distance", gait.distance, 1.324, 0.04);
}

#[test]
fn c1_with_a_good_grip_every_section_of_the_snake_follows_its_head() {
    let gait = Animal::snake().run(14).metrics();
    near("distance", gait.distance, 9.54, 0.03);
    assert!(gait.path_error <= 0.25, "path error {}", gait.path_error);
    assert!(gait.slip <= 0.03, "slip {}", gait.slip);
    assert!(gait.residue <= 0.02, "residue {}", gait.residue);
}

#[test]
fn c2_with_a_poor_grip_the_snake_slides() {
    let (good, poor) = (Animal::snake().run(14).metrics(), Animal::shipped("snake-poor-grip", 0.05).run(14).metrics());
    near("distance", poor.distance, 4.67, 0.05);
    assert!(poor.path_error >= 3.0 * good.path_error, "path errors {} and {}", poor.path_error, good.path_error);
    assert!(poor.slip >= 0.25, "slip {}", poor.slip);
}

#[test]
fn c3_steering_turns_the_snake() {
    for side in [1.0, -1.0] {
        let turn = Animal::snake().with(|snake| snake.plan.steering = side * 0.05).run(14).metrics().turn;
        assert!((turn - side * 19.3).abs() <= 5.0, "turns {turn}° a cycle");
    }
}

fn quick_on_slippery_ground(damping: f64) -> GaitMetrics {
    let snake = Animal::shipped("snake-low-damping", 0.05).with(|snake| snake.plan.damping = damping);
    snake.run(14).metrics()
}

#[test]
fn c4_with_little_damping_the_snake_swings_until_its_cells_turn_inside_out() {
    let calm = quick_on_slippery_ground(3.5);
    assert!(calm.smallest_cell >= 0.8 && calm.residue <= 0.03, "{calm:?}");
    let wild = quick_on_slippery_ground(0.9);
    assert!(wild.smallest_cell < 0.3 || wild.residue >= 0.1, "{wild:?}");
}

#[test]
fn c5_in_space_damping_takes_the_wave_that_comes_back() {
    let reflected = |damping| {
        let free = Animal::snake().with(|snake| {
            (snake.ground, snake.gravity) = (None, 0.0);
            snake.friction = wriggle::creatures::Friction { ratchet: false, ..Default::default() };
            snake.plan.damping = damping;
            snake.plan.waves[0].period = 20.0;
            snake.plan.waves[0].amplitude = 0.2;
        });
        free.run(14).metrics().reflected.unwrap()
    };
    assert!(reflected(3.5) <= 0.28, "{}", reflected(3.5));
    assert!(reflected(0.9) >= 0.36, "{}", reflected(0.9));
}

#[test]
fn s1_the_sidewinder_goes_sideways_with_most_of_it_off_the_ground() {
    for (lead, side) in [(0.25, -1.0), (-0.25, 1.0)] {
        let gait = Animal::sidewinder().with(|snake| snake.plan.waves[1].lead = lead).run(28).metrics();
        near("distance", gait.distance, 5.75, 0.12);
        assert!((side * gait.angle - 76.0).abs() <= 5.0, "goes {}° off its axis", gait.angle);
        assert!((0.62..0.73).contains(&gait.lifted), "{} of it is lifted", gait.lifted);
    }
}

#[test]
fn s2_without_the_lead_or_the_lift_it_goes_forward() {
    let level = Animal::sidewinder().with(|snake| snake.plan.waves[1].amplitude = 0.0).run(28).metrics();
    let together = Animal::sidewinder().with(|snake| snake.plan.waves[1].lead = 0.0).run(28).metrics();
    for gait in [level, together] {
        assert!(gait.angle.abs() < 10.0, "goes {}° off its axis", gait.angle);
    }
}

#[test]
fn d1_the_caterpillar_humps_along() {
    let gait = Animal::caterpillar().run(16).metrics();
    near("distance", gait.distance, 2.13, 0.05);
    assert!((0.43..0.57).contains(&gait.lifted), "{} of it is lifted", gait.lifted);
    assert!(gait.smallest_cell >= 0.8, "smallest cell {}", gait.smallest_cell);
}

#[test]
fn d2_feet_alone_carry_it_against_the_wave() {
    let forward = |direction| {
        let feet = Animal::shipped("caterpillar-feet", 0.1).with(|caterpillar| {
            for wave in &mut caterpillar.plan.waves {
                wave.direction = direction;
            }
        });
        feet.run(16).metrics().forward
    };
    let (there, back) = (forward(WaveDirection::TailToHead), forward(WaveDirection::HeadToTail));
    near("forward", there, 0.44, 0.15);
    near("the other way", back, -there, 0.01);
}

/// The largest stable step of semi-implicit Euler, (4m/Λ)/(D + √(D² + 4km/Λ)) with the largest eigenvalue Λ of Σuuᵀ over all springs.
fn largest_step(animal: &Animal) -> f64 {
    let raw = animal.plan.raw();
    let lines: Vec<_> = (raw.springs.iter())
        .map(|spring| {
            let [a, b] = [spring.ends.0, spring.ends.1].map(|end| end as usize);
            let place = |i: usize| DVec3::from(raw.particles[i].position);
            (a, b, (place(b) - place(a)).normalize())
        })
        .collect();
    let mut shape: Vec<_> =
        (0..raw.particles.len()).map(|i| DVec3::new(1.0, (i % 7) as f64 - 3.0, (i % 5) as f64 - 2.0)).collect();
    let mut eigenvalue = 0.0;
    for _ in 0..3000 {
        let mut image = vec![DVec3::ZERO; shape.len()];
        for &(a, b, along) in &lines {
            let stretch = (shape[b] - shape[a]).dot(along);
            image[b] += along * stretch;
            image[a] -= along * stretch;
        }
        let size = image.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
        eigenvalue = size / shape.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
        shape = image.into_iter().map(|v| v / size).collect();
    }
    let (k, d, m) = (animal.plan.stiffness, animal.plan.damping, animal.plan.mass);
    4.0 * m / eigenvalue / (d + (d * d + 4.0 * k * m / eigenvalue).sqrt())
}

#[test]
fn k3_the_animals_explode_where_the_formula_says() {
    for (animal, known) in [(Animal::worm(), 0.2357), (Animal::snake(), 0.0716), (Animal::caterpillar(), 0.3885)] {
        let limit = largest_step(&animal);
        near("the formula itself", limit, known, 0.005);
        let explodes = |part: f64| {
            let animal = animal.clone().with(|animal| animal.dt = part * limit);
            let mut app = stepping_app(animal.dt, 100);
            let body = animal.spawn(app.world_mut());
            (0..60).any(|_| {
                app.update();
                let parts = body_parts(app.world().entity(body)).unwrap();
                app.world().get::<Frozen>(body).is_some() || strains(&parts, 0.0).into_iter().any(|strain| strain > 2.0)
            })
        };
        assert!(!explodes(0.94), "at 94 % of {limit}");
        assert!(explodes(1.06), "at 106 % of {limit}");
    }
}
