//! Forces of a block on a regular grid: neighbours by where they are, eight springs at a time, layer by layer.
//!
//! The general springs look up the ends of each; here the neighbour along a way is always as many numbers further. Two layers of the grid at a time are
//! laid out coordinate by coordinate, and of each way to a neighbour all springs that begin in the lower layer are computed side by side. A spring acts forward on the
//! mass at which it begins and back on the other; both sums are kept apart and come together when a layer is done.
//!
//! What a mass feels is summed in an order that depends on its place in the grid alone: back along the ways from the layer before, then those of its own layer, in the order of
//! [`Neighbours::ways`](crate::body::Neighbours::ways), and forward likewise. So a slab of layers comes to the same bits wherever it begins and ends, and threads may share the layers in any
//! way. A slab computes the springs from the layer before it once more.

mod join;
mod layer;

use core::ops::Range;

use bevy::tasks::ComputeTaskPool;

use crate::body::{Lattice, Neighbours};

use super::{BodyParts, Lanes, Model, Real, State, model::LONGEST_STRETCH};

use join::{Ask, LANES, Way, join};
use layer::Layer;

/// A thread is worth its start for so many particles.
const PARTICLES_A_THREAD: usize = 4096;

/// A block as the force loop reads it.
#[derive(Clone, Debug)]
pub(super) struct LatticeRows {
    lattice: Lattice,
    /// The ways along which there are springs: within a layer, and to the next.
    within: Vec<Way>,
    onward: Vec<Way>,
    /// For each of nine ways across a layer, 1 where a mass of the layer has a neighbour there, 0 elsewhere.
    masks: Vec<Vec<f64>>,
    damped: bool,
    /// How long a spring of each kind is when the watch holds the body for exploded.
    longest: [f64; 3],
    /// Scratch: two layers for each slab.
    scratch: Vec<[Layer; 2]>,
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
        let layer = across * along;
        // Room for a neighbour before the first mass and behind the last, whole vectors of them.
        let pad = (across + 1).next_multiple_of(LANES);
        let room = 2 * pad + layer.next_multiple_of(LANES) + LANES;
        let mask = |way: usize| {
            let (dx, dy) = (way % 3, way / 3);
            let mut mask = vec![0.0; room];
            for (i, value) in mask[pad..pad + layer].iter_mut().enumerate() {
                // One more than where the neighbour is.
                let (x, y) = (i % across + dx, i / across + dy);
                *value = f64::from(u8::from((1..=across).contains(&x) && (1..=along).contains(&y)));
            }
            mask
        };
        let (mut within, mut onward, mut damped, mut longest) = (Vec::new(), Vec::new(), false, [0.0; 3]);
        for kind in Neighbours::ALL {
            let Some(spring) = body.springs.uniform(lattice.range(kind)) else { continue };
            damped |= spring.damping > 0.0;
            longest[kind as usize] = LONGEST_STRETCH * spring.rest_length;
            for &[dx, dy, dz] in kind.ways() {
                let way = Way {
                    from: pad + if dy < 0 { across } else { 0 },
                    upto: pad + layer.saturating_sub(if dy > 0 { across } else { 0 }),
                    offset: lattice.offset([dx, dy, 0]) as isize,
                    mask: (dx + 1 + 3 * (dy + 1)) as usize,
                    stiffness: spring.stiffness,
                    damping: spring.damping,
                    rest_length: spring.rest_length,
                    longest_square: longest[kind as usize] * longest[kind as usize],
                };
                if dz == 0 { within.push(way) } else { onward.push(way) }
            }
        }
        let masks = (0..9).map(mask).collect();
        let rows = Self { lattice, within, onward, masks, damped, longest, scratch: Vec::new() };
        let slabs = rows.slabs();
        Some(Self { scratch: vec![[Layer::new(room, pad), Layer::new(room, pad)]; slabs], ..rows })
    }

    /// Among how many threads its layers are shared.
    fn slabs(&self) -> usize {
        let threads = ComputeTaskPool::try_get().map_or(1, |pool| pool.thread_num());
        (self.lattice.particles() / PARTICLES_A_THREAD).min(threads).min(self.lattice.size()[2]).max(1)
    }

    /// The ends of all springs in order, and the length at which the watch holds the body for exploded.
    pub(super) fn springs(&self) -> impl Iterator<Item = ([usize; 2], f64)> + '_ {
        let kinds = Neighbours::ALL.into_iter().filter(|kind| self.lattice.joins(*kind));
        kinds.flat_map(move |kind| {
            let longest = self.longest[kind as usize];
            self.lattice.ends_between(kind).map(move |ends| (ends.map(|end| end.index()), longest))
        })
    }

    /// Computes slab by slab what the springs accelerate every mass with, and whether one is too long.
    #[inline(always)]
    fn forces<R: Real, const D: usize>(&mut self, masses: &Masses<'_, R, D>, acceleration: &mut [[R; D]]) -> bool {
        let [across, along, layers] = self.lattice.size();
        let (layer, slabs) = (across * along, self.scratch.len());
        let Self { within, onward, masks, damped, scratch, .. } = self;
        let ask = if *damped { Ask::Damped } else { Ask::Stiff };
        let grid = Grid { within, onward, masks, layers, layer };
        let share = layers.div_ceil(slabs);
        let slabs = scratch.iter_mut().zip(acceleration.chunks_mut(share * layer));
        let slabs = slabs.enumerate().map(|(i, (scratch, acceleration))| {
            let range = i * share..i * share + acceleration.len() / layer;
            Slab { grid, ask, masses: *masses, range, scratch, acceleration }
        });
        run(slabs.collect())
    }

    /// Whether a spring is too long.
    #[inline(always)]
    fn is_too_long<R: Real, const D: usize>(&mut self, masses: &Masses<'_, R, D>) -> bool {
        let [across, along, layers] = self.lattice.size();
        let (layer, slabs) = (across * along, self.scratch.len());
        let Self { within, onward, masks, scratch, .. } = self;
        let grid = Grid { within, onward, masks, layers, layer };
        let share = layers.div_ceil(slabs);
        let slab = |(i, scratch): (usize, _)| {
            let range = i * share..((i + 1) * share).min(layers);
            Slab { grid, ask: Ask::Lengths, masses: *masses, range, scratch, acceleration: &mut [] }
        };
        run(scratch.iter_mut().take(layers.div_ceil(share)).enumerate().map(slab).collect())
    }
}

/// The masses of a body.
#[derive(Clone, Copy)]
struct Masses<'a, R, const D: usize> {
    position: &'a [[R; D]],
    velocity: &'a [[R; D]],
    inverse: &'a [R],
}

/// The springs of a grid.
#[derive(Clone, Copy)]
struct Grid<'a> {
    within: &'a [Way],
    onward: &'a [Way],
    masks: &'a [Vec<f64>],
    /// How many layers there are, and of how many masses.
    layers: usize,
    layer: usize,
}

/// Some layers of a block, and where what accelerates them goes.
struct Slab<'a, R, const D: usize> {
    grid: Grid<'a>,
    ask: Ask,
    masses: Masses<'a, R, D>,
    range: Range<usize>,
    scratch: &'a mut [Layer; 2],
    acceleration: &'a mut [[R; D]],
}

/// Computes all slabs, each on a thread. Whether any spring is too long.
fn run<R: Real, const D: usize>(mut slabs: Vec<Slab<'_, R, D>>) -> bool {
    match (ComputeTaskPool::try_get(), &mut slabs[..]) {
        (Some(pool), [_, _, ..]) => {
            let found = pool.scope(|scope| {
                for slab in slabs {
                    scope.spawn(async move { pulp::Arch::new().dispatch(slab) });
                }
            });
            found.into_iter().any(|too_long| too_long)
        }
        _ => slabs.into_iter().map(|slab| pulp::Arch::new().dispatch(slab)).fold(false, |a, b| a | b),
    }
}

impl<R: Real, const D: usize> pulp::NullaryFnOnce for Slab<'_, R, D> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        match self.ask {
            Ask::Lengths => self.sweep(Ask::Lengths),
            Ask::Stiff => self.sweep(Ask::Stiff),
            Ask::Damped => self.sweep(Ask::Damped),
        }
    }
}

impl<R: Real, const D: usize> Slab<'_, R, D> {
    #[inline(always)]
    fn sweep(self, ask: Ask) -> bool {
        let Self { grid: Grid { within, onward, masks, layers, layer }, masses, range, scratch, acceleration, .. } =
            self;
        let mut too_long = Lanes::splat(0.0);
        let [here, next] = scratch;
        let (mut here, mut next) = (here, next);
        let read = |into: &mut Layer, z: usize| {
            let rows = z * layer..(z + 1) * layer;
            into.set(&masses.position[rows.clone()], (ask == Ask::Damped).then(|| &masses.velocity[rows]));
        };
        // The springs from the layer before the first pull back at it.
        let start = range.start.saturating_sub(1);
        read(here, start);
        for z in start..range.end {
            if range.contains(&z) {
                for way in within {
                    join(ask, here, None, way, &masks[way.mask], &mut too_long);
                }
            }
            if z + 1 < layers {
                read(next, z + 1);
                for way in onward {
                    join(ask, here, Some(next), way, &masks[way.mask], &mut too_long);
                }
            }
            if ask != Ask::Lengths && range.contains(&z) {
                let (rows, from) = (z * layer..(z + 1) * layer, (z - range.start) * layer);
                here.accelerate(&masses.inverse[rows], &mut acceleration[from..from + layer]);
            }
            core::mem::swap(&mut here, &mut next);
        }
        (0..LANES).any(|lane| too_long.lane(lane) != 0.0)
    }
}

impl<R: Real, const D: usize> Model<R, D> {
    /// What the springs of a block and gravity accelerate every particle with.
    // On its own for the same reason as a strand's.
    #[inline(never)]
    pub(super) fn lattice_forces(&mut self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let Self { lattice: Some(rows), inverse_mass, gravity, overstretched, .. } = self else { return };
        if rows.forces(&Masses { position, velocity, inverse: inverse_mass }, acceleration) {
            *overstretched = R::splat(1.0);
        }
        let Some(gravity) = *gravity else { return };
        let zero = R::splat(0.0);
        for (row, &inverse_mass) in acceleration.iter_mut().zip(&*inverse_mass) {
            row[1] -= zero.if_below(inverse_mass, gravity, zero);
        }
    }

    /// Notes springs of a block that are too long.
    #[inline(never)]
    pub(super) fn note_lattice(&mut self, state: &State<R, D>) {
        let Self { lattice: Some(rows), inverse_mass, overstretched, .. } = self else { return };
        let State { position, velocity } = state;
        if rows.is_too_long(&Masses { position, velocity, inverse: inverse_mass }) {
            *overstretched = R::splat(1.0);
        }
    }
}
