//! What can be wrong with a file.

use thiserror::Error;

/// Why a file cannot be read, used or written. Every message names the file and says what would be right.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FileError {
    /// Nothing of this name is anywhere.
    #[error("there is no {what} `{name}`{}; looked for {}", did_you_mean(near), places.join(", "))]
    NotFound {
        /// `scene` or `creature`.
        what: &'static str,
        /// What was asked for.
        name: String,
        /// Where it was looked for, in order.
        places: Vec<String>,
        /// Names that are there and look alike.
        near: Vec<String>,
    },
    /// Bad syntax, an unknown field or a value that is not allowed.
    #[error("{file}:{line}:{column}: {field}{problem}")]
    Value {
        /// The file.
        file: String,
        /// The line, counted from 1.
        line: usize,
        /// The column in characters, counted from 1.
        column: usize,
        /// The path of the field with a colon and a space behind it, or nothing.
        field: String,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// Two places of a file, or of a scene and its creature, contradict each other.
    #[error("{file}{}: {path}: {problem}", line.map(|line| format!(":{line}")).unwrap_or_default())]
    Conflict {
        /// The file.
        file: String,
        /// The line of the element, counted from 1; nothing where the file does not write it out.
        line: Option<usize>,
        /// The element, such as `springs[3].ends`.
        path: String,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// The file as a whole: missing rights, a folder, empty, too large, no text.
    #[error("{file}: {problem}")]
    Unreadable {
        /// The file.
        file: String,
        /// What is wrong and what would be right.
        problem: String,
    },
    /// The file could not be written. What it held before is still there.
    #[error("{file}: could not be written: {problem}")]
    Unwritable {
        /// The file.
        file: String,
        /// What went wrong.
        problem: String,
    },
}

fn did_you_mean(near: &[String]) -> String {
    if near.is_empty() { String::new() } else { format!(" (did you mean {}?)", near.join(" or ")) }
}
