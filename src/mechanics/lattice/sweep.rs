//! The way through the layers of a slab.

use core::{mem::swap, ops::Range};

use bevy::tasks::ComputeTaskPool;

use crate::mechanics::Real;

use super::{
    columns::{Eight, LANES},
    join::{Ask, Grid, Next},
    layer::{Layer, Sums},
    task::Task,
};

/// Some layers of a block.
pub(super) struct Slab<'a, T> {
    pub(super) grid: Grid<'a>,
    pub(super) ask: Ask,
    pub(super) range: Range<usize>,
    /// Room for all of its layers, or for two that are at hand.
    pub(super) layers: &'a mut [Layer],
    pub(super) scratch: &'a mut Scratch,
    pub(super) task: T,
}

/// What a slab needs room for beside its layers.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    /// A layer that belongs to another slab.
    pub(super) beside: Layer,
    /// Of the two layers at hand; what leads back is zero but while they are.
    pub(super) sums: [Sums; 2],
}

impl<T> Slab<'_, T> {
    /// The same, to be gone through once more afterwards.
    pub(super) fn again(&mut self) -> Slab<'_, &mut T> {
        let Self { grid, ask, range, layers, scratch, task } = self;
        Slab { grid: *grid, ask: *ask, range: range.clone(), layers, scratch, task }
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
    /// From the last layer to the first: what the slab behind waits for comes first, and what the slab before has to give is wanted last.
    #[inline(always)]
    fn sweep(self, ask: Ask) -> bool {
        let Self { grid, range, layers, scratch, mut task, .. } = self;
        let Scratch { beside, sums: [here, next] } = scratch;
        let (mut here, mut next) = (here, next);
        let mut too_long = Eight::splat(0.0);
        let (start, end) = (range.start, range.end);
        for z in range.rev() {
            let [at, after] = [z - start, z - start + 1].map(|i| i % layers.len());
            let (layer, behind) = match layers.get_disjoint_mut([at, after]) {
                Ok([layer, behind]) if z + 1 < end => (layer, Some(behind)),
                _ => (&mut layers[at], None),
            };
            task.read(z, layer);
            let (to, own) = match behind {
                Some(behind) => (behind, true),
                None => (&mut *beside, false),
            };
            let inner = z + 1 < grid.layers;
            if inner && !own {
                task.read(z + 1, to);
            }
            let behind = inner.then_some(Next { z: z + 1, own, layer: to, sums: next });
            grid.join(ask, layer, behind, here, &mut too_long, &mut task);
            if inner && !own && ask != Ask::Lengths {
                task.hand_on(&next.before);
                next.before.clear();
            }
            swap(&mut here, &mut next);
        }
        let first = layers.first_mut().filter(|_| ask != Ask::Lengths);
        if let Some(first) = first {
            if start > 0 && !task.take_over(&mut next.before) {
                task.read(start - 1, beside);
                let onward = Grid { within: &[], ..grid };
                let to = Next { z: start, own: false, layer: first, sums: next };
                onward.join(ask, beside, Some(to), here, &mut too_long, &mut task);
            }
            for row in first.rows().step_by(LANES) {
                task.write(start, row, first, next.take(row));
            }
        }
        (0..LANES).any(|lane| too_long.lane(lane) != 0.0)
    }
}
