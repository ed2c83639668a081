//! Springs that tear.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, Requirement, SpringId, check};

/// Springs that tear for good where they are stretched too far: at the start of a step a spring whose strain l/L − 1, by its rest length L without any muscle, is above the limit
/// exerts no force from then on. What is torn may lie as far apart as it will. A body without it holds together.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Tearing {
    strain: f64,
    /// Which springs are torn, in order; those beyond its end are not.
    torn: Vec<bool>,
}

impl Tearing {
    /// At this strain a spring is taken for exploded, and the watch freezes its body.
    pub const EXPLODED: f64 = 9.0;

    /// Springs that tear at a strain; none is torn yet.
    ///
    /// # Errors
    /// If the strain is not above zero, or not below [`EXPLODED`](Self::EXPLODED): such springs never tear.
    pub fn new(strain: f64) -> Result<Self, BodyError> {
        let strain = check(strain, Requirement::Positive, || "tear".into())?;
        if strain >= Self::EXPLODED {
            let most = Self::EXPLODED;
            let problem = format!(
                "{strain} is not allowed; give a number below {most}: a spring as long as {} rest lengths is taken for exploded and its body frozen, before it tears",
                1.0 + most
            );
            return Err(BodyError::Inconsistent { path: "tear".into(), problem });
        }
        Ok(Self { strain, torn: Vec::new() })
    }

    /// The strain at which springs tear.
    pub fn strain(&self) -> f64 {
        self.strain
    }

    /// Whether a spring is torn.
    pub fn is_torn(&self, spring: SpringId) -> bool {
        self.torn.get(spring.index()).is_some_and(|torn| *torn)
    }

    /// How many springs are torn.
    pub fn count(&self) -> usize {
        self.torn.iter().filter(|torn| **torn).count()
    }

    /// Makes all springs whole again.
    pub fn mend(&mut self) {
        self.torn.clear();
    }

    /// Notes which springs are torn.
    pub(crate) fn set_torn(&mut self, torn: impl Iterator<Item = bool>) {
        self.torn.clear();
        self.torn.extend(torn);
    }
}
