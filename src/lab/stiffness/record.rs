//! What a study of stiffness has found, as it is kept, drawn and written.

use serde::{Deserialize, Serialize};

use crate::{lab::Point, mechanics::integrators::Method};

/// The cheapest run of a method that is good enough.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StiffRun {
    /// The method.
    pub method: Method,
    /// The run; `None` where no step that was tried is good enough.
    pub run: Option<Point>,
}

/// A scene with every spring stiffer by a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StiffScene {
    /// By how much every stiffness is multiplied; every damping by its root.
    pub factor: f64,
    /// How far the reference moves the centre of mass of a body, at most (lengths): it shows whether the motion is still the same.
    pub way: f64,
    /// How far the reference is from what confirms it (lengths).
    pub reference_error: f64,
    /// Every method.
    pub runs: Vec<StiffRun>,
}

impl StiffScene {
    /// The run of a method that is good enough, if there is one.
    pub fn run(&self, method: Method) -> Option<&Point> {
        self.runs.iter().find(|run| run.method == method)?.run.as_ref()
    }

    /// The cheapest method of those that `of` admits, and its seconds.
    pub fn cheapest(&self, of: impl Fn(Method) -> bool) -> Option<(Method, f64)> {
        let runs = self.runs.iter().filter(|run| of(run.method));
        let costs = runs.filter_map(|run| Some((run.method, run.run?.seconds)));
        costs.filter(|(_, seconds)| *seconds > 0.0).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// What good enough costs with stiffer and stiffer springs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StiffnessStudy {
    /// The scene's name.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// The simulated time of a run.
    pub duration: f64,
    /// The error that the scene can afford (lengths).
    pub budget: f64,
    /// How often a run was timed.
    pub repeats: usize,
    /// The scene from its own stiffness upwards.
    pub scenes: Vec<StiffScene>,
    /// Why it ends where it ends, if not because it was meant to.
    pub ended: Option<String>,
    /// What the reference is and what confirms it, in words.
    pub reference: String,
    /// Processor and commit, in words.
    pub machine: String,
}
