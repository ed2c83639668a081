//! Friction that knows where forward is.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, ParticleId, Particles, Requirement, check};

/// Friction along and across the spine.
///
/// The spine is a list of sections from tail to head, of one particle each or of as many as a [`Strand`](super::Strand) has in a section. At each of
/// them the spine vector is S = (X_next − X_previous)/|X_next − X_previous| with the sections' centres X, one-sided at the ends (Miller 1988), and it is that of
/// all masses of the section. Scales let a mass slide forward along S and never back. Particles that are not on the spine feel no friction. On a body with
/// a [`Ground`](super::Ground), only masses in contact with it do.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct SpineFriction {
    /// Section by section.
    spine: Vec<ParticleId>,
    /// How many particles a section has.
    width: usize,
    ratchet: bool,
    drag: f64,
    grip: f64,
    isotropic: f64,
    brake: f64,
}

impl SpineFriction {
    /// Friction along `spine`, from tail to head, with the ratchet on and nothing else.
    ///
    /// # Errors
    /// If the spine has fewer than two particles, names one that is not there, or names one twice.
    pub fn new(spine: impl IntoIterator<Item = ParticleId>, particles: &Particles) -> Result<Self, BodyError> {
        let spine = check_spine(spine, particles)?;
        Ok(Self { spine, width: 1, ratchet: true, drag: 0.0, grip: 0.0, isotropic: 0.0, brake: 0.0 })
    }

    /// The same along sections of `W` particles, one or more.
    ///
    /// # Errors
    /// If there are fewer than two sections, or they name a particle that is not there or one twice.
    pub fn along_sections<const W: usize>(
        sections: impl IntoIterator<Item = [ParticleId; W]>,
        particles: &Particles,
    ) -> Result<Self, BodyError> {
        let spine: Vec<_> = sections.into_iter().flatten().collect();
        if spine.len() < 2 * W {
            return Err(BodyError::Inconsistent {
                path: "spine".into(),
                problem: "has fewer than two sections; two or more, from tail to head, give it a direction".into(),
            });
        }
        Ok(Self { width: W, ..Self::new(spine, particles)? })
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

    /// Sets the isotropic friction μ_iso, the rate at which sliding in any direction dies away (1 a unit of time): along the surface of a ground, and in all
    /// directions without one. No animal crawls by it alone; it is there for comparison.
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn with_isotropic(mut self, isotropic: f64) -> Result<Self, BodyError> {
        self.isotropic = check(isotropic, Requirement::NonNegative, || "friction.isotropic".into())?;
        Ok(self)
    }

    /// Sets the brake, the least forward drag and side grip of a body whose [`TravelingWaves`](super::TravelingWaves) are told to rest (1 a unit of time).
    /// Without it a snake that stops coasts more than its own length.
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn with_brake(mut self, brake: f64) -> Result<Self, BodyError> {
        self.brake = check(brake, Requirement::NonNegative, || "friction.brake".into())?;
        Ok(self)
    }

    /// The particles of the spine from tail to head, section by section.
    pub fn spine(&self) -> &[ParticleId] {
        &self.spine
    }

    /// How many particles a section of the spine has.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The sections of the spine from tail to head.
    pub fn sections(&self) -> impl ExactSizeIterator<Item = &[ParticleId]> {
        self.spine.chunks(self.width)
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

    /// The isotropic friction μ_iso.
    pub fn isotropic(&self) -> f64 {
        self.isotropic
    }

    /// The least forward drag and side grip while the muscles are told to rest.
    pub fn brake(&self) -> f64 {
        self.brake
    }

    /// The largest of its rates that may act.
    pub(crate) fn fastest(&self) -> f64 {
        self.drag.max(self.grip).max(self.isotropic).max(self.brake)
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
