//! Conservation laws and symmetries.

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, Particle, ParticleId, Particles, Spring, Springs},
    mechanics::{Lanes, Real, angular_momentum, integrators::Method, kinetic_energy, momentum, sin_cycles},
};

use crate::support::{Worm, in_space, particles, stepping_app};

/// A crumpled net of five masses with unequal springs, thrown spinning.
fn net() -> (Particles, Springs) {
    let at = [
        DVec3::new(0.0, 0.0, 0.0),
        DVec3::new(1.0, 0.2, -0.1),
        DVec3::new(0.3, 1.1, 0.2),
        DVec3::new(0.1, 0.2, 0.9),
        DVec3::new(1.2, 0.9, 0.8),
    ];
    let masses = [1.0, 2.0, 0.5, 3.0, 1.5];
    let particles = Particles::new((0..5).map(|i| Particle {
        velocity: DVec3::new(0.3, 0.1, -0.2) * i as f64 - DVec3::Y * at[i].x,
        mass: masses[i],
        ..Particle::at(at[i])
    }))
    .unwrap();
    let pairs = (0..5).flat_map(|a| (a + 1..5).map(move |b| (a, b)));
    let springs = Springs::new(
        pairs.enumerate().map(|(i, (a, b))| Spring {
            ends: [ParticleId(a), ParticleId(b)],
            stiffness: 1.0 + 0.3 * i as f64,
            damping: 0.1 * (i % 3) as f64,
            rest_length: 0.9,
        }),
        &particles,
    )
    .unwrap();
    (particles, springs)
}

#[test]
fn without_friction_momentum_stays() {
    for method in in_space() {
        let (start, springs) = net();
        let (p, l) = (momentum(&start), angular_momentum(&start));
        let mut app = stepping_app(0.01, 1000);
        let body = app.world_mut().spawn((start, springs, method)).id();
        app.update();
        let after = particles(&app, body);
        // XPBD's velocities are differences of positions, with their rounding.
        let bound = if method == Method::Xpbd { 1e-10 } else { 1e-12 };
        assert!((momentum(after) - p).length() < bound, "{method:?}");
        let drift = (angular_momentum(after) - l).length() / l.length();
        // Forces along lines on which the masses are when they are kicked turn nothing, and the midpoint rule keeps what is quadratic; Runge–Kutta
        // methods keep it to their order, and what is left does not keep it.
        let bound = match method {
            Method::RungeKutta4 => 1e-6,
            Method::RungeKutta2 => 1e-3,
            Method::ExplicitEuler | Method::ImplicitEuler | Method::Xpbd => continue,
            _ => 1e-10,
        };
        assert!(drift < bound, "angular momentum drifts by {drift}, {method:?}");
    }
}

#[test]
fn a_worm_without_friction_keeps_its_momentum() {
    let mut app = stepping_app(0.005, 5000);
    let body = app.world_mut().spawn(Worm { ratchet: false, drag: 0.0, ..Worm::GARDEN }.body()).id();
    app.update();
    assert!(momentum(particles(&app, body)).length() < 1e-13);
    assert!(kinetic_energy(particles(&app, body)) > 1e-4, "it does move");
}

#[test]
fn what_is_pinned_stays() {
    for method in in_space() {
        let mut body = Worm { method, ..Worm::GARDEN }.body();
        let held = Particle { pinned: true, ..Particle::at(DVec3::X) };
        body.particles.set(ParticleId(1), held).unwrap();
        let mut app = stepping_app(0.01, 1000);
        let entity = app.world_mut().spawn((body, Gravity::new(0.1).unwrap())).id();
        app.update();
        assert_eq!(particles(&app, entity).get(ParticleId(1)), Some(held));
        assert_ne!(particles(&app, entity).velocity(ParticleId(0)), Some(DVec3::ZERO));
    }
}

#[test]
fn a_free_fall_is_exact_for_runge_kutta() {
    let mut app = stepping_app(0.1, 50);
    let particle = Particle { velocity: DVec3::new(0.5, 2.0, 0.0), ..Particle::at(DVec3::ZERO) };
    let body = (Particles::new([particle]).unwrap(), Springs::default(), Gravity::new(0.8).unwrap());
    let entity = app.world_mut().spawn((body, Method::RungeKutta4)).id();
    app.update();
    let x = particles(&app, entity).position(ParticleId(0)).unwrap();
    assert!((x - DVec3::new(2.5, 2.0 * 5.0 - 0.4 * 25.0, 0.0)).length() < 1e-12, "{x}");
}

#[test]
fn the_sine_in_cycles_is_the_sine() {
    let mut worst: f64 = 0.0;
    for i in -200_000..200_000 {
        let cycles = f64::from(i) * 1.7e-5;
        let reduced = cycles - cycles.round();
        worst = worst.max((sin_cycles(cycles) - libm::sin(core::f64::consts::TAU * reduced)).abs());
    }
    assert!(worst < 4.5e-16, "largest difference {worst:e}");
    for (cycles, sine) in [(0.0, 0.0), (0.25, 1.0), (0.5, 0.0), (0.75, -1.0), (-0.25, -1.0), (1e9 + 0.25, 1.0)] {
        assert!((sin_cycles(cycles) - sine).abs() < 2.3e-16, "at {cycles}");
    }
}

#[test]
fn a_lane_has_the_bits_of_one_number() {
    let mut lanes = Lanes::<8>::splat(0.0);
    for i in 0..10_000 {
        for lane in 0..8 {
            lanes.set_lane(lane, f64::from(i * 8 + lane as i32) * 0.0137 - 400.0);
        }
        let (sine, root) = (sin_cycles(lanes), lanes.abs().sqrt());
        for lane in 0..8 {
            let x = lanes.lane(lane);
            assert_eq!(sine.lane(lane).to_bits(), sin_cycles(x).to_bits());
            assert_eq!(root.lane(lane).to_bits(), x.abs().sqrt().to_bits());
        }
    }
}

#[test]
fn a_turned_and_shifted_worm_crawls_the_same_way() {
    // The worm on the axis is stepped in one dimension, the turned one in three.
    for method in in_space() {
        let mut app = stepping_app(0.01, 3000);
        let straight = app.world_mut().spawn(Worm { method, ..Worm::GARDEN }.body()).id();
        let (by, turn) = (DVec3::new(3.0, 1.0, -2.0), 0.9);
        let turned = app.world_mut().spawn(Worm { method, ..Worm::GARDEN }.body().moved(by, turn)).id();
        app.update();
        let rotation = bevy::math::DQuat::from_rotation_y(turn);
        for (a, b) in particles(&app, straight).positions().zip(particles(&app, turned).positions()) {
            assert!(
                (rotation * a + by - b).length() < 1e-10,
                "{a} and {b}, {method:?}, {:e}",
                (rotation * a + by - b).length()
            );
        }
        assert!(particles(&app, straight).center().x > 2.0);
    }
}
