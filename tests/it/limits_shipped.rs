//! The limits of everything that is shipped.

use bevy::math::DVec3;
use wriggle::{
    body::{Particle, ParticleId},
    creatures::library,
    lab::{
        Problem, ProblemBody,
        limits::{growth, limits, predicted_limit},
    },
    mechanics::{
        BodyParts,
        integrators::{Method, StickRule},
    },
};

use crate::limits::agree;

#[test]
#[ignore = "takes minutes: cargo test --release --no-default-features --test it shipped -- --ignored --nocapture"]
fn limits_of_all_shipped_scenes_have_what_is_expected_or_a_reason() {
    for name in library::list(library::SCENE).into_keys() {
        for row in limits(&wriggle::scenes::load(&name).unwrap(), &|_, _| {}).unwrap() {
            println!("{row:?}");
            let (Some(linearised), Some(explodes)) = (row.linearised, row.explodes) else { continue };
            if row.method != "SixMatrix" && row.predicted.is_some_and(f64::is_finite) {
                assert!(row.predicted.is_some_and(|predicted| agree(linearised, predicted, 1.0)), "{row:?}");
            }
            // Each limit is found to its own precision, and no limit as a small one.
            let is_half = row.bound >= 0.5 * linearised || row.bound == 0.0 && linearised < 0.005;
            assert!(row.bound.is_infinite() || row.bound <= 1.005 * linearised && is_half, "{row:?}");
            let near = explodes == linearised || (explodes / linearised - 1.0).abs() <= 0.06;
            assert!(near || row.reason.is_some(), "{row:?}");
        }
    }
}

/// The bodies of all shipped scenes, those with the same springs and masses once.
fn bodies() -> Vec<ProblemBody> {
    let mut all: Vec<ProblemBody> = Vec::new();
    for name in library::list(library::SCENE).into_keys() {
        let scene = wriggle::scenes::load(&name).unwrap();
        // The six-matrix particle system has no springs.
        for body in Problem::of(&scene).map(|problem| problem.bodies).unwrap_or_default() {
            let same = |other: &ProblemBody| {
                (&other.springs, other.strand, other.mass_damping) == (&body.springs, body.strand, body.mass_damping)
                    && other.particles.masses() == body.particles.masses()
            };
            if !all.iter().any(same) {
                all.push(ProblemBody { name: format!("{name}: {}", body.name), ..body });
            }
        }
    }
    all
}

#[test]
#[ignore = "takes minutes: cargo test --release --no-default-features --test it shipped -- --ignored --nocapture"]
fn stretched_shipped_bodies_have_a_bound_of_at_least_half_of_their_limit_and_never_above_it() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for mut body in bodies() {
        for stretch in [DVec3::ONE, DVec3::splat(1.1), DVec3::splat(1.4), DVec3::new(1.3, 1.0, 1.1)] {
            let whole = body.particles.clone();
            for i in 0..whole.len() {
                let id = ParticleId(i as u32);
                let particle = whole.get(id).unwrap();
                body.particles.set(id, Particle { position: particle.position * stretch, ..particle }).unwrap();
            }
            for method in Method::ALL {
                // Friction lowers the bound and is no part of the limit.
                let parts = BodyParts { friction: None, ..body.parts(method, StickRule::InStages) };
                let Some(limit) = predicted_limit(&parts) else { continue };
                let bound = parts.stability_limit(0.0);
                seen += 1;
                let part = if bound == limit { 1.0 } else { bound / limit };
                println!("{}, stretch {stretch}, {}: bound {bound}, {part} of {limit}", body.name, method.name());
                // Where rest lengths follow the pose, limits are found to a thousandth.
                if !(0.5..=1.001).contains(&part) {
                    wrong.push(format!("{}, stretch {stretch}, {}: {bound} of {limit}", body.name, method.name()));
                }
                // A step of explicit Euler sees no other pose than this one. The matrix of a large body's takes hours.
                if method == Method::ExplicitEuler && whole.len() < 200 && bound > 0.0 {
                    let [at, beyond] = [0.999, 2.002].map(|part| growth(&parts, part * bound).unwrap());
                    if at > 1.0 + 1e-8 || beyond < 1.0 + 1e-8 {
                        wrong.push(format!("{}, stretch {stretch}: grows by {at} below, {beyond} above", body.name));
                    }
                }
            }
            body.particles = whole;
        }
    }
    assert!(seen > 200, "{seen} limits");
    assert!(wrong.is_empty(), "{} wrong of {seen}:\n{}", wrong.len(), wrong.join("\n"));
}
