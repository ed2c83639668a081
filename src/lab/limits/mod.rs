//! How large a step may be: predicted, bounded, found, and as the scene itself has it.
//!
//! Four answers stand beside each other. The **predicted** limit follows from the stiffness and the damping of the linearised body by the formula
//! of the method; the **bound** is the cheap one that the gauge uses; the **linearised** limit is found by bisection on the growth of the
//! method's own step near the body's pose, with friction and contact off; and at the **scene**'s limit the body explodes with its muscles running.

mod alike;
mod linear;
mod predicted;
mod scene;
mod search;
mod six;
mod step_matrix;

use serde::{Serialize, Serializer};

use crate::{creatures::FileError, lab::ProblemBody, mechanics::integrators::Method, scenes::LoadedScene};

pub use predicted::predicted_limit;
pub use scene::scene_limit;
pub use six::linearised_six_limit;
pub use step_matrix::{growth, linearised_limit};

/// A scene's limit further from the linearised one than this part of it has a reason.
const NEAR: f64 = 0.06;

/// The eigenvalues of larger bodies take minutes; they have their bound alone.
const MOST_LINEARISED: usize = 100;

/// The limits of the step of one body by one method. An infinite limit is none: no step makes the method unstable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// The name of the scene.
    pub scene: String,
    /// The name of the body, and of those that are like it.
    pub body: String,
    /// The name of the method; `SixMatrix` for bodies of the six-matrix particle system.
    pub method: &'static str,
    /// From the eigenvalues of the linearised body; nothing where no formula is known.
    #[serde(serialize_with = "limit")]
    pub predicted: Option<f64>,
    /// The cheap bound, which is never above the true limit.
    #[serde(serialize_with = "finite")]
    pub bound: f64,
    /// By bisection on the growth of the linearised step; nothing where the method cannot step the body, and for large bodies.
    #[serde(serialize_with = "limit")]
    pub linearised: Option<f64>,
    /// The smallest step at which the scene's body explodes; nothing where the method cannot step it.
    #[serde(serialize_with = "limit")]
    pub explodes: Option<f64>,
    /// Why the body explodes at another step than the linearised one, where it does.
    pub reason: Option<&'static str>,
}

/// The limits of every body of a scene by every method. Bodies that differ only in where they are come once.
///
/// # Errors
/// If a body cannot be built, which loading the scene has found out before.
pub fn limits(scene: &LoadedScene) -> Result<Vec<Limits>, FileError> {
    let mut rows = Vec::new();
    for body in alike::distinct(ProblemBody::all(scene)?.0) {
        for method in Method::ALL {
            let parts = body.parts(method, scene.file.stick);
            if parts.particles.len() > MOST_LINEARISED {
                let bound = parts.stability_limit(0.0);
                rows.push(Limits {
                    scene: scene.source.stem(),
                    body: body.name.clone(),
                    method: method.name(),
                    predicted: None,
                    bound,
                    linearised: None,
                    explodes: None,
                    reason: Some("too large to be linearised"),
                });
                continue;
            }
            let linearised = linearised_limit(&parts);
            let explodes = linearised.and_then(|linearised| scene_limit(&parts, linearised));
            let reason = linearised
                .zip(explodes)
                .filter(|&(linearised, explodes)| is_apart(linearised, explodes))
                .map(|(linearised, explodes)| scene::reason(&parts, linearised, explodes));
            rows.push(Limits {
                scene: scene.source.stem(),
                body: body.name.clone(),
                method: method.name(),
                predicted: predicted_limit(&parts),
                bound: parts.stability_limit(0.0),
                linearised,
                explodes,
                reason,
            });
        }
    }
    rows.extend(six::rows(scene)?);
    Ok(rows)
}

/// Whether two limits differ by more than is expected of them.
fn is_apart(a: f64, b: f64) -> bool {
    a != b && (b - a).abs().partial_cmp(&(NEAR * a)).is_none_or(core::cmp::Ordering::is_gt)
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
