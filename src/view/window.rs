//! Bevy's plugins for the app with a window.

use bevy::{
    app::PluginGroupBuilder,
    prelude::*,
    window::{PresentMode, WindowResolution},
};

/// Bevy's default plugins with Wriggle's window: 1280 × 720, synchronised with the screen.
pub fn window_plugins() -> PluginGroupBuilder {
    let window = Window {
        title: "Wriggle".into(),
        name: Some("wriggle".into()),
        resolution: WindowResolution::new(1280, 720),
        present_mode: PresentMode::AutoVsync,
        ..default()
    };
    DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() })
}
