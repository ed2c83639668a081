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

/// Stops the time of a scene that shows a moment, and has one tick take it there; lets time go on in the scene that is opened after it.
fn stand_still(world: &mut World, stands: bool, steps: u64) {
    if let Some(mut clock) = world.get_resource_mut::<Clock>() {
        clock.leap(steps);
    }
    if let Some(mut time) = world.get_resource_mut::<Time<Virtual>>() {
        if stands { time.pause() } else { time.unpause() }
    }
    if stands && let Some(mut fixed) = world.get_resource_mut::<Time<Fixed>>() {
        let tick = fixed.timestep();
        fixed.accumulate_overstep(tick);
    }
}

fn try_open(world: &mut World, scene: Result<LoadedScene, super::FileError>) {
    let stood = world.get_resource::<Opened>().is_some_and(|Opened(scene)| scene.file.clock.opens_at.is_some());
    let moment = scene.as_ref().map_or(0, |scene| scene.file.clock.opening_steps());
    let stands = scene.as_ref().is_ok_and(|scene| scene.file.clock.opens_at.is_some());
    let result = scene.and_then(|scene| open(world, scene));
    if result.is_ok() && (stands || stood) {
        stand_still(world, stands, moment);
    }
    if let Err(problem) = result {
        let text = problem.to_string();
        error!("{text}");
        world.write_message(SceneProblem { text });
    }
}
