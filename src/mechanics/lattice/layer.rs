//! One layer of a block, laid out for the inner loop.

use super::tasks::KickDrift;

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

    /// Puts the masses of a layer here, moved on by `reach` of time, without forces yet.
    #[inline(always)]
    pub(super) fn set(&mut self, position: &[[f64; 3]], velocity: Option<&[[f64; 3]]>, reach: f64) {
        deal(position, &mut self.position, self.pad);
        if let Some(velocity) = velocity {
            deal(velocity, &mut self.velocity, self.pad);
        }
        if reach > 0.0 {
            for (position, velocity) in self.position.iter_mut().zip(&self.velocity) {
                for (x, v) in position.iter_mut().zip(velocity) {
                    *x += *v * reach;
                }
            }
        }
        for sums in self.forward.iter_mut().chain(&mut self.back) {
            sums.fill(0.0);
        }
    }

    /// Kicks its masses, which stand where they are to feel the forces, and lets them drift on. What comes to be below a floor is put back on it and loses what of
    /// its velocity leads down.
    #[inline(always)]
    pub(super) fn kick(&mut self, rule: KickDrift, inverse_mass: &[f64], gravity: f64, floor: bool) {
        let KickDrift { dt, after, rate, kept, .. } = rule;
        let (from, count) = (self.pad, inverse_mass.len());
        let Self { position, velocity, forward, back, .. } = self;
        for axis in 0..3 {
            let x = &mut position[axis][from..from + count];
            let v = &mut velocity[axis][from..from + count];
            let (f, b) = (&forward[axis][from..from + count], &back[axis][from..from + count]);
            let gravity = if axis == 1 { gravity } else { 0.0 };
            for i in 0..count {
                // What is pinned has no weight, and no velocity that a damping could take.
                let weight = if inverse_mass[i] > 0.0 { gravity } else { 0.0 };
                let a = (f[i] + b[i]) * inverse_mass[i] - weight;
                v[i] = v[i] * kept + (a - rate * v[i]) * dt;
                x[i] += v[i] * after;
            }
        }
        if floor {
            let (y, v) = (&mut position[1][from..from + count], &mut velocity[1][from..from + count]);
            for i in 0..count {
                let below = inverse_mass[i] > 0.0 && y[i] < 0.0;
                v[i] = if below && v[i] < 0.0 { 0.0 } else { v[i] };
                y[i] = if below { 0.0 } else { y[i] };
            }
        }
    }

    /// Writes where its masses are and how they move.
    #[inline(always)]
    pub(super) fn write(&self, position: &mut [[f64; 3]], velocity: &mut [[f64; 3]]) {
        gather(&self.position, self.pad, position);
        gather(&self.velocity, self.pad, velocity);
    }

    /// Gives the force on each of its masses to `work`.
    #[inline(always)]
    pub(super) fn each_force(&self, count: usize, mut work: impl FnMut(usize, [f64; 3])) {
        let [f0, f1, f2] = self.forward.each_ref().map(|f| &f[self.pad..self.pad + count]);
        let [b0, b1, b2] = self.back.each_ref().map(|b| &b[self.pad..self.pad + count]);
        for i in 0..count {
            work(i, [f0[i] + b0[i], f1[i] + b1[i], f2[i] + b2[i]]);
        }
    }
}

/// Deals the coordinates of vectors out to an array each.
#[inline(always)]
fn deal(vectors: &[[f64; 3]], columns: &mut [Vec<f64>; 3], pad: usize) {
    let count = vectors.len();
    let [x, y, z] = columns.each_mut().map(|column| &mut column[pad..pad + count]);
    for i in 0..count {
        x[i] = vectors[i][0];
        y[i] = vectors[i][1];
        z[i] = vectors[i][2];
    }
}

/// Gathers vectors from an array for each coordinate.
#[inline(always)]
fn gather(columns: &[Vec<f64>; 3], pad: usize, vectors: &mut [[f64; 3]]) {
    let count = vectors.len();
    let [x, y, z] = columns.each_ref().map(|column| &column[pad..pad + count]);
    for i in 0..count {
        vectors[i] = [x[i], y[i], z[i]];
    }
}
