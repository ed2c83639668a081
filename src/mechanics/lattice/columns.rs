//! Numbers laid out for the inner loop.

use core::{array, ops::Range};

use bytemuck::{Pod, Zeroable};

use crate::mechanics::Lanes;

/// How many numbers are computed side by side.
pub(super) const LANES: usize = 8;

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
pub(super) fn eight(flat: &[f64], at: usize) -> Eight {
    let mut vector = [0.0; LANES];
    vector.copy_from_slice(&flat[at..at + LANES]);
    vector.into()
}

/// The numbers from a row on in the first three of columns of this length.
// Spelled out, as in the loop that uses it: closures among vectors are not always inlined.
#[inline(always)]
pub(super) fn three(flat: &[f64], length: usize, row: usize) -> [Eight; 3] {
    let block = &flat[row..row + 2 * length + LANES];
    [eight(block, 0), eight(block, length), eight(block, 2 * length)]
}

/// Replaces the numbers from a row on in the first three of columns of this length.
#[inline(always)]
pub(super) fn put(flat: &mut [f64], length: usize, row: usize, [x, y, z]: [Eight; 3]) {
    let block = &mut flat[row..row + 2 * length + LANES];
    for (vector, at) in [(x, 0), (y, length), (z, 2 * length)] {
        block[at..at + LANES].copy_from_slice(&<[f64; LANES]>::from(vector));
    }
}

/// Some rows of a column, a whole number of vectors. Cut to one length, columns need no check of their bounds in a loop.
#[inline(always)]
pub(super) fn eights<'a>(column: &'a [f64], rows: &Range<usize>) -> &'a [[f64; LANES]] {
    &column[rows.start..rows.start + rows.len() / LANES * LANES].as_chunks().0[..rows.len() / LANES]
}

#[inline(always)]
pub(super) fn eights_mut<'a>(column: &'a mut [f64], rows: &Range<usize>) -> &'a mut [[f64; LANES]] {
    &mut column[rows.start..rows.start + rows.len() / LANES * LANES].as_chunks_mut().0[..rows.len() / LANES]
}
