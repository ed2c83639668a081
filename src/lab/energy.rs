//! The energy of a body on its way.

use crate::{
    body::Particles,
    mechanics::{
        BodyParts, elastic_energy, gravity_energy,
        integrators::{Method, StickRule},
        kinetic_energy,
    },
};

use super::ProblemBody;

/// The energies of a body at the shared times.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Energies {
    /// In motion, in springs and in the field of gravity.
    pub(super) all: Vec<f64>,
    /// The largest that was in motion and in springs: what differences are parts of, since that in the field of gravity has no zero of its own.
    pub(super) scale: f64,
}

impl Energies {
    pub(super) fn push(&mut self, energy: Energy) {
        self.all.push(energy.all);
        self.scale = self.scale.max(energy.held);
    }

    /// By how much an energy at one of the shared times differs, as a part of the scale; nothing of a body that never has any.
    pub(super) fn apart(&self, energy: Energy, sample: usize) -> Option<f64> {
        (self.scale > 0.0).then(|| (energy.all - self.all[sample]).abs() / self.scale)
    }
}

/// The energy of a body at a moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy {
    all: f64,
    held: f64,
}

impl Energy {
    /// That of a body whose particles have come to be like this at `time`.
    pub(super) fn of(body: &ProblemBody, particles: &Particles, time: f64) -> Self {
        // Energy asks for no method.
        let parts = BodyParts { particles, ..body.parts(Method::default(), StickRule::default()) };
        let held = kinetic_energy(particles) + elastic_energy(&parts, time);
        Self { all: held + gravity_energy(&parts), held }
    }
}
