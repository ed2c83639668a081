//! Explicit Euler and RK2 on bodies whose springs are damped unevenly: they let grow what is damped least, whichever motion that is.

use bevy::math::DVec3;
use wriggle::{
    body::{MassDamping, Particle, ParticleId, Particles, SpineFriction, Spring, Springs},
    lab::limits::{linearised_limit, scene_limit},
    mechanics::{BodyParts, integrators::Method},
};

const METHODS: [Method; 2] = [Method::ExplicitEuler, Method::RungeKutta2];

fn spring(ends: [u32; 2], stiffness: f64, damping: f64) -> Spring {
    Spring { ends: ends.map(ParticleId), stiffness, damping, rest_length: 1.0 }
}

/// Masses of 1, the first of them pinned, on two springs of stiffness 1 of which the second is not damped and a little longer than at rest.
fn half_damped() -> (Particles, Springs) {
    let at = |i: u32| Particle { pinned: i == 0, ..Particle::at(DVec3::X * [0.0, 1.0, 2.1][i as usize]) };
    let particles = Particles::new((0..3).map(at)).unwrap();
    let springs = Springs::new([spring([0, 1], 1.0, 1.0), spring([1, 2], 1.0, 0.0)], &particles).unwrap();
    (particles, springs)
}

#[test]
fn friction_that_anchors_a_mass_does_not_lift_the_bound_above_where_it_explodes() {
    // Held by friction, the first of two masses is an anchor, and the second swings on the undamped spring.
    let (particles, springs) = half_damped();
    for method in METHODS {
        for (spine, friction, loss) in [([0, 1], 10.0, 0.0), ([1, 2], 20.0, 0.3), ([1, 2], 20.0, 0.8)] {
            let spine = SpineFriction::new(spine.map(ParticleId), &particles).unwrap();
            let friction = spine.with_ratchet(false).with_isotropic(friction).unwrap();
            let body = BodyParts {
                friction: Some(&friction),
                mass_damping: (loss > 0.0).then(|| MassDamping::per_step(loss).unwrap()),
                ..BodyParts::new(&particles, &springs, method)
            };
            let explodes = scene_limit(&body, linearised_limit(&body).unwrap()).unwrap();
            assert!(explodes < 0.2, "{method:?}, {loss} a step: {explodes}");
            for bound in [body.stability_limit(0.0), body.alarm_limit(0.0)] {
                assert!(bound <= explodes, "{method:?}, {loss} a step: bound {bound}, explodes at {explodes}");
            }
        }
    }
}

#[test]
fn a_spring_without_damping_has_no_limit_above_0_in_any_units() {
    for mass in [1.0, 1e-9] {
        // Nine pairs of a pinned and a free mass, every second spring damped to a ten-thousandth.
        let at = |i: u32| Particle { mass, pinned: i.is_multiple_of(2), ..Particle::at(DVec3::X * f64::from(i)) };
        let particles = Particles::new((0..18).map(at)).unwrap();
        let stiffness = 1e3_f64;
        let damping = |i: u32| if i.is_multiple_of(2) { 0.0 } else { 2e-4 * (stiffness * mass).sqrt() };
        let pairs = (0..9).map(|i| spring([2 * i, 2 * i + 1], stiffness, damping(i)));
        let springs = Springs::new(pairs, &particles).unwrap();
        for method in METHODS {
            let limit = BodyParts::new(&particles, &springs, method).stability_limit(0.0);
            assert_eq!(limit, 0.0, "{method:?}, masses of {mass}");
        }
    }
}

#[test]
fn what_buckles_by_itself_does_not_take_the_bound_of_what_does_not() {
    // Squeezed between its ends, the middle leaves the line by any method; the bound is that of all else.
    let at = [DVec3::ZERO, DVec3::new(1.0, 0.1, 0.0), DVec3::X * 2.0];
    let particles = Particles::new(at.map(|at| Particle { pinned: at == DVec3::ZERO, ..Particle::at(at) })).unwrap();
    let squeezed = |ends, damping| Spring { rest_length: 1.01, ..spring(ends, 1.0, damping) };
    let springs = Springs::new([squeezed([0, 1], 0.5), squeezed([1, 2], 0.2)], &particles).unwrap();
    for method in METHODS {
        let body = BodyParts::new(&particles, &springs, method);
        let bound = body.stability_limit(0.0);
        let explodes = scene_limit(&body, bound).unwrap();
        assert!(bound > 0.0 && bound <= explodes && explodes < 2.0 * bound, "{method:?}: {bound} of {explodes}");
    }
}

#[test]
fn rates_beyond_all_numbers_are_not_taken_for_none() {
    let at = |i: u32| Particle { mass: 1e-300, ..Particle::at(DVec3::X * f64::from(i)) };
    let particles = Particles::new((0..3).map(at)).unwrap();
    let springs = Springs::new([spring([0, 1], 1e200, 1.0), spring([1, 2], 1e200, 0.0)], &particles).unwrap();
    for method in METHODS {
        let limit = BodyParts::new(&particles, &springs, method).stability_limit(0.0);
        assert!(limit <= 1e-300, "{method:?}: {limit:e}");
    }
}
