//! The worm whose motion two independent methods of event location agree on to twelve digits: rest lengths 1 + ¼ sin πt and
//! 1 + ¼ sin(πt − π/2), k 1.5, D 0.9, m 1, ratchet alone, from rest.

use bevy::{ecs::system::EntityCommand, prelude::*};
use wriggle::{
    creatures::{
        Body, Pose,
        library::{Source, read_creature},
    },
    mechanics::integrators::Method,
};

use crate::{
    files::RAW,
    support::{Worm, particles, stepping_app},
};

const EXACT: [f64; 3] = [3.058918927290, 3.994998746503, 5.085548685141];

/// The worm as its file says.
fn read() -> Body {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("exact.creature.ron");
    std::fs::write(&path, RAW).unwrap();
    read_creature(&Source::Disk(path)).unwrap().body(Pose::default()).unwrap()
}

/// Puts the worm into an app, stepped by a method.
fn spawn(app: &mut App, method: Method) -> Entity {
    let body = app.world_mut().spawn(method).id();
    read().apply(app.world_mut().entity_mut(body));
    body
}

#[test]
fn the_file_is_the_worm_that_other_tests_build() {
    let (read, built) = (read(), Worm::EXACT.body());
    assert_eq!((read.particles, read.springs), (built.particles, built.springs));
    assert_eq!((read.muscles, read.friction), (Some(built.muscles), Some(built.friction)));
}

/// The largest error of a position at t = 20.
fn error(method: Method, dt: f64) -> f64 {
    let steps = (20.0 / dt).round() as u64;
    let mut app = stepping_app(dt, steps);
    let body = spawn(&mut app, method);
    app.update();
    particles(&app, body).positions().zip(EXACT).map(|(x, exact)| (x.x - exact).abs()).fold(0.0, f64::max)
}

#[test]
fn semi_implicit_euler_is_of_first_order() {
    let errors: Vec<_> = [0.004, 0.002, 0.001, 0.0005].map(|dt| error(Method::SemiImplicitEuler, dt)).into();
    assert!((errors[3] - 1.03e-3).abs() < 1e-5, "at half a millisecond: {}", errors[3]);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 1.0).abs() < 0.02, "observed order {order} in {errors:?}");
    }
}

#[test]
fn runge_kutta_4_with_the_rule_in_its_stages_is_within_a_millimetre_at_50_ms() {
    for (dt, bound) in [(0.05, 1e-3), (0.04, 1e-3), (0.025, 1e-3), (0.02, 1e-3), (0.005, 3e-5)] {
        let error = error(Method::RungeKutta4, dt);
        assert!(error < bound, "{error} at dt {dt}");
    }
}

#[test]
fn the_first_stick_and_slip_events_happen_when_they_should() {
    // C slips at .368158542829, A slips at .835621599543, B sticks at 1.008115772431.
    const DT: f64 = 1e-4;
    let mut app = stepping_app(DT, 1);
    let body = spawn(&mut app, Method::RungeKutta4);
    let (mut sliding, mut events) = ([false; 3], Vec::new());
    for step in 1..12_000_u64 {
        app.update();
        for (mass, v) in particles(&app, body).velocities().enumerate() {
            let slides = v.x > 1e-12;
            if slides != sliding[mass] {
                events.push((mass, slides, step as f64 * DT));
            }
            sliding[mass] = slides;
        }
    }
    // B starts to slide at once, pulled by its springs.
    let expected = [(2, true, 0.368158542829), (0, true, 0.835621599543), (1, false, 1.008115772431)];
    let events: Vec<_> = events.into_iter().filter(|event| event.2 > 0.01).take(3).collect();
    for (event, expected) in events.iter().zip(expected) {
        assert_eq!((event.0, event.1), (expected.0, expected.1), "{events:?}");
        assert!((event.2 - expected.2).abs() < 3.0 * DT, "{event:?}, expected at {}", expected.2);
    }
    assert_eq!(events.len(), 3);
}

#[test]
fn the_distance_after_20_is_the_known_one_of_the_method() {
    for (dt, travelled) in [(0.05, 3.1561778525), (0.01, 3.0670875950), (0.001, 3.0485331490)] {
        let mut app = stepping_app(dt, (20.0_f64 / dt).round() as u64);
        let body = spawn(&mut app, Method::SemiImplicitEuler);
        app.update();
        let center = particles(&app, body).center().x - 1.0;
        assert!((center - travelled).abs() < 2e-9, "{center} at dt {dt}");
    }
}
