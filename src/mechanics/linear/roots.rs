//! The limit of explicit Runge–Kutta methods from the roots of the linearised body.
//!
//! Of order n ≤ 4, such a method multiplies what goes with exp(μt) by R(hμ) a step, R(z) = Σ zⁿ/n!; the μ are the roots of the quadratic eigenvalue
//! problem μ² + μC + K.

use faer::{Mat, c64};

use crate::body::MassDamping;

use super::{Linear, MOST, eigenvalues, first_unstable, spectrum};

/// What rounding may take from the decay of a root, in the fastest.
const ROUNDING: f64 = 1e-11;
/// Limits are found to this part of themselves.
const PRECISION: f64 = 1e-9;
/// A root whose damping is below this part of it is not damped.
const UNDAMPED: f64 = 1e-9;
/// One that grows by more than this part of it a unit of time does so by itself; less may be rounding.
const GROWING: f64 = 1e-6;
/// What moves at less than this part of the fastest rate is not told from what nothing moves.
const SLOWEST: f64 = 1e-6;

/// The largest step at which |R(hμ)| ≤ 1 for all roots μ but those of what grows by itself. Infinite where no step is unstable; nothing where the roots
/// cannot be found.
pub(crate) fn polynomial_limit(linear: &Linear, order: u32) -> Option<f64> {
    let per_step = matches!(linear.mass_damping, Some(MassDamping::PerStep(_)));
    let fixed = if per_step { None } else { Some(roots(linear, 1.0)?) };
    let undamped = |root: &c64| root.re.abs() <= UNDAMPED * root.norm();
    // Methods of order 1 and 2 let every oscillation grow that is not damped.
    if order < 3 && fixed.as_ref().is_some_and(|roots| roots.iter().any(|root| root.norm() > 0.0 && undamped(root))) {
        return Some(0.0);
    }
    let mut failed = false;
    // A coarser search could step over a small limit of weak damping.
    let limit = first_unstable(linear.rate, [1e-3, MOST], PRECISION, |h| {
        let now = if fixed.is_some() { None } else { roots(linear, h) };
        let Some(roots) = fixed.as_ref().or(now.as_ref()) else {
            failed = true;
            return false;
        };
        let fastest = roots.iter().map(|root| root.norm()).fold(0.0, f64::max);
        roots.iter().all(|&root| gain(root * h, order) <= ROUNDING * fastest * h)
    });
    (!failed).then_some(limit)
}

/// |R(z)|² − 1 as 2 Re w + |w|² with w = R(z) − 1, of which little is lost where z is small.
fn gain(z: c64, order: u32) -> f64 {
    let more = (1..=order).rev().fold(c64::ZERO, |sum, n| z * (sum + 1.0) / f64::from(n));
    2.0 * more.re + more.norm_sqr()
}

/// The roots of μ² + μC + K with the damping by mass that it has at steps of `dt`, without those of what nothing moves and of what grows by itself.
fn roots(linear: &Linear, dt: f64) -> Option<Vec<c64>> {
    let (count, rate) = (linear.stiffness.nrows(), linear.mass_rate(dt));
    let mut roots = match modes(linear) {
        Some(modes) => modes.into_iter().flat_map(|(stiffness, damping)| pair(stiffness, damping + rate)).collect(),
        None => {
            let damping = |i: usize, j: usize| linear.damping[(i, j)] + if i == j { rate } else { 0.0 };
            // Velocities in units in which they compare with positions.
            let matrix = Mat::from_fn(2 * count, 2 * count, |i, j| match (i < count, j < count) {
                (true, true) => 0.0,
                (true, false) if i + count == j => linear.rate,
                (true, false) => 0.0,
                (false, true) => -linear.stiffness[(i - count, j)] / linear.rate,
                (false, false) => -damping(i - count, j - count),
            });
            eigenvalues(&matrix)?
        }
    };
    let fastest = roots.iter().map(|root| root.norm()).fold(0.0, f64::max);
    roots.retain(|root| root.norm() > SLOWEST * fastest && root.re <= GROWING * root.norm());
    if linear.free.ncols() > 0 && rate > 0.0 {
        roots.push(c64::new(-rate, 0.0));
    }
    Some(roots)
}

/// κ and γ of every mode, where the modes are damped one by one: C is a multiple of K.
fn modes(linear: &Linear) -> Option<Vec<(f64, f64)>> {
    let count = linear.stiffness.nrows();
    let trace = |matrix: &Mat<f64>| (0..count).map(|i| matrix[(i, i)]).sum::<f64>();
    let (stiffness, damping) = (trace(&linear.stiffness), trace(&linear.damping));
    if stiffness <= 0.0 {
        return None;
    }
    let ratio = damping / stiffness;
    let small = 1e-10 * damping;
    let same = |i, j| (linear.damping[(i, j)] - ratio * linear.stiffness[(i, j)]).abs() <= small;
    let proportional = linear.symmetric && (0..count).all(|i| (0..count).all(|j| same(i, j)));
    let values = if proportional { spectrum(&linear.stiffness)? } else { return None };
    Some(values.into_iter().map(|stiffness| (stiffness, ratio * stiffness)).collect())
}

/// The roots of μ² + γμ + κ.
fn pair(stiffness: f64, damping: f64) -> [c64; 2] {
    let (half, square) = (0.5 * damping, 0.25 * damping * damping - stiffness);
    let root = square.abs().sqrt();
    if square < 0.0 {
        return [c64::new(-half, root), c64::new(-half, -root)];
    }
    // The slow root as κ over the fast one: their difference would cancel.
    let fast = half + root;
    [c64::new(-fast, 0.0), c64::new(if fast > 0.0 { -stiffness / fast } else { 0.0 }, 0.0)]
}
