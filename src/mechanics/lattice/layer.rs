//! One layer of a block, laid out for the inner loop.

use core::{iter::zip, ops::Range};

use crate::mechanics::Real;

use super::{
    columns::{Eight, LANES, clear, column, each, each_mut, put, some, three},
    tasks::KickDrift,
};

/// How the columns of all layers of a block are laid out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Where the first mass is in a column: there is room for any neighbour before it.
    pub(super) pad: usize,
    /// How many masses there are.
    pub(super) count: usize,
    /// How many numbers a column has.
    pub(super) length: usize,
}

impl Shape {
    /// That of a layer of so many masses, of which no neighbour is further than so many others.
    pub(super) fn new(count: usize, furthest: usize) -> Self {
        // Room for neighbours that are not there on either side, whole vectors of them.
        let pad = furthest.next_multiple_of(LANES);
        Self { pad, count, length: column(2 * pad + count.next_multiple_of(LANES) + LANES) }
    }

    /// How many numbers a layer has: places, velocities, inverse masses.
    #[inline(always)]
    pub(super) fn layer(self) -> usize {
        7 * self.length
    }

    /// How many numbers the sums of a layer have.
    #[inline(always)]
    pub(super) fn sums(self) -> usize {
        9 * self.length
    }

    /// The rows of the masses, a whole number of vectors.
    #[inline(always)]
    pub(super) fn rows(self) -> Range<usize> {
        self.pad..self.pad + self.count.next_multiple_of(LANES)
    }

    /// Those of eight masses from a row on that there are, by their numbers in the layer.
    #[inline(always)]
    pub(super) fn masses(self, row: usize) -> Range<usize> {
        let first = row - self.pad;
        first..(first + LANES).min(self.count)
    }
}

/// A layer of the grid, coordinate by coordinate.
pub(super) struct Layer<'a> {
    shape: Shape,
    /// Places, then velocities, then inverse masses.
    columns: &'a mut [f64],
}

/// The sums of the forces of springs on a layer.
pub(super) struct Sums<'a> {
    length: usize,
    /// On the masses at which they begin, found as a whole and not added to; on those at which they end, from the same layer; and these from the layer before.
    columns: &'a mut [f64],
}

impl<'a> Sums<'a> {
    #[inline(always)]
    pub(super) fn new(shape: Shape, columns: &'a mut [f64]) -> Self {
        Self { length: shape.length, columns: &mut columns[..shape.sums()] }
    }

    /// Forward on the masses at which springs begin, and back on those at which they end, within the layer.
    #[inline(always)]
    pub(super) fn own(&mut self) -> [&mut [f64]; 2] {
        let (forward, within) = self.columns[..6 * self.length].split_at_mut(3 * self.length);
        [forward, within]
    }

    /// Back on the masses at which springs from the layer before end.
    #[inline(always)]
    pub(super) fn before(&mut self) -> &mut [f64] {
        &mut self.columns[6 * self.length..9 * self.length]
    }

    /// Sums up what acts on the eight masses that begin with a row. What springs pull back with is zero afterwards.
    #[inline(always)]
    pub(super) fn take(&mut self, row: usize) -> [Eight; 3] {
        let length = self.length;
        let [forward, within] = self.own();
        let [x, y, z]: [Eight; 3] = three(forward, length, row);
        let [wx, wy, wz] = three(within, length, row);
        clear(within, length, row);
        let before = self.before();
        let [bx, by, bz] = three(before, length, row);
        clear(before, length, row);
        [x + (wx + bx), y + (wy + by), z + (wz + bz)]
    }
}

impl<'a> Layer<'a> {
    #[inline(always)]
    pub(super) fn new(shape: Shape, columns: &'a mut [f64]) -> Self {
        Self { shape, columns: &mut columns[..shape.layer()] }
    }

    /// How its columns are laid out.
    #[inline(always)]
    pub(super) fn shape(&self) -> Shape {
        self.shape
    }

    /// Where its masses are.
    #[inline(always)]
    pub(super) fn position(&self) -> &[f64] {
        &self.columns[..3 * self.shape.length]
    }

    /// How they move.
    #[inline(always)]
    pub(super) fn velocity(&self) -> &[f64] {
        &self.columns[3 * self.shape.length..6 * self.shape.length]
    }

    /// Where its masses are, how they move, and one by their masses.
    #[inline(always)]
    fn parts(&mut self) -> [&mut [f64]; 3] {
        let (position, rest) = self.columns.split_at_mut(3 * self.shape.length);
        let (velocity, inverse_mass) = rest.split_at_mut(3 * self.shape.length);
        [position, velocity, inverse_mass]
    }

    /// Becomes a copy of another.
    pub(super) fn copy(&mut self, columns: &[f64]) {
        self.columns.copy_from_slice(&columns[..self.shape.layer()]);
    }

    /// Puts the masses of a layer here.
    #[inline(always)]
    pub(super) fn deal(&mut self, position: &[[f64; 3]], velocity: Option<&[[f64; 3]]>) {
        let Shape { pad, length, .. } = self.shape;
        let [own_position, own_velocity, _] = self.parts();
        deal(position, each_mut(own_position, length), pad);
        if let Some(velocity) = velocity {
            deal(velocity, each_mut(own_velocity, length), pad);
        }
    }

    /// Puts the inverse masses here.
    pub(super) fn weigh(&mut self, inverse_mass: &[f64]) {
        let Shape { pad, count, .. } = self.shape;
        let [_, _, column] = self.parts();
        column[pad..pad + count].copy_from_slice(inverse_mass);
    }

    /// Writes where its masses are and how they move.
    #[inline(always)]
    pub(super) fn gather(&self, position: &mut [[f64; 3]], velocity: &mut [[f64; 3]]) {
        let Shape { pad, length, .. } = self.shape;
        gather(each(self.position(), length), pad, position);
        gather(each(self.velocity(), length), pad, velocity);
    }

    /// Becomes what another layer of the block will be when it has drifted for so long; with its velocity where that is asked for.
    pub(super) fn foresee(&mut self, other: &Layer<'_>, reach: f64, velocity: bool) {
        let [own_position, own_velocity, _] = self.parts();
        own_position.copy_from_slice(other.position());
        drift(own_position, other.velocity(), reach);
        if velocity {
            own_velocity.copy_from_slice(other.velocity());
        }
    }

    /// Moves its masses on for so long.
    #[inline(always)]
    pub(super) fn drift(&mut self, reach: f64) {
        let [position, velocity, _] = self.parts();
        drift(position, velocity, reach);
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
        let length = self.shape.length;
        let [position, velocity, inverse_mass] = self.parts();
        let inverse_mass = some(inverse_mass, row);
        let [fx, fy, fz] = forces;
        let [x, y, z] = three(position, length, row);
        let [vx, vy, vz] = three(velocity, length, row);
        let kick = Kick { rule, inverse_mass, ahead };
        let (x, vx) = kick.moves::<false>(x, vx, fx * inverse_mass);
        let (z, vz) = kick.moves::<false>(z, vz, fz * inverse_mass);
        // What is pinned has no weight.
        let zero = Eight::splat(0.0);
        let down = fy * inverse_mass - zero.if_below(inverse_mass, Eight::splat(gravity), zero);
        let (y, vy) = if floor { kick.moves::<true>(y, vy, down) } else { kick.moves::<false>(y, vy, down) };
        put(position, length, row, [x, y, z]);
        put(velocity, length, row, [vx, vy, vz]);
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
fn drift(position: &mut [f64], velocity: &[f64], reach: f64) {
    if reach > 0.0 {
        for (x, v) in zip(position, velocity) {
            *x += *v * reach;
        }
    }
}

/// Deals the coordinates of vectors out to a column each. What the last vector has room for beside them becomes zero: something that is not finite may be left of an
/// explosion.
#[inline(always)]
fn deal(vectors: &[[f64; 3]], columns: [&mut [f64]; 3], pad: usize) {
    let count = vectors.len();
    let [x, y, z] = columns.map(|column| {
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
fn gather(columns: [&[f64]; 3], pad: usize, vectors: &mut [[f64; 3]]) {
    let count = vectors.len();
    let [x, y, z] = columns.map(|column| &column[pad..pad + count]);
    for i in 0..count {
        vectors[i] = [x[i], y[i], z[i]];
    }
}
