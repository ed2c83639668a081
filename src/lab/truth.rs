//! What candidates are compared with: the positions of a reference, or the speeds of gaits.

use crate::mechanics::integrators::Method;

use super::{Cache, GaitSpeeds, LabError, Problem, Reference, Setting, run::errors};

/// What is asked of a method in a scene, as the scene's error budget says.
#[derive(Clone, Debug, PartialEq)]
pub enum Truth {
    /// All positions, in lengths.
    Positions(Reference),
    /// How fast the bodies go, as a part of their speed.
    Speeds(GaitSpeeds),
}

impl Truth {
    /// What the budget of a problem asks for; a reference may come out of the cache.
    ///
    /// # Errors
    /// If it cannot be had.
    pub fn of(problem: &Problem, cache: &Cache) -> Result<Self, LabError> {
        Ok(match problem.gait_speed {
            Some(_) => Self::Speeds(GaitSpeeds::solve(problem)?),
            None => Self::Positions(cache.reference(problem)?),
        })
    }

    /// How far it is itself from what confirms it.
    pub fn error(&self) -> f64 {
        match self {
            Self::Positions(reference) => reference.error(),
            Self::Speeds(speeds) => speeds.error(),
        }
    }

    /// The error of a run; nothing where it blows up or its method refuses a step.
    pub(super) fn error_of(&self, problem: &Problem, setting: Setting) -> Option<f64> {
        match self {
            Self::Positions(reference) => Some(errors(problem, reference, setting)?.largest),
            Self::Speeds(speeds) => speeds.error_of(problem, setting),
        }
    }

    /// Whether a method may be chosen. One that tells the truth may not be judged by it.
    pub(super) fn may_judge(&self, method: Method) -> bool {
        matches!(self, Self::Positions(_)) || method != GaitSpeeds::METHOD
    }
}
