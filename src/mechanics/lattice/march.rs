//! Steps of all slabs in time with each other.

use core::{
    hint,
    sync::atomic::{AtomicUsize, Ordering},
};
use std::{
    panic::resume_unwind,
    sync::{Mutex, MutexGuard, PoisonError},
    thread,
};

use super::{
    sweep::Slab,
    tasks::{Move, Rows},
};

/// Takes so many steps with slabs that lie one behind the other, each on a thread that stays awake in between. Whether any spring was too long.
///
/// Tasks of a pool would not do: each step would wake its threads anew, which takes as long as the step of a small block, and a task that waits for another keeps
/// its thread from it.
pub(super) fn march(mut slabs: Vec<Slab<'_, Move<'_>>>, steps: u64) -> bool {
    let front = Front { edges: slabs.iter().map(|_| Edges::default()).collect(), arrived: AtomicUsize::new(0) };
    let Some((first, others)) = slabs.split_first_mut() else { return false };
    thread::scope(|scope| {
        let front = &front;
        let march = |(i, slab)| scope.spawn(move || front.march(i, slab, steps));
        let others: Vec<_> = (1..).zip(others).map(march).collect();
        let found = front.march(0, first, steps);
        others.into_iter().fold(found, |found, other| found | other.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

/// The first and the last layer of a slab as they were before a step, each for even and for odd steps.
type Edges = [[Mutex<Rows>; 2]; 2];

/// What the slabs tell each other.
struct Front {
    /// How often a slab was ready for a step.
    arrived: AtomicUsize,
    /// Of each slab. When one is ready for a step all others are at least ready for the one before, and may still read what belongs to it.
    edges: Vec<Edges>,
}

/// A layer, of which nobody else wants anything at the moment.
fn lock(rows: &Mutex<Rows>) -> MutexGuard<'_, Rows> {
    rows.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Front {
    fn march(&self, i: usize, slab: &mut Slab<'_, Move<'_>>, steps: u64) -> bool {
        // Before it and behind it.
        let neighbours = [i.checked_sub(1), Some(i + 1)].map(|neighbour| self.edges.get(neighbour?));
        let mut found = false;
        for step in 0..steps {
            let turn = (step % 2) as usize;
            for (which, _) in neighbours.iter().enumerate().filter(|(_, neighbour)| neighbour.is_some()) {
                slab.task.hand_out(which, &mut lock(&self.edges[i][which][turn]));
            }
            self.wait();
            for (which, neighbour) in neighbours.iter().enumerate() {
                let Some(edges) = neighbour else { continue };
                core::mem::swap(&mut slab.task.beside[which], &mut lock(&edges[1 - which][turn]));
            }
            found |= pulp::Arch::new().dispatch(slab.again());
        }
        found
    }

    /// Waits until all slabs are ready for the same step.
    fn wait(&self) {
        /// Longer than the slabs differ, so that a thread gives way only where there are more threads than cores.
        const SPINS: u32 = 4000;
        let before = self.arrived.fetch_add(1, Ordering::AcqRel);
        let all = (before / self.edges.len() + 1) * self.edges.len();
        let mut spins = 0;
        while self.arrived.load(Ordering::Acquire) < all {
            spins += 1;
            if spins < SPINS { hint::spin_loop() } else { thread::yield_now() }
        }
    }
}
