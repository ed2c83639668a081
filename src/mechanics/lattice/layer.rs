//! One layer of a block, laid out for the inner loop.

use crate::mechanics::Real;

/// A layer of the grid: an array for each coordinate, with room for neighbours that are not there on either side.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Where the first mass is in the arrays.
    pad: usize,
    pub(super) position: [Vec<f64>; 3],
    pub(super) velocity: [Vec<f64>; 3],
    /// The sum of the forces of springs on the masses at which they begin.
    pub(super) forward: [Vec<f64>; 3],
    /// The same at which they end.
    pub(super) back: [Vec<f64>; 3],
}

impl Layer {
    pub(super) fn new(room: usize, pad: usize) -> Self {
        let zeros = || [vec![0.0; room], vec![0.0; room], vec![0.0; room]];
        Self { pad, position: zeros(), velocity: zeros(), forward: zeros(), back: zeros() }
    }

    /// Puts the masses of a layer here, without forces yet.
    #[inline(always)]
    pub(super) fn set<R: Real, const D: usize>(&mut self, position: &[[R; D]], velocity: Option<&[[R; D]]>) {
        deal(position, &mut self.position, self.pad);
        if let Some(velocity) = velocity {
            deal(velocity, &mut self.velocity, self.pad);
        }
        for sums in self.forward.iter_mut().chain(&mut self.back) {
            sums.fill(0.0);
        }
    }

    /// Writes what accelerates the masses.
    #[inline(always)]
    pub(super) fn accelerate<R: Real, const D: usize>(&self, inverse_mass: &[R], acceleration: &mut [[R; D]]) {
        let count = acceleration.len();
        let [f0, f1, f2] = self.forward.each_ref().map(|f| &f[self.pad..self.pad + count]);
        let [b0, b1, b2] = self.back.each_ref().map(|b| &b[self.pad..self.pad + count]);
        let inverse_mass = &inverse_mass[..count];
        for (i, row) in acceleration.iter_mut().enumerate() {
            let light = inverse_mass[i].lane(0);
            row[0] = R::splat((f0[i] + b0[i]) * light);
            row[1] = R::splat((f1[i] + b1[i]) * light);
            row[2] = R::splat((f2[i] + b2[i]) * light);
        }
    }
}

/// Deals the coordinates of vectors out to an array each.
#[inline(always)]
fn deal<R: Real, const D: usize>(vectors: &[[R; D]], columns: &mut [Vec<f64>; 3], pad: usize) {
    let count = vectors.len();
    let [x, y, z] = columns.each_mut().map(|column| &mut column[pad..pad + count]);
    for i in 0..count {
        x[i] = vectors[i][0].lane(0);
        y[i] = vectors[i][1].lane(0);
        z[i] = vectors[i][2].lane(0);
    }
}
