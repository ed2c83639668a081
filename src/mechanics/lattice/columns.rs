//! Numbers laid out for the inner loop.

use core::array;

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

/// `N` columns of equally many numbers. Each begins with a line of the cache; a vector that lies across two takes twice as long to load and to store.
#[derive(Clone, Debug)]
pub(super) struct Columns<const N: usize> {
    lines: Vec<Line>,
    length: usize,
}

impl<const N: usize> Columns<N> {
    /// Zeros, at least `length` of them in each.
    pub(super) fn zeros(length: usize) -> Self {
        // An odd number of lines, so that the same place of all columns is never in the same set of the cache.
        let lines = length.div_ceil(LANES) | 1;
        Self { lines: vec![Line::zeroed(); N * lines], length: lines * LANES }
    }

    #[inline(always)]
    pub(super) fn each(&self) -> [&[f64]; N] {
        let mut columns = self.flat().chunks_exact(self.length);
        array::from_fn(|_| columns.next().unwrap_or_default())
    }

    #[inline(always)]
    pub(super) fn each_mut(&mut self) -> [&mut [f64]; N] {
        let length = self.length;
        let mut columns = self.flat_mut().chunks_exact_mut(length);
        array::from_fn(|_| columns.next().unwrap_or_default())
    }

    /// How many numbers a column has.
    pub(super) fn length(&self) -> usize {
        self.length
    }

    /// Column after column.
    #[inline(always)]
    pub(super) fn flat(&self) -> &[f64] {
        bytemuck::cast_slice(&self.lines)
    }

    #[inline(always)]
    pub(super) fn flat_mut(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }

    /// Becomes a copy of columns of the same length.
    pub(super) fn copy(&mut self, other: &Self) {
        self.lines.copy_from_slice(&other.lines);
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.lines.fill(Line::zeroed());
    }
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
