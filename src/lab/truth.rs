//! What candidates are compared with: the positions of a reference, or the speeds of gaits.

use crate::mechanics::integrators::Method;

use super::{Cache, Errors, GaitSpeeds, LabError, Problem, Reference, Setting, Unit, run::errors};

/// What is asked of a method in a scene, as the scene's error budget says.
///
/// A chart of positions shows how methods follow one motion; on the ground, where contacts are located by none, it shows how fast they let the animals go.
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
    /// If it cannot be had, or small steps tell speeds that are farther apart than the budget.
    pub fn of(problem: &Problem, cache: &Cache) -> Result<Self, LabError> {
        Ok(match problem.gait_speed {
            Some(budget) => {
                let speeds = cache.gait_speeds(problem)?;
                if speeds.error() > budget {
                    let what = format!(
                        "gaits whose speeds change by {:.2} % when steps that are small become twice as large",
                        100.0 * speeds.error()
                    );
                    return Err(LabError::Unsupported { scene: problem.name.clone(), what });
                }
                Self::Speeds(speeds)
            }
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

    /// What it is and what confirms it.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Positions(_) => Reference::WORDS,
            Self::Speeds(_) => GaitSpeeds::WORDS,
        }
    }

    /// What an error is.
    pub fn unit(&self) -> Unit {
        match self {
            Self::Positions(_) => Unit::Length,
            Self::Speeds(_) => Unit::PartOfSpeed,
        }
    }

    /// The error that the scene can afford, in that unit.
    pub(super) fn budget(&self, problem: &Problem) -> f64 {
        match self {
            Self::Positions(_) => problem.budget,
            Self::Speeds(_) => problem.gait_speed.unwrap_or(f64::INFINITY),
        }
    }

    /// The errors of a run; nothing where it blows up or its method refuses a step.
    pub(super) fn errors_of(&self, problem: &Problem, setting: Setting) -> Option<Errors> {
        match self {
            Self::Positions(reference) => errors(problem, reference, setting),
            Self::Speeds(speeds) => speeds.errors_of(problem, setting),
        }
    }

    /// Whether a method can be measured: it can step every body, and does not tell the truth itself.
    pub(super) fn may_judge(&self, problem: &Problem, method: Method) -> bool {
        let is_other = matches!(self, Self::Positions(_)) || method != GaitSpeeds::METHOD;
        is_other && problem.can_be_stepped_by(method)
    }
}
