//! Creatures.
use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

/// How a body wants to be drawn.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component)]
pub enum Look {
    /// Three ellipsoids with rings and a face.
    GardenWorm,
    /// Balls and rods.
    #[default]
    Plain,
}
pub mod library {
    //! Where files are (stub).
    use std::collections::BTreeMap;

    /// A kind of file.
    #[derive(Clone, Copy, Debug)]
    pub struct FileKind;

    /// Scene files.
    pub const SCENE: FileKind = FileKind;

    /// The files of a kind that have a name.
    pub fn list(_: FileKind) -> BTreeMap<String, ()> {
        ["garden", "document"].map(|name| (name.into(), ())).into()
    }
}
