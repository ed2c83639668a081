//! The second-order Runge–Kutta method with its second stage in the middle (the explicit midpoint rule).
//!
//! k₁ = f(t, y), k₂ = f(t + dt/2, y + dt/2·k₁), y⁺ = y + dt·k₂. Order 2; two evaluations a step. With θ = ω·dt it is stable where
//! θ³/4 − ζθ² + 2ζ²θ − 2ζ ≤ 0, never without damping; beyond ζ = 1 as explicit Euler. Source: C. Runge, Math. Ann. 46 (1895) 167.

use crate::mechanics::{Model, Real, State, stability::StabilityBound};

use super::{
    About, Integrator,
    explicit_euler::fastest_decay,
    located::Staged,
    stages::{Stage, Stages},
};

pub(super) const ABOUT: About = About {
    name: "RungeKutta2",
    summary: "order 2, two force evaluations a step; friction acts inside the stages",
    order: 2,
    evaluations: Some(2),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct RungeKutta2<R, const D: usize>(Stages<R, D>);

impl<R, const D: usize> Staged for RungeKutta2<R, D> {
    const STAGES: &'static [Stage] = &[Stage { at: 0.0, weight: 0.0 }, Stage { at: 0.5, weight: 1.0 }];
}

impl<R: Real, const D: usize> Integrator<R, D> for RungeKutta2<R, D> {
    fn new(particles: usize) -> Self {
        Self(Stages::new(particles))
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        self.0.step(Self::STAGES, model, state, time);
    }
}

/// See the head of this file.
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    bound.least(|stiffness, damping| {
        let frequency = stiffness.sqrt();
        let ratio = 0.5 * damping / frequency;
        if ratio >= 1.0 {
            return 2.0 / fastest_decay(stiffness, damping);
        }
        // Bisection from θ = 0, where the left side is −2ζ, to 3, where it is positive for every ζ < 1.
        let unstable = |theta: f64| {
            theta * theta * theta / 4.0 - ratio * theta * theta + 2.0 * ratio * ratio * theta - 2.0 * ratio > 0.0
        };
        let (mut low, mut high) = (0.0, 3.0);
        while high - low > 1e-12 {
            let middle = 0.5 * (low + high);
            if unstable(middle) { high = middle } else { low = middle }
        }
        low / frequency
    })
}
