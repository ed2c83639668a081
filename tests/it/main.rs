//! Integration tests: headless apps, one file a subject.

mod support;

mod clock;
mod determinism;
mod exact_worm;
mod friction;
mod garden_worm;
mod laws;
#[cfg(feature = "window")]
mod panel;
mod stability;
mod sync;
mod watch;
