//! The exercise "Mass-Spring-Damper model": its five questions, answered with runs made on the spot.

mod answers;
mod page;
mod runs;

use crate::{
    body::BodyError,
    lab::{chart::curves::Curves, machine::machine},
};

pub use page::{html, text};

/// How large the runs of the exercise are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExerciseOptions {
    /// How many masses the block has each way, 3 or more. The exercise has 5.
    pub count: u32,
    /// How long blocks are followed until they have come to rest.
    pub time: f64,
    /// How often the interval of a largest step is halved.
    pub halvings: u32,
    /// How many steps, or 400/3000 units of time for each, a block must stay whole for a step to be called stable.
    pub trial: u32,
}

impl Default for ExerciseOptions {
    fn default() -> Self {
        Self { count: 5, time: 2000.0, halvings: 9, trial: 3000 }
    }
}

/// The exercise, answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Exercise {
    /// On what it was measured.
    pub machine: String,
    /// One for each question.
    pub answers: Vec<Answer>,
}

/// The answer to a question.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The question, shortened.
    pub question: &'static str,
    /// What there is to say.
    pub paragraphs: Vec<String>,
    /// What was measured, beside the theory.
    pub tables: Vec<Table>,
    /// What was seen.
    pub figures: Vec<Curves>,
}

/// Rows of cells under a head.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// The head of each column.
    pub head: Vec<&'static str>,
    /// The rows, each with a cell a column.
    pub rows: Vec<Vec<String>>,
}

/// What answers a question.
type Question = fn(&ExerciseOptions) -> Result<Answer, BodyError>;

/// Answers the exercise. `done` is told after each answer how many there are.
///
/// # Errors
/// If a block cannot be built.
pub fn exercise(options: &ExerciseOptions, done: &mut dyn FnMut(usize)) -> Result<Exercise, BodyError> {
    let questions: [Question; 5] =
        [answers::template, answers::springs, answers::tilts, answers::neighbours, answers::verlet];
    let mut all = Vec::new();
    for question in questions {
        all.push(question(options)?);
        done(all.len());
    }
    Ok(Exercise { machine: machine(), answers: all })
}
