//! Damped Verlet, as drift, kick, drift.
//!
//! x½ = x + dt/2·v, v⁺ = (1 − λ)v + dt·F/m, x⁺ = x½ + dt/2·v⁺, where F leaves the damping in proportion to mass to λ = 1 − e^(−c·dt). The
//! middles obey the project's equation (1.4), x(t+dt) = (2 − λ)x(t) − (1 − λ)x(t−dt) + a(t)·dt². Given as a rate, λ does not change the physics
//! when dt changes; the document's fixed λ does. One evaluation a step; order 2 without damping, else 1. Stable up to
//! ω·dt = √(4 − 2λ), with spring damping 2(√(1+ζ²−λ/2) − ζ). Source: "Mass-Spring-Damper model", (1.4).

use crate::mechanics::{
    Model, Real, State,
    lattice::KickDrift,
    stability::{Rates, StabilityBound},
};

use super::{About, Integrator};

pub(super) const ABOUT: About = About {
    name: "DampedVerlet",
    summary: "order 2 (1 with damping), one force evaluation a step; takes damping by mass as the document's λ",
    order: 2,
    evaluations: Some(1),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct DampedVerlet<R, const D: usize> {
    /// Positions in the middle of the step.
    middle: Vec<[R; D]>,
    acceleration: Vec<[R; D]>,
}

impl<R: Real, const D: usize> Integrator<R, D> for DampedVerlet<R, D> {
    fn new(particles: usize) -> Self {
        let zeros = vec![[R::splat(0.0); D]; particles];
        Self { middle: zeros.clone(), acceleration: zeros }
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let (dt, half) = (R::splat(model.dt), R::splat(0.5 * model.dt));
        for ((middle, x), v) in self.middle.iter_mut().zip(&state.position).zip(&state.velocity) {
            for axis in 0..D {
                middle[axis] = x[axis] + v[axis] * half;
            }
        }
        model.forces(time + 0.5 * model.dt, &self.middle, &state.velocity, &mut self.acceleration);
        model.admit_acceleration(&self.middle, &state.velocity, &mut self.acceleration);
        let kept = R::splat(1.0) - model.damping.map_or(R::splat(0.0), |damping| damping.loss);
        for (v, a) in state.velocity.iter_mut().zip(&self.acceleration) {
            for axis in 0..D {
                v[axis] = v[axis] * kept + a[axis] * dt;
            }
        }
        model.finish_velocity(&self.middle, &mut state.velocity);
        for ((x, middle), v) in state.position.iter_mut().zip(&self.middle).zip(&state.velocity) {
            for axis in 0..D {
                x[axis] = middle[axis] + v[axis] * half;
            }
        }
        model.apply_contact(state);
    }
}

/// The step as a drift, a kick and a drift.
pub(super) fn kick_drift<R: Real, const D: usize>(model: &Model<R, D>) -> KickDrift {
    let kept = 1.0 - model.damping.map_or(0.0, |damping| damping.loss.lane(0));
    KickDrift { dt: model.dt, before: 0.5 * model.dt, after: 0.5 * model.dt, rate: 0.0, kept }
}

/// See the head of this file. A λ that comes from a rate is the smaller the smaller the step: that of a step as large as without it is safe.
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    let limit = |loss: f64| {
        let row = |&Rates { stiffness, damping }: &Rates| {
            let damping = damping + bound.friction;
            // h²κ + 2hγ ≤ 4 − 2λ
            (4.0 - 2.0 * loss) / (damping + (damping * damping + (4.0 - 2.0 * loss) * stiffness).sqrt())
        };
        bound.rates.iter().map(row).fold(f64::INFINITY, f64::min)
    };
    match bound.loss_per_step {
        Some(loss) => limit(loss),
        None => limit(-libm::expm1(-bound.mass_damping * limit(0.0).min(f64::MAX))),
    }
}
