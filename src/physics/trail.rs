//! Where a body has been.

use bevy::{ecs::prelude::*, math::DVec3, prelude::ReflectComponent, reflect::Reflect};

/// The way of a body's middle: one point every so many steps, so that it is the same whatever the ticks and frames are. A long way is kept in as many points as a
/// short one, further apart. Every body of the six-matrix particle system has it; a restart forgets it.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Trail {
    points: Vec<DVec3>,
    every: u64,
}

impl Default for Trail {
    fn default() -> Self {
        Self { points: Vec::new(), every: 10 }
    }
}

impl Trail {
    /// The most points that are kept.
    pub const MOST: usize = 1024;

    /// The points in order, the first where it started.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Takes notice of where the middle is before a step.
    pub(super) fn note(&mut self, step: u64, middle: impl FnOnce() -> DVec3) {
        if !step.is_multiple_of(self.every) {
            return;
        }
        if self.points.len() == Self::MOST {
            let mut index = 0;
            self.points.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2;
            if !step.is_multiple_of(self.every) {
                return;
            }
        }
        self.points.push(middle());
    }
}
