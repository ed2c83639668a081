//! Forces of a block on a regular grid: neighbours by where they are, eight springs at a time, or four at the end of a layer.
//!
//! The general springs look up the ends of each; here the neighbour along a way is always as many numbers further. Layers lie coordinate by coordinate; two are
//! at hand at a time, and the springs that begin at eight masses of the lower one are computed side by side, one way after the other. A spring acts forward on the mass
//! at which it begins and back on the other.
//!
//! The next layer's masses move on as soon as no spring that is still to come ends there, in the midst of the springs of this one: what moves them is done while the
//! processor waits for roots and quotients.
//!
//! Three sums are kept of what a mass feels: forward, back within its layer, and back from the layer before. Each is in an order that depends on the mass's place in
//! its layer alone, and they come together when all are complete. So a slab of layers comes to the same bits wherever it begins and ends, whoever computes the
//! springs between two slabs, and threads may share the layers in any way.

mod columns;
mod join;
mod layer;
mod march;
mod sweep;
mod task;
mod tasks;

use bevy::tasks::ComputeTaskPool;

use crate::body::{Lattice, Neighbours};

use super::{BodyParts, Model, Real, State, ground::ContactKind, model::LONGEST_STRETCH};

use columns::Numbers;
use join::{Ask, Grid, Way};
use layer::Shape;
use march::{Border, march};
use sweep::{Slab, run, scratch};
use tasks::{Accelerate, Measure, Motion, Move};

pub(super) use tasks::KickDrift;

/// A thread is worth its start for so many particles.
const PARTICLES_A_THREAD: usize = 4096;

/// So many layers are at hand at a time. What is gone through once needs room for no more, and stays in the cache.
const AT_HAND: usize = 2;

/// Ways across a layer: none or one along each of two axes, in either direction.
const MASKS: usize = 9;

/// A block as the force loop reads it.
#[derive(Clone, Debug)]
pub(super) struct LatticeRows {
    lattice: Lattice,
    /// The ways along which there are springs: within a layer, and to the next.
    within: Vec<Way>,
    onward: Vec<Way>,
    damped: bool,
    /// How long a spring of each kind is when the watch holds the body for exploded.
    longest: [f64; 3],
    /// How the columns of a layer are laid out.
    shape: Shape,
    /// Among how many threads its layers are shared.
    slabs: usize,
    /// The masks; then what each slab needs beside its layers; then all layers.
    numbers: Numbers,
}

impl BodyParts<'_> {
    /// Whether it is a block on a regular grid, all springs of a kind alike, and stepped by a method that asks for nothing but forces. Such a body is stepped by
    /// itself, without lists of its springs.
    pub fn is_regular(&self) -> bool {
        self.lattice.is_some_and(|lattice| {
            let alike = |kind: Neighbours| {
                let range = lattice.range(kind);
                range.is_empty() || self.springs.uniform(range).is_some()
            };
            self.muscles.is_none()
                && self.strand.is_none()
                && self.tearing.is_none()
                && self.method.asks_forces_alone()
                && Neighbours::ALL.into_iter().all(alike)
        })
    }
}

impl LatticeRows {
    /// The rows of a body that [is regular](BodyParts::is_regular).
    pub(super) fn of(body: &BodyParts<'_>) -> Option<Self> {
        let lattice = body.lattice.filter(|_| body.is_regular())?;
        let [across, along, _] = lattice.size();
        let shape = Shape::new(across * along, across + 1);
        let Shape { pad, count, length } = shape;
        let (mut within, mut onward, mut damped, mut longest) = (Vec::new(), Vec::new(), false, [0.0; 3]);
        for kind in Neighbours::ALL {
            let Some(spring) = body.springs.uniform(lattice.range(kind)) else { continue };
            damped |= spring.damping > 0.0;
            longest[kind as usize] = LONGEST_STRETCH * spring.rest_length;
            for &[dx, dy, dz] in kind.ways() {
                let way = Way {
                    from: pad + if dy < 0 { across } else { 0 },
                    upto: pad + count.saturating_sub(if dy > 0 { across } else { 0 }),
                    offset: lattice.offset([dx, dy, 0]) as isize,
                    mask: (dx + 1 + 3 * (dy + 1)) as usize,
                    stiffness: spring.stiffness,
                    damping: spring.damping,
                    tension: spring.stiffness * spring.rest_length,
                    longest_square: longest[kind as usize] * longest[kind as usize],
                };
                if dz == 0 { within.push(way) } else { onward.push(way) }
            }
        }
        // Sums of neighbours side by side overlap, and would have to wait for each other; so ways to other rows come in between: first those straight on, then to either side.
        let side = |way: &Way| [2, 0, 1][way.mask % 3];
        onward.sort_by_key(side);
        let slabs = slabs(lattice);
        let mut numbers = Numbers::zeros(MASKS * length + slabs * scratch(shape) + lattice.size()[2] * shape.layer());
        for (way, mask) in numbers.all_mut()[..MASKS * length].chunks_exact_mut(length).enumerate() {
            let (dx, dy) = (way % 3, way / 3);
            for (i, value) in mask[pad..pad + count].iter_mut().enumerate() {
                // One more than where the neighbour is.
                let (x, y) = (i % across + dx, i / across + dy);
                *value = f64::from(u8::from((1..=across).contains(&x) && (1..=along).contains(&y)));
            }
        }
        Some(Self { lattice, within, onward, damped, longest, shape, slabs, numbers })
    }

    /// The ends of all springs in order, and the length at which the watch holds the body for exploded.
    pub(super) fn springs(&self) -> impl Iterator<Item = ([usize; 2], f64)> + '_ {
        let kinds = Neighbours::ALL.into_iter().filter(|kind| self.lattice.joins(*kind));
        kinds.flat_map(move |kind| {
            let longest = self.longest[kind as usize];
            self.lattice.ends_between(kind).map(move |ends| (ends.map(|end| end.index()), longest))
        })
    }

    /// Parts the layers into slabs, each with its scratch and room for `at_hand` layers. `task` makes what is done with each from its first layer and how many it has.
    fn slabs_of<'a, T>(
        &'a mut self,
        ask: Ask,
        at_hand: usize,
        mut task: impl FnMut(usize, usize) -> T,
    ) -> Vec<Slab<'a, T>> {
        let Self { lattice, within, onward, shape, slabs, numbers, .. } = self;
        let (layers, shape) = (lattice.size()[2], *shape);
        let share = layers.div_ceil(*slabs);
        let (masks, rest) = numbers.all_mut().split_at_mut(MASKS * shape.length);
        let (beside, rest) = rest.split_at_mut(*slabs * scratch(shape));
        let grid = Grid { within, onward, masks, shape, layers };
        let own = rest[..layers * shape.layer()].chunks_mut(share * shape.layer());
        let slabs = own.zip(beside.chunks_exact_mut(scratch(shape))).enumerate().map(|(i, (own, scratch))| {
            let (start, count) = (i * share, own.len() / shape.layer());
            let layers = &mut own[..count.min(at_hand) * shape.layer()];
            Slab { grid, ask, range: start..start + count, layers, scratch, task: task(start, count) }
        });
        slabs.collect()
    }

    /// What the springs and gravity accelerate the masses with. Whether a spring is too long.
    fn forces(
        &mut self,
        position: &[[f64; 3]],
        velocity: &[[f64; 3]],
        inverse_mass: &[f64],
        gravity: f64,
        acceleration: &mut [[f64; 3]],
    ) -> bool {
        let (layer, ask, mut left) = (self.shape.count, self.asks_forces(), acceleration);
        run(self.slabs_of(ask, AT_HAND, |start, count| {
            let (acceleration, rest) = core::mem::take(&mut left).split_at_mut(count * layer);
            left = rest;
            Accelerate { ask, position, velocity, inverse_mass, gravity, start, layer, acceleration }
        }))
    }

    /// Takes so many steps. Whether a spring was too long.
    fn steps(&mut self, steps: u64, motion: Motion<'_>, mut x: &mut [[f64; 3]], mut v: &mut [[f64; 3]]) -> bool {
        let (layer, ask) = (self.shape.count, self.asks_forces());
        let borders: Vec<_> = (1..self.slabs).map(|_| Border::new(self.shape)).collect();
        let mut behind = borders.iter();
        let mut before = None;
        let slabs = self.slabs_of(ask, usize::MAX, |start, count| {
            let (position, more_x) = core::mem::take(&mut x).split_at_mut(count * layer);
            let (velocity, more_v) = core::mem::take(&mut v).split_at_mut(count * layer);
            (x, v) = (more_x, more_v);
            let borders = [before, behind.next()];
            [_, before] = borders;
            Move { motion, still: 0.0, ahead: 0.0, end: start + count, layer, borders, position, velocity }
        });
        march(slabs, steps)
    }

    fn asks_forces(&self) -> Ask {
        if self.damped { Ask::Damped } else { Ask::Stiff }
    }
}

/// Among how many threads the layers of a block are shared.
fn slabs(lattice: Lattice) -> usize {
    let threads = ComputeTaskPool::try_get().map_or(1, |pool| pool.thread_num());
    (lattice.particles() / PARTICLES_A_THREAD).min(threads).min(lattice.size()[2]).max(1)
}

/// The vectors of a body alone, which have three coordinates.
fn vectors<R: Real, const D: usize>(rows: &[[R; D]]) -> Option<&[[f64; 3]]> {
    R::alone(rows.as_flattened()).filter(|_| D == 3).map(|values| values.as_chunks().0)
}

fn vectors_mut<R: Real, const D: usize>(rows: &mut [[R; D]]) -> Option<&mut [[f64; 3]]> {
    R::alone_mut(rows.as_flattened_mut()).filter(|_| D == 3).map(|values| values.as_chunks_mut().0)
}

impl<R: Real, const D: usize> Model<R, D> {
    /// What the springs of a block and gravity accelerate every particle with.
    #[inline(never)]
    pub(super) fn lattice_forces(&mut self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let gravity = self.gravity.map_or(0.0, |gravity| gravity.lane(0));
        let Self { lattice: Some(rows), inverse_mass, overstretched, .. } = self else { return };
        let (Some(position), Some(velocity)) = (vectors(position), vectors(velocity)) else { return };
        let (Some(inverse_mass), Some(acceleration)) = (R::alone(inverse_mass), vectors_mut(acceleration)) else {
            return;
        };
        if rows.forces(position, velocity, inverse_mass, gravity, acceleration) {
            *overstretched = R::splat(1.0);
        }
    }

    /// Takes so many steps with a block on which nothing acts but its springs, gravity, damping by mass and the flat ground: every layer is moved as soon as its forces
    /// are known, while it is in the cache. Gives back whether it did; if not, the steps are still to be taken.
    pub(super) fn step_lattice(&mut self, rule: KickDrift, state: &mut State<R, D>, steps: u64) -> bool {
        let (kind, gravity) = (self.contact.kind, self.gravity.map_or(0.0, |gravity| gravity.lane(0)));
        if self.pull.is_some() || self.friction.is_some() || self.coulomb.is_some() || kind == ContactKind::Terrain {
            return false;
        }
        let Self { lattice: Some(rows), inverse_mass, overstretched, evaluations, .. } = self else { return false };
        let (Some(inverse_mass), Some(position)) = (R::alone(inverse_mass), vectors_mut(&mut state.position)) else {
            return false;
        };
        let Some(velocity) = vectors_mut(&mut state.velocity) else { return false };
        *evaluations += R::splat(steps as f64);
        let motion = Motion { rule, gravity, floor: kind == ContactKind::Flat, inverse_mass };
        if rows.steps(steps, motion, position, velocity) {
            *overstretched = R::splat(1.0);
        }
        true
    }

    /// Notes springs of a block that are too long.
    #[inline(never)]
    pub(super) fn note_lattice(&mut self, state: &State<R, D>) {
        let Self { lattice: Some(rows), overstretched, .. } = self else { return };
        let Some(position) = vectors(&state.position) else { return };
        let layer = rows.shape.count;
        if run(rows.slabs_of(Ask::Lengths, AT_HAND, |_, _| Measure { position, layer })) {
            *overstretched = R::splat(1.0);
        }
    }
}
