//! What friction may and may not do.

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, Ground, Particle, ParticleId, Particles, SpineFriction},
    mechanics::kinetic_energy,
};

use crate::support::{Worm, in_space, particles, stepping_app};

/// Three masses in a row with these velocities, no springs pulling, in an app of one step a tick.
fn slide(
    velocities: [DVec3; 3],
    heading: f64,
    change: impl FnOnce(SpineFriction) -> SpineFriction,
) -> (Particles, Particles) {
    let mut body = Worm { stiffness: 0.0, damping: 0.0, amplitude: 0.0, drag: 0.0, ..Worm::GARDEN }.body();
    body.particles =
        Particles::new((0..3).map(|i| Particle { velocity: velocities[i], ..Particle::at(DVec3::X * i as f64) }))
            .unwrap();
    body.friction = change(body.friction);
    let body = body.moved(DVec3::ZERO, heading);
    let before = body.particles.clone();
    let mut app = stepping_app(0.01, 1);
    let entity = app.world_mut().spawn(body).id();
    app.update();
    (before, particles(&app, entity).clone())
}

#[test]
fn the_ratchet_takes_exactly_the_energy_of_sliding_back() {
    for heading in [0.0, 0.7, 2.0] {
        let velocities = [DVec3::new(-0.4, 0.1, 0.2), DVec3::new(0.3, 0.0, -0.2), DVec3::new(-0.1, 0.0, 0.0)];
        let (before, after) = slide(velocities, heading, |friction| friction);
        let lost = kinetic_energy(&before) - kinetic_energy(&after);
        let expected = 0.5 * (0.4_f64 * 0.4 + 0.1 * 0.1);
        assert!((lost - expected).abs() < 1e-12, "lost {lost}, expected {expected}, heading {heading}");
    }
}

#[test]
fn drag_takes_forward_speed_and_grip_sideways_speed_as_decays_over_the_step() {
    let velocity = DVec3::new(0.5, 0.25, -0.75);
    for heading in [0.0, 1.1] {
        let turn = bevy::math::DQuat::from_rotation_y(heading);
        let (_, after) =
            slide([velocity; 3], heading, |friction| friction.with_drag(3.0).unwrap().with_grip(7.0).unwrap());
        for v in after.velocities() {
            let v = turn.inverse() * v;
            let expected = DVec3::new(0.5 * libm::exp(-0.03), 0.25, -0.75 * libm::exp(-0.07));
            assert!((v - expected).length() < 1e-12, "{v}, expected {expected}");
        }
    }
}

#[test]
fn friction_never_speeds_a_mass_up_and_no_mass_ever_slides_back() {
    for method in in_space() {
        for (heading, tolerance) in [(0.0, 0.0), (0.4, 1e-15)] {
            let mut app = stepping_app(0.01, 1);
            let body = Worm { method, ..Worm::GARDEN }.body().moved(DVec3::ZERO, heading);
            let entity = app.world_mut().spawn(body).id();
            let forward = bevy::math::DQuat::from_rotation_y(heading) * DVec3::X;
            let mut last: Vec<_> = particles(&app, entity).positions().collect();
            for step in 0..3000 {
                app.update();
                let now = particles(&app, entity);
                for (v, (x, before)) in now.velocities().zip(now.positions().zip(&last)) {
                    assert!(v.dot(forward) >= -tolerance, "{} at step {step}, {method:?}", v.dot(forward));
                    assert!((x - before).dot(forward) >= -10.0 * tolerance, "moved back at step {step}, {method:?}");
                }
                last = now.positions().collect();
            }
        }
    }
}

#[test]
fn friction_takes_more_than_nothing_from_a_worm() {
    // The same worm coasts without its muscles; whatever it loses beyond its springs' damping is friction's.
    let energy_after = |ratchet: bool, drag: f64| {
        let mut app = stepping_app(0.01, 500);
        let mut body = Worm { amplitude: 0.0, damping: 0.0, ratchet, drag, ..Worm::GARDEN }.body();
        body.particles = Particles::new(
            (0..3).map(|i| Particle { velocity: DVec3::X * [0.9, -0.3, 0.2][i], ..Particle::at(DVec3::X * i as f64) }),
        )
        .unwrap();
        let start = kinetic_energy(&body.particles);
        let entity = app.world_mut().spawn(body.clone()).id();
        app.update();
        body.particles = particles(&app, entity).clone();
        start - kinetic_energy(&body.particles) - wriggle::mechanics::elastic_energy(&body.parts(), 5.0)
    };
    assert!(energy_after(false, 0.0).abs() < 5e-3, "without friction energy stays: {}", energy_after(false, 0.0));
    // The ratchet takes the backward mass's ½·0.3² at once; the method's energy swings by 0.005.
    assert!(energy_after(true, 0.0) > 0.04);
    assert!(energy_after(true, 0.5) > energy_after(true, 0.0));
}

#[test]
fn on_a_ground_friction_holds_only_what_touches_it() {
    let mut body = Worm { stiffness: 0.0, damping: 0.0, amplitude: 0.0, drag: 0.0, ..Worm::GARDEN }.body();
    let heights = [0.0, 0.04, 0.06];
    body.particles = Particles::new(
        (0..3).map(|i| Particle { velocity: DVec3::NEG_X, ..Particle::at(DVec3::new(i as f64, heights[i], 0.0)) }),
    )
    .unwrap();
    // A level spine, so that the ratchet takes all of a level velocity: the neighbours of the middle decide.
    let mut app = stepping_app(1e-6, 1);
    let entity = app.world_mut().spawn((body, Ground::Flat)).id();
    app.update();
    let v: Vec<_> = particles(&app, entity).velocities().map(|v| v.x).collect();
    assert!(v[0] > -0.01 && v[1] > -0.01, "masses that touch are held: {v:?}");
    assert_eq!(v[2], -1.0, "a mass above the contact distance slides freely");
}

#[test]
fn a_dropped_mass_comes_to_rest_on_the_ground() {
    let body = Particles::new([Particle::at(DVec3::new(0.0, 1.0, 0.0))]).unwrap();
    let mut app = stepping_app(0.01, 1);
    let entity =
        app.world_mut().spawn((body, wriggle::body::Springs::default(), Gravity::new(1.0).unwrap(), Ground::Flat)).id();
    for _ in 0..400 {
        app.update();
        assert!(particles(&app, entity).position(ParticleId(0)).unwrap().y >= 0.0);
    }
    let mass = particles(&app, entity).get(ParticleId(0)).unwrap();
    assert_eq!((mass.position, mass.velocity), (DVec3::ZERO, DVec3::ZERO));
}
