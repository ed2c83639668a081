//! Opening and switching scenes while an app runs.

use bevy::{log::error, prelude::*};

use super::{LoadedScene, load, open, race, spawn::Opened};
use crate::{
    creatures::library::Source,
    physics::{Clock, PhysicsSystems},
};

/// Asks for another scene. It is open before the next tick; a bad file is answered by [`SceneProblem`].
#[derive(Clone, Debug, Message, PartialEq, Eq)]
pub enum SceneChange {
    /// The scene of this name or file.
    Load(String),
    /// The same again from its files, with every parameter as they have it.
    Reload,
}

/// A file was bad. The last good scene goes on.
#[derive(Clone, Debug, Message, PartialEq, Eq)]
pub struct SceneProblem {
    /// What is wrong, for people.
    pub text: String,
}

/// Opens a scene at the start and others when [`SceneChange`] asks for them.
///
/// The first scene is open before `Startup`.
#[derive(Clone, Debug, Default)]
pub struct ScenesPlugin {
    first: Option<LoadedScene>,
}

impl ScenesPlugin {
    /// Starts with `scene`. The default starts with none.
    pub fn new(scene: LoadedScene) -> Self {
        Self { first: Some(scene) }
    }
}

impl Plugin for ScenesPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<SceneChange>()
            .add_message::<SceneProblem>()
            .add_systems(PreUpdate, switch)
            .add_systems(FixedPostUpdate, race::measure.run_if(resource_exists::<Clock>))
            .add_systems(
                RunFixedMainLoop,
                race::haunt.after(PhysicsSystems::Sync).in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
            );
        if let Some(first) = self.first.clone() {
            app.add_systems(PreStartup, move |world: &mut World| try_open(world, Ok(first.clone())));
        }
    }
}

/// Opens what was asked for last.
fn switch(world: &mut World) {
    let Some(change) = world.resource_mut::<Messages<SceneChange>>().drain().last() else { return };
    let scene = match change {
        SceneChange::Load(name) => load(&name),
        SceneChange::Reload => {
            let Some(Opened(scene)) = world.get_resource::<Opened>() else { return };
            load(&match &scene.source {
                Source::Disk(path) => path.display().to_string(),
                Source::Shipped(path) => path.clone(),
            })
        }
    };
    try_open(world, scene);
}

fn try_open(world: &mut World, scene: Result<LoadedScene, super::FileError>) {
    if let Err(problem) = scene.and_then(|scene| open(world, scene)) {
        let text = problem.to_string();
        error!("{text}");
        world.write_message(SceneProblem { text });
    }
}
