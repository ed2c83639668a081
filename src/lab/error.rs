//! Why a problem cannot be measured.

use thiserror::Error;

use crate::creatures::FileError;

/// Why the laboratory has no answer.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LabError {
    /// The scene cannot be opened.
    #[error(transparent)]
    File(#[from] FileError),
    /// The scene has something for which no reference solution is known.
    #[error("{scene}: there is no reference solution of {what}")]
    Unsupported {
        /// The scene's name.
        scene: String,
        /// What it is that the scene has.
        what: String,
    },
    /// The reference solution of a body broke off.
    #[error("{body}: its reference solution broke off at t = {time}: {problem}")]
    Reference {
        /// The body's name.
        body: String,
        /// When.
        time: f64,
        /// What happened.
        problem: String,
    },
    /// No method is good enough at any step that was tried.
    #[error("{scene}: no method keeps the error within {budget:.3e} at any step that was tried")]
    NothingFits {
        /// The scene's name.
        scene: String,
        /// The error that the scene can afford (lengths).
        budget: f64,
    },
}
