//! Numbers laid out for the inner loop.

use bytemuck::{Pod, Zeroable};

use crate::mechanics::Lanes;

/// How many numbers are computed side by side.
pub(super) const LANES: usize = 8;

/// How many where no more than so many are left.
pub(super) const HALF: usize = 4;

pub(super) type Eight = Lanes<LANES>;

/// A line of the cache: a vector.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
struct Line([f64; LANES]);

/// Numbers of which the first begins a line of the cache; a vector that lies across two takes twice as long to load and to store.
///
/// A block has all of its own in one of these: a processor finds what lies together sooner than what lies in many places.
#[derive(Clone, Debug)]
pub(super) struct Numbers(Vec<Line>);

impl Numbers {
    /// Zeros, at least so many.
    pub(super) fn zeros(count: usize) -> Self {
        Self(vec![Line::zeroed(); count.div_ceil(LANES)])
    }

    /// All of them.
    pub(super) fn all_mut(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(&mut self.0)
    }
}

/// How many numbers a column has that has room for so many: an odd number of lines, so that the same place of columns that follow each other is never in the same set of the
/// cache.
pub(super) fn column(room: usize) -> usize {
    (room.div_ceil(LANES) | 1) * LANES
}

/// Three columns of this length, each by itself.
#[inline(always)]
pub(super) fn each(flat: &[f64], length: usize) -> [&[f64]; 3] {
    let (x, rest) = flat.split_at(length);
    let (y, z) = rest.split_at(length);
    [x, y, &z[..length]]
}

#[inline(always)]
pub(super) fn each_mut(flat: &mut [f64], length: usize) -> [&mut [f64]; 3] {
    let (x, rest) = flat.split_at_mut(length);
    let (y, z) = rest.split_at_mut(length);
    [x, y, &mut z[..length]]
}

/// The numbers from a place on.
#[inline(always)]
pub(super) fn some<const W: usize>(flat: &[f64], at: usize) -> Lanes<W> {
    let mut vector = [0.0; W];
    vector.copy_from_slice(&flat[at..at + W]);
    vector.into()
}

/// The numbers from a row on in the first three of columns of this length.
// Spelled out, as in the loop that uses it: closures among vectors are not always inlined.
#[inline(always)]
pub(super) fn three<const W: usize>(flat: &[f64], length: usize, row: usize) -> [Lanes<W>; 3] {
    let block = &flat[row..row + 2 * length + W];
    [some(block, 0), some(block, length), some(block, 2 * length)]
}

/// Replaces the numbers from a row on in the first three of columns of this length.
#[inline(always)]
pub(super) fn put<const W: usize>(flat: &mut [f64], length: usize, row: usize, [x, y, z]: [Lanes<W>; 3]) {
    let block = &mut flat[row..row + 2 * length + W];
    for (vector, at) in [(x, 0), (y, length), (z, 2 * length)] {
        block[at..at + W].copy_from_slice(&<[f64; W]>::from(vector));
    }
}

/// Sets the numbers from a row on to zero in the first three of columns of this length.
#[inline(always)]
pub(super) fn clear(flat: &mut [f64], length: usize, row: usize) {
    let block = &mut flat[row..row + 2 * length + LANES];
    block[..LANES].fill(0.0);
    block[length..length + LANES].fill(0.0);
    block[2 * length..].fill(0.0);
}
