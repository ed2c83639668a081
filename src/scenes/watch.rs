//! Reloads the scene when a file that it was read from is edited, with Bevy's file watcher.

use core::time::Duration;
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use bevy::{
    asset::io::{AssetSourceEvent, file::FileWatcher},
    log::warn,
    prelude::*,
    tasks::{IoTaskPool, Task},
};

use super::{CurrentScene, SceneChange, save::LastSaved, spawn::Opened};

/// How long the watcher waits for an editor to be done with a file.
const SETTLE: Duration = Duration::from_millis(150);

/// Asks for [`SceneChange::Reload`] when a file on disk that the open scene was read from is edited. A file that is bad then is reported as
/// [`SceneProblem`](super::SceneProblem), and mending it reloads again.
#[derive(Clone, Copy, Debug, Default)]
pub struct WatchPlugin;

impl Plugin for WatchPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Watched>()
            .add_systems(PreUpdate, (follow.run_if(resource_exists_and_changed::<CurrentScene>), notice).chain());
    }
}

/// The files of the open scene and the watchers of their folders.
#[derive(Default, Resource)]
struct Watched {
    files: BTreeSet<PathBuf>,
    folders: BTreeMap<PathBuf, Folder>,
}

struct Folder {
    events: async_channel::Receiver<AssetSourceEvent>,
    /// Holds the watcher, which is set up in the background: it walks through all folders inside.
    _watcher: Task<Option<FileWatcher>>,
}

/// Watches the folders of the scene that was opened, and no others.
fn follow(scene: Option<Res<Opened>>, mut watched: ResMut<Watched>) {
    let files = scene.map(|scene| scene.0.files()).unwrap_or_default();
    watched.files = files.iter().filter_map(|file| std::path::absolute(file).ok()).collect();
    let folders: BTreeSet<_> = watched.files.iter().filter_map(|file| file.parent()).map(Path::to_owned).collect();
    watched.folders.retain(|folder, _| folders.contains(folder));
    for folder in folders {
        watched.folders.entry(folder).or_insert_with_key(|folder| watch(folder.clone()));
    }
}

fn watch(folder: PathBuf) -> Folder {
    let (sender, events) = async_channel::unbounded();
    let watcher = IoTaskPool::get().spawn(async move {
        FileWatcher::new(folder.clone(), sender, SETTLE)
            .inspect_err(|error| warn!("{}: edited files will not be reloaded: {error}", folder.display()))
            .ok()
    });
    Folder { events, _watcher: watcher }
}

/// Reloads if a file of the scene has other content now.
fn notice(watched: Res<Watched>, saved: Option<Res<LastSaved>>, mut changes: MessageWriter<SceneChange>) {
    let edited = |folder: &Path, event| {
        let (AssetSourceEvent::AddedAsset(path)
        | AssetSourceEvent::ModifiedAsset(path)
        | AssetSourceEvent::RenamedAsset { new: path, .. }) = event
        else {
            // An editor may take a file away and put another in its place.
            return false;
        };
        let path = folder.join(path);
        let is_own = |saved: &LastSaved| saved.path == path && fs::read(&path).is_ok_and(|now| now == saved.content);
        watched.files.contains(&path) && !saved.as_deref().is_some_and(is_own)
    };
    let mut reload = false;
    for (folder, Folder { events, .. }) in &watched.folders {
        while let Ok(event) = events.try_recv() {
            reload |= edited(folder, event);
        }
    }
    if reload {
        changes.write(SceneChange::Reload);
    }
}
