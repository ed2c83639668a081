//! One layer of a block, laid out for the inner loop.

use core::{iter::zip, ops::Range};

use crate::mechanics::Real;

use super::{
    columns::{Columns, Eight, LANES, clear, put, some, three},
    tasks::KickDrift,
};

/// A layer of the grid, coordinate by coordinate, with room for neighbours that are not there on either side.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Where the first mass is in the columns: there is room for any neighbour before it.
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

    /// Sums up what acts on the eight masses that begin with a row. What springs pull back with is zero afterwards.
    #[inline(always)]
    pub(super) fn take(&mut self, row: usize) -> [Eight; 3] {
        let length = self.forward.length();
        let [x, y, z]: [Eight; 3] = three(self.forward.flat(), length, row);
        let [wx, wy, wz] = three(self.within.flat(), length, row);
        let [bx, by, bz] = three(self.before.flat(), length, row);
        clear(self.within.flat_mut(), length, row);
        clear(self.before.flat_mut(), length, row);
        [x + (wx + bx), y + (wy + by), z + (wz + bz)]
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

    /// By how many rows the neighbours of a mass are further at most, rounded up to vectors.
    #[inline(always)]
    pub(super) fn reach(&self) -> usize {
        self.pad
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

    /// Kicks eight of its masses by the forces on them, which they feel where they are, and lets them drift on. What comes to be below a floor is put back on it and loses
    /// what of its velocity leads down. That is the end of a step; `ahead` is for how long they drift on from there, into the next.
    #[inline(always)]
    pub(super) fn kick(
        &mut self,
        rule: KickDrift,
        gravity: f64,
        floor: bool,
        ahead: f64,
        row: usize,
        forces: [Eight; 3],
    ) {
        let length = self.position.length();
        let inverse_mass = some(self.inverse_mass.flat(), row);
        let [fx, fy, fz] = forces;
        let [x, y, z] = three(self.position.flat(), length, row);
        let [vx, vy, vz] = three(self.velocity.flat(), length, row);
        let kick = Kick { rule, inverse_mass, ahead };
        let (x, vx) = kick.moves::<false>(x, vx, fx * inverse_mass);
        let (z, vz) = kick.moves::<false>(z, vz, fz * inverse_mass);
        // What is pinned has no weight.
        let zero = Eight::splat(0.0);
        let down = fy * inverse_mass - zero.if_below(inverse_mass, Eight::splat(gravity), zero);
        let (y, vy) = if floor { kick.moves::<true>(y, vy, down) } else { kick.moves::<false>(y, vy, down) };
        put(self.position.flat_mut(), length, row, [x, y, z]);
        put(self.velocity.flat_mut(), length, row, [vx, vy, vz]);
    }

    /// Those of eight masses from a row on that there are, by their numbers in the layer.
    #[inline(always)]
    pub(super) fn masses(&self, row: usize) -> Range<usize> {
        let first = row - self.pad;
        first..(first + LANES).min(self.count)
    }
}

/// A kick of eight masses, and the drifts after it.
struct Kick {
    rule: KickDrift,
    inverse_mass: Eight,
    ahead: f64,
}

impl Kick {
    /// Where they come to be and how they move then, along one axis.
    #[inline(always)]
    fn moves<const FLOOR: bool>(&self, place: Eight, speed: Eight, acceleration: Eight) -> (Eight, Eight) {
        let Self { rule, inverse_mass, ahead } = self;
        let zero = Eight::splat(0.0);
        let damping = Eight::splat(rule.rate) * speed;
        let mut speed = speed * Eight::splat(rule.kept) + (acceleration - damping) * Eight::splat(rule.dt);
        let mut place = place + speed * Eight::splat(rule.after);
        if FLOOR {
            // What is pinned stays where it is.
            let least = zero.if_below(*inverse_mass, zero, Eight::splat(f64::NEG_INFINITY));
            speed = place.if_below(least, speed.if_below(zero, zero, speed), speed);
            place = place.if_below(least, least, place);
        }
        if *ahead > 0.0 {
            place += speed * Eight::splat(*ahead);
        }
        (place, speed)
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
