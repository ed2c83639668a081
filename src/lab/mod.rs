//! The laboratory: references, work-precision runs, stability limits and their charts.

pub mod limits;
mod record;

pub use record::{Errors, Point, Setting, WorkPrecision};
