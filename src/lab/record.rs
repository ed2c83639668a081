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
    /// Root mean square over particles and shared times, in [lengths of the body](crate::lab::ProblemBody::length); over gaits, or over measures and times.
    pub rms: f64,
    /// Of the way of the centre of mass at the end, of that over the last cycles of a gait, or of a block's height at the end (lengths).
    pub distance: f64,
    /// Of the way of the centre of mass in a cycle of the longest muscle, the largest of all cycles (lengths); nothing where no reference is or no muscle.
    pub cycle: Option<f64>,
    /// Of the energy, in the largest that the reference ever has in motion and in springs; nothing where no reference is. What has no muscles, no
    /// damping and no friction keeps its energy, so that this is the drift.
    pub energy: Option<f64>,
    /// How deep any particle ever was below the ground at two hundred times (lengths): no error to a reference. Nothing where no ground is.
    pub penetration: Option<f64>,
}

/// The stability edge of a method: its largest stable step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// The method.
    pub method: Method,
    /// The step; infinite where none makes the method unstable.
    #[serde(with = "infinite")]
    pub dt: f64,
    /// Whether it follows from the eigenvalues of the linearised bodies; else it is a bound, and the edge may be larger.
    pub predicted: bool,
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
    /// How often it was timed.
    pub runs: usize,
    /// The shortest of the timed runs, in seconds.
    pub seconds: f64,
    /// The median of the timed runs, in seconds.
    pub median_seconds: f64,
    /// Its errors; `None` where it blew up.
    pub errors: Option<Errors>,
}

impl Point {
    /// The largest error; `None` where it blew up or is not finite.
    pub fn largest_error(&self) -> Option<f64> {
        self.errors.map(|errors| errors.largest).filter(|error| error.is_finite() && *error >= 0.0)
    }
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
    /// The stability edge of each method.
    pub edges: Vec<Edge>,
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

impl WorkPrecision {
    /// An error is known when the reference is so many times surer.
    pub const SURER: f64 = 100.0;

    /// The least error that is known: [`Self::SURER`] times as large as what the reference and what confirms it differ by.
    pub fn least_known_error(&self) -> f64 {
        Self::SURER * self.reference_error
    }

    /// Whether the error of a run is known, and not as small as what the reference itself may be off by.
    pub fn is_known(&self, point: &Point) -> bool {
        point.largest_error().is_some_and(|error| error >= self.least_known_error())
    }
}

/// Numbers as they are written that may be infinite: JSON has no infinity, so that is null.
mod infinite {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        value.is_finite().then_some(value).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
    }
}
