//! Integrators.
use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

/// A method of integration.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
#[reflect(Component)]
pub enum Method {
    /// Semi-implicit (symplectic) Euler: velocity first, then position with the new velocity.
    #[default]
    SemiImplicitEuler,
    /// The classic fourth-order Runge–Kutta method, with the friction rule inside its stages.
    RungeKutta4,
}

impl Method {
    /// Every method.
    pub const ALL: [Self; 2] = [Self::SemiImplicitEuler, Self::RungeKutta4];

    /// Its name, as files and `--method` write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "SemiImplicitEuler",
            Self::RungeKutta4 => "RungeKutta4",
        }
    }
}
