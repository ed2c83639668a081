//! The limits of bodies of the six-matrix particle system.

use bevy::{math::DVec3, prelude::*};

use crate::{
    body::{Collisions, Rules},
    creatures::FileError,
    mechanics::{
        linear::bisect,
        six_matrix::{SixParts, Stepper, stability_limit},
    },
    physics::six_parts,
    scenes::{self, LoadedScene, SceneBodies},
};

use super::Limits;

/// How many steps the bonds are watched, and how many the whole body: what leaves its road falls apart at any step.
const STEPS: usize = 4000;
const STEPS_ON_ROAD: usize = 600;
/// How far its particles are disturbed, and by how much the disturbance may grow.
const DISTURBANCE: f64 = 1e-6;
const GROWTH: f64 = 1e3;
/// Limits are searched from half of the predicted one, upwards by this factor, up to four times that.
const STRIDE: f64 = 1.05;
/// They are found to this part of themselves.
const PRECISION: f64 = 0.002;

/// The limits of every such body of a scene: predicted as t ≤ 2(1 + d)/K from its bonds, by bisection on bonds alone, and by bisection on the body with its rules on
/// its road.
pub(super) fn rows(scene: &LoadedScene) -> Result<Vec<Limits>, FileError> {
    let mut world = World::new();
    scenes::open(&mut world, scene.clone())?;
    let bodies = world.resource::<SceneBodies>().0.clone();
    let rows = bodies.into_iter().filter_map(|body| {
        let entity = world.get_entity(body).ok()?;
        let parts = six_parts(entity)?;
        let predicted = stability_limit(parts.bonds, parts.columns);
        let explodes = search(predicted, |dt| runs(&parts, dt));
        Some(Limits {
            scene: scene.source.stem(),
            body: entity.get::<Name>().map_or("body", Name::as_str).to_owned(),
            method: "SixMatrix",
            predicted: Some(predicted),
            bound: predicted,
            linearised: Some(linearised_six_limit(&parts)),
            explodes: Some(explodes),
            reason: (explodes < predicted * (1.0 - super::NEAR))
                .then_some("what it does and touches is stiffer than its bonds"),
        })
    });
    Ok(rows.collect())
}

/// The largest step at which a small disturbance of the body's bonds at rest does not grow, by bisection. Infinite for a body without bonds.
pub fn linearised_six_limit(body: &SixParts<'_>) -> f64 {
    let none = (Collisions::new(body.particles.len(), |_, _| false), Rules::default());
    let bare = SixParts { collisions: &none.0, rules: &none.1, road: None, ..*body };
    search(stability_limit(body.bonds, body.columns), |dt| is_calm(&bare, dt))
}

/// The edge between steps that are good and larger ones that are not, near a predicted one.
fn search(predicted: f64, good: impl Fn(f64) -> bool) -> f64 {
    if !predicted.is_finite() {
        return f64::INFINITY;
    }
    let mut dt = 0.5 * predicted;
    while !good(dt) {
        dt *= 0.5;
        if dt < 1e-3 * predicted {
            return 0.0;
        }
    }
    while good(dt * STRIDE) {
        dt *= STRIDE;
        if dt > 4.0 * predicted {
            return f64::INFINITY;
        }
    }
    bisect(dt, dt * STRIDE, PRECISION, good)
}

/// Whether the body takes all steps without bursting.
fn runs(body: &SixParts<'_>, dt: f64) -> bool {
    let mut stepper = Stepper::new(body);
    (0..STEPS_ON_ROAD).all(|_| stepper.step(body, dt).is_ok())
}

/// Whether a small disturbance stays small.
fn is_calm(body: &SixParts<'_>, dt: f64) -> bool {
    let start: Vec<_> = body.particles.positions().collect();
    // Of no regularity, so that it has a part of the fastest mode.
    let kick = |i: usize| {
        let part = |k: usize| ((i * k + k) % 101) as f64 / 50.0 - 1.0;
        DISTURBANCE * DVec3::new(part(37), part(53), part(71))
    };
    let mut stepper = Stepper::new(body).moved(kick);
    (0..STEPS).all(|_| {
        let away = |(x, start): (&DVec3, &DVec3)| x.distance(*start);
        stepper.step(body, dt).is_ok()
            && stepper.state().position.iter().zip(&start).map(away).fold(0.0, f64::max) < GROWTH * DISTURBANCE
    })
}
