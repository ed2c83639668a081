//! Integration tests: headless apps, one file a subject.

mod support;

mod cli;
mod clock;
mod crawlers;
mod determinism;
mod exact_worm;
mod failures;
mod files;
mod friction;
mod garden_worm;
mod laws;
mod limits;
#[cfg(feature = "window")]
mod panel;
mod parameters;
#[cfg(feature = "window")]
mod picture;
mod saving;
mod stability;
mod sync;
mod watch;
