//! The limit of a method's step from the matrices of the linearised body.
//!
//! For one oscillator these are the closed forms of the methods' own files. For a whole body:
//!
//! - **kicks** (semi-implicit Euler, Störmer–Verlet, damped Verlet): x⁺ − (2 − λ)x + (1 − λ)x⁻ = −h²Kx − hC(x − x⁻) is stable exactly while
//!   λ_max(h²K + 2hC) ≤ 4 − 2λ, with any K and C. Leapfrog's centred damping leaves λ_max(h²K) ≤ 4.
//! - **polynomials** (explicit Runge–Kutta methods): stable exactly while |R(hμ)| ≤ 1, R(z) = Σ zⁿ/n!, for all roots μ of the
//!   quadratic eigenvalue problem μ² + μC + K.

use faer::{Mat, c64};

use crate::mechanics::{BodyParts, integrators::Method};

use super::{
    linear::{Linear, spectrum},
    search::first_unstable,
};

/// What rounding may add to a growth of 1.
const ROUNDING: f64 = 1e-11;
/// Limits are found to this part of themselves.
const PRECISION: f64 = 1e-9;
/// A root whose damping is below this part of it is not damped.
const UNDAMPED: f64 = 1e-9;

/// The largest stable step of the body's method, from the eigenvalues of the body in its present pose, without friction, contact and gravity and
/// with its muscles at rest. Infinite where no step is unstable; nothing where no formula is known for the method, or the
/// eigenvalues cannot be found.
pub fn predicted_limit(body: &BodyParts<'_>) -> Option<f64> {
    let linear = Linear::of(body)?;
    match body.method {
        Method::SemiImplicitEuler | Method::StormerVerlet => kicks(&linear, 2.0, |h| (linear.mass_rate(h), 0.0)),
        Method::DampedVerlet => kicks(&linear, 2.0, |h| (0.0, -libm::expm1(-linear.mass_rate(h) * h))),
        Method::Leapfrog => kicks(&linear, 0.0, |_| (0.0, 0.0)),
        Method::ExplicitEuler => polynomial(&linear, 1),
        Method::RungeKutta2 => polynomial(&linear, 2),
        Method::RungeKutta4 => polynomial(&linear, 4),
        _ if body.stability_limit(0.0) == f64::INFINITY => Some(f64::INFINITY),
        _ => None,
    }
}

/// λ_max(h²K + `damped`·hC) ≤ 4 − 2λ − 2hc. `by_mass` gives the rate of damping in proportion to mass that acts as a force, and the λ that acts on the velocity.
fn kicks(linear: &Linear, damped: f64, by_mass: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
    let count = linear.stiffness.nrows();
    let mut failed = false;
    // Stable for sure without damping by mass: the fastest rate is no less than √λ_max(K) and than λ_max(C).
    let from = 0.25 / linear.rate;
    let limit = first_unstable(linear.rate, from, PRECISION, |h| {
        let (rate, loss) = by_mass(h);
        let room = 4.0 - 2.0 * loss - 2.0 * h * rate;
        let matrix =
            Mat::from_fn(count, count, |i, j| h * h * linear.stiffness[(i, j)] + damped * h * linear.damping[(i, j)]);
        let values = spectrum(&matrix);
        failed |= values.is_none();
        values.is_some_and(|values| values.last().is_none_or(|&value| value <= room) && room >= 0.0)
    });
    (!failed).then_some(limit)
}

fn polynomial(linear: &Linear, order: u32) -> Option<f64> {
    let per_step = matches!(linear.mass_damping, Some(crate::body::MassDamping::PerStep(_)));
    let fixed = if per_step { None } else { Some(roots(linear, 1.0)?) };
    let undamped = |root: &c64| root.re.abs() <= UNDAMPED * root.norm();
    // Methods of order 1 and 2 let every oscillation grow that is not damped.
    if order < 3 && fixed.as_ref().is_some_and(|roots| roots.iter().any(|root| root.norm() > 0.0 && undamped(root))) {
        return Some(0.0);
    }
    let mut failed = false;
    // A coarser search could step over a small limit of weak damping.
    let limit = first_unstable(linear.rate, 1e-3 / linear.rate, PRECISION, |h| {
        let now = if fixed.is_some() { None } else { roots(linear, h) };
        let Some(roots) = fixed.as_ref().or(now.as_ref()) else {
            failed = true;
            return false;
        };
        roots.iter().all(|&root| amplification(root * h, order) <= 1.0 + ROUNDING)
    });
    (!failed).then_some(limit)
}

/// |Σ zⁿ/n!| up to `order`.
fn amplification(z: c64, order: u32) -> f64 {
    let mut sum = c64::new(1.0, 0.0);
    for n in (1..=order).rev() {
        sum = c64::new(1.0, 0.0) + z * sum * (1.0 / f64::from(n));
    }
    sum.norm()
}

/// The roots of μ² + μC + K with the damping by mass that it has at steps of `dt`, without those of what nothing moves.
fn roots(linear: &Linear, dt: f64) -> Option<Vec<c64>> {
    let (count, rate) = (linear.stiffness.nrows(), linear.mass_rate(dt));
    let mut roots = match modes(linear) {
        Some(modes) => modes.into_iter().flat_map(|(stiffness, damping)| pair(stiffness, damping + rate)).collect(),
        None => {
            let damping = |i: usize, j: usize| linear.damping[(i, j)] + if i == j { rate } else { 0.0 };
            let matrix = Mat::from_fn(2 * count, 2 * count, |i, j| match (i < count, j < count) {
                (true, true) => 0.0,
                (true, false) => f64::from(u8::from(i + count == j)),
                (false, true) => -linear.stiffness[(i - count, j)],
                (false, false) => -damping(i - count, j - count),
            });
            matrix.eigenvalues().ok()?
        }
    };
    let fastest = roots.iter().map(|root| root.norm()).fold(0.0, f64::max);
    roots.retain(|root| root.norm() > 1e-6 * fastest);
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
    let small = 1e-10 * stiffness.max(damping);
    let same = |i, j| (linear.damping[(i, j)] - ratio * linear.stiffness[(i, j)]).abs() <= small;
    let proportional = (0..count).all(|i| (0..count).all(|j| same(i, j)));
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
