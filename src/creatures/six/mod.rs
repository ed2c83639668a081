//! Creatures of the six-matrix particle system, as data: particles in groups, bonds and collisions by groups and distances, and rules by name.
//!
//! [`Inchworm`] and [`Roller`] are made of the same [`Composed`] data that a file can write out, so a third creature needs no Rust.

mod build;
mod composed;
mod course;
mod inchworm;
mod roads;
mod roller;

pub use build::SixBody;
pub use composed::{
    Composed, DrivePlan, GroupPlan, LegPlan, MusclePlan, PairPlan, ParticlePlace, RangePlace, RulePlan, Shape, SixSkin,
    WeightPlan, WheelPlan,
};
pub use course::Course;
pub use inchworm::Inchworm;
pub use roads::{Height, Helix, RoadFile, RoadForm, Rough, Station, Strip};
pub use roller::Roller;

/// The most particles of a composed creature: every pair of them is asked for bonds and collisions.
pub const MOST_COMPOSED: usize = 4096;
