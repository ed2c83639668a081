//! The way through the layers of a slab.

use core::{mem::swap, ops::Range};

use bevy::tasks::ComputeTaskPool;

use crate::mechanics::Real;

use super::{
    columns::{Eight, LANES},
    join::{Ask, Grid, Next},
    layer::{Layer, Shape, Sums},
    task::Task,
};

/// Some layers of a block.
pub(super) struct Slab<'a, T> {
    pub(super) grid: Grid<'a>,
    pub(super) ask: Ask,
    pub(super) range: Range<usize>,
    /// Room for all of its layers, or for two that are at hand.
    pub(super) layers: &'a mut [f64],
    /// Room for [what it needs beside them](scratch).
    pub(super) scratch: &'a mut [f64],
    pub(super) task: T,
}

/// How many numbers a slab needs room for beside its layers: a layer that belongs to another slab, and the sums of the two layers at hand. What leads back to its masses
/// is zero but while they are.
pub(super) fn scratch(shape: Shape) -> usize {
    shape.layer() + 2 * shape.sums()
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
        let shape = grid.shape;
        let (beside, sums) = scratch.split_at_mut(shape.layer());
        let (here, next) = sums.split_at_mut(shape.sums());
        let (mut here, mut next) = (&mut Sums::new(shape, here), &mut Sums::new(shape, next));
        let mut too_long = Eight::splat(0.0);
        let (start, end, at_hand) = (range.start, range.end, layers.len() / shape.layer());
        for z in range.rev() {
            let [at, after] = [z - start, z - start + 1].map(|i| {
                let first = i % at_hand * shape.layer();
                first..first + shape.layer()
            });
            let (layer, behind) = match layers.get_disjoint_mut([at.clone(), after]) {
                Ok([layer, behind]) if z + 1 < end => (layer, Some(behind)),
                _ => (&mut layers[at], None),
            };
            let (layer, own) = (&mut Layer::new(shape, layer), behind.is_some());
            let mut to = Layer::new(shape, behind.unwrap_or(beside));
            task.read(z, layer);
            let inner = z + 1 < grid.layers;
            if inner && !own {
                task.read(z + 1, &mut to);
            }
            let behind = inner.then_some(Next { z: z + 1, own, layer: &mut to, sums: next });
            grid.join(ask, layer, behind, here, &mut too_long, &mut task);
            if inner && !own && ask != Ask::Lengths {
                task.hand_on(next.before());
                next.before().fill(0.0);
            }
            swap(&mut here, &mut next);
        }
        if ask != Ask::Lengths {
            let mut first = Layer::new(shape, layers);
            if start > 0 && !task.take_over(next.before()) {
                let beside = &mut Layer::new(shape, beside);
                task.read(start - 1, beside);
                let onward = Grid { within: &[], ..grid };
                let to = Next { z: start, own: false, layer: &mut first, sums: next };
                onward.join(ask, beside, Some(to), here, &mut too_long, &mut task);
            }
            for row in shape.rows().step_by(LANES) {
                task.write(start, row, &mut first, next.take(row));
            }
        }
        (0..LANES).any(|lane| too_long.lane(lane) != 0.0)
    }
}
