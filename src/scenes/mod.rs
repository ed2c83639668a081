//! Scenes (stub; types as the contract has them).
use std::collections::BTreeMap;

use bevy::prelude::*;

use crate::{body::Ground, mechanics::integrators::Method};

pub mod garden;

/// The scene that is open.
#[derive(Clone, Debug, Resource)]
pub struct CurrentScene {
    /// Its file.
    pub file: SceneFile,
    /// Where it came from.
    pub source: String,
}

/// A scene file.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// Title.
    pub title: String,
    /// Gravity.
    pub gravity: f64,
    /// Ground.
    pub ground: Option<Ground>,
    /// Props.
    pub props: Props,
    /// Camera.
    pub camera: Camera,
    /// Method.
    pub method: Method,
    /// Changed parameters.
    pub set: BTreeMap<String, f64>,
}

/// What stands around.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Props {
    /// Nothing.
    None,
    /// The garden.
    Garden {
        /// The seed of everything random in it.
        seed: u64,
    },
}

/// Where the camera starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// Looks at a target from around it.
    Orbit {
        /// Target.
        target: (f64, f64, f64),
        /// Distance.
        distance: f64,
        /// Degrees above the horizon.
        pitch: f64,
        /// Degrees about y; 0 stands at +z of the target.
        yaw: f64,
    },
}

/// Everything that a scene spawned.
#[derive(Clone, Component, Copy, Debug, Default)]
pub struct SceneMember;

/// Asks for another scene.
#[derive(Clone, Debug, Message)]
pub enum SceneChange {
    /// The scene of this name or file.
    Load(String),
    /// The same again from its file.
    Reload,
}

/// A file was bad; the last good scene goes on.
#[derive(Clone, Debug, Message)]
pub struct SceneProblem {
    /// What is wrong, for people.
    pub text: String,
}

pub mod parameters;

/// Why a file is not written (stub).
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct FileError(String);

/// Saves the scene that is open (stub).
///
/// # Errors
/// Always.
pub fn save(_: &mut World, path: &std::path::Path) -> Result<(), FileError> {
    Err(FileError(format!("{}: no scene is open", path.display())))
}
