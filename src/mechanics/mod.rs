//! Mechanics.
pub mod integrators;
