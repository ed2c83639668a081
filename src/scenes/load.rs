//! Reading a scene with all of its creatures, and checking that they fit together, before anything in a world changes.

use std::{
    collections::{BTreeSet, HashMap},
    path::PathBuf,
    sync::Arc,
};

use bevy::{ecs::world::World, math::DVec3};

use super::{Placement, Props, SceneClock, SceneFile, StepSize, alone, fits, parameters, roads::Roads, spawn};
use crate::{
    body::{BodyError, Ground, Muscles, TravelingWave, TravelingWaves},
    creatures::{
        Body, Creature, FileError, MOST_PARTICLES, Pose, RoadForm,
        library::{self, CREATURE, SCENE, Source},
        line_of, parse,
    },
    mechanics::{
        ground_distance,
        integrators::{Method, StickRule},
        six_matrix::Road,
    },
    physics::{Clock, cut_waves},
};

/// The step of the six-matrix particle system, as printed.
const SIX_MATRIX_DT: f64 = 0.01;

/// A scene with its creatures, read and found to be good.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// The scene.
    pub file: SceneFile,
    /// Where it came from.
    pub source: Source,
    /// What is allowed but probably not meant, for people.
    pub warnings: Vec<String>,
    /// The blueprint of each creature, in the order of the scene, and where it came from.
    pub(super) creatures: Vec<(Source, Arc<Creature>)>,
    /// The roads that it names.
    pub(super) roads: Roads,
}

impl LoadedScene {
    /// The files on disk that it was read from.
    pub fn files(&self) -> BTreeSet<PathBuf> {
        let sources = self.creatures.iter().map(|(source, _)| source).chain(self.roads.sources()).chain([&self.source]);
        sources
            .filter_map(|source| match source {
                Source::Disk(path) => Some(path.clone()),
                Source::Shipped(_) => None,
            })
            .collect()
    }

    /// Builds the bodies in the order of the scene.
    pub(super) fn bodies(&self) -> impl Iterator<Item = Result<Body, FileError>> + '_ {
        self.file.creatures.iter().zip(&self.creatures).enumerate().map(|(i, (placement, (source, creature)))| {
            let pose = Pose { at: DVec3::from(placement.at), heading: placement.heading };
            // That there is a road, and a creature for it, was checked before.
            let place = placement.on_road.zip(self.road_of(placement)).zip(creature.body.composed());
            let pose = match place {
                None => pose,
                Some(((place, (form, road)), composed)) => {
                    let stands = composed.pose_on(road, form.station(place.row), place.aside, placement.heading);
                    let stands = stands.ok_or_else(|| {
                        let problem =
                            format!("no road is below `{}` there; give another row, or less aside", placement.name);
                        scene_conflict(self, format!("creatures[{i}].on_road"), problem)
                    })?;
                    Pose { at: stands.at + pose.at, ..stands }
                }
            };
            creature.body(pose).map_err(|error| conflict(source, error))
        })
    }

    /// The road that a creature moves on.
    pub(super) fn road_of(&self, placement: &Placement) -> Option<(&RoadForm, &Road)> {
        self.roads.get(placement.road.as_ref().or(self.file.road.as_ref())?)
    }
}

/// Reads a scene or, where the name is that of a creature, the creature alone.
///
/// The name is a path or a name: looked for as given, then under `./assets`, then among what is shipped.
///
/// # Errors
/// If a file is missing or bad; see [`FileError`].
pub fn load(name: &str) -> Result<LoadedScene, FileError> {
    if name.ends_with(CREATURE.suffix) {
        return load_creature(name);
    }
    let source = match library::find(SCENE, name, None) {
        Err(FileError::NotFound { what, name: asked, places, mut near }) => {
            match library::find(CREATURE, name, None) {
                Ok(_) => return load_creature(name),
                Err(FileError::NotFound { near: creatures, .. }) => near.extend(creatures),
                Err(_) => {}
            }
            return Err(FileError::NotFound { what, name: asked, places, near });
        }
        source => source?,
    };
    let file = read_scene(&source)?;
    let mut read = HashMap::new();
    let mut creatures = Vec::with_capacity(file.creatures.len());
    for (i, placement) in file.creatures.iter().enumerate() {
        if !read.contains_key(&placement.creature) {
            let found = library::find(CREATURE, &placement.creature, source.folder())
                .map_err(|error| named_in(&source, format!("creatures[{i}].creature"), error))?;
            let creature = Arc::new(library::read_creature(&found)?);
            read.insert(placement.creature.clone(), (found, creature));
        }
        creatures.push(read[&placement.creature].clone());
    }
    let roads = Roads::read(&file, &source)?;
    check(LoadedScene { file, source, warnings: Vec::new(), creatures, roads })
}

/// Reads a scene file by itself, without its creatures.
///
/// # Errors
/// If it is missing or bad; see [`FileError`].
pub fn read_scene(source: &Source) -> Result<SceneFile, FileError> {
    parse(&library::read(SCENE, source)?, &source.to_string())
}

/// Reads a creature and makes a scene for it alone: on the ground and under the gravity that it asks for, looked at from nearby.
///
/// # Errors
/// If its file is missing or bad; see [`FileError`].
pub fn load_creature(name: &str) -> Result<LoadedScene, FileError> {
    let source = library::find(CREATURE, name, None)?;
    let creature = Arc::new(library::read_creature(&source)?);
    let stem = source.stem();
    // What is wrong with its body is told where the scene is checked.
    let body = creature.body(Pose::default()).ok().filter(|body| body.six.is_none());
    let camera = body.as_ref().map(|body| alone::camera(body, creature.ground.is_some()));
    let time_scale = body.as_ref().map_or(1.0, alone::time_scale);
    let file = SceneFile {
        version: 1,
        title: stem.clone(),
        gravity: creature.gravity.unwrap_or(0.0),
        ground: creature.ground.clone(),
        road: creature.road.clone(),
        creatures: vec![Placement {
            name: usable_name(&stem),
            creature: reference(&source),
            at: (0.0, 0.0, 0.0),
            heading: 0.0,
            on_road: None,
            road: None,
            method: None,
        }],
        props: Props::None,
        camera: camera.unwrap_or_default(),
        clock: match creature.body.composed() {
            // t belongs to this model of motion as its other numbers do.
            Some(_) => SceneClock { step: StepSize::Dt(SIX_MATRIX_DT), time_scale: 3.0, opens_at: None },
            None => SceneClock { time_scale, ..SceneClock::default() },
        },
        method: Method::default(),
        stick: StickRule::default(),
        truth: None,
        budget: super::Budget::default(),
        set: Default::default(),
    };
    let roads = Roads::read(&file, &source)?;
    let name = &file.creatures[0].name;
    let renamed = (*name != stem).then(|| {
        format!("{source}: `{}` cannot be a name, so its parameter paths begin with `{name}`", stem.escape_debug())
    });
    check(LoadedScene {
        file,
        source: source.clone(),
        warnings: renamed.into_iter().collect(),
        creatures: vec![(source, creature)],
        roads,
    })
}

/// How a scene file refers to a creature file wherever the scene file is.
pub(super) fn reference(source: &Source) -> String {
    match source {
        Source::Disk(path) => std::path::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string(),
        Source::Shipped(_) => source.stem(),
    }
}

/// A race's runners are what they are measured against, and look the same way.
fn check_truth(scene: &LoadedScene) -> Result<(), FileError> {
    let Some(truth) = &scene.file.truth else { return Ok(()) };
    let Some(index) = scene.file.creatures.iter().position(|placement| placement.name == *truth) else {
        let names: Vec<_> = scene.file.creatures.iter().map(|placement| placement.name.as_str()).collect();
        let problem = format!("no creature is called \"{truth}\"; give one of {}", names.join(", "));
        return Err(scene_conflict(scene, "truth".into(), problem));
    };
    for (i, (placement, (_, creature))) in scene.file.creatures.iter().zip(&scene.creatures).enumerate() {
        if creature.body.composed().is_some() {
            let problem = format!(
                "\"{}\" follows the six-matrix particle system, which knows one step and no method: it cannot race",
                placement.name
            );
            return Err(scene_conflict(scene, format!("creatures[{i}]"), problem));
        }
    }
    let (model, count) = (&scene.file.creatures[index], scene.creatures[index].1.particle_count());
    for (i, (placement, (_, creature))) in scene.file.creatures.iter().zip(&scene.creatures).enumerate() {
        if placement.heading != model.heading || creature.particle_count() != count {
            let problem =
                format!("must have the heading and the {count} particles of \"{truth}\", the truth of this race");
            return Err(scene_conflict(scene, format!("creatures[{i}]"), problem));
        }
    }
    Ok(())
}

/// Checks what single files cannot know, and that the scene can be opened.
fn check(mut scene: LoadedScene) -> Result<LoadedScene, FileError> {
    check_names(&scene)?;
    check_truth(&scene)?;
    fits::check(&scene)?;
    let particles: usize = scene.creatures.iter().map(|(_, creature)| creature.particle_count()).sum();
    if particles > MOST_PARTICLES {
        return Err(scene_conflict(
            &scene,
            "creatures".into(),
            format!("have {particles} particles together; a scene has at most {MOST_PARTICLES}"),
        ));
    }
    let set = check_set(&scene)?;
    let dt = set.as_ref().and_then(|world| world.get_resource::<Clock>()).map_or(scene.file.clock.dt(), Clock::dt);
    let mut warned = BTreeSet::new();
    let (mut warnings, mut ill_timed) = (core::mem::take(&mut scene.warnings), false);
    for (i, body) in scene.bodies().enumerate() {
        let body = body?;
        if let Some(ground) = scene.file.ground.as_ref().filter(|_| body.six.is_none()) {
            check_above_ground(&scene, ground, i, &body)?;
        }
        let (source, set) = (&scene.creatures[i].0, set.as_ref().and_then(|world| spawn::nth_body(world, i)));
        let own: Vec<_> = cut_waves(body.muscles.as_ref(), body.waves.as_ref()).collect();
        let cut = match set {
            Some(body) => cut_waves(body.get::<Muscles>(), body.get::<TravelingWaves>()).collect(),
            None => own.clone(),
        };
        if cut != own {
            let name = &scene.file.creatures[i].name;
            let cut = cut.into_iter().map(|(path, problem)| format!("{name}.{path}: {problem}"));
            warnings.extend(cut.map(|problem| warning(&scene.source, "set".into(), problem)));
        } else if !cut.is_empty() && warned.insert((source, "cut")) {
            warnings.extend(cut.into_iter().map(|(path, problem)| warning(source, path, problem)));
        }
        let waves = set.map_or(body.waves.as_ref(), |body| body.get());
        if let Some((path, problem)) = waves.and_then(|waves| hasty_wave(waves, dt))
            && warned.insert((source, "hasty"))
        {
            warnings.push(warning(source, path, problem));
        }
        if body.six.is_some() && scene.file.clock.dt() != SIX_MATRIX_DT && !ill_timed {
            ill_timed = true;
            let problem = format!(
                "steps are of {}, and the forces of `{}` are per step: its numbers belong to dt: {SIX_MATRIX_DT}",
                scene.file.clock.dt(),
                scene.file.creatures[i].name
            );
            warnings.push(warning(&scene.source, "clock".into(), problem));
        }
    }
    scene.warnings = warnings;
    Ok(scene)
}

fn check_names(scene: &LoadedScene) -> Result<(), FileError> {
    let mut first = HashMap::new();
    for (i, placement) in scene.file.creatures.iter().enumerate() {
        let name = &placement.name;
        let problem = if *name != usable_name(name) {
            format!("`{}` cannot be a name; `{}` can", name.escape_debug(), usable_name(name))
        } else if let Some(other) = first.insert(name, i) {
            format!("`{name}` is the name of creatures[{other}] already; give each creature a name of its own")
        } else {
            continue;
        };
        return Err(scene_conflict(scene, format!("creatures[{i}].name"), problem));
    }
    Ok(())
}

/// A name that can stand in a parameter path and in a column of a table.
fn usable_name(name: &str) -> String {
    let name: String =
        name.trim().chars().map(|c| if c.is_control() || "[]=,\"".contains(c) { '-' } else { c }).collect();
    match name.as_str() {
        "" => "creature".into(),
        // `clock.dt` is a path already.
        "clock" => "clock-".into(),
        _ => name,
    }
}

fn check_above_ground(scene: &LoadedScene, ground: &Ground, creature: usize, body: &Body) -> Result<(), FileError> {
    // What a turn or a sum rounds off is no mistake.
    const ROUNDING: f64 = 1e-9;
    let distances = body.particles.positions().map(|position| ground_distance(ground, position).0);
    let Some((i, distance)) = (0..).zip(distances).min_by(|a: &(usize, f64), b| a.1.total_cmp(&b.1)) else {
        return Ok(());
    };
    if distance >= -ROUNDING {
        return Ok(());
    }
    let (x, y, z) = scene.file.creatures[creature].at;
    let depth = -distance;
    // Above the flat ground it is known how to mend it; elsewhere another place may be meant.
    let flat = *ground == Ground::Flat;
    Err(if scene.source == scene.creatures[creature].0 {
        let mend = if flat { "lift the creature by that much" } else { "move the creature out of it" };
        scene_conflict(
            scene,
            format!("particles[{i}].position"),
            format!("is {depth} below the ground; {mend}, or give ground: None"),
        )
    } else {
        let name = &scene.file.creatures[creature].name;
        let mend =
            if flat { format!("at: ({x}, {}, {z}) or higher", y + depth) } else { "another place with `at`".into() };
        scene_conflict(
            scene,
            format!("creatures[{creature}].at"),
            format!("puts particle {i} of `{name}` {depth} below the ground; give {mend}, or ground: None"),
        )
    })
}

/// What is no error, as one would be said.
fn warning(source: &Source, path: String, problem: String) -> String {
    FileError::Conflict { file: source.to_string(), line: line_in(source, &path), path, problem }.to_string()
}

/// The path of a wave that is too quick for steps of `dt`, and why.
fn hasty_wave(waves: &TravelingWaves, dt: f64) -> Option<(String, String)> {
    /// Fewer steps than these in a cycle do not follow its wave.
    const LEAST_STEPS: f64 = 20.0;
    let hasty = |(_, wave): &(usize, TravelingWave)| wave.amplitude > 0.0 && dt > wave.period / LEAST_STEPS;
    waves.iter().enumerate().find(hasty).map(|(i, wave)| {
        let problem = format!(
            "{} is less than {LEAST_STEPS} steps of {dt}, which do not follow the wave; give a longer period, or a smaller dt",
            wave.period
        );
        (format!("waves[{i}].period"), problem)
    })
}

/// Sets the scene's parameters in a world of their own, to see whether they can be set and what comes of it; nothing where it sets none.
fn check_set(scene: &LoadedScene) -> Result<Option<World>, FileError> {
    if scene.file.set.is_empty() {
        return Ok(None);
    }
    let mut world = spawn::scratch(scene)?;
    for (path, value) in parameters::in_order(&scene.file.set) {
        parameters::set(&mut world, path, value).map_err(|error| FileError::Conflict {
            file: scene.source.to_string(),
            line: line_in(&scene.source, &format!("set.{path}")),
            path: "set".into(),
            problem: error.to_string(),
        })?;
    }
    Ok(Some(world))
}

pub(super) fn scene_conflict(scene: &LoadedScene, path: String, problem: String) -> FileError {
    let file = scene.source.to_string();
    FileError::Conflict { file, line: line_in(&scene.source, &path), path, problem }
}

/// That what a file names is nowhere, with the place where it names it.
pub(super) fn named_in(source: &Source, path: String, error: FileError) -> FileError {
    match error {
        FileError::NotFound { .. } => {
            let (file, line) = (source.to_string(), line_in(source, &path));
            FileError::Conflict { file, line, path, problem: error.to_string() }
        }
        error => error,
    }
}

/// What a body refuses, with the name of its file.
pub(super) fn conflict(source: &Source, error: BodyError) -> FileError {
    let file = source.to_string();
    let text = error.to_string();
    match text.split_once(": ") {
        Some((path, problem)) => {
            FileError::Conflict { file, line: line_in(source, path), path: path.into(), problem: problem.into() }
        }
        None => FileError::Unreadable { file, problem: text },
    }
}

/// The line of a file on which the field at `path` is; paths of creatures leave out that it is in the body.
fn line_in(source: &Source, path: &str) -> Option<usize> {
    let text = library::read(SCENE, source).ok()?;
    line_of(&text, path).or_else(|| line_of(&text, &format!("body.{path}")))
}
