//! Explicit (forward) Euler.
//!
//! x⁺ = x + dt·v, v⁺ = v + dt·F(t, x, v)/m. Order 1; one evaluation a step. An oscillation of frequency ω and damping ratio ζ is stable up
//! to ω·dt = 2ζ (ζ ≤ 1), 2(ζ − √(ζ² − 1)) above: **never without damping**, where each step multiplies the energy by 1 + (ω·dt)². Here for
//! that failure. Source: L. Euler, Institutionum calculi integralis I (1768), ch. 7.

use crate::mechanics::{Model, Real, State, stability::StabilityBound};

use super::{
    About, Integrator,
    stages::{Stage, Stages},
};

pub(super) const ABOUT: About = About {
    name: "ExplicitEuler",
    summary: "order 1, one force evaluation a step; gains energy, here for its failure",
    order: 1,
    evaluations: Some(1),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct ExplicitEuler<R, const D: usize>(Stages<R, D>);

const STAGES: [Stage; 1] = [Stage { at: 0.0, weight: 1.0 }];

impl<R: Real, const D: usize> Integrator<R, D> for ExplicitEuler<R, D> {
    fn new(particles: usize) -> Self {
        Self(Stages::new(particles))
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        self.0.step(&STAGES, model, state, time);
    }
}

/// See the head of this file.
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    bound.least(|stiffness, damping| match damping * damping < 4.0 * stiffness {
        true => damping / stiffness,
        false => 2.0 / fastest_decay(stiffness, damping),
    })
}

/// The faster of the two rates of an overdamped oscillation, μ² − γμ + κ = 0.
pub(super) fn fastest_decay(stiffness: f64, damping: f64) -> f64 {
    0.5 * damping + (0.25 * damping * damping - stiffness).max(0.0).sqrt()
}
