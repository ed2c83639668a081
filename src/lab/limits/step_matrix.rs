//! The limit of a method's step from the step itself: the method is run on small disturbances of the body's pose, which gives the matrix of the
//! linearised step, and grows where an eigenvalue of that is beyond the unit circle.

use faer::Mat;

use crate::mechanics::{Advance, BodyParts, Model, State, Timeline};

use super::{
    linear::{Linear, bare},
    search::first_unstable,
};

/// How large disturbances are, in the shortest rest length: on an axis, where springs are linear, and in space.
const DISTURBANCE: [f64; 2] = [1e-3, 1e-5];
/// The search begins at this part of the time of the fastest rate.
const FROM: f64 = 1e-3;
/// Limits are found to this part of themselves.
const PRECISION: f64 = 1e-4;
/// What rounding and the square of a disturbance may add to a growth of 1.
const ROUNDING: f64 = 1e-8;

/// The smallest step at which a small disturbance of the body's present pose grows, to a part in ten thousand: without friction, contact and gravity,
/// with its muscles at rest. Infinite where none grows at any step; nothing where the method cannot step the body.
pub fn linearised_limit(body: &BodyParts<'_>) -> Option<f64> {
    let linear = Linear::of(body)?;
    let mut refused = false;
    let limit = first_unstable(linear.rate, FROM / linear.rate, PRECISION, |dt| match growth_of(body, &linear, dt) {
        Some(growth) => growth <= 1.0 + ROUNDING,
        None => {
            refused = true;
            false
        }
    });
    (!refused).then_some(limit)
}

/// By how much a step of `dt` multiplies the disturbance that grows most, in the long run: the spectral radius of the linearised step. 1 where the
/// body only moves as a whole. Nothing where the method cannot step the body.
pub fn growth(body: &BodyParts<'_>, dt: f64) -> Option<f64> {
    growth_of(body, &Linear::of(body)?, dt)
}

fn growth_of(body: &BodyParts<'_>, linear: &Linear, dt: f64) -> Option<f64> {
    let body = bare(body);
    let matrix = if body.on_axis() { matrix::<1>(&body, linear, dt)? } else { matrix::<3>(&body, linear, dt)? };
    if matrix.col_iter().any(|column| column.iter().any(|value| !value.is_finite())) {
        return Some(f64::INFINITY);
    }
    let values = if matrix.nrows() == 0 { Vec::new() } else { matrix.eigenvalues().ok()? };
    Some(values.into_iter().map(|value| value.norm()).fold(0.0, f64::max))
}

/// The step as a matrix on the resisted directions' positions and velocities. What moves as a whole is left out: it drifts, which is no growth.
/// Where its mass damps it, one such velocity stands for all.
fn matrix<const D: usize>(body: &BodyParts<'_>, linear: &Linear, dt: f64) -> Option<Mat<f64>> {
    let resisted = linear.resisted.ncols();
    let drifting = usize::from(linear.mass_damping.is_some() && linear.free.ncols() > 0);
    let count = 2 * resisted + drifting;
    let rest = body.springs.iter().map(|spring| spring.rest_length).fold(f64::INFINITY, f64::min);
    let size = if rest.is_finite() { rest } else { 1.0 } * DISTURBANCE[usize::from(D == 3)];
    // Positions in lengths, velocities in lengths a time in which nothing much happens.
    let time = dt.max(1.0 / linear.rate);
    let direction = |column: usize, i: usize| match column % resisted.max(1) {
        _ if column >= 2 * resisted => linear.free[(i, 0)],
        mode => linear.resisted[(i, mode)],
    };
    let mut model = Model::<f64, D>::new(body, [], dt);
    let mut start = State::<f64, D>::new(body.particles.len());
    start.set_lane(0, body.particles);
    let mut out = Mat::zeros(count, count);
    for column in 0..count {
        let largest = linear.coordinates.iter().enumerate();
        let largest = largest.map(|(i, at)| (direction(column, i) * at.weight).abs()).fold(0.0, f64::max);
        let amount = size / largest;
        let mut ends = Vec::with_capacity(2);
        for sign in [1.0, -1.0] {
            let mut state = start.clone();
            for (i, at) in linear.coordinates.iter().enumerate() {
                let change = sign * amount * at.weight * direction(column, i);
                if column < resisted {
                    state.position[at.particle][at.axis] += change;
                } else {
                    state.velocity[at.particle][at.axis] += change / time;
                }
            }
            let timeline = Timeline { dt, base_step: 0, base_time: 0.0 };
            let method = body.method;
            Advance { model: &mut model, state: &mut state, method, timeline, first: 0, steps: 1 }.run();
            if model.has_refused(0) {
                return None;
            }
            ends.push(state);
        }
        for row in 0..count {
            let moved = linear.coordinates.iter().enumerate().map(|(i, at)| {
                let value = |state: &State<f64, D>| match row < resisted {
                    true => state.position[at.particle][at.axis],
                    false => state.velocity[at.particle][at.axis] * time,
                };
                direction(row, i) * (value(&ends[0]) - value(&ends[1])) / at.weight
            });
            out[(row, column)] = moved.sum::<f64>() / (2.0 * amount);
        }
    }
    Some(out)
}
