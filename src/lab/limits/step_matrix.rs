//! The limit of a method's step from the step itself: the method is run on small disturbances of the body's pose, which gives the matrix of the
//! linearised step, and grows where an eigenvalue of that is beyond the unit circle.

use faer::Mat;

use crate::mechanics::{
    BodyParts,
    linear::{Linear, MOST, eigenvalues, first_unstable},
};

use super::{iterated, linearised_step::LinearisedStep};

/// The search begins at this part of the time of the fastest rate.
const FROM: f64 = 1e-3;
/// Limits are found to this part of themselves.
const PRECISION: f64 = 1e-4;
/// To this part of themselves limits are found by iteration.
const ITERATED_PRECISION: f64 = 5e-3;
/// A body of more coordinates is large.
const MANY: usize = 60;
/// Of a large body the search begins here, and ends where the conjugate gradients of implicit methods leave more than a disturbance.
const RANGE_OF_MANY: [f64; 2] = [0.25, 100.0];
/// The eigenvalues of the steps of bodies of more coordinates take longer than iterations. Those of a large body by an implicit method, whose equations are
/// solved to a tolerance, drown in what that leaves.
const MOST_COORDINATES: usize = 400;
/// What rounding and the square of a disturbance may add to a growth of 1.
const ROUNDING: f64 = 1e-8;

/// The smallest step at which a small disturbance of the body's present pose grows: without friction, contact and gravity, with its muscles at rest.
/// To a part in ten thousand by the eigenvalues of the step's matrix, or for bodies too large for that to half a percent by iteration. Infinite
/// where none grows at any step; nothing where the method cannot step the body.
pub fn linearised_limit(body: &BodyParts<'_>) -> Option<f64> {
    let linear = Linear::of(body)?;
    let count = linear.coordinates.len();
    let most = if body.method.is_implicit() { MANY } else { MOST_COORDINATES };
    // The iteration watches an energy, which nothing has where no spring is.
    let iterated = count > most && linear.is_stiff();
    let calm = |dt| match iterated {
        true if linear.dimensions == 1 => is_calm::<1>(body, &linear, dt),
        true => is_calm::<3>(body, &linear, dt),
        false => growth_of(body, &linear, dt).map(|growth| growth <= 1.0 + ROUNDING),
    };
    let range = if count > MANY && linear.is_stiff() { RANGE_OF_MANY } else { [FROM, MOST] };
    let precision = if iterated { ITERATED_PRECISION } else { PRECISION };
    let mut refused = false;
    let limit = first_unstable(linear.rate, range, precision, |dt| {
        let calm = calm(dt);
        refused |= calm.is_none();
        calm == Some(true)
    });
    (!refused).then_some(limit)
}

fn is_calm<const D: usize>(body: &BodyParts<'_>, linear: &Linear, dt: f64) -> Option<bool> {
    let mut step = LinearisedStep::<D>::new(body, linear, dt);
    iterated::is_calm(linear, dt, |disturbance| step.take(disturbance))
}

/// By how much a step of `dt` multiplies the disturbance that grows most, in the long run: the spectral radius of the linearised step. 1 where the
/// body only moves as a whole. Nothing where the method cannot step the body.
pub fn growth(body: &BodyParts<'_>, dt: f64) -> Option<f64> {
    growth_of(body, &Linear::of(body)?, dt)
}

pub(super) fn growth_of(body: &BodyParts<'_>, linear: &Linear, dt: f64) -> Option<f64> {
    let matrix = if linear.dimensions == 1 { matrix::<1>(body, linear, dt)? } else { matrix::<3>(body, linear, dt)? };
    if matrix.col_iter().any(|column| column.iter().any(|value| !value.is_finite())) {
        return Some(f64::INFINITY);
    }
    let values = eigenvalues(&matrix)?;
    Some(values.into_iter().map(|value| value.norm()).fold(0.0, f64::max))
}

/// The step as a matrix on the resisted directions' positions and velocities. What moves as a whole is left out: it drifts, which is no growth.
/// Where its mass damps it, one such velocity stands for all.
fn matrix<const D: usize>(body: &BodyParts<'_>, linear: &Linear, dt: f64) -> Option<Mat<f64>> {
    let (coordinates, resisted) = (linear.coordinates.len(), linear.resisted.ncols());
    let drifting = usize::from(linear.mass_damping.is_some() && linear.free.ncols() > 0);
    let count = 2 * resisted + drifting;
    let direction = |column: usize, i: usize| match column % resisted.max(1) {
        _ if column >= 2 * resisted => linear.free[(i, 0)],
        mode => linear.resisted[(i, mode)],
    };
    // Where a direction's part of a disturbance begins: positions come before velocities.
    let from = |column: usize| if column < resisted { 0 } else { coordinates };
    let mut step = LinearisedStep::<D>::new(body, linear, dt);
    let mut out = Mat::zeros(count, count);
    for column in 0..count {
        let mut disturbance = vec![0.0; 2 * coordinates];
        for (i, value) in disturbance[from(column)..].iter_mut().enumerate().take(coordinates) {
            *value = direction(column, i);
        }
        let after = step.take(&disturbance)?;
        for row in 0..count {
            let part = after[from(row)..].iter().take(coordinates).enumerate();
            out[(row, column)] = part.map(|(i, value)| direction(row, i) * value).sum::<f64>();
        }
    }
    Some(out)
}
