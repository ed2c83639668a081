//! Implicit (backward) Euler.
//!
//! M(v⁺ − v) = dt·F(t + dt, x⁺, v⁺) + R, x⁺ = x + dt·v⁺, with 0 ≤ R ⟂ S·v⁺ ≥ 0. Order 1; an evaluation for each round of Newton's iteration,
//! one on an axis. No step is unstable; oscillations die away: at ω·dt = 0.1 a period leaves 73 % of the amplitude. Source: D. Baraff, A. Witkin,
//! "Large steps in cloth simulation" (1998), solved to the end.

use crate::mechanics::{Model, State};

use super::{
    About, Integrator,
    implicit::{Implicit, Scheme},
};

pub(super) const ABOUT: About = About {
    name: "ImplicitEuler",
    summary: "order 1, one system of equations a step; no step is unstable, oscillations are damped",
    order: 1,
    evaluations: None,
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct ImplicitEuler<const D: usize>(Implicit<D>);

const SCHEME: Scheme = Scheme { at: 1.0, velocity: 1.0, admitted: 1.0, position_old: 0.0, position_new: 1.0 };

impl<const D: usize> Integrator<f64, D> for ImplicitEuler<D> {
    fn new(particles: usize) -> Self {
        Self(Implicit::new(particles))
    }

    fn step(&mut self, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64) {
        self.0.step(&SCHEME, model, state, time);
    }
}
