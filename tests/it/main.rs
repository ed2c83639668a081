//! Integration tests: headless apps, one file a subject.

mod support;

mod chart;
mod cli;
mod clock;
mod determinism;
mod exact_worm;
mod files;
mod friction;
mod gallery;
mod garden_worm;
mod lab;
mod laws;
#[cfg(feature = "window")]
mod panel;
mod parameters;
#[cfg(feature = "window")]
mod picture;
mod saving;
mod stability;
mod sync;
mod watch;
