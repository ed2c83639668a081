//! How large a step may be: predicted, bounded, found, and as the scene itself has it.
//!
//! Four answers stand beside each other. The **predicted** limit follows from the stiffness and the damping of the linearised body by the formula
//! of the method; the **bound** is the cheap one that the gauge uses; the **linearised** limit is found by bisection on the growth of the
//! method's own step near the body's pose, with friction and contact off; and at the **scene**'s limit the body explodes with its muscles running.

mod alike;
mod edges;
mod iterated;
mod linearised_step;
mod predicted;
mod scene;
mod six;
mod step_matrix;

use core::sync::atomic::{AtomicUsize, Ordering};

use bevy::tasks::TaskPool;
use serde::{Serialize, Serializer};

use crate::{
    creatures::FileError,
    lab::ProblemBody,
    mechanics::{BodyParts, integrators::Method},
    scenes::LoadedScene,
};

pub use edges::edges;
pub use predicted::predicted_limit;
pub use scene::scene_limit;
pub use six::linearised_six_limit;
pub use step_matrix::{growth, linearised_limit};

/// A scene's limit further from the linearised one than this part of it has a reason.
const NEAR: f64 = 0.06;

/// The linearised limit further from the predicted one than this part of it has a reason.
const AGREED: f64 = 0.02;
/// What is rounded off of a length, as a part of it.
const ROUNDING: f64 = 1e-9;

/// The limits of the step of one body by one method. An infinite limit is none: no step makes the method unstable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// The name of the scene.
    pub scene: String,
    /// The name of the body, and of those that are like it.
    pub body: String,
    /// The name of the method; `SixMatrix` for bodies of the six-matrix particle system.
    pub method: &'static str,
    /// From the eigenvalues of the linearised body; nothing where no formula is known, and for large bodies that are damped otherwise than in
    /// proportion to their stiffness.
    #[serde(serialize_with = "limit")]
    pub predicted: Option<f64>,
    /// The cheap bound, which is never above the true limit.
    #[serde(serialize_with = "finite")]
    pub bound: f64,
    /// By bisection on the growth of the linearised step; nothing where the method cannot step the body.
    #[serde(serialize_with = "limit")]
    pub linearised: Option<f64>,
    /// The smallest step at which the scene's body explodes or the method refuses it; nothing where the method cannot step the body at all.
    #[serde(serialize_with = "limit")]
    pub explodes: Option<f64>,
    /// Why the body cannot be stepped at all, the linearised limit is not the predicted one, or the body explodes at another step than that; nothing where
    /// all agree.
    pub reason: Option<&'static str>,
}

/// The limits of every body of a scene by every method. Bodies that differ only in where they are come once. Each body and method is looked at on a thread
/// of its own; `progress` hears how many of how many are done.
///
/// # Errors
/// If a body cannot be built, which loading the scene has found out before.
pub fn limits(scene: &LoadedScene, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<Vec<Limits>, FileError> {
    let bodies = alike::distinct(ProblemBody::all(scene)?.0);
    let all = bodies.len() * Method::ALL.len();
    let done = AtomicUsize::new(0);
    progress(0, all);
    let mut rows = TaskPool::new().scope(|scope| {
        for (body, method) in bodies.iter().flat_map(|body| Method::ALL.map(|method| (body, method))) {
            let done = &done;
            scope.spawn(async move {
                let row = row(scene, body, method);
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
                row
            });
        }
    });
    rows.extend(six::rows(scene)?);
    Ok(rows)
}

fn row(scene: &LoadedScene, body: &ProblemBody, method: Method) -> Limits {
    let parts = body.parts(method, scene.file.stick);
    let refused = parts.refused_by_method();
    let predicted = predicted_limit(&parts);
    let linearised = if refused.is_some() { None } else { linearised_limit(&parts) };
    let explodes = linearised.and_then(|linearised| scene_limit(&parts, linearised));
    let reason = linearised
        .zip(explodes)
        .filter(|&(linearised, explodes)| is_apart(linearised, explodes, NEAR))
        .map(|(linearised, explodes)| scene::reason(&parts, linearised, explodes));
    let disagree = predicted.zip(linearised).is_some_and(|(predicted, found)| is_apart(predicted, found, AGREED));
    let pose = (disagree && !is_slack(&parts)).then_some(
        "its springs are not at their rest lengths where it starts: the pose changes within a step, and what grows there grows slowly",
    );
    Limits {
        scene: scene.source.stem(),
        body: body.name.clone(),
        method: method.name(),
        predicted,
        bound: parts.stability_limit(0.0),
        linearised,
        explodes,
        reason: refused.or(pose).or(reason),
    }
}

/// Whether two limits differ by more than this part of the first.
fn is_apart(a: f64, b: f64, part: f64) -> bool {
    let is_near = (b - a).abs() <= part * a && a.is_finite();
    a != b && !is_near
}

/// Whether no spring pulls or pushes before muscles do.
fn is_slack(body: &BodyParts<'_>) -> bool {
    let position = |end| body.particles.position(end).unwrap_or_default();
    body.springs.iter().all(|spring| {
        let length = position(spring.ends[0]).distance(position(spring.ends[1]));
        (length - spring.rest_length).abs() <= ROUNDING * spring.rest_length
    })
}

/// JSON has no infinity.
fn finite<S: Serializer>(limit: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if limit.is_finite() { serializer.serialize_f64(*limit) } else { serializer.serialize_str("none") }
}

fn limit<S: Serializer>(limit: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match limit {
        Some(limit) => finite(limit, serializer),
        None => serializer.serialize_none(),
    }
}
