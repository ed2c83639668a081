//! The way through the layers of a slab.

use core::{mem::swap, ops::Range};

use bevy::tasks::ComputeTaskPool;

use crate::mechanics::{Lanes, Real};

use super::{
    columns::{Columns, LANES},
    join::{Ask, Grid},
    layer::{Layer, Sums},
};

/// Where layers come from, and what is done with them.
pub(super) trait Task: Send {
    /// Brings a layer to where it feels the springs, once in a sweep: one of the slab, or the one behind it, or before it where that is not [taken over](Self::take_over).
    fn read(&mut self, z: usize, layer: &mut Layer);

    /// Uses the forces on a layer of the slab, which are complete, and sets the sums of what springs pull back with to zero.
    fn write(&mut self, z: usize, layer: &mut Layer, sums: &mut Sums);

    /// Gives the slab behind the sums of the springs that lead to its first layer from this one. Where nobody wants them they are lost.
    fn hand_on(&mut self, _: &Columns<3>) {}

    /// Whether the slab before has given its sums of the springs that lead to the first layer of this one. If not, they are computed once more.
    fn take_over(&mut self, _: &mut Columns<3>) -> bool {
        false
    }
}

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
        let mut too_long = Lanes::splat(0.0);
        let (start, end) = (range.start, range.end);
        for z in range.rev() {
            let [at, after] = [z - start, z - start + 1].map(|i| i % layers.len());
            let (layer, behind) = match layers.get_disjoint_mut([at, after]) {
                Ok([layer, behind]) if z + 1 < end => (layer, Some(behind)),
                _ => (&mut layers[at], None),
            };
            task.read(z, layer);
            let Sums { forward, within, .. } = here;
            if z + 1 == grid.layers {
                grid.join(ask, layer, None, forward, within, &mut too_long);
            } else if let Some(to) = behind {
                grid.join(ask, layer, Some((to, &mut next.before)), forward, within, &mut too_long);
                if ask != Ask::Lengths {
                    task.write(z + 1, to, next);
                }
            } else {
                task.read(z + 1, beside);
                grid.join(ask, layer, Some((beside, &mut next.before)), forward, within, &mut too_long);
                if ask != Ask::Lengths {
                    task.hand_on(&next.before);
                    next.before.clear();
                }
            }
            swap(&mut here, &mut next);
        }
        let first = layers.first_mut().filter(|_| ask != Ask::Lengths);
        if let Some(first) = first {
            if start > 0 && !task.take_over(&mut next.before) {
                task.read(start - 1, beside);
                let onward = Grid { within: &[], ..grid };
                onward.join(
                    ask,
                    beside,
                    Some((first, &mut next.before)),
                    &mut here.forward,
                    &mut here.within,
                    &mut too_long,
                );
            }
            task.write(start, first, next);
        }
        (0..LANES).any(|lane| too_long.lane(lane) != 0.0)
    }
}
