//! Methods of integration, one file each and all of one shape: what is to be known about it, a struct with its scratch,
//! [`Integrator::step`], and its stability limit.

mod damped_verlet;
mod exact_flow;
mod explicit_euler;
mod implicit;
mod implicit_euler;
mod implicit_midpoint;
mod lane_by_lane;
mod leapfrog;
mod located;
mod runge_kutta_2;
mod runge_kutta_4;
mod semi_implicit_euler;
mod stages;
mod stormer_verlet;
mod xpbd;

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{Model, Real, State, lattice::KickDrift, stability::StabilityBound};

pub use damped_verlet::DampedVerlet;
pub use exact_flow::ExactFlow;
pub use explicit_euler::ExplicitEuler;
pub use implicit_euler::ImplicitEuler;
pub use implicit_midpoint::ImplicitMidpoint;
pub use lane_by_lane::LaneByLane;
pub use leapfrog::Leapfrog;
pub use located::{Located, Staged};
pub use runge_kutta_2::RungeKutta2;
pub use runge_kutta_4::RungeKutta4;
pub use semi_implicit_euler::SemiImplicitEuler;
pub use stormer_verlet::StormerVerlet;
pub use xpbd::Xpbd;

/// A method of integration at work on bodies with `D` coordinates a particle: it holds the scratch that a step needs.
pub trait Integrator<R: Real, const D: usize> {
    /// Scratch for bodies of as many particles.
    fn new(particles: usize) -> Self;

    /// Takes one step of the model's dt from `time`: forces, friction, positions and contact.
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64);
}

/// Which method steps a body.
#[derive(
    Clone, Component, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect, Serialize, Deserialize,
)]
#[reflect(Component)]
#[require(StickRule)]
pub enum Method {
    /// [`ExplicitEuler`]: for its failure.
    ExplicitEuler,
    /// [`SemiImplicitEuler`]: the documents' own.
    #[default]
    SemiImplicitEuler,
    /// [`StormerVerlet`].
    StormerVerlet,
    /// [`DampedVerlet`].
    DampedVerlet,
    /// [`Leapfrog`], with damping in the middle of the step.
    Leapfrog,
    /// [`RungeKutta2`], with the friction rule inside its stages.
    RungeKutta2,
    /// [`RungeKutta4`], with the friction rule inside its stages.
    RungeKutta4,
    /// [`ImplicitMidpoint`].
    ImplicitMidpoint,
    /// [`ImplicitEuler`].
    ImplicitEuler,
    /// [`Xpbd`].
    Xpbd,
    /// [`ExactFlow`], for bodies on an axis.
    ExactFlow,
}

/// When friction acts within a step. Methods in stages ask in every stage unless told otherwise; semi-implicit Euler and XPBD let it act at the end
/// of the step in any case, and the exact flow where it does act.
#[derive(
    Clone, Component, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect, Serialize, Deserialize,
)]
#[reflect(Component)]
pub enum StickRule {
    /// Each stage admits only velocities and accelerations that friction admits.
    #[default]
    InStages,
    /// Stages know no friction; velocities are projected once at the end of the step, as the documents do it. Every method is of order 1 then.
    EndOfStep,
    /// RK2 and RK4 stop their steps where a mass comes to rest or starts to slip, and keep their order ([`Located`]); other methods, and
    /// all on a body with Coulomb friction, as in stages.
    Located,
}

impl StickRule {
    /// Every rule, in the order in which they are shown.
    pub const ALL: [Self; 3] = [Self::InStages, Self::EndOfStep, Self::Located];

    /// When friction acts, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::InStages => "in stages",
            Self::EndOfStep => "at end",
            Self::Located => "located",
        }
    }

    /// Whether stages admit only what friction admits.
    pub(super) fn asks_in_stages(self) -> bool {
        self != Self::EndOfStep
    }
}

/// What is to be known about a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// Its name, as files and command lines write it.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// Its order on smooth problems.
    pub order: u32,
    /// How many times a step evaluates the forces; `None` where that depends on the step.
    pub evaluations: Option<u64>,
}

impl Method {
    /// Every method.
    pub const ALL: [Self; 11] = [
        Self::ExplicitEuler,
        Self::SemiImplicitEuler,
        Self::StormerVerlet,
        Self::DampedVerlet,
        Self::Leapfrog,
        Self::RungeKutta2,
        Self::RungeKutta4,
        Self::ImplicitMidpoint,
        Self::ImplicitEuler,
        Self::Xpbd,
        Self::ExactFlow,
    ];

    /// What is to be known about it.
    pub fn about(self) -> About {
        match self {
            Self::ExplicitEuler => explicit_euler::ABOUT,
            Self::SemiImplicitEuler => semi_implicit_euler::ABOUT,
            Self::StormerVerlet => stormer_verlet::ABOUT,
            Self::DampedVerlet => damped_verlet::ABOUT,
            Self::RungeKutta2 => runge_kutta_2::ABOUT,
            Self::RungeKutta4 => runge_kutta_4::ABOUT,
            Self::Leapfrog => leapfrog::ABOUT,
            Self::ImplicitMidpoint => implicit_midpoint::ABOUT,
            Self::ImplicitEuler => implicit_euler::ABOUT,
            Self::Xpbd => xpbd::ABOUT,
            Self::ExactFlow => exact_flow::ABOUT,
        }
    }

    /// Its name, as files and command lines write it.
    pub fn name(self) -> &'static str {
        self.about().name
    }

    /// Whether bodies of equal topology gain from being stepped side by side: whether every body takes the same operations.
    pub fn side_by_side(self) -> bool {
        !matches!(self, Self::Leapfrog | Self::ImplicitMidpoint | Self::ImplicitEuler | Self::ExactFlow)
    }

    /// Whether its steps ask a body only for its forces, and not for its springs one by one.
    pub fn asks_forces_alone(self) -> bool {
        self.side_by_side() && self != Self::Xpbd
    }

    /// How it moves masses that nothing but forces acts on, if it is a method of kicks and drifts.
    pub(super) fn kick_drift<R: Real, const D: usize>(self, model: &Model<R, D>) -> Option<KickDrift> {
        match self {
            Self::SemiImplicitEuler => Some(semi_implicit_euler::kick_drift(model)),
            Self::StormerVerlet => Some(stormer_verlet::kick_drift(model)),
            Self::DampedVerlet => Some(damped_verlet::kick_drift(model)),
            _ => None,
        }
    }

    /// Whether it solves for where a step ends, so that no stiffness bounds the step and none makes it dearer.
    pub fn is_implicit(self) -> bool {
        matches!(self, Self::ImplicitMidpoint | Self::ImplicitEuler | Self::Xpbd)
    }

    /// Whether it can stop its steps where masses stick and slip.
    pub fn locates(self) -> bool {
        matches!(self, Self::RungeKutta2 | Self::RungeKutta4)
    }

    /// The largest dt that is stable for every body within `bound`; infinite for methods that no step makes unstable.
    pub fn stability_limit(self, bound: &StabilityBound) -> f64 {
        match bound.loss_per_step {
            // Its own formula knows what a step takes.
            Some(loss) if self != Self::DampedVerlet => self.limit_with_loss(bound, loss),
            _ => self.limit_with_rates(bound),
        }
    }

    /// The same where each step takes a part of the velocity: the rate of that, −ln(1 − λ)/dt, is another at every dt.
    fn limit_with_loss(self, bound: &StabilityBound, loss: f64) -> f64 {
        /// No method is stable with more of ω·dt than this where little damping is.
        const MOST: f64 = 4.0;
        let stiffness = bound.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max);
        let is_stable = |dt: f64| {
            let mass_damping = -libm::log1p(-loss) / dt;
            dt <= self.limit_with_rates(&StabilityBound { mass_damping, loss_per_step: None, ..bound.clone() })
        };
        if stiffness == 0.0 || self.limit_with_rates(bound) == f64::INFINITY {
            return self.limit_with_rates(bound);
        }
        let (mut stable, mut unstable) = (0.0, MOST / stiffness.sqrt());
        // As many halvings as a number has bits.
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (stable + unstable);
            if is_stable(middle) { stable = middle } else { unstable = middle }
        }
        stable
    }

    fn limit_with_rates(self, bound: &StabilityBound) -> f64 {
        match self {
            Self::ExplicitEuler => explicit_euler::stability_limit(bound),
            Self::SemiImplicitEuler => semi_implicit_euler::stability_limit(bound),
            Self::StormerVerlet => stormer_verlet::stability_limit(bound),
            Self::DampedVerlet => damped_verlet::stability_limit(bound),
            Self::RungeKutta2 => runge_kutta_2::stability_limit(bound),
            Self::RungeKutta4 => runge_kutta_4::stability_limit(bound),
            Self::Leapfrog => leapfrog::stability_limit(bound),
            Self::ImplicitMidpoint | Self::ImplicitEuler | Self::Xpbd | Self::ExactFlow => f64::INFINITY,
        }
    }
}
