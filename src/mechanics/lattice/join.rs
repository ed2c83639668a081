//! The springs along one way, eight side by side: the inner loop of a block.

use crate::mechanics::Real;

use super::{
    columns::{Columns, Eight, LANES, eights, eights_mut},
    layer::Layer,
};

/// A way to neighbours, and the springs along it.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// The first mass of a layer that may have a neighbour there, and the one after the last, by their places in the layer's arrays.
    pub(super) from: usize,
    pub(super) upto: usize,
    /// By how much the place of the neighbour in the arrays of its layer is further.
    pub(super) offset: isize,
    /// Which mask tells who has a neighbour there.
    pub(super) mask: usize,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) rest_length: f64,
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

/// Adds the forces of the springs along `way` from the masses of `a` to those of `b`. `too_long` becomes 1 where a spring is not shorter than its longest.
#[inline(always)]
pub(super) fn join(
    ask: Ask,
    [a, b]: [&Layer; 2],
    way: &Way,
    masks: &[Columns<1>],
    forward: &mut Columns<3>,
    back: &mut Columns<3>,
    too_long: &mut Eight,
) {
    let count = way.upto.saturating_sub(way.from).div_ceil(LANES);
    if count == 0 {
        return;
    }
    let start = way.from.wrapping_add_signed(way.offset);
    let (from, to) = (way.from..way.from + LANES * count, start..start + LANES * count);
    let [mask] = masks[way.mask].each().map(|mask| eights(mask, &from));
    let x = a.position.each().map(|x| eights(x, &from));
    let y = b.position.each().map(|y| eights(y, &to));
    let (v, w) = if ask == Ask::Damped {
        (a.velocity.each().map(|v| eights(v, &from)), b.velocity.each().map(|w| eights(w, &to)))
    } else {
        (x, y)
    };
    if ask == Ask::Lengths {
        for i in 0..count {
            let apart = [0, 1, 2].map(|k| Eight::from(y[k][i]) - Eight::from(x[k][i]));
            note(dot(apart, apart), way, Eight::from(mask[i]), too_long);
        }
        return;
    }
    let [f0, f1, f2] = forward.each_mut().map(|f| eights_mut(f, &from));
    let [b0, b1, b2] = back.each_mut().map(|b| eights_mut(b, &to));
    for i in 0..count {
        let apart = difference([y[0][i], y[1][i], y[2][i]], [x[0][i], x[1][i], x[2][i]]);
        let mask = Eight::from(mask[i]);
        let square = dot(apart, apart);
        note(square, way, mask, too_long);
        let (zero, length) = (Eight::splat(0.0), square.sqrt());
        let inverse = zero.if_below(length, Eight::splat(1.0) / length, zero);
        let mut pull = Eight::splat(way.stiffness) - Eight::splat(way.stiffness * way.rest_length) * inverse;
        if ask == Ask::Damped {
            let speed = dot(difference([w[0][i], w[1][i], w[2][i]], [v[0][i], v[1][i], v[2][i]]), apart);
            pull += Eight::splat(way.damping) * speed * inverse * inverse;
        }
        let pull = pull * mask;
        let force = [apart[0] * pull, apart[1] * pull, apart[2] * pull];
        f0[i] = (Eight::from(f0[i]) + force[0]).into();
        f1[i] = (Eight::from(f1[i]) + force[1]).into();
        f2[i] = (Eight::from(f2[i]) + force[2]).into();
        b0[i] = (Eight::from(b0[i]) - force[0]).into();
        b1[i] = (Eight::from(b1[i]) - force[1]).into();
        b2[i] = (Eight::from(b2[i]) - force[2]).into();
    }
}

/// Notes lengths, given as squares, that are not below the longest.
#[inline(always)]
fn note(square: Eight, way: &Way, mask: Eight, too_long: &mut Eight) {
    *too_long = (square * mask).if_below(Eight::splat(way.longest_square), *too_long, Eight::splat(1.0));
}

#[inline(always)]
fn difference(to: [[f64; LANES]; 3], from: [[f64; LANES]; 3]) -> [Eight; 3] {
    [
        Eight::from(to[0]) - Eight::from(from[0]),
        Eight::from(to[1]) - Eight::from(from[1]),
        Eight::from(to[2]) - Eight::from(from[2]),
    ]
}

#[inline(always)]
fn dot(a: [Eight; 3], b: [Eight; 3]) -> Eight {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
