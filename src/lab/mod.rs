//! The laboratory: references, work-precision runs, stability limits and their charts.

mod cache;
pub mod chart;
mod choose;
mod energy;
mod error;
pub mod exercise;
mod gait;
mod gallery;
mod hash;
pub mod limits;
mod machine;
mod page;
mod partial;
mod problem;
mod record;
mod reference;
mod run;
mod shapes;
mod stiffness;
mod sweep;
mod table;
mod truth;

pub use cache::Cache;
pub use choose::{Candidate, Choice, Search, cheapest, choose, frontier};
pub use error::LabError;
pub use gait::GaitSpeeds;
pub use gallery::{Gallery, GalleryError, study_stem};
pub use machine::IS_DEBUG_BUILD;
pub use page::page;
pub use partial::{Partial, StudiedRun};
pub use problem::{Problem, ProblemBody};
pub use record::{Edge, Errors, Point, Setting, Unit, WorkPrecision};
pub use reference::{Reference, StickSlip};
pub use run::measure;
pub use shapes::Shapes;
pub use stiffness::{
    Crossing, FindRun, STIFFNESS_COLUMNS, StiffRun, StiffScene, StiffnessStudy, cheapest_run, crossing, crossing_of,
    factors, resumed_stiffness_study, stiffened, stiffness_csv, stiffness_study, studied_methods,
};
pub use sweep::{SweepOptions, resumed_sweep, sweep, work_precision};
pub use table::{COLUMNS, csv};
pub use truth::Truth;
