//! Steps of all slabs in time with each other.

use core::{
    hint,
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
};
use std::{
    panic::resume_unwind,
    sync::{Mutex, PoisonError},
    thread,
};

use super::{
    join::Ask,
    layer::{Layer, Shape},
    sweep::Slab,
    tasks::Move,
};

/// Takes so many steps with slabs, each on a thread that stays awake in between. Whether any spring was too long.
///
/// Tasks of a pool would not do: each step would wake its threads anew, which takes as long as the step of a small block, and a task that waits for another keeps
/// its thread from it.
pub(super) fn march(mut slabs: Vec<Slab<'_, Move<'_>>>, steps: u64) -> bool {
    // Where the system has no thread for a slab, those that have begun must not wait for it.
    let closing: Vec<_> = slabs.iter().map(|slab| Closing(slab.task.borders)).collect();
    let Some((first, others)) = slabs.split_first_mut() else { return false };
    thread::scope(|scope| {
        let _closing = closing;
        let others: Vec<_> = others.iter_mut().map(|slab| scope.spawn(move || slab.march(steps))).collect();
        let found = first.march(steps);
        others.into_iter().fold(found, |found, other| found | other.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

impl Slab<'_, Move<'_>> {
    fn march(&mut self, steps: u64) -> bool {
        let [before, behind] = self.task.borders;
        let _closing = Closing([before, behind]);
        let shape = self.grid.shape;
        pulp::Arch::new().dispatch(Deal(&self.task, shape, self.layers));
        let (reach, damped) = (self.task.motion.rule.before, self.ask == Ask::Damped);
        let mut found = false;
        for step in 0..steps {
            let [still, ahead] = [step == 0, step + 1 < steps].map(|drifts| if drifts { reach } else { 0.0 });
            (self.task.still, self.task.ahead) = (still, ahead);
            if let Some(border) = before {
                let first = Layer::new(shape, self.layers);
                border.layer.send(|into| Layer::new(shape, into).foresee(&first, still, damped));
            }
            found |= pulp::Arch::new().dispatch(self.again());
        }
        pulp::Arch::new().dispatch(Gather(&mut self.task, shape, self.layers));
        found
    }
}

/// Deals the masses of a slab out to its layers, in the widest vectors that there are.
struct Deal<'a, 'b>(&'a Move<'b>, Shape, &'a mut [f64]);

impl pulp::NullaryFnOnce for Deal<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.deal(self.1, self.2);
    }
}

/// Gathers them again.
struct Gather<'a, 'b>(&'a mut Move<'b>, Shape, &'a mut [f64]);

impl pulp::NullaryFnOnce for Gather<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.gather(self.1, self.2);
    }
}

/// What two slabs that lie one behind the other tell each other in each step.
pub(super) struct Border {
    /// From the one behind: its first layer where it feels the springs.
    pub(super) layer: Post<Vec<f64>>,
    /// From the one before, thereafter: the sums of the springs that lead to that layer.
    pub(super) sums: Post<Vec<f64>>,
}

impl Border {
    pub(super) fn new(shape: Shape) -> Self {
        Self { layer: Post::new(vec![0.0; shape.layer()]), sums: Post::new(vec![0.0; 3 * shape.length]) }
    }
}

/// Room for one thing that is sent over and over. Whoever sends must have heard from the receiver before the next: here layers and sums answer each other.
pub(super) struct Post<T> {
    item: Mutex<T>,
    sent: AtomicU64,
    received: AtomicU64,
    /// Whether a side is gone.
    closed: AtomicBool,
}

impl<T> Post<T> {
    fn new(item: T) -> Self {
        Self {
            item: Mutex::new(item),
            sent: AtomicU64::new(0),
            received: AtomicU64::new(0),
            closed: AtomicBool::new(false),
        }
    }

    pub(super) fn send(&self, fill: impl FnOnce(&mut T)) {
        fill(&mut self.item.lock().unwrap_or_else(PoisonError::into_inner));
        self.sent.fetch_add(1, Ordering::Release);
    }

    /// Waits for what is sent next.
    pub(super) fn receive(&self, fetch: impl FnOnce(&mut T)) {
        /// Longer than slabs differ, so that a thread gives way only where there are more threads than cores.
        const SPINS: u32 = 4000;
        let received = self.received.fetch_add(1, Ordering::Relaxed);
        let mut spins = 0_u32;
        while self.sent.load(Ordering::Acquire) <= received {
            assert!(!self.closed.load(Ordering::Relaxed), "the thread of a neighbouring slab has panicked");
            spins = spins.saturating_add(1);
            if spins < SPINS { hint::spin_loop() } else { thread::yield_now() }
        }
        fetch(&mut self.item.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// Closes borders where their slab panics: whoever waits there would wait for ever.
struct Closing<'a>([Option<&'a Border>; 2]);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            for border in self.0.into_iter().flatten() {
                border.layer.closed.store(true, Ordering::Relaxed);
                border.sums.closed.store(true, Ordering::Relaxed);
            }
        }
    }
}
