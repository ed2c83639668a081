//! One layer of a block, laid out for the inner loop.

use core::{iter::zip, ops::Range};

use crate::mechanics::Real;

use super::{
    columns::{Columns, Eight, LANES, eights, eights_mut},
    tasks::KickDrift,
};

/// A layer of the grid, coordinate by coordinate, with room for neighbours that are not there on either side.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Where the first mass is in the columns.
    pad: usize,
    /// How many masses there are.
    count: usize,
    pub(super) position: Columns<3>,
    pub(super) velocity: Columns<3>,
    inverse_mass: Columns<1>,
}

/// The sums of the forces of springs on a layer.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    /// On the masses at which they begin. Found as a whole, and not added to.
    pub(super) forward: Columns<3>,
    /// On the masses at which they end, from the same layer.
    pub(super) within: Columns<3>,
    /// From the layer before.
    pub(super) before: Columns<3>,
}

impl Sums {
    pub(super) fn new(room: usize) -> Self {
        Self { forward: Columns::zeros(room), within: Columns::zeros(room), before: Columns::zeros(room) }
    }

    /// Sets the sums of what springs pull back with to zero.
    fn clear(&mut self) {
        self.within.clear();
        self.before.clear();
    }
}

impl Layer {
    pub(super) fn new(room: usize, pad: usize, count: usize) -> Self {
        let (position, velocity, inverse_mass) = (Columns::zeros(room), Columns::zeros(room), Columns::zeros(room));
        Self { pad, count, position, velocity, inverse_mass }
    }

    /// The rows of the masses, a whole number of vectors.
    #[inline(always)]
    pub(super) fn rows(&self) -> Range<usize> {
        self.pad..self.pad + self.count.next_multiple_of(LANES)
    }

    /// Puts the masses of a layer here.
    #[inline(always)]
    pub(super) fn deal(&mut self, position: &[[f64; 3]], velocity: Option<&[[f64; 3]]>) {
        deal(position, &mut self.position, self.pad);
        if let Some(velocity) = velocity {
            deal(velocity, &mut self.velocity, self.pad);
        }
    }

    /// Puts the inverse masses here.
    pub(super) fn weigh(&mut self, inverse_mass: &[f64]) {
        let [column] = self.inverse_mass.each_mut();
        column[self.pad..self.pad + self.count].copy_from_slice(inverse_mass);
    }

    /// Writes where its masses are and how they move.
    #[inline(always)]
    pub(super) fn gather(&self, position: &mut [[f64; 3]], velocity: &mut [[f64; 3]]) {
        gather(&self.position, self.pad, position);
        gather(&self.velocity, self.pad, velocity);
    }

    /// Becomes what another layer of the block will be when it has drifted for so long; with its velocity where that is asked for.
    pub(super) fn foresee(&mut self, other: &Self, reach: f64, velocity: bool) {
        self.position.copy(&other.position);
        drift(&mut self.position, &other.velocity, reach);
        if velocity {
            self.velocity.copy(&other.velocity);
        }
    }

    /// Moves its masses on for so long.
    #[inline(always)]
    pub(super) fn drift(&mut self, reach: f64) {
        drift(&mut self.position, &self.velocity, reach);
    }

    /// Kicks its masses, which stand where they are to feel the forces, and lets them drift on. What comes to be below a floor is put back on it and loses what of
    /// its velocity leads down. That is the end of a step; `ahead` is for how long they drift on from there, into the next. What springs pull back with is zero
    /// afterwards.
    #[inline(always)]
    pub(super) fn kick(&mut self, rule: KickDrift, gravity: f64, floor: bool, ahead: f64, sums: &mut Sums) {
        let rows = self.rows();
        let [inverse_mass] = self.inverse_mass.each().map(|column| eights(column, &rows));
        let columns = zip(self.position.each_mut(), self.velocity.each_mut());
        let sums = zip(sums.forward.each(), zip(sums.within.each_mut(), sums.before.each_mut()));
        for (axis, ((x, v), (f, (w, b)))) in zip(columns, sums).enumerate() {
            let f = eights(f, &rows);
            let columns = [x, v, w, b].map(|column| eights_mut(column, &rows));
            // Each on its own: a branch in the loop costs twice its time.
            let gravity = if axis == 1 { gravity } else { 0.0 };
            match (floor && axis == 1, ahead > 0.0) {
                (false, false) => kick::<false, false>(rule, inverse_mass, gravity, ahead, f, columns),
                (false, true) => kick::<false, true>(rule, inverse_mass, gravity, ahead, f, columns),
                (true, false) => kick::<true, false>(rule, inverse_mass, gravity, ahead, f, columns),
                (true, true) => kick::<true, true>(rule, inverse_mass, gravity, ahead, f, columns),
            }
        }
    }

    /// Gives the force on each of its masses to `work`. What springs pull back with is zero afterwards.
    #[inline(always)]
    pub(super) fn each_force(&self, sums: &mut Sums, mut work: impl FnMut(usize, [f64; 3])) {
        let masses = self.pad..self.pad + self.count;
        let [f0, f1, f2] = sums.forward.each().map(|column| &column[masses.clone()]);
        let [w0, w1, w2] = sums.within.each().map(|column| &column[masses.clone()]);
        let [b0, b1, b2] = sums.before.each().map(|column| &column[masses.clone()]);
        for i in 0..self.count {
            work(i, [f0[i] + (w0[i] + b0[i]), f1[i] + (w1[i] + b1[i]), f2[i] + (w2[i] + b2[i])]);
        }
        sums.clear();
    }
}

/// Kicks along one axis: positions and velocities, by the sums forward, and back within the layer and from the one before.
#[inline(always)]
fn kick<const FLOOR: bool, const AHEAD: bool>(
    rule: KickDrift,
    inverse_mass: &[[f64; LANES]],
    gravity: f64,
    ahead: f64,
    f: &[[f64; LANES]],
    [x, v, w, b]: [&mut [[f64; LANES]]; 4],
) {
    let [dt, after, rate, kept] = [rule.dt, rule.after, rule.rate, rule.kept].map(Eight::splat);
    let (zero, gravity, ahead, count) =
        (Eight::splat(0.0), Eight::splat(gravity), Eight::splat(ahead), inverse_mass.len());
    let (x, v, f, w, b) = (&mut x[..count], &mut v[..count], &f[..count], &mut w[..count], &mut b[..count]);
    for i in 0..count {
        let inverse = Eight::from(inverse_mass[i]);
        let force = Eight::from(f[i]) + (Eight::from(w[i]) + Eight::from(b[i]));
        // What is pinned has no weight, and no velocity that a damping could take.
        let a = force * inverse - zero.if_below(inverse, gravity, zero);
        let speed = Eight::from(v[i]);
        let mut speed = speed * kept + (a - rate * speed) * dt;
        let mut place = Eight::from(x[i]) + speed * after;
        if FLOOR {
            let least = zero.if_below(inverse, zero, Eight::splat(f64::NEG_INFINITY));
            speed = place.if_below(least, speed.if_below(zero, zero, speed), speed);
            place = place.if_below(least, least, place);
        }
        if AHEAD {
            place += speed * ahead;
        }
        (x[i], v[i]) = (place.into(), speed.into());
        (w[i], b[i]) = (zero.into(), zero.into());
    }
}

#[inline(always)]
fn drift(position: &mut Columns<3>, velocity: &Columns<3>, reach: f64) {
    if reach > 0.0 {
        for (position, velocity) in zip(position.each_mut(), velocity.each()) {
            for (x, v) in zip(position, velocity) {
                *x += *v * reach;
            }
        }
    }
}

/// Deals the coordinates of vectors out to a column each. What the last vector has room for beside them becomes zero: something that is not finite may be left of an
/// explosion.
#[inline(always)]
fn deal(vectors: &[[f64; 3]], columns: &mut Columns<3>, pad: usize) {
    let count = vectors.len();
    let [x, y, z] = columns.each_mut().map(|column| {
        let (masses, beside) = column[pad..pad + count.next_multiple_of(LANES)].split_at_mut(count);
        beside.fill(0.0);
        masses
    });
    for i in 0..count {
        x[i] = vectors[i][0];
        y[i] = vectors[i][1];
        z[i] = vectors[i][2];
    }
}

/// Gathers vectors from a column for each coordinate.
#[inline(always)]
fn gather(columns: &Columns<3>, pad: usize, vectors: &mut [[f64; 3]]) {
    let count = vectors.len();
    let [x, y, z] = columns.each().map(|column| &column[pad..pad + count]);
    for i in 0..count {
        vectors[i] = [x[i], y[i], z[i]];
    }
}
