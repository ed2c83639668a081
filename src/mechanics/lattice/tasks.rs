//! What is done with the layers of a block: forces, whole steps, or only lengths.

use core::ops::Range;

use super::{join::Ask, layer::Layer, sweep::Task};

/// Finds what accelerates the masses.
pub(super) struct Accelerate<'a> {
    pub(super) position: &'a [[f64; 3]],
    pub(super) velocity: &'a [[f64; 3]],
    pub(super) inverse_mass: &'a [f64],
    pub(super) gravity: f64,
    /// The first layer of the slab.
    pub(super) start: usize,
    /// Of the masses of the slab.
    pub(super) acceleration: &'a mut [[f64; 3]],
}

impl Task for Accelerate<'_> {
    #[inline(always)]
    fn read(&self, into: &mut Layer, _: usize, masses: Range<usize>, ask: Ask) {
        into.set(&self.position[masses.clone()], (ask == Ask::Damped).then(|| &self.velocity[masses]), 0.0);
    }

    #[inline(always)]
    fn write(&mut self, from: &mut Layer, masses: Range<usize>) {
        let first = self.start * masses.len();
        let own = &mut self.acceleration[masses.start - first..masses.end - first];
        let inverse_mass = &self.inverse_mass[masses];
        from.each_force(own.len(), |i, force| own[i] = accelerated(force, inverse_mass[i], self.gravity));
    }
}

/// How a method of kicks and drifts moves a mass: it drifts, is kicked, and drifts on.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanics) struct KickDrift {
    /// The step.
    pub(in crate::mechanics) dt: f64,
    /// For how long it drifts before and after the kick.
    pub(in crate::mechanics) before: f64,
    pub(in crate::mechanics) after: f64,
    /// The rate of damping by mass as a part of the acceleration.
    pub(in crate::mechanics) rate: f64,
    /// What a kick leaves of the velocity.
    pub(in crate::mechanics) kept: f64,
}

/// Positions and velocities of a layer.
pub(super) type Rows = (Vec<[f64; 3]>, Vec<[f64; 3]>);

/// What moves the masses of a block, beside its springs.
#[derive(Clone, Copy)]
pub(super) struct Motion<'a> {
    pub(super) rule: KickDrift,
    pub(super) gravity: f64,
    /// Whether there is a floor at y = 0.
    pub(super) floor: bool,
    pub(super) inverse_mass: &'a [f64],
}

/// Takes whole steps.
pub(super) struct Move<'a> {
    pub(super) motion: Motion<'a>,
    /// The first layer of the slab, and how many it has.
    pub(super) start: usize,
    pub(super) count: usize,
    /// The layers before and behind the slab, which belong to others, as they were before the step.
    pub(super) beside: [Rows; 2],
    /// Of the masses of the slab.
    pub(super) position: &'a mut [[f64; 3]],
    pub(super) velocity: &'a mut [[f64; 3]],
}

impl Move<'_> {
    /// Copies the first or the last layer of the slab.
    pub(super) fn hand_out(&self, which: usize, into: &mut Rows) {
        let layer = self.position.len() / self.count;
        let rows = if which == 0 { 0..layer } else { self.position.len() - layer..self.position.len() };
        into.0.clear();
        into.0.extend_from_slice(&self.position[rows.clone()]);
        into.1.clear();
        into.1.extend_from_slice(&self.velocity[rows]);
    }
}

impl Task for &mut Move<'_> {
    #[inline(always)]
    fn read(&self, into: &mut Layer, layer: usize, masses: Range<usize>, _: Ask) {
        let (position, velocity) = if layer < self.start {
            (&self.beside[0].0[..], &self.beside[0].1[..])
        } else if layer >= self.start + self.count {
            (&self.beside[1].0[..], &self.beside[1].1[..])
        } else {
            let first = self.start * masses.len();
            let own = masses.start - first..masses.end - first;
            (&self.position[own.clone()], &self.velocity[own])
        };
        into.set(position, Some(velocity), self.motion.rule.before);
    }

    #[inline(always)]
    fn write(&mut self, from: &mut Layer, masses: Range<usize>) {
        let first = self.start * masses.len();
        let own = masses.start - first..masses.end - first;
        let Motion { rule, gravity, floor, inverse_mass } = self.motion;
        from.kick(rule, &inverse_mass[masses], gravity, floor);
        from.write(&mut self.position[own.clone()], &mut self.velocity[own]);
    }
}

/// Only looks at lengths.
pub(super) struct Measure<'a> {
    pub(super) position: &'a [[f64; 3]],
}

impl Task for Measure<'_> {
    #[inline(always)]
    fn read(&self, into: &mut Layer, _: usize, masses: Range<usize>, _: Ask) {
        into.set(&self.position[masses], None, 0.0);
    }

    #[inline(always)]
    fn write(&mut self, _: &mut Layer, _: Range<usize>) {}
}

/// What a force and gravity accelerate a mass with; nothing that is pinned.
#[inline(always)]
fn accelerated(force: [f64; 3], inverse_mass: f64, gravity: f64) -> [f64; 3] {
    let weight = if inverse_mass > 0.0 { gravity } else { 0.0 };
    [force[0] * inverse_mass, force[1] * inverse_mass - weight, force[2] * inverse_mass]
}
