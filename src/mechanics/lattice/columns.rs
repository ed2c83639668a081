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
    /// How many numbers a column has.
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
        let mut columns = bytemuck::cast_slice(&self.lines).chunks_exact(self.length);
        array::from_fn(|_| columns.next().unwrap_or_default())
    }

    #[inline(always)]
    pub(super) fn each_mut(&mut self) -> [&mut [f64]; N] {
        let mut columns = bytemuck::cast_slice_mut(&mut self.lines).chunks_exact_mut(self.length);
        array::from_fn(|_| columns.next().unwrap_or_default())
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

/// Some rows of a column, a whole number of vectors. Cut to one length, columns need no check of their bounds in a loop.
#[inline(always)]
pub(super) fn eights<'a>(column: &'a [f64], rows: &Range<usize>) -> &'a [[f64; LANES]] {
    &column[rows.start..rows.start + rows.len() / LANES * LANES].as_chunks().0[..rows.len() / LANES]
}

#[inline(always)]
pub(super) fn eights_mut<'a>(column: &'a mut [f64], rows: &Range<usize>) -> &'a mut [[f64; LANES]] {
    &mut column[rows.start..rows.start + rows.len() / LANES * LANES].as_chunks_mut().0[..rows.len() / LANES]
}
