//! The springs that begin in a layer, eight side by side: the inner loop of a block.

use crate::mechanics::Real;

use super::{
    columns::{Columns, Eight, LANES, eight, put, three},
    layer::Layer,
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
    pub(super) masks: &'a Columns<9>,
    /// How many layers there are.
    pub(super) layers: usize,
}

impl Grid<'_> {
    /// Adds the forces of all springs that begin in `layer` back on the masses at which they end, of this layer and of the next one. `forward` becomes the sums on the
    /// masses at which they begin, `too_long` 1 where a spring is not shorter than its longest.
    ///
    /// Of eight masses all springs come one after the other, so that what belongs to the eight stays in registers.
    #[inline(always)]
    pub(super) fn join(
        &self,
        ask: Ask,
        layer: &Layer,
        next: Option<(&Layer, &mut Columns<3>)>,
        forward: &mut Columns<3>,
        within: &mut Columns<3>,
        too_long: &mut Eight,
    ) {
        let (length, masks) = (self.masks.length(), self.masks.flat());
        let (position, velocity, forward) = (layer.position.flat(), layer.velocity.flat(), forward.flat_mut());
        let mut own = Ends { position, velocity, back: within.flat_mut() };
        let mut next = next.map(|(layer, before)| Ends {
            position: layer.position.flat(),
            velocity: layer.velocity.flat(),
            back: before.flat_mut(),
        });
        for row in layer.rows().step_by(LANES) {
            let position = three(position, length, row);
            let velocity = if ask == Ask::Damped { three(velocity, length, row) } else { position };
            let mut springs = Springs { ask, row, length, masks, position, velocity, sum: [Eight::splat(0.0); 3] };
            if let Some(next) = &mut next {
                for way in self.onward {
                    springs.pull(way, next, too_long);
                }
            }
            for way in self.within {
                springs.pull(way, &mut own, too_long);
            }
            put(forward, length, row, springs.sum);
        }
    }
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
        let (length, to) = (self.length, self.row.wrapping_add_signed(way.offset));
        let apart = difference(three(ends.position, length, to), self.position);
        let (square, mask) = (dot(apart, apart), eight(self.masks, way.mask * length + self.row));
        let (zero, one) = (Eight::splat(0.0), Eight::splat(1.0));
        *too_long = (square * mask).if_below(Eight::splat(way.longest_square), *too_long, one);
        if self.ask == Ask::Lengths {
            return;
        }
        let distance = square.sqrt();
        let inverse = zero.if_below(distance, one / distance, zero);
        let mut pull = Eight::splat(way.stiffness) - Eight::splat(way.tension) * inverse;
        if self.ask == Ask::Damped {
            let speed = dot(difference(three(ends.velocity, length, to), self.velocity), apart);
            pull += Eight::splat(way.damping) * speed * inverse * inverse;
        }
        let pull = pull * mask;
        let force = [apart[0] * pull, apart[1] * pull, apart[2] * pull];
        self.sum = [self.sum[0] + force[0], self.sum[1] + force[1], self.sum[2] + force[2]];
        let back = three(ends.back, length, to);
        put(ends.back, length, to, difference(back, force));
    }
}

#[inline(always)]
fn difference(a: [Eight; 3], b: [Eight; 3]) -> [Eight; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: [Eight; 3], b: [Eight; 3]) -> Eight {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
