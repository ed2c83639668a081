//! The way through the layers of a slab.

use core::ops::Range;

use bevy::tasks::ComputeTaskPool;

use crate::mechanics::{Lanes, Real};

use super::{
    join::{Ask, LANES, Way, join},
    layer::Layer,
};

/// The springs of a grid.
#[derive(Clone, Copy)]
pub(super) struct Grid<'a> {
    pub(super) within: &'a [Way],
    pub(super) onward: &'a [Way],
    pub(super) masks: &'a [Vec<f64>],
    /// How many layers there are, and of how many masses.
    pub(super) layers: usize,
    pub(super) layer: usize,
}

/// Where layers come from, and what is done with them.
pub(super) trait Task: Send {
    /// Reads a layer that has these masses.
    fn read(&self, into: &mut Layer, layer: usize, masses: Range<usize>, ask: Ask);

    /// Uses the forces on a layer of the slab. All layers before it have been used, and the next one has been read.
    fn write(&mut self, from: &mut Layer, masses: Range<usize>);
}

/// Some layers of a block.
pub(super) struct Slab<'a, T> {
    pub(super) grid: Grid<'a>,
    pub(super) ask: Ask,
    pub(super) range: Range<usize>,
    pub(super) scratch: &'a mut [Layer; 2],
    pub(super) task: T,
}

impl<T> Slab<'_, T> {
    /// The same, to be gone through once more afterwards.
    pub(super) fn again(&mut self) -> Slab<'_, &mut T> {
        let Self { grid, ask, range, scratch, task } = self;
        Slab { grid: *grid, ask: *ask, range: range.clone(), scratch, task }
    }
}

/// Goes through all slabs, each on a thread. Whether any spring is too long.
pub(super) fn run<T: Task>(slabs: Vec<Slab<'_, T>>) -> bool {
    match (ComputeTaskPool::try_get(), slabs.len()) {
        (Some(pool), 2..) => {
            let found = pool.scope(|scope| {
                for slab in slabs {
                    scope.spawn(async move { pulp::Arch::new().dispatch(slab) });
                }
            });
            found.into_iter().any(|too_long| too_long)
        }
        _ => slabs.into_iter().fold(false, |found, slab| found | pulp::Arch::new().dispatch(slab)),
    }
}

impl<T: Task> pulp::NullaryFnOnce for Slab<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        // Each on its own, so that what is asked is known in the inner loop.
        match self.ask {
            Ask::Lengths => self.sweep(Ask::Lengths),
            Ask::Stiff => self.sweep(Ask::Stiff),
            Ask::Damped => self.sweep(Ask::Damped),
        }
    }
}

impl<T: Task> Slab<'_, T> {
    #[inline(always)]
    fn sweep(self, ask: Ask) -> bool {
        let Self { grid: Grid { within, onward, masks, layers, layer }, range, scratch, mut task, .. } = self;
        let mut too_long = Lanes::splat(0.0);
        let [here, next] = scratch;
        let (mut here, mut next) = (here, next);
        let masses = |z: usize| z * layer..(z + 1) * layer;
        // The springs from the layer before the first pull back at it.
        let start = range.start.saturating_sub(1);
        task.read(here, start, masses(start), ask);
        for z in start..range.end {
            if range.contains(&z) {
                for way in within {
                    join(ask, here, None, way, &masks[way.mask], &mut too_long);
                }
            }
            if z + 1 < layers {
                task.read(next, z + 1, masses(z + 1), ask);
                for way in onward {
                    join(ask, here, Some(next), way, &masks[way.mask], &mut too_long);
                }
            }
            if ask != Ask::Lengths && range.contains(&z) {
                task.write(here, masses(z));
            }
            core::mem::swap(&mut here, &mut next);
        }
        (0..LANES).any(|lane| too_long.lane(lane) != 0.0)
    }
}
