//! The same steps give the same bits: beside others or alone, at any frame rate and time scale, with or without pauses.

use bevy::{math::DVec3, prelude::*, time::TimeUpdateStrategy};
use core::time::Duration;
use wriggle::{mechanics::integrators::Method, physics::Clock};

use crate::support::{Worm, bits, particles, stepping_app, ticking_app};

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
fn run(mut app: App, bodies: Vec<crate::support::Body>) -> Vec<Vec<u64>> {
    let entities: Vec<_> = bodies.into_iter().map(|body| app.world_mut().spawn(body).id()).collect();
    while app.world().resource::<Clock>().step() < STEPS {
        let mut clock = app.world_mut().resource_mut::<Clock>();
        if clock.time_scale().is_some() && STEPS - clock.step() < 200 {
            // The last steps one by one, so as to end exactly.
            clock.set_steps_per_tick(1);
            app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        }
        app.update();
    }
    assert_eq!(app.world().resource::<Clock>().step(), STEPS);
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
    let expected = run(stepping_app(0.01, 1), worms(9));
    for (frames, scale) in [(30.0, 3.0), (60.0, 3.0), (144.0, 3.0), (60.0, 25.0), (60.0, 0.7)] {
        let mut app = ticking_app(0.01, scale);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / frames)));
        assert_eq!(run(app, worms(9)), expected, "{frames} frames a second, time scale {scale}");
    }
    let mut app = ticking_app(0.01, 3.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(17)));
    app.add_systems(Update, |mut frame: Local<u32>, mut time: ResMut<Time<Virtual>>| {
        *frame += 1;
        if frame.is_multiple_of(5) { time.pause() } else { time.unpause() }
    });
    assert_eq!(run(app, worms(9)), expected, "with pauses");
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
