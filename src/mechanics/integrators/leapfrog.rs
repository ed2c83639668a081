//! Leapfrog with centred damping, as drift, kick, drift.
//!
//! x½ = x + dt/2·v, M(v⁺ − v) = dt·F(t + dt/2, x½, (v + v⁺)/2) + R, x⁺ = x½ + dt/2·v⁺, with 0 ≤ R ⟂ S·v⁺ ≥ 0. Damping is linear in v⁺: one
//! evaluation and one linear system a step. Order 2, with damping as without; stable up to ω·dt = 2 whatever the damping. Source: J. C. Simo, N.
//! Tarnow (1992) for the centred form; D. Potter, "Computational physics" (1973), ch. 2.

use crate::mechanics::{Model, State, stability::StabilityBound};

use super::{
    About, Integrator,
    implicit::{Implicit, Scheme},
};

pub(super) const ABOUT: About = About {
    name: "Leapfrog",
    summary: "order 2, one force evaluation and a linear system a step; damping does not narrow its stability",
    order: 2,
    // One, and a linear system that costs more than it.
    evaluations: None,
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct Leapfrog<const D: usize>(Implicit<D>);

const SCHEME: Scheme = Scheme { at: 0.5, velocity: 0.5, admitted: 1.0, position_old: 0.5, position_new: 0.0 };

impl<const D: usize> Integrator<f64, D> for Leapfrog<D> {
    fn new(particles: usize) -> Self {
        Self(Implicit::new(particles))
    }

    fn step(&mut self, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64) {
        self.0.step(&SCHEME, model, state, time);
    }
}

/// ω·dt = 2 of the stiffest mode.
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    let stiffness = bound.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max);
    if stiffness > 0.0 { 2.0 / stiffness.sqrt() } else { f64::INFINITY }
}
