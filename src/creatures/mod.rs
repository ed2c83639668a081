//! Creatures as data: a blueprint, read from a file, becomes the components of a body. Needs no Bevy schedule.
//!
//! A [`Creature`] is a kind with parameters ([`GardenWorm`], [`StrandPlan`], [`JellyPlan`]) or raw lists of particles and springs ([`RawBody`]); or it belongs to the
//! six-matrix particle system as a kind ([`Inchworm`], [`Roller`]) or written out ([`Composed`]), and then moves on a road ([`RoadFile`]). [`Creature::body`]
//! places it in the world and gives a [`Body`], which is put on an entity as a command:
//!
//! ```
//! use bevy::{ecs::system::EntityCommand, prelude::*};
//! use wriggle::creatures::{Creature, GardenWorm, Pose};
//!
//! let mut world = World::new();
//! let body = Creature::from(GardenWorm::default()).body(Pose::default())?;
//! body.apply(world.spawn(Name::new("worm")));
//! # Ok::<(), wriggle::body::BodyError>(())
//! ```

mod blueprint;
mod build;
mod error;
mod garden_worm;
mod jelly;
pub mod library;
mod locate;
mod look;
mod memory;
pub(crate) mod numbers;
mod parse;
mod six;
mod strand;
mod wording;

pub use blueprint::{Coulomb, Creature, Friction, Plan, RawBody, RawMuscle, RawParticle, RawSpring};
pub use build::{Body, Pose};
pub use error::FileError;
pub use garden_worm::GardenWorm;
pub use jelly::{Attitude, JellyPlan, NeighboursPlan, Rotation, SpringPlan};
pub(crate) use locate::line_of;
pub use look::{Look, Skin};
pub(crate) use parse::{CurrentVersion, options, parse, version};
pub use six::{
    Composed, Course, DrivePlan, GroupPlan, Height, Helix, Inchworm, LegPlan, MOST_COMPOSED, MusclePlan, PairPlan,
    ParticlePlace, RangePlace, RoadFile, RoadForm, Roller, Rough, RulePlan, Shape, SixBody, SixSkin, Station, Strip,
    WeightPlan, WheelPlan,
};
pub use strand::{StrandPlan, WavePlan};

/// The most particles that the creatures of a scene may have together. Files that ask for more are refused before memory is taken.
pub const MOST_PARTICLES: usize = 4_000_000;

/// No coordinate of a creature with springs starts further away: from here on, a position has fewer than seven decimals.
pub const FARTHEST: f64 = 1e9;
