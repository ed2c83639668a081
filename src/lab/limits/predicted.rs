//! The limit of a method's step from the matrices of the linearised body.
//!
//! For one oscillator these are the closed forms of the methods' own files. For a whole body:
//!
//! - **kicks** (semi-implicit Euler, Störmer–Verlet, damped Verlet): x⁺ − (2 − λ)x + (1 − λ)x⁻ = −h²Kx − hC(x − x⁻) is stable exactly while
//!   λ_max(h²K + 2hC) ≤ 4 − 2λ, with any K and C. Leapfrog's centred damping leaves λ_max(h²K) ≤ 4.
//!   Where rest lengths follow the pose K is not symmetric, and the formula is iterated with the matrices.
//! - **polynomials** (explicit Runge–Kutta methods): stable exactly while |R(hμ)| ≤ 1, R(z) = Σ zⁿ/n!, for all roots μ of the
//!   [quadratic eigenvalue problem](polynomial_limit) μ² + μC + K.

use faer::{Col, Mat, Scale, linalg::solvers::Solve};

use crate::mechanics::{
    BodyParts,
    integrators::Method,
    linear::{Linear, MOST, first_unstable, polynomial_limit, spectrum},
};

use super::iterated;

/// Limits are found to this part of themselves.
const PRECISION: f64 = 1e-9;
/// The same where a formula is iterated.
const ROUGH_PRECISION: f64 = 1e-3;

/// The largest stable step of the body's method, from the eigenvalues of the body in its present pose, without friction, contact and gravity and
/// with its muscles at rest. Infinite where no step is unstable; nothing where no formula is known for the method, or the
/// eigenvalues cannot be found.
pub fn predicted_limit(body: &BodyParts<'_>) -> Option<f64> {
    let linear = || Linear::of(body).filter(|linear| linear.decisive);
    match body.method {
        Method::SemiImplicitEuler | Method::StormerVerlet | Method::DampedVerlet | Method::Leapfrog => {
            kicks(&linear()?, body.method)
        }
        Method::ExplicitEuler => polynomial_limit(&linear()?, 1),
        Method::RungeKutta2 => polynomial_limit(&linear()?, 2),
        Method::RungeKutta4 => polynomial_limit(&linear()?, 4),
        Method::ImplicitMidpoint | Method::ImplicitEuler | Method::Xpbd | Method::ExactFlow => Some(f64::INFINITY),
    }
}

/// How the kicks of a method damp with steps of some length.
#[derive(Clone, Copy, Debug)]
struct Kick {
    /// Half of the damping acts on the velocity after the kick, and not all on that before.
    centred: bool,
    /// The rate of damping in proportion to mass that acts as a force.
    rate: f64,
    /// λ: the part of the velocity that is lost.
    loss: f64,
}

impl Kick {
    fn of(method: Method, linear: &Linear, h: f64) -> Self {
        let rate = linear.mass_rate(h);
        match method {
            Method::DampedVerlet => Self { centred: false, rate: 0.0, loss: -libm::expm1(-rate * h) },
            _ => Self { centred: method == Method::Leapfrog, rate, loss: 0.0 },
        }
    }
}

fn kicks(linear: &Linear, method: Method) -> Option<f64> {
    let mut failed = false;
    let precision = if linear.symmetric { PRECISION } else { ROUGH_PRECISION };
    // Stable for sure without damping by mass: the fastest rate is no less than √λ_max(K) and than λ_max(C).
    let limit = first_unstable(linear.rate, [0.25, MOST], precision, |h| {
        let kick = Kick::of(method, linear, h);
        let stable = if linear.symmetric { kick_is_stable(linear, kick, h) } else { kick_is_calm(linear, kick, h) };
        failed |= stable.is_none();
        stable == Some(true)
    });
    (!failed).then_some(limit)
}

/// λ_max(h²K + 2hC) ≤ 4 − 2λ − 2hc; with centred damping λ_max(h²K) ≤ 4.
fn kick_is_stable(linear: &Linear, kick: Kick, h: f64) -> Option<bool> {
    let count = linear.stiffness.nrows();
    let (damped, room) = if kick.centred { (0.0, 4.0) } else { (2.0, 4.0 - 2.0 * kick.loss - 2.0 * h * kick.rate) };
    let matrix =
        Mat::from_fn(count, count, |i, j| h * h * linear.stiffness[(i, j)] + damped * h * linear.damping[(i, j)]);
    let values = spectrum(&matrix)?;
    Some(values.last().is_none_or(|&value| value <= room) && room >= 0.0)
}

/// The same with any K: whether (I + ½hC)v⁺ = (I − ½hC)v − hKx (centred), or v⁺ = (I − λ − hC)v − hKx, with x⁺ = x + hv⁺, do not grow.
fn kick_is_calm(linear: &Linear, kick: Kick, h: f64) -> Option<bool> {
    let (coordinates, count, time) = (linear.coordinates.len(), linear.stiffness.nrows(), linear.time(h));
    let (before, after) = if kick.centred { (0.5, 0.5) } else { (1.0, 0.0) };
    let damped = |part: f64, own: f64| {
        Mat::from_fn(count, count, |i, j| {
            let same = if i == j { own + part * h * kick.rate } else { 0.0 };
            same + part * h * linear.damping[(i, j)]
        })
    };
    let ahead = damped(after, 1.0).partial_piv_lu();
    let (kept, pulled) = (ahead.solve(-damped(before, kick.loss - 1.0)), ahead.solve(&linear.stiffness * Scale(h)));
    iterated::is_calm(linear, h, |disturbance| {
        let (positions, velocities) = disturbance.split_at(coordinates);
        let column = |values: &[f64]| linear.resisted.transpose() * Col::from_iter(values.iter().copied());
        let velocities = &kept * column(velocities) - &pulled * column(positions) * Scale(time);
        let velocities = &linear.resisted * velocities;
        let positions = positions.iter().zip(velocities.iter()).map(|(x, v)| x + h / time * v);
        Some(positions.chain(velocities.iter().copied()).collect())
    })
}
