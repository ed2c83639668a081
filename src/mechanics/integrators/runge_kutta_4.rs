//! The classic fourth-order Runge–Kutta method, with the friction rule inside its stages.
//!
//! Order 4 while no mass sticks or slips; about 2, and erratic, across such events, because they are not located. Four evaluations a step.
//! Stable while |R(λ·dt)| ≤ 1 with R(z) = 1 + z + z²/2 + z³/6 + z⁴/24: without damping up to ω·dt = 2√2. Source: W. Kutta, Z. Math. Phys. 46
//! (1901) 435.

use crate::mechanics::{Model, Real, State, stability::StabilityBound};

use super::{
    About, Integrator,
    explicit_euler::fastest_decay,
    located::Staged,
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

impl<R, const D: usize> Staged for RungeKutta4<R, D> {
    const STAGES: &'static [Stage] = &[
        Stage { at: 0.0, weight: 1.0 / 6.0 },
        Stage { at: 0.5, weight: 1.0 / 3.0 },
        Stage { at: 0.5, weight: 1.0 / 3.0 },
        Stage { at: 1.0, weight: 1.0 / 6.0 },
    ];
}

impl<R: Real, const D: usize> Integrator<R, D> for RungeKutta4<R, D> {
    fn new(particles: usize) -> Self {
        Self(Stages::new(particles))
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        self.0.step(Self::STAGES, model, state, time);
    }
}

/// The smallest |z| in the left half-plane at which |1 + z + z²/2 + z³/6 + z⁴/24| = 1 (at a damping ratio near ½), rounded down.
const STABLE_RADIUS: f64 = 2.615;
/// The same on the real axis.
const STABLE_DECAY: f64 = 2.785;

/// A mode e^(μt) is stable while μ·dt is within the method's region of stability: surely while |μ|·dt is within its [`STABLE_RADIUS`], and where μ is
/// real, within its [`STABLE_DECAY`].
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    let stiffness = bound.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max);
    let damping = bound.rates.iter().map(|rates| rates.damping).fold(0.0, f64::max);
    // What oscillates has γ < 2√κ and γ ≥ βκ with the least β, so that √κ < 2/β.
    let oscillation = stiffness.sqrt().min(2.0 / bound.least_ratio);
    // What decays has at least the stiffness that comes with such damping: the faster of its two rates is the larger the less it has of that.
    let least = if damping > 0.0 { damping / bound.most_ratio } else { 0.0 };
    let decay = fastest_decay(least, damping + bound.friction + bound.mass_damping);
    // Over zero, a limit is infinite: none.
    (STABLE_RADIUS / oscillation).min(STABLE_DECAY / decay)
}
