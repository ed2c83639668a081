//! The columns d and m of the six-matrix particle system.

use bevy::{ecs::prelude::*, math::DVec3, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, Requirement, check};

/// The damping d and the memory m of each particle, beside the position and velocity that [`Particles`](super::Particles) holds: the model of motion
/// keeps the part d of a velocity in each step, and a [`Rule`](super::Rule) reads and writes memory (Holopainen and Rönkkö 2007, section 2).
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Columns {
    damping: Vec<f64>,
    memory: Vec<DVec3>,
    /// The memory at the start.
    first: Vec<DVec3>,
}

impl Columns {
    /// The columns of a body: damping and memory particle by particle.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn new(rows: impl IntoIterator<Item = (f64, DVec3)>) -> Result<Self, BodyError> {
        let mut columns = Self::default();
        for (i, (damping, memory)) in rows.into_iter().enumerate() {
            columns.damping.push(check(damping, Requirement::Finite, || format!("particles[{i}].damping"))?);
            for value in memory.to_array() {
                check(value, Requirement::Finite, || format!("particles[{i}].memory"))?;
            }
            columns.memory.push(memory);
        }
        columns.first.clone_from(&columns.memory);
        Ok(columns)
    }

    /// How many particles they are for.
    pub fn len(&self) -> usize {
        self.damping.len()
    }

    /// Whether they are for none.
    pub fn is_empty(&self) -> bool {
        self.damping.is_empty()
    }

    /// d: the part of its velocity that each particle keeps in a step, 1 for all of it.
    pub fn damping(&self) -> &[f64] {
        &self.damping
    }

    /// Sets d of one particle, if there is such a particle.
    ///
    /// # Errors
    /// If it is not finite; nothing is changed then.
    pub fn set_damping(&mut self, particle: usize, damping: f64) -> Result<(), BodyError> {
        let damping = check(damping, Requirement::Finite, || format!("particles[{particle}].damping"))?;
        if let Some(old) = self.damping.get_mut(particle) {
            *old = damping;
        }
        Ok(())
    }

    /// m: three numbers a particle, whose meaning is that of the rules that use them.
    pub fn memory(&self) -> &[DVec3] {
        &self.memory
    }

    /// m, for steppers.
    pub(crate) fn memory_mut(&mut self) -> &mut [DVec3] {
        &mut self.memory
    }

    /// Remembers what was remembered at the start.
    pub fn rewind(&mut self) {
        self.memory.clone_from(&self.first);
    }
}
