//! What work-precision runs have measured, as it is kept, drawn and written.

use serde::{Deserialize, Serialize};

use crate::mechanics::integrators::{Method, StickRule};

/// A method with its step: what a scene chooses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// The method.
    pub method: Method,
    /// When friction acts in its steps.
    pub stick: StickRule,
    /// The step.
    pub dt: f64,
}

/// What an error is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// The distance of a particle from where it should be.
    Length,
    /// A part of the speed of a gait.
    PartOfSpeed,
    /// A part of the spacing of a block's grid, or of the block's volume; see [`Budget::Shape`](crate::scenes::Budget::Shape).
    PartOfCell,
}

/// How far a run was from the truth: largest over all bodies and, of positions and shapes, over all shared times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Of the position of any particle (lengths), of the speed of any gait (as a part of it), or of any measure of a block (as a part of a cell).
    pub largest: f64,
    /// Root mean square over particles and shared times, over gaits, or over measures and times.
    pub rms: f64,
    /// Of the way of the centre of mass at the end, of that over the last cycles of a gait, or of a block's height at the end (lengths).
    pub distance: f64,
}

/// One run of a scene's problem.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// With what.
    pub setting: Setting,
    /// Steps taken.
    pub steps: u64,
    /// Evaluations of the forces of all bodies.
    pub evaluations: u64,
    /// The shortest of the timed runs, in seconds.
    pub seconds: f64,
    /// The median of the timed runs, in seconds.
    pub median_seconds: f64,
    /// Its errors; `None` where it blew up.
    pub errors: Option<Errors>,
}

/// The work-precision chart of one scene as numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkPrecision {
    /// The scene's name.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// The simulated time of a run.
    pub duration: f64,
    /// The seconds in which the app shows that time: duration / time scale.
    pub real_time: f64,
    /// All runs, method by method and from the largest step down.
    pub points: Vec<Point>,
    /// The stability limit of each method's step; infinite where none makes it unstable.
    #[serde(with = "limits")]
    pub limits: Vec<(Method, f64)>,
    /// The scene's own setting.
    pub setting: Setting,
    /// What an error is.
    pub unit: Unit,
    /// The error that the scene can afford, in that unit.
    pub budget: f64,
    /// What the reference is and what confirms it, in words.
    pub reference: String,
    /// How far the reference is from what confirms it, in the unit of errors.
    pub reference_error: f64,
    /// Processor and commit, in words.
    pub machine: String,
}

/// Limits as they are written: JSON has no infinity, so a method without a limit has null.
mod limits {
    use serde::{Deserialize, Deserializer, Serializer};

    use super::Method;

    pub(super) fn serialize<S: Serializer>(limits: &[(Method, f64)], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(limits.iter().map(|&(method, limit)| (method, limit.is_finite().then_some(limit))))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<(Method, f64)>, D::Error> {
        let limits = Vec::<(Method, Option<f64>)>::deserialize(deserializer)?;
        Ok(limits.into_iter().map(|(method, limit)| (method, limit.unwrap_or(f64::INFINITY))).collect())
    }
}
