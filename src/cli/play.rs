//! `wriggle play`: a scene in a window, or a run of it in the terminal where nothing can be drawn.

use clap::Args;

use super::{
    CliError, Outcome, headless_garden,
    run::{RunArguments, run},
};
use crate::scenes;
#[cfg(feature = "window")]
use crate::{
    panel::PanelPlugin,
    physics::PhysicsPlugin,
    scenes::{RescuePlugin, ScenesPlugin, WatchPlugin},
    view::{self, ViewPlugin},
};

#[derive(Args, Debug)]
pub(super) struct PlayArguments {
    /// A scene or creature by name or file [default: garden]
    scene: Option<String>,
}

pub(super) fn play(arguments: &PlayArguments) -> Result<Outcome, CliError> {
    let name = arguments.scene.as_deref().unwrap_or("garden");
    let scene = scenes::load(name)?;
    match missing() {
        Some(missing) if name == "garden" => headless_garden(&missing),
        Some(missing) => {
            eprintln!("{missing}; running {name} without a picture (`wriggle run --help` has more)");
            run(&RunArguments::of(name))
        }
        None => open_window(scene),
    }
}

/// What a window needs and is not there.
#[cfg(feature = "window")]
fn missing() -> Option<String> {
    if let Err(missing) = view::display() {
        return Some(missing.to_string());
    }
    view::adapter().err().map(|missing| missing.to_string())
}

#[cfg(not(feature = "window"))]
fn missing() -> Option<String> {
    Some("this build has no window (it was made without the feature `window`)".into())
}

#[cfg(not(feature = "window"))]
fn open_window(_: scenes::LoadedScene) -> Result<Outcome, CliError> {
    Err(CliError::Usage("this build has no window".into()))
}

#[cfg(feature = "window")]
fn open_window(scene: scenes::LoadedScene) -> Result<Outcome, CliError> {
    use bevy::prelude::*;

    let mut app = App::new();
    app.add_plugins((
        view::window_plugins(),
        PhysicsPlugin::default(),
        ScenesPlugin::new(scene),
        WatchPlugin,
        RescuePlugin,
        ViewPlugin::default(),
        PanelPlugin,
    ));
    match app.run() {
        AppExit::Success => Ok(Outcome::Done),
        AppExit::Error(code) => Err(CliError::Usage(format!("the window closed with error {code}"))),
    }
}
