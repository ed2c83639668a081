//! The same steps give the same bits: beside others or alone, at any frame rate and time scale, with or without pauses.

use bevy::{math::DVec3, prelude::*, time::TimeUpdateStrategy};
use core::time::Duration;
use std::sync::Arc;
use wriggle::{
    body::{
        Gravity, Ground, MassDamping, Particle, ParticleId, Particles, Pull, SpineFriction, Spring, SpringId, Springs,
        Surface, Terrain, TravelingWaves,
    },
    mechanics::integrators::Method,
    physics::{Clock, Steer},
};

use crate::{
    animal::Animal,
    support::{Worm, bits, particles, stepping_app, ticking_app},
};

/// Worms that all differ, the odd ones turned off the axis.
fn worms(count: usize) -> Vec<crate::support::Body> {
    (0..count)
        .map(|i| {
            let i = i as f64;
            let worm = Worm {
                stiffness: 1.5 + 0.01 * i,
                amplitude: 0.2 + 0.002 * i,
                period: 6.0 - 0.03 * i,
                // The exact flow is for the axis, where the even ones are.
                method: match Method::ALL[i as usize / 2 % Method::ALL.len()] {
                    Method::ExactFlow if i % 2.0 == 1.0 => Method::RungeKutta4,
                    method => method,
                },
                ..Worm::GARDEN
            };
            worm.body().moved(DVec3::Z * i, if i % 2.0 == 0.0 { 0.0 } else { 0.1 * i })
        })
        .collect()
}

const STEPS: u64 = 3000;

/// The bits of every worm after exactly [`STEPS`] steps.
fn run(app: App, bodies: Vec<crate::support::Body>) -> Vec<Vec<u64>> {
    run_for(STEPS, app, bodies)
}

/// The bits of every worm after exactly so many steps.
fn run_for(steps: u64, mut app: App, bodies: Vec<crate::support::Body>) -> Vec<Vec<u64>> {
    let entities: Vec<_> = bodies.into_iter().map(|body| app.world_mut().spawn(body).id()).collect();
    while app.world().resource::<Clock>().step() < steps {
        let mut clock = app.world_mut().resource_mut::<Clock>();
        if clock.time_scale().is_some() && steps - clock.step() < 200 {
            // The last steps one by one, so as to end exactly.
            clock.set_steps_per_tick(1);
            app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        }
        app.update();
    }
    assert_eq!(app.world().resource::<Clock>().step(), steps);
    entities.into_iter().map(|entity| bits(particles(&app, entity))).collect()
}

#[test]
fn a_body_has_the_same_bits_in_a_lane_and_alone() {
    let together = run(stepping_app(0.01, 100), worms(40));
    for (i, body) in worms(40).into_iter().enumerate() {
        let alone = run(stepping_app(0.01, 100), vec![body]);
        assert_eq!(alone[0], together[i], "worm {i}");
    }
}

#[test]
fn ticks_change_no_bits() {
    let one_by_one = run(stepping_app(0.01, 1), worms(9));
    assert_eq!(run(stepping_app(0.01, STEPS), worms(9)), one_by_one);
    assert_eq!(run(stepping_app(0.01, 8), worms(9)), one_by_one);
}

#[test]
fn frame_rates_time_scales_and_pauses_change_no_bits() {
    // All methods, on the axis and off it, in groups that fill lanes and groups that do not.
    let run = |app| run_for(600, app, worms(64));
    let expected = run(stepping_app(0.01, 1));
    for (frames, scale) in [(30.0, 3.0), (60.0, 3.0), (144.0, 3.0), (60.0, 25.0), (60.0, 0.7)] {
        let mut app = ticking_app(0.01, scale);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / frames)));
        assert_eq!(run(app), expected, "{frames} frames a second, time scale {scale}");
    }
    let mut app = ticking_app(0.01, 3.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(17)));
    app.add_systems(Update, |mut frame: Local<u32>, mut time: ResMut<Time<Virtual>>| {
        *frame += 1;
        if frame.is_multiple_of(5) { time.pause() } else { time.unpause() }
    });
    assert_eq!(run(app), expected, "with pauses");
}

#[test]
fn a_frozen_body_has_the_same_bits_whatever_the_ticks() {
    let exploding = || {
        let mut bodies = worms(5);
        bodies[2]
            .particles
            .set(
                wriggle::body::ParticleId(2),
                wriggle::body::Particle { velocity: DVec3::X * 60.0, ..wriggle::body::Particle::at(DVec3::X * 2.0) },
            )
            .unwrap();
        bodies
    };
    let one_by_one = run(stepping_app(0.01, 1), exploding());
    assert_eq!(run(stepping_app(0.01, 1000), exploding()), one_by_one);
    assert_ne!(one_by_one, run(stepping_app(0.01, 1), worms(5)));
}

/// Changes of a body between two ticks.
type Change = fn(&mut EntityWorldMut);

/// Each kind of change: of a value, of something that comes, of something that goes.
const CHANGES: [(&str, Change); 16] = [
    ("mass", |body| {
        let mut particles = body.get_mut::<Particles>().unwrap();
        let particle = Particle { mass: 3.0, ..particles.get(ParticleId(5)).unwrap() };
        particles.set(ParticleId(5), particle).unwrap();
    }),
    ("spring", |body| {
        let mut springs = body.get_mut::<Springs>().unwrap();
        let spring = springs.get(SpringId(7)).unwrap();
        springs.set(SpringId(7), Spring { stiffness: 2.0 * spring.stiffness, ..spring }).unwrap();
    }),
    ("steering of waves", |body| body.get_mut::<TravelingWaves>().unwrap().set_steering(0.2).unwrap()),
    ("waves that rest", |body| body.get_mut::<TravelingWaves>().unwrap().set_active(false, 3.0)),
    ("no waves", |body| {
        body.remove::<TravelingWaves>();
    }),
    ("grip", |body| {
        let friction = body.take::<SpineFriction>().unwrap();
        body.insert(friction.with_grip(3.0).unwrap());
    }),
    ("no friction", |body| {
        body.remove::<SpineFriction>();
    }),
    ("gravity", |body| *body.get_mut::<Gravity>().unwrap() = Gravity::new(0.01).unwrap()),
    ("no gravity", |body| {
        body.remove::<Gravity>();
    }),
    ("a hill", |body| {
        let hill = Surface::Hill { center: (0.0, 0.0), radius: 9.0, height: 1.0 };
        let floor = Surface::Floor { height: 0.0 };
        *body.get_mut::<Ground>().unwrap() = Ground::Terrain(Arc::new(Terrain::new([floor, hill]).unwrap()));
    }),
    ("no ground", |body| {
        body.remove::<Ground>();
    }),
    ("mass damping", |body| {
        body.insert(MassDamping::rate(0.3).unwrap());
    }),
    ("method", |body| *body.get_mut::<Method>().unwrap() = Method::RungeKutta4),
    ("a hand", |body| {
        body.insert(Pull { particle: ParticleId(0), target: DVec3::Y * 3.0 });
    }),
    ("a turn", |body| body.get_mut::<Steer>().unwrap().turn(1.0).unwrap()),
    ("a stop", |body| body.get_mut::<Steer>().unwrap().stop()),
];

/// The bits of a worm that is changed on its way; of one at which a hand pulls, after the hand has moved and let go.
fn changed(change: Change, others_come: bool) -> Vec<u64> {
    let dt = 0.05;
    let mut app = stepping_app(dt, 2);
    let body = Animal::worm().with(|worm| worm.dt = dt).spawn(app.world_mut());
    let go_on = |app: &mut App| {
        if others_come {
            app.world_mut().spawn(Worm::GARDEN.body());
        }
        (0..20).for_each(|_| app.update());
    };
    go_on(&mut app);
    change(&mut app.world_mut().entity_mut(body));
    go_on(&mut app);
    if let Some(mut pull) = app.world_mut().get_mut::<Pull>(body) {
        pull.target = DVec3::Z * 3.0;
        go_on(&mut app);
        app.world_mut().entity_mut(body).remove::<Pull>();
        go_on(&mut app);
    }
    bits(particles(&app, body))
}

#[test]
fn every_change_of_a_body_is_felt_at_the_next_step() {
    let unchanged = changed(|_| {}, false);
    let late = CHANGES.into_iter().filter_map(|(name, change)| {
        // What comes makes all layouts new.
        let (kept, new) = (changed(change, false), changed(change, true));
        assert_ne!(new, unchanged, "{name}: nothing came of it");
        (kept != new).then_some(name)
    });
    assert_eq!(late.collect::<Vec<_>>(), [""; 0]);
}
