//! What surrounds a body: gravity and the ground.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{BodyError, Requirement, check};

/// Gravity: every free particle of the body accelerates by this much towards −y.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Gravity(f64);

impl Gravity {
    /// Gravity of `acceleration` (lengths a squared unit of time).
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn new(acceleration: f64) -> Result<Self, BodyError> {
        check(acceleration, Requirement::NonNegative, || "gravity".into()).map(Self)
    }

    /// The acceleration.
    pub fn acceleration(self) -> f64 {
        self.0
    }
}

/// The ground that a body stands on: no particle of the body gets below it, and friction acts only on masses that touch it.
/// A body without this component meets no ground, and its friction always acts.
#[derive(Clone, Component, Copy, Debug, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[reflect(Component)]
pub enum Ground {
    /// The plane y = 0.
    Flat,
}

impl Ground {
    /// A mass nearer to the ground than this touches it, and friction acts on it.
    pub const CONTACT_DISTANCE: f64 = 0.05;
}
