//! Semi-implicit (symplectic) Euler.
//!
//! v⁺ = friction(v + dt·F(t, x, v)/m), x⁺ = x + dt·v⁺. Order 1; one evaluation a step. Without damping its energy stays within
//! bounds up to ω·dt = 2; with damping it is stable up to 2(√(1+ζ²) − ζ). "A 3 mass-2 spring system" (A. Ravi) and Miller's animals are stepped so.

use crate::mechanics::{
    Model, Real, State,
    lattice::KickDrift,
    stability::{Rates, StabilityBound},
};

use super::{About, Integrator};

pub(super) const ABOUT: About = About {
    name: "SemiImplicitEuler",
    summary: "order 1, one force evaluation a step; friction acts at the end of the step",
    order: 1,
    evaluations: Some(1),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct SemiImplicitEuler<R, const D: usize> {
    acceleration: Vec<[R; D]>,
}

impl<R: Real, const D: usize> Integrator<R, D> for SemiImplicitEuler<R, D> {
    fn new(particles: usize) -> Self {
        Self { acceleration: vec![[R::splat(0.0); D]; particles] }
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let dt = R::splat(model.dt);
        model.acceleration(time, &state.position, &state.velocity, &mut self.acceleration);
        for (v, a) in state.velocity.iter_mut().zip(&self.acceleration) {
            for axis in 0..D {
                v[axis] += a[axis] * dt;
            }
        }
        model.apply_friction(&state.position, &mut state.velocity);
        for (x, v) in state.position.iter_mut().zip(&state.velocity) {
            for axis in 0..D {
                x[axis] += v[axis] * dt;
            }
        }
        model.apply_contact(state);
    }
}

/// The step as a kick and a drift.
pub(super) fn kick_drift<R: Real, const D: usize>(model: &Model<R, D>) -> KickDrift {
    let rate = model.damping.map_or(0.0, |damping| damping.rate.lane(0));
    KickDrift { dt: model.dt, before: 0.0, after: model.dt, rate, kept: 1.0 }
}

/// The step is stable exactly while λ_max(M⁻¹(h²K + 2hC)) ≤ 4. Each pair of rates bounds a row of that by h²κ + 2hγ ≤ 4, which gives
/// h ≤ 4/(γ + √(γ² + 4κ)).
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    limit_with(bound, bound.mass_damping)
}

/// The same with so much more damping γ of every mode.
pub(super) fn limit_with(bound: &StabilityBound, more: f64) -> f64 {
    bound
        .rates
        .iter()
        .map(|&Rates { stiffness, damping }| {
            let damping = damping + more;
            4.0 / (damping + (damping * damping + 4.0 * stiffness).sqrt())
        })
        .fold(f64::INFINITY, f64::min)
}
