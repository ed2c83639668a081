//! How a body wants to be drawn.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

/// How a body wants to be drawn. The physics does not read it.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component)]
pub enum Look {
    /// Three ellipsoids with rings and a face.
    GardenWorm,
    /// Balls and rods.
    #[default]
    Plain,
}
