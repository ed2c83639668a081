//! Bevy's plugins for the app with a window.

use bevy::{
    app::PluginGroupBuilder,
    prelude::*,
    window::{PresentMode, WindowResolution},
};

/// All assets are made in code or embedded, so there is no folder to watch, and none to warn of where it is missing.
pub(super) fn quiet_assets() -> AssetPlugin {
    AssetPlugin { watch_for_changes_override: Some(false), ..default() }
}

/// Bevy's default plugins with Wriggle's window: 1280 × 720, synchronised with the screen.
pub fn window_plugins() -> PluginGroupBuilder {
    let window = Window {
        title: "Wriggle".into(),
        name: Some("wriggle".into()),
        resolution: WindowResolution::new(1280, 720),
        present_mode: PresentMode::AutoVsync,
        ..default()
    };
    DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }).set(quiet_assets())
}
