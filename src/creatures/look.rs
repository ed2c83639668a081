//! How a body wants to be drawn.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::SixSkin;

/// How a body wants to be drawn. The physics does not read it.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component)]
pub enum Look {
    /// Three ellipsoids with rings and a face.
    GardenWorm,
    /// A smooth skin over the sections of a [`Strand`](crate::body::Strand).
    Strand(Skin),
    /// A smooth translucent skin over the outer masses of a [`Lattice`](crate::body::Lattice).
    Jelly,
    /// A creature of the six-matrix particle system.
    SixMatrix(SixSkin),
    /// Balls and rods.
    #[default]
    Plain,
}

/// The skin of a strand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
pub enum Skin {
    /// Rings and wrinkles.
    #[default]
    Worm,
    /// Scales with dark saddles.
    Snake,
    /// Scales in the colours of sand.
    Sidewinder,
    /// Thick segments, banded, with bristles.
    Caterpillar,
}
