//! The laboratory: references, work-precision runs, stability limits and their charts.

mod record;

pub use record::{Errors, Point, Setting, WorkPrecision};
