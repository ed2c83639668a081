//! From a loaded scene to entities.

use bevy::{
    ecs::{prelude::*, system::EntityCommand},
    log::warn,
    prelude::{Name, ReflectComponent},
    reflect::Reflect,
};

use super::{FileError, LoadedScene, Props, SceneFile, garden, load::scene_conflict, parameters, race};
use crate::{body::Gravity, physics::Clock};

/// The scene that is open. Replaced when a scene is opened or reloaded, and not when a parameter changes.
#[derive(Clone, Debug, Resource)]
pub struct CurrentScene {
    /// Its file.
    pub file: SceneFile,
    /// Where it came from, for messages.
    pub source: String,
}

/// The bodies of the scene in the order of its file. Recordings and hashes go by it.
#[derive(Clone, Debug, Default, Resource)]
pub struct SceneBodies(pub Vec<Entity>);

/// Put on everything that is there for the scene that is open, and goes when another is opened.
#[derive(Clone, Component, Copy, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct SceneMember;

/// What the open scene was made from.
#[derive(Resource)]
pub(super) struct Opened(pub(super) LoadedScene);

/// Puts a scene into the world: what the last one left is despawned, the clock starts at 0, and every parameter is as in the file.
///
/// # Errors
/// If a body cannot be built or a parameter not be set, which [`load`](super::load) has found out before; nothing is changed then.
pub fn open(world: &mut World, scene: LoadedScene) -> Result<(), FileError> {
    let bodies = scene.bodies().collect::<Result<Vec<_>, _>>()?;
    let clock = clock(&scene)?;
    let members: Vec<_> = world.query_filtered::<Entity, With<SceneMember>>().iter(world).collect();
    for member in members {
        // A member that was the child of another is gone with it.
        world.get_entity_mut(member).map(EntityWorldMut::despawn).ok();
    }
    world.insert_resource(clock);
    spawn(world, &scene, bodies);
    for (path, value) in parameters::in_order(&scene.file.set) {
        if let Err(error) = parameters::set(world, path, value) {
            warn!("{}: set: {error}", scene.source);
        }
    }
    for warning in &scene.warnings {
        warn!("{warning}");
    }
    world.insert_resource(CurrentScene { file: scene.file.clone(), source: scene.source.to_string() });
    world.insert_resource(Opened(scene));
    Ok(())
}

/// A world with the clock and the bodies of a scene as its creature files have them, without what the scene sets.
pub(super) fn scratch(scene: &LoadedScene) -> Result<World, FileError> {
    let mut world = World::new();
    let bodies = scene.bodies().collect::<Result<Vec<_>, _>>()?;
    world.insert_resource(clock(scene)?);
    spawn(&mut world, scene, bodies);
    Ok(world)
}

/// A body by its place in the file of the scene.
pub(super) fn nth_body(world: &World, index: usize) -> Option<EntityRef<'_>> {
    world.get_entity(*world.get_resource::<SceneBodies>()?.0.get(index)?).ok()
}

fn clock(scene: &LoadedScene) -> Result<Clock, FileError> {
    Clock::new(scene.file.clock.dt(), scene.file.clock.time_scale)
        .map_err(|error| scene_conflict(scene, "clock".into(), error.to_string()))
}

fn spawn(world: &mut World, scene: &LoadedScene, bodies: Vec<crate::creatures::Body>) {
    let file = &scene.file;
    // A body has only the components that its scene needs: without gravity there is no `Gravity`.
    let gravity = Gravity::new(file.gravity).ok().filter(|gravity| gravity.acceleration() > 0.0);
    let mut entities = Vec::with_capacity(bodies.len());
    for (placement, body) in file.creatures.iter().zip(bodies) {
        let mut entity = world.spawn((Name::new(placement.name.clone()), SceneMember));
        if body.six.is_some() {
            if let Some((_, road)) = scene.road_of(placement) {
                entity.insert(road.clone());
            }
            entities.push(entity.id());
            body.apply(entity);
            continue;
        }
        entity.insert((placement.method.unwrap_or(file.method), file.stick));
        if let Some(gravity) = gravity {
            entity.insert(gravity);
        }
        if let Some(ground) = &file.ground {
            entity.insert(ground.clone());
        }
        if matches!(file.props, Props::Garden { .. }) {
            entity.insert(garden::LAP);
        }
        entities.push(entity.id());
        body.apply(entity);
    }
    if let Some(truth) = file.creatures.iter().position(|placement| Some(&placement.name) == file.truth.as_ref()) {
        race::line_up(world, &entities, truth);
    }
    world.insert_resource(SceneBodies(entities));
}
