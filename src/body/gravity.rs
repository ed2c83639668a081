//! What pulls at a body: gravity.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

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
