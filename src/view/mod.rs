//! View.
use bevy::prelude::*;

/// Whether the pointer is on the panel: what it does there is not meant for the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub struct PointerOnPanel(pub bool);
