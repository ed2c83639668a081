//! Saving the scene that is open as a file of the user's own.

use std::{fs, io::Write, path::Path};

use bevy::prelude::*;
use ron::ser::PrettyConfig;

use super::{
    FileError, LoadedScene, SceneFile, StepSize,
    load::reference,
    parameters,
    spawn::{Opened, scratch},
};
use crate::{
    creatures::{
        library::{self, CREATURE, ROAD, Source},
        options,
    },
    physics::Clock,
};

/// Saves the scene that is open, with every parameter, its clock and its method as they are now, so that loading the file gives the
/// same again.
///
/// Parameters that differ from those of the creature files stand under `set`. Writing is atomic: whatever happens, `path` holds what it
/// held before or all of the new, and nothing else is left in its folder.
///
/// # Errors
/// If no scene is open or the file cannot be written.
pub fn save(world: &mut World, path: &Path) -> Result<(), FileError> {
    let fail = |problem: String| FileError::Unwritable { file: path.display().to_string(), problem };
    let Some(Opened(scene)) = world.get_resource::<Opened>() else {
        return Err(fail("no scene is open".into()));
    };
    let scene = scene.clone();
    let file = current(world, &scene, path)?;
    let text = options().to_string_pretty(&file, PrettyConfig::new()).map_err(|error| fail(error.to_string()))?;
    let content = format!("Scene{text}\n").into_bytes();
    write(path, &content).map_err(|error| fail(error.to_string()))?;
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    world.insert_resource(LastSaved { path, content });
    Ok(())
}

/// What was saved last. Watching files takes no notice of it: the scene is that way already.
#[derive(Resource)]
#[cfg_attr(not(feature = "window"), expect(dead_code, reason = "files are watched only beside a window"))]
pub(super) struct LastSaved {
    pub(super) path: std::path::PathBuf,
    pub(super) content: Vec<u8>,
}

/// The scene's file as it would have to be, at `path`, to give what is now.
fn current(world: &mut World, scene: &LoadedScene, path: &Path) -> Result<SceneFile, FileError> {
    let mut file = scene.file.clone();
    let base = parameters::body_values(&mut scratch(scene)?);
    let now = parameters::body_values(world);
    file.set = parameters::changes(base, now);
    file.method = parameters::method(world);
    for (placement, method) in file.creatures.iter_mut().zip(parameters::methods(world)) {
        placement.method = method.filter(|method| *method != file.method);
    }
    if let Some(clock) = world.get_resource::<Clock>() {
        let scale = clock.time_scale().unwrap_or(file.clock.time_scale);
        if clock.dt() != file.clock.dt() || scale != file.clock.time_scale {
            file.clock.step = StepSize::Dt(clock.dt());
            file.clock.time_scale = scale;
        }
    }
    for (placement, (source, _)) in file.creatures.iter_mut().zip(&scene.creatures) {
        if library::find(CREATURE, &placement.creature, path.parent()).as_ref() != Ok(source) {
            placement.creature = portable(source, path);
        }
    }
    let own = file.creatures.iter_mut().filter_map(|placement| placement.road.as_mut());
    for name in own.chain(&mut file.road) {
        let Some(source) = scene.roads.source(name) else { continue };
        if library::find(ROAD, name, path.parent()).as_ref() != Ok(source) {
            *name = portable(source, path);
        }
    }
    Ok(file)
}

/// How a scene file at `path` refers to a creature: by its name alone if that lies beside it.
fn portable(source: &Source, path: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).ok();
    match source {
        Source::Disk(creature)
            if creature.parent().and_then(absolute) == path.parent().and_then(absolute)
                && let Some(name) = creature.file_name().and_then(|name| name.to_str()) =>
        {
            name.to_owned()
        }
        _ => reference(source),
    }
}

/// Replaces the file at `path` in one step: written in full beside it, flushed to the disk, then renamed.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if path.is_dir() {
        return Err(std::io::Error::other("it is a folder; give the name of a file"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".wriggle-").suffix(".part");
    // Temporary files are for their owner alone; a new file is for whom the user's mask allows.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    if let Ok(old) = fs::metadata(path) {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    // The rename itself is on the disk once its folder is; not every system can flush a folder.
    if let Ok(folder) = fs::File::open(folder) {
        folder.sync_all().ok();
    }
    Ok(())
}
