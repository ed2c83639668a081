//! Wriggle: a simulator of small soft creatures made of masses and springs.
#![warn(missing_docs)]

pub mod body;
pub mod cli;
pub mod creatures;
pub mod mechanics;
#[cfg(feature = "window")]
pub mod panel;
pub mod physics;
pub mod scenes;
#[cfg(feature = "window")]
pub mod view;
