//! Scenes: from a file to entities, switching between them, their live parameters, and saving them.
//!
//! [`load`] reads and checks a scene with its creatures, and nothing in the world changes until all of it is good; [`open`] then puts
//! it there. [`ScenesPlugin`] does both when asked by [`SceneChange`] and reports a bad file as [`SceneProblem`].

mod alone;
mod file;
mod fits;
pub mod garden;
mod load;
pub mod parameters;
mod race;
#[cfg(feature = "window")]
mod rescue;
mod roads;
mod save;
mod spawn;
mod switch;
#[cfg(feature = "window")]
mod watch;

pub use crate::creatures::FileError;
pub use file::{Budget, Camera, DOCUMENT_DT, FIELD_OF_VIEW, OnRoad, Placement, Props, SceneClock, SceneFile, StepSize};
pub use load::{LoadedScene, load, load_creature, read_scene};
pub use race::{Ghost, Runner};
#[cfg(feature = "window")]
pub use rescue::{BodyRescued, RescuePlugin};
pub use save::save;
pub(crate) use save::write;
pub use spawn::{CurrentScene, SceneBodies, SceneMember, open};
pub use switch::{SceneChange, SceneProblem, ScenesPlugin};
#[cfg(feature = "window")]
pub use watch::WatchPlugin;
