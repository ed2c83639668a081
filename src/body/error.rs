//! What can be wrong with a body, said so that it can be mended.

use thiserror::Error;

/// What a number must be. Constructors, files, sliders and flags all refuse a value by the same requirement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Requirement {
    /// Neither infinite nor NaN.
    Finite,
    /// Finite and above zero.
    Positive,
    /// Finite and zero or more.
    NonNegative,
}

impl Requirement {
    /// Whether `value` meets the requirement.
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Finite => true,
                Self::Positive => value > 0.0,
                Self::NonNegative => value >= 0.0,
            }
    }
}

impl core::fmt::Display for Requirement {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Finite => "a finite number",
            Self::Positive => "a finite number above 0",
            Self::NonNegative => "a finite number, 0 or more",
        })
    }
}

/// Why a body cannot be built or changed. Every variant names the element, as files and `--set` write it.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BodyError {
    /// A number is outside of what its field allows.
    #[error("{path}: {value} is not allowed; give {requirement}")]
    Value {
        /// The element and field, such as `springs[3].stiffness`.
        path: String,
        /// What was given.
        value: f64,
        /// What would be right.
        requirement: Requirement,
    },
    /// An index names an element that does not exist.
    #[error("{path}: there is no {what} {index}; this body has {count} ({what}s are counted from 0)")]
    Missing {
        /// The element and field that hold the index.
        path: String,
        /// `particle` or `spring`.
        what: &'static str,
        /// The index given.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// Elements contradict each other or a rule that is no range of one number.
    #[error("{path}: {problem}")]
    Inconsistent {
        /// The element and field.
        path: String,
        /// What is wrong and what would be right.
        problem: String,
    },
}

/// Returns `value` if it meets `requirement`.
///
/// # Errors
/// [`BodyError::Value`] with the path that `path` makes; it is only called when there is an error to report.
pub fn check(value: f64, requirement: Requirement, path: impl FnOnce() -> String) -> Result<f64, BodyError> {
    if requirement.admits(value) { Ok(value) } else { Err(BodyError::Value { path: path(), value, requirement }) }
}

/// Refuses a number above 0 that is so small that its inverse is infinite: of a mass or a period it is the inverse that is computed with.
///
/// # Errors
/// [`BodyError::Inconsistent`] with the path that `path` makes, whose field is called `what`.
pub(super) fn check_inverse(value: f64, what: &str, path: impl FnOnce() -> String) -> Result<(), BodyError> {
    if value.recip().is_finite() {
        return Ok(());
    }
    let problem = format!("{value:e} is so small that its inverse is infinite; give a larger {what}");
    Err(BodyError::Inconsistent { path: path(), problem })
}
