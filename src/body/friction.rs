//! Friction that knows where forward is.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, ParticleId, Particles, Requirement, check};

/// Friction along and across the spine.
///
/// The spine is a list of particles from tail to head. At each of them the spine vector is
/// S = (X_next − X_previous)/|X_next − X_previous|, one-sided at the ends (Miller 1988). Scales let a mass slide forward along S
/// and never back. Particles that are not on the spine feel no friction. On a body with a [`Ground`](super::Ground), only
/// masses in contact with it do.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct SpineFriction {
    spine: Vec<ParticleId>,
    ratchet: bool,
    drag: f64,
    grip: f64,
}

impl SpineFriction {
    /// Friction along `spine`, from tail to head, with the ratchet on and neither drag nor grip.
    ///
    /// # Errors
    /// If the spine has fewer than two particles, names one that is not there, or names one twice.
    pub fn new(spine: impl IntoIterator<Item = ParticleId>, particles: &Particles) -> Result<Self, BodyError> {
        Ok(Self { spine: check_spine(spine, particles)?, ratchet: true, drag: 0.0, grip: 0.0 })
    }

    /// Switches the ratchet: with it, S·V < 0 ⇒ V −= S(S·V).
    #[must_use]
    pub fn with_ratchet(mut self, ratchet: bool) -> Self {
        self.ratchet = ratchet;
        self
    }

    /// Sets the forward drag μ_f, the rate at which forward sliding dies away (1 a unit of time).
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn with_drag(mut self, drag: f64) -> Result<Self, BodyError> {
        self.drag = check(drag, Requirement::NonNegative, || "friction.drag".into())?;
        Ok(self)
    }

    /// Sets the side grip μ_l, the rate at which sliding across the spine dies away (1 a unit of time).
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn with_grip(mut self, grip: f64) -> Result<Self, BodyError> {
        self.grip = check(grip, Requirement::NonNegative, || "friction.grip".into())?;
        Ok(self)
    }

    /// The particles of the spine from tail to head.
    pub fn spine(&self) -> &[ParticleId] {
        &self.spine
    }

    /// Whether the ratchet is on.
    pub fn ratchet(&self) -> bool {
        self.ratchet
    }

    /// The forward drag μ_f.
    pub fn drag(&self) -> f64 {
        self.drag
    }

    /// The side grip μ_l.
    pub fn grip(&self) -> f64 {
        self.grip
    }
}

/// A spine of particles that are there, two or more, each once.
pub(super) fn check_spine(
    spine: impl IntoIterator<Item = ParticleId>,
    particles: &Particles,
) -> Result<Vec<ParticleId>, BodyError> {
    let spine: Vec<_> = spine.into_iter().collect();
    if spine.len() < 2 {
        return Err(BodyError::Inconsistent {
            path: "spine".into(),
            problem: format!("has {} particle(s); two or more, from tail to head, give it a direction", spine.len()),
        });
    }
    let mut seen = vec![false; particles.len()];
    for (i, particle) in spine.iter().enumerate() {
        let Some(seen) = seen.get_mut(particle.index()) else {
            return Err(BodyError::Missing {
                path: format!("spine[{i}]"),
                what: "particle",
                index: particle.0,
                count: particles.len(),
            });
        };
        if core::mem::replace(seen, true) {
            return Err(BodyError::Inconsistent {
                path: format!("spine[{i}]"),
                problem: format!("names particle {} a second time; a spine passes each once", particle.0),
            });
        }
    }
    Ok(spine)
}
