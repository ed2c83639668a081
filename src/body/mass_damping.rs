//! Damping by what surrounds a body.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{BodyError, Requirement, check};

/// Damping in proportion to mass, of every free particle: a force −c·m·v. A body without it moves in a vacuum.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[reflect(Component)]
pub enum MassDamping {
    /// The rate c, 1 a unit of time: the physics does not depend on dt.
    Rate(f64),
    /// The λ of damped Verlet, x⁺ = (2−λ)x − (1−λ)x⁻ + a·dt²: the part of a velocity that every step takes, whatever its dt. The same as a
    /// rate of −ln(1−λ)/dt.
    PerStep(f64),
}

impl MassDamping {
    /// Damping at a rate.
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn rate(rate: f64) -> Result<Self, BodyError> {
        check(rate, Requirement::NonNegative, || "damping".into()).map(Self::Rate)
    }

    /// A part of the velocity in each step.
    ///
    /// # Errors
    /// If it is not from 0 to below 1.
    pub fn per_step(part: f64) -> Result<Self, BodyError> {
        let part = check(part, Requirement::NonNegative, || "damping".into())?;
        if part >= 1.0 {
            let problem = format!("takes {part} of the velocity in a step; it must be below 1");
            return Err(BodyError::Inconsistent { path: "damping".into(), problem });
        }
        Ok(Self::PerStep(part))
    }

    /// The rate c that it has with steps of `dt`.
    pub fn rate_at(self, dt: f64) -> f64 {
        match self {
            Self::Rate(rate) => rate,
            Self::PerStep(part) => -libm::log1p(-part) / dt,
        }
    }
}
