//! What is done with the layers of a block: forces, whole steps, or only lengths.

use core::{iter::zip, ops::Range};

use super::{
    columns::{Eight, LANES},
    join::Ask,
    layer::{Layer, Shape},
    march::Border,
    task::Task,
};

/// Finds what accelerates the masses.
pub(super) struct Accelerate<'a> {
    pub(super) ask: Ask,
    pub(super) position: &'a [[f64; 3]],
    pub(super) velocity: &'a [[f64; 3]],
    pub(super) inverse_mass: &'a [f64],
    pub(super) gravity: f64,
    /// The first layer of the slab.
    pub(super) start: usize,
    /// How many masses a layer has.
    pub(super) layer: usize,
    /// Of the masses of the slab.
    pub(super) acceleration: &'a mut [[f64; 3]],
}

impl Task for Accelerate<'_> {
    #[inline(always)]
    fn read(&mut self, z: usize, layer: &mut Layer<'_>) {
        let masses = masses(z, self.layer);
        let velocity = (self.ask == Ask::Damped).then(|| &self.velocity[masses.clone()]);
        layer.deal(&self.position[masses], velocity);
    }

    #[inline(always)]
    fn write(&mut self, z: usize, row: usize, layer: &mut Layer<'_>, forces: [Eight; 3]) {
        let own = &mut self.acceleration[masses(z - self.start, self.layer)][layer.shape().masses(row)];
        let inverse_mass = &self.inverse_mass[masses(z, self.layer)][layer.shape().masses(row)];
        let [x, y, z] = forces;
        let (x, y, z): ([f64; LANES], [f64; LANES], [f64; LANES]) = (x.into(), y.into(), z.into());
        for (i, (own, inverse_mass)) in zip(own, inverse_mass).enumerate() {
            *own = accelerated([x[i], y[i], z[i]], *inverse_mass, self.gravity);
        }
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

/// What moves the masses of a block, beside its springs.
#[derive(Clone, Copy)]
pub(super) struct Motion<'a> {
    pub(super) rule: KickDrift,
    pub(super) gravity: f64,
    /// Whether there is a floor at y = 0.
    pub(super) floor: bool,
    pub(super) inverse_mass: &'a [f64],
}

/// Takes whole steps with layers that lie where they belong.
pub(super) struct Move<'a> {
    pub(super) motion: Motion<'a>,
    /// For how long masses are still to drift until they feel the springs, in the first of many steps; and for how long they drift on from the end of a step, in all
    /// but the last. So the two drifts between the kicks of two steps are one way through the layer.
    pub(super) still: f64,
    pub(super) ahead: f64,
    /// The layer behind the slab.
    pub(super) end: usize,
    /// How many masses a layer has.
    pub(super) layer: usize,
    /// To the slab before, and to the one behind.
    pub(super) borders: [Option<&'a Border>; 2],
    /// Of the masses of the slab.
    pub(super) position: &'a mut [[f64; 3]],
    pub(super) velocity: &'a mut [[f64; 3]],
}

impl Move<'_> {
    /// Deals the masses of the slab out to its layers.
    #[inline(always)]
    pub(super) fn deal(&self, shape: Shape, layers: &mut [f64]) {
        let start = self.end - layers.len() / shape.layer();
        for (i, columns) in layers.chunks_exact_mut(shape.layer()).enumerate() {
            let (own, mut layer) = (masses(i, self.layer), Layer::new(shape, columns));
            layer.deal(&self.position[own.clone()], Some(&self.velocity[own]));
            layer.weigh(&self.motion.inverse_mass[masses(start + i, self.layer)]);
        }
    }

    /// Gathers them again.
    #[inline(always)]
    pub(super) fn gather(&mut self, shape: Shape, layers: &mut [f64]) {
        for (i, columns) in layers.chunks_exact_mut(shape.layer()).enumerate() {
            let own = masses(i, self.layer);
            Layer::new(shape, columns).gather(&mut self.position[own.clone()], &mut self.velocity[own]);
        }
    }
}

impl Task for &mut Move<'_> {
    #[inline(always)]
    fn read(&mut self, z: usize, layer: &mut Layer<'_>) {
        match self.borders {
            [_, Some(border)] if z == self.end => border.layer.receive(|first| layer.copy(first)),
            _ => layer.drift(self.still),
        }
    }

    #[inline(always)]
    fn write(&mut self, _: usize, row: usize, layer: &mut Layer<'_>, forces: [Eight; 3]) {
        let Motion { rule, gravity, floor, .. } = self.motion;
        layer.kick(rule, gravity, floor, self.ahead, row, forces);
    }

    #[inline(always)]
    fn hand_on(&mut self, sums: &[f64]) {
        if let [_, Some(border)] = self.borders {
            border.sums.send(|into| into.copy_from_slice(sums));
        }
    }

    #[inline(always)]
    fn take_over(&mut self, sums: &mut [f64]) -> bool {
        let [border, _] = self.borders;
        border.inspect(|border| border.sums.receive(|from| sums.copy_from_slice(from))).is_some()
    }
}

/// Only looks at lengths.
pub(super) struct Measure<'a> {
    pub(super) position: &'a [[f64; 3]],
    /// How many masses a layer has.
    pub(super) layer: usize,
}

impl Task for Measure<'_> {
    #[inline(always)]
    fn read(&mut self, z: usize, layer: &mut Layer<'_>) {
        layer.deal(&self.position[masses(z, self.layer)], None);
    }

    #[inline(always)]
    fn write(&mut self, _: usize, _: usize, _: &mut Layer<'_>, _: [Eight; 3]) {}
}

/// The masses of a layer.
#[inline(always)]
fn masses(z: usize, layer: usize) -> Range<usize> {
    z * layer..(z + 1) * layer
}

/// What a force and gravity accelerate a mass with; nothing that is pinned.
#[inline(always)]
fn accelerated(force: [f64; 3], inverse_mass: f64, gravity: f64) -> [f64; 3] {
    let weight = if inverse_mass > 0.0 { gravity } else { 0.0 };
    [force[0] * inverse_mass, force[1] * inverse_mass - weight, force[2] * inverse_mass]
}
