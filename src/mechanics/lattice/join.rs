//! The springs that begin in a layer, eight side by side, or four at the end: the inner loop of a block.

use crate::mechanics::{Lanes, Real};

use super::{
    columns::{Eight, HALF, LANES, put, some, three},
    layer::{Layer, Shape, Sums},
    task::Task,
};

/// A way to neighbours, and the springs along it.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// The first mass of a layer that may have a neighbour there, and the one after the last, by their rows in the layer's columns.
    pub(super) from: usize,
    pub(super) upto: usize,
    /// By how many rows the neighbour is further in the columns of its layer.
    pub(super) offset: isize,
    /// Which mask tells who has a neighbour there.
    pub(super) mask: usize,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    /// Stiffness times rest length.
    pub(super) tension: f64,
    /// The square of the length at which the watch holds the body for exploded.
    pub(super) longest_square: f64,
}

/// What is done with the springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ask {
    /// Only whether one is too long.
    Lengths,
    /// Forces of springs without damping.
    Stiff,
    /// Forces of springs with damping.
    Damped,
}

/// All springs of a grid, by the layer in which they begin.
#[derive(Clone, Copy)]
pub(super) struct Grid<'a> {
    /// The ways to masses of the same layer, and of the next one.
    pub(super) within: &'a [Way],
    pub(super) onward: &'a [Way],
    /// A column for each of nine ways across a layer: 1 where a mass of the layer has a neighbour there, 0 elsewhere.
    pub(super) masks: &'a [f64],
    /// How the columns of a layer are laid out.
    pub(super) shape: Shape,
    /// How many layers there are.
    pub(super) layers: usize,
}

impl Grid<'_> {
    /// Adds the forces of all springs that begin in `layer` back on the masses at which they end, of this layer and of the next one. `forward` becomes the sums on the
    /// masses at which they begin, `too_long` more than 0 where a spring is not shorter than its longest.
    ///
    /// Of eight masses all springs come one after the other, so that what belongs to the eight stays in registers. The forces on masses of the next layer go to `task` as
    /// soon as no spring that is still to come ends there: what it does with them costs little in between, while the processor waits for roots and quotients.
    #[inline(always)]
    pub(super) fn join<T: Task>(
        &self,
        ask: Ask,
        layer: &Layer<'_>,
        mut next: Option<Next<'_, '_, '_>>,
        sums: &mut Sums<'_>,
        too_long: &mut Eight,
        task: &mut T,
    ) {
        let Shape { length, pad: reach, .. } = self.shape;
        let (masks, rows) = (self.masks, self.shape.rows());
        let (position, velocity) = (layer.position(), layer.velocity());
        let [forward, within] = sums.own();
        let mut own = Ends { position, velocity, back: within };
        for row in (rows.start..rows.end + reach).step_by(LANES) {
            if row < rows.end {
                let position = three(position, length, row);
                let velocity = if ask == Ask::Damped { three(velocity, length, row) } else { position };
                let mut springs = Springs { ask, row, length, masks, position, velocity, sum: [Eight::splat(0.0); 3] };
                if let Some(Next { layer, sums, .. }) = &mut next {
                    let (position, velocity) = (layer.position(), layer.velocity());
                    let mut ends = Ends { position, velocity, back: sums.before() };
                    for way in self.onward {
                        springs.pull(way, &mut ends, too_long);
                    }
                }
                for way in self.within {
                    springs.pull(way, &mut own, too_long);
                }
                put(forward, length, row, springs.sum);
            }
            if let Some(Next { z, own: true, layer, sums }) = &mut next
                && ask != Ask::Lengths
                && row >= rows.start + reach
            {
                let row = row - reach;
                task.write(*z, row, layer, sums.take(row));
            }
        }
    }
}

/// The next layer.
pub(super) struct Next<'a, 'b, 'c> {
    /// Which it is.
    pub(super) z: usize,
    /// Whether the forces on it are complete with the springs that lead to it, and are used.
    pub(super) own: bool,
    /// Its masses.
    pub(super) layer: &'a mut Layer<'b>,
    /// What acts on them.
    pub(super) sums: &'a mut Sums<'c>,
}

/// The columns of a layer in which springs end, and the sums of what they pull back with.
struct Ends<'a> {
    position: &'a [f64],
    velocity: &'a [f64],
    back: &'a mut [f64],
}

/// The springs that begin at eight masses.
struct Springs<'a> {
    ask: Ask,
    /// Of the first mass.
    row: usize,
    /// Of all columns. One for all leaves the loop more registers.
    length: usize,
    masks: &'a [f64],
    position: [Eight; 3],
    velocity: [Eight; 3],
    sum: [Eight; 3],
}

impl Springs<'_> {
    /// Those along a way.
    #[inline(always)]
    fn pull(&mut self, way: &Way, ends: &mut Ends<'_>, too_long: &mut Eight) {
        if self.row + LANES <= way.from || way.upto <= self.row {
            return;
        }
        if self.row + HALF < way.upto {
            self.pull_some::<LANES>(way, ends, too_long);
        } else {
            // Roots and quotients of half a vector take half the time.
            self.pull_some::<HALF>(way, ends, too_long);
        }
    }

    /// The first `W` of those along a way.
    #[inline(always)]
    fn pull_some<const W: usize>(&mut self, way: &Way, ends: &mut Ends<'_>, too_long: &mut Eight) {
        let (length, to) = (self.length, self.row.wrapping_add_signed(way.offset));
        let apart = difference(three(ends.position, length, to), first(self.position));
        let (square, mask) = (dot(apart, apart), some::<W>(self.masks, way.mask * length + self.row));
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        let over = (square * mask).if_below(Lanes::splat(way.longest_square), zero, one);
        *too_long += over.resized();
        if self.ask == Ask::Lengths {
            return;
        }
        let distance = square.sqrt();
        let inverse = zero.if_below(distance, one / distance, zero);
        let mut pull = Lanes::splat(way.stiffness) - Lanes::splat(way.tension) * inverse;
        if self.ask == Ask::Damped {
            let speed = dot(difference(three(ends.velocity, length, to), first(self.velocity)), apart);
            pull += Lanes::splat(way.damping) * speed * inverse * inverse;
        }
        let pull = pull * mask;
        let force = [apart[0] * pull, apart[1] * pull, apart[2] * pull];
        let [x, y, z] = self.sum;
        self.sum = [x + force[0].resized(), y + force[1].resized(), z + force[2].resized()];
        let back = three(ends.back, length, to);
        put(ends.back, length, to, difference(back, force));
    }
}

/// The first of some numbers.
#[inline(always)]
fn first<const W: usize>([x, y, z]: [Eight; 3]) -> [Lanes<W>; 3] {
    [x.resized(), y.resized(), z.resized()]
}

#[inline(always)]
fn difference<const W: usize>(a: [Lanes<W>; 3], b: [Lanes<W>; 3]) -> [Lanes<W>; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<const W: usize>(a: [Lanes<W>; 3], b: [Lanes<W>; 3]) -> Lanes<W> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
