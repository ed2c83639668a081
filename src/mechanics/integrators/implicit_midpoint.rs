//! The implicit midpoint rule.
//!
//! M(v⁺ − v) = dt·F(t + dt/2, (x + x⁺)/2, (v + v⁺)/2) + R, x⁺ = x + dt·(v + v⁺)/2, with 0 ≤ R ⟂ S·(v + v⁺) ≥ 0, so that R does no work; then the
//! ratchet takes from v⁺ what slides back. Order 2; an
//! evaluation for each round of Newton's iteration, one on an axis. Linear springs are stable at any step and keep all of their
//! amplitude, at the frequency (2/dt)·atan(ω·dt/2). Source: E. Hairer, C. Lubich, G. Wanner, "Geometric numerical integration", II.1.

use crate::mechanics::{Model, State};

use super::{
    About, Integrator,
    implicit::{Implicit, Scheme},
};

pub(super) const ABOUT: About = About {
    name: "ImplicitMidpoint",
    summary: "order 2, one system of equations a step; no step is unstable for linear springs",
    order: 2,
    evaluations: None,
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct ImplicitMidpoint<const D: usize>(Implicit<D>);

const SCHEME: Scheme = Scheme { at: 0.5, velocity: 0.5, admitted: 0.5, position_old: 0.25, position_new: 0.25 };

impl<const D: usize> Integrator<f64, D> for ImplicitMidpoint<D> {
    fn new(particles: usize) -> Self {
        Self(Implicit::new(particles))
    }

    fn step(&mut self, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64) {
        self.0.step(&SCHEME, model, state, time);
    }
}
