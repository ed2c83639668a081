//! The laboratory: references, work-precision runs, stability limits and their charts.

mod cache;
mod choose;
mod error;
mod hash;
mod machine;
mod problem;
mod record;
mod reference;
mod run;
mod sweep;

pub use cache::Cache;
pub use choose::{Candidate, Choice, Search, cheapest, choose, frontier};
pub use error::LabError;
pub use problem::{Problem, ProblemBody};
pub use record::{Errors, Point, Setting, WorkPrecision};
pub use reference::{Reference, StickSlip};
pub use run::measure;
pub use sweep::{SweepOptions, sweep, work_precision};
