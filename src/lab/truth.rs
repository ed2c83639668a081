//! What candidates are compared with: the positions of a reference, the speeds of gaits, or the shapes of blocks.

use crate::mechanics::integrators::Method;

use super::{Cache, Errors, GaitSpeeds, LabError, Problem, Reference, Setting, Shapes, Unit, run::errors};

/// What judges errors of a budget is known to so much of it.
const SURE: f64 = 0.25;

/// What is asked of a method in a scene, as the scene's error budget says.
///
/// A chart of positions shows how methods follow one motion; on the ground, where contacts are located by none, it shows how fast they let the animals go,
/// or how blocks keep their shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Truth {
    /// All positions, in lengths.
    Positions(Reference),
    /// How fast the bodies go, as a part of their speed.
    Speeds(GaitSpeeds),
    /// How blocks fall and keep their shape, as a part of a cell.
    Shapes(Shapes),
}

impl Truth {
    /// What the budget of a problem asks for; a reference may come out of the cache.
    ///
    /// # Errors
    /// If it cannot be had, or small steps tell speeds or shapes that are farther apart than a quarter of the budget.
    pub fn of(problem: &Problem, cache: &Cache) -> Result<Self, LabError> {
        let (truth, what) = match problem.unit {
            Unit::Length => return Ok(Self::Positions(cache.reference(problem)?)),
            Unit::PartOfSpeed => (Self::Speeds(cache.gait_speeds(problem)?), "gaits whose speeds change"),
            Unit::PartOfCell => (Self::Shapes(cache.shapes(problem)?), "blocks whose shapes change"),
        };
        if truth.error() > SURE * problem.budget {
            let error = 100.0 * truth.error();
            let most = 100.0 * SURE * problem.budget;
            let what = format!(
                "{what} by {error:.2} % when steps that are small become twice as large; {most:.2e} % would tell enough for this budget"
            );
            return Err(LabError::Unsupported { scene: problem.name.clone(), what });
        }
        Ok(truth)
    }

    /// The truth of a problem as far as it can be known, and the problem, shortened to that where gaits become chaotic: what a body does long after it
    /// buckled or met a wall depends on roundings, and no method can be blamed for it. It must be known in steps that are twice as large, too: what small
    /// steps hardly agree on tells other methods nothing. At least two cycles of the longest period have to be known.
    ///
    /// # Errors
    /// As [`Self::of`], of the whole duration.
    pub fn as_far_as_known(problem: Problem, cache: &Cache) -> Result<(Problem, Self), LabError> {
        match Self::of(&problem, cache) {
            Err(error @ LabError::Unsupported { .. }) if problem.unit == Unit::PartOfSpeed => {
                let known = problem.shorter().find_map(|shorter| {
                    let Setting { dt, .. } = shorter.setting;
                    let coarser = Problem { setting: Setting { dt: 2.0 * dt, ..shorter.setting }, ..shorter.clone() };
                    Self::of(&coarser, cache).and_then(|_| Self::of(&shorter, cache)).ok().map(|truth| (shorter, truth))
                });
                known.ok_or(error)
            }
            truth => Ok((problem, truth?)),
        }
    }

    /// How far it is itself from what confirms it.
    pub fn error(&self) -> f64 {
        match self {
            Self::Positions(reference) => reference.error(),
            Self::Speeds(speeds) => speeds.error(),
            Self::Shapes(shapes) => shapes.error(),
        }
    }

    /// What it is and what confirms it.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Positions(_) => Reference::WORDS,
            Self::Speeds(_) => GaitSpeeds::WORDS,
            Self::Shapes(_) => Shapes::WORDS,
        }
    }

    /// What an error is.
    pub fn unit(&self) -> Unit {
        match self {
            Self::Positions(_) => Unit::Length,
            Self::Speeds(_) => Unit::PartOfSpeed,
            Self::Shapes(_) => Unit::PartOfCell,
        }
    }

    /// The errors of a run; nothing where it blows up or its method refuses a step.
    pub(super) fn errors_of(&self, problem: &Problem, setting: Setting) -> Option<Errors> {
        match self {
            Self::Positions(reference) => errors(problem, reference, setting),
            Self::Speeds(speeds) => speeds.errors_of(problem, setting),
            Self::Shapes(shapes) => shapes.errors_of(problem, setting),
        }
    }

    /// Whether a method can be measured: it can step every body, and does not tell the truth itself.
    pub(super) fn may_judge(&self, problem: &Problem, method: Method) -> bool {
        let tells = match self {
            Self::Positions(_) => None,
            Self::Speeds(_) => Some(GaitSpeeds::METHOD),
            Self::Shapes(_) => Some(Shapes::METHOD),
        };
        tells != Some(method) && problem.can_be_stepped_by(method)
    }
}
