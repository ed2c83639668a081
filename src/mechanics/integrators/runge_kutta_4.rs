//! The classic fourth-order Runge–Kutta method, with the friction rule inside its stages.
//!
//! Order 4 while no mass sticks or slips; about 2, and erratic, across such events, because they are not located. Four evaluations a step.
//! Stable while |R(λ·dt)| ≤ 1 with R(z) = 1 + z + z²/2 + z³/6 + z⁴/24: without damping up to ω·dt = 2√2. Source: W. Kutta, Z. Math. Phys. 46
//! (1901) 435.

use crate::mechanics::{
    Model, Real, State,
    stability::{Damping, StabilityBound},
};

use super::{
    About, Integrator,
    stages::{Stage, Stages},
};

pub(super) const ABOUT: About = About {
    name: "RungeKutta4",
    summary: "order 4, four force evaluations a step; friction acts inside the stages",
    order: 4,
    evaluations: Some(4),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct RungeKutta4<R, const D: usize>(Stages<R, D>);

const STAGES: [Stage; 4] = [
    Stage { at: 0.0, weight: 1.0 / 6.0 },
    Stage { at: 0.5, weight: 1.0 / 3.0 },
    Stage { at: 0.5, weight: 1.0 / 3.0 },
    Stage { at: 1.0, weight: 1.0 / 6.0 },
];

impl<R: Real, const D: usize> Integrator<R, D> for RungeKutta4<R, D> {
    fn new(particles: usize) -> Self {
        Self(Stages::new(particles))
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        self.0.step(&STAGES, model, state, time);
    }
}

/// The smallest |z| in the left half-plane at which |1 + z + z²/2 + z³/6 + z⁴/24| = 1 (at a damping ratio near ½), rounded down.
const STABLE_RADIUS: f64 = 2.615;

/// A mode e^(μt) is stable while |μ|·dt is within the method's region of stability, and thus surely within its [`STABLE_RADIUS`].
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    let stiffness = bound.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max);
    let damping = bound.rates.iter().map(|rates| rates.damping).fold(0.0, f64::max);
    let frequency = stiffness.sqrt();
    let fastest = match bound.damping {
        // Every mode has γ = βκ, and |μ| grows with κ: the stiffest mode is the fastest.
        Damping::Proportional if bound.friction == 0.0 && bound.mass_damping == 0.0 => {
            let overdamped = 0.25 * damping * damping - stiffness;
            if overdamped > 0.0 { 0.5 * damping + overdamped.sqrt() } else { frequency }
        }
        // Over all modes within the bounds: √κ if it oscillates, at most γ if not.
        _ => frequency.max(damping + bound.friction + bound.mass_damping),
    };
    if fastest > 0.0 { STABLE_RADIUS / fastest } else { f64::INFINITY }
}
