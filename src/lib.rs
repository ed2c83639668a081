//! Wriggle simulates small soft creatures made of masses and springs, in Bevy.
//!
//! - **Play**: the binary `wriggle` opens a garden in which a worm crawls to its house.
//! - **Build a game**: add [`PhysicsPlugin`](physics::PhysicsPlugin) and spawn creatures, as below.
//! - **Study methods**: [`mechanics`] has the forces, the methods of integration and their stability limits; `wriggle run` steps any scene
//!   by any of them and records it.
//!
//! The README shows a worm in an app of your own, and how to write a creature file.
//!
//! # The map of the house
//!
//! A room uses only rooms that come before it in this list.
//!
//! | room | what it holds |
//! |---|---|
//! | [`body`] | what a body is made of: components, plain data and its invariants |
//! | [`mechanics`] | pure functions on a body's data: forces, friction, contact, energy, stability; one file a method of integration |
//! | [`creatures`] | blueprints (data) that become bodies, and the files that they are read from |
//! | [`physics`] | the plugin: clock, schedule, the systems of a tick, the watch |
//! | [`scenes`] | scene files that become entities; live parameters; saving |
//! | [`lab`] | how far methods are from the truth, and what they cost |
//! | `view` | what is drawn (with the feature `window`) |
//! | `panel` | what is set and plotted (with the feature `window`) |
//! | [`cli`] | one file a command |
#![warn(missing_docs)]

pub mod body;
pub mod cli;
pub mod creatures;
pub mod lab;
pub mod mechanics;
#[cfg(feature = "window")]
pub mod panel;
pub mod physics;
pub mod scenes;
#[cfg(feature = "window")]
pub mod view;

/// The README's example is compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// What a game needs to have creatures in it.
pub mod prelude {
    pub use crate::{
        body::{
            BodyError, Gravity, Ground, Muscle, Muscles, Particle, ParticleId, Particles, SpineFriction, Spring,
            SpringId, Springs, Wave,
        },
        creatures::{Creature, GardenWorm, Pose},
        mechanics::integrators::Method,
        physics::{BodyFrozen, Clock, FollowParticle, Frozen, PhysicsPlugin, PhysicsSystems, Restart, Shown},
    };
}
