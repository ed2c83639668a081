//! `wriggle play`: a scene in a window, or the garden without one where nothing can be drawn.

use clap::Args;

use super::{CliError, Outcome, headless_garden};
use crate::scenes;

#[derive(Args, Debug)]
pub(super) struct PlayArguments {
    /// A scene or creature by name or file [default: garden]
    scene: Option<String>,
}

pub(super) fn play(arguments: &PlayArguments) -> Result<Outcome, CliError> {
    let scene = scenes::load(arguments.scene.as_deref().unwrap_or("garden"))?;
    match missing() {
        Some(missing) => headless_garden(missing),
        None => open_window(scene),
    }
}

/// What a window needs and is not there.
fn missing() -> Option<&'static str> {
    if cfg!(not(feature = "window")) {
        return Some("this build has no window (it was made without the feature `window`)");
    }
    let display = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];
    let has_display = || display.iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()));
    (cfg!(all(unix, not(target_os = "macos"))) && !has_display()).then_some("there is no display (DISPLAY is not set)")
}

#[cfg(not(feature = "window"))]
fn open_window(_: scenes::LoadedScene) -> Result<Outcome, CliError> {
    headless_garden("this build has no window")
}

#[cfg(feature = "window")]
fn open_window(scene: scenes::LoadedScene) -> Result<Outcome, CliError> {
    use bevy::prelude::*;

    use crate::{
        physics::PhysicsPlugin,
        scenes::{ScenesPlugin, WatchPlugin},
    };

    let window = Window { title: format!("{} – Wriggle", scene.file.title), ..default() };
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }));
    app.add_plugins((PhysicsPlugin::default(), ScenesPlugin::new(scene), WatchPlugin));
    match app.run() {
        AppExit::Success => Ok(Outcome::Done),
        AppExit::Error(code) => Err(CliError::Usage(format!("the window closed with error {code}"))),
    }
}
