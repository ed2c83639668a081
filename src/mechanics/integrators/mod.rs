//! Methods of integration, one file each and all of one shape: a struct with its scratch, and [`Integrator::step`].

mod runge_kutta_4;
mod semi_implicit_euler;

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{Model, Real, State, stability::StabilityBound};

pub use runge_kutta_4::RungeKutta4;
pub use semi_implicit_euler::SemiImplicitEuler;

/// A method of integration at work on bodies with `D` coordinates a particle: it holds the scratch that a step needs.
pub trait Integrator<R: Real, const D: usize> {
    /// Scratch for bodies of as many particles.
    fn new(particles: usize) -> Self;

    /// Takes one step of the model's dt from `time`: forces, friction, positions and contact.
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64);
}

/// Which method steps a body.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
#[reflect(Component)]
pub enum Method {
    /// [`SemiImplicitEuler`]: the documents' own.
    #[default]
    SemiImplicitEuler,
    /// [`RungeKutta4`], with the friction rule inside its stages.
    RungeKutta4,
}

impl Method {
    /// Every method.
    pub const ALL: [Self; 2] = [Self::SemiImplicitEuler, Self::RungeKutta4];

    /// Its name, as files and command lines write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "SemiImplicitEuler",
            Self::RungeKutta4 => "RungeKutta4",
        }
    }

    /// What it is, in one line.
    pub fn summary(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "order 1, one force evaluation a step; friction acts at the end of the step",
            Self::RungeKutta4 => "order 4, four force evaluations a step; friction acts inside the stages",
        }
    }

    /// How many times a step evaluates the forces.
    pub fn evaluations(self) -> u64 {
        match self {
            Self::SemiImplicitEuler => 1,
            Self::RungeKutta4 => 4,
        }
    }

    /// The largest dt that is stable for every body within `bound`.
    pub fn stability_limit(self, bound: &StabilityBound) -> f64 {
        match self {
            Self::SemiImplicitEuler => semi_implicit_euler::stability_limit(bound),
            Self::RungeKutta4 => runge_kutta_4::stability_limit(bound),
        }
    }
}
