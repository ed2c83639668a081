//! The laboratory: references, work-precision runs, stability limits and their charts.

pub mod chart;
mod gallery;
mod page;
mod record;
mod table;

pub use gallery::{Gallery, GalleryError};
pub use page::page;
pub use record::{Errors, Point, Setting, WorkPrecision};
pub use table::{COLUMNS, csv};
