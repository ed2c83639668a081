//! Where files are found: as given, then under `./assets`, then embedded in the program.

use std::{
    collections::BTreeMap,
    fmt, fs,
    io::{self, Read},
    path::{Path, PathBuf},
};

use rust_embed::RustEmbed;

use super::{Creature, FileError, RoadFile, parse};

/// The largest file that is read, in bytes.
pub const LARGEST_FILE: u64 = 64 * 1024 * 1024;

#[derive(RustEmbed)]
#[folder = "assets/"]
#[include = "*.ron"]
struct Shipped;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileKind {
    /// What messages call it.
    pub what: &'static str,
    /// Its folder under `assets`.
    pub folder: &'static str,
    /// How its names end.
    pub suffix: &'static str,
    /// How its text begins, for messages.
    pub opening: &'static str,
}

/// Creature files.
pub const CREATURE: FileKind = FileKind {
    what: "creature",
    folder: "creatures",
    suffix: ".creature.ron",
    opening: "Creature(version: 1, body: …)",
};

/// Scene files.
pub const SCENE: FileKind = FileKind {
    what: "scene",
    folder: "scenes",
    suffix: ".scene.ron",
    opening: "Scene(version: 1, title: …, creatures: …)",
};

/// Road files.
pub const ROAD: FileKind =
    FileKind { what: "road", folder: "roads", suffix: ".road.ron", opening: "Road(version: 1, form: …)" };

/// Where a file is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Source {
    /// On disk.
    Disk(PathBuf),
    /// Shipped inside the program: its path under `assets`.
    Shipped(String),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disk(path) => write!(f, "{}", path.display()),
            Self::Shipped(path) => write!(f, "shipped {path}"),
        }
    }
}

impl Source {
    /// The name without folder and suffix: `garden` of `assets/scenes/garden.scene.ron`.
    pub fn stem(&self) -> String {
        let path = match self {
            Self::Disk(path) => path.as_path(),
            Self::Shipped(path) => Path::new(path),
        };
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let stem =
            [SCENE.suffix, CREATURE.suffix, ROAD.suffix, ".ron"].iter().find_map(|suffix| name.strip_suffix(suffix));
        stem.filter(|stem| !stem.is_empty()).unwrap_or(&name).to_owned()
    }

    /// The folder that it is in, if it is on disk.
    pub fn folder(&self) -> Option<&Path> {
        match self {
            Self::Disk(path) => path.parent(),
            Self::Shipped(_) => None,
        }
    }
}

/// Looks for a file: beside the file that names it if there is one, as given, under `./assets`, and embedded.
///
/// # Errors
/// If it is nowhere; the message has the places and names that look alike.
pub fn find(kind: FileKind, name: &str, beside: Option<&Path>) -> Result<Source, FileError> {
    let long = if name.ends_with(kind.suffix) { name.to_owned() } else { format!("{name}{}", kind.suffix) };
    let mut candidates = Vec::new();
    for folder in beside.into_iter().chain([Path::new("")]) {
        candidates.extend([folder.join(name), folder.join(&long)]);
    }
    candidates.extend([Path::new("assets").join(&long), Path::new("assets").join(kind.folder).join(&long)]);
    // A name that has its suffix is a candidate twice.
    let mut seen = std::collections::HashSet::new();
    candidates.retain(|path| seen.insert(path.clone()));
    if let Some(path) = candidates.iter().find(|path| fs::metadata(path).is_ok_and(|file| !file.is_dir())) {
        return Ok(Source::Disk(path.clone()));
    }
    let embedded = [format!("{}/{long}", kind.folder), long];
    if let Some(path) = embedded.iter().find(|path| Shipped::get(path).is_some()) {
        return Ok(Source::Shipped(path.clone()));
    }
    if let Some(folder) = candidates.iter().find(|path| path.is_dir() && path.file_name().is_some()) {
        return Err(is_folder(folder, kind));
    }
    let near = list(kind).into_keys().filter(|known| looks_like(known, name)).collect();
    let mut places: Vec<_> = candidates.iter().map(|path| path.display().to_string()).collect();
    places.push(format!("shipped {}", embedded[0]));
    Err(FileError::NotFound { what: kind.what, name: name.into(), places, near })
}

/// The files of a kind that have a name, under `./assets` and embedded, by name.
pub fn list(kind: FileKind) -> BTreeMap<String, Source> {
    let mut all = BTreeMap::new();
    for path in Shipped::iter() {
        let name = path.strip_prefix(kind.folder).and_then(|path| path.strip_prefix('/'));
        if let Some(name) = name.and_then(|name| name.strip_suffix(kind.suffix)) {
            all.insert(name.to_owned(), Source::Shipped(path.to_string()));
        }
    }
    for entry in fs::read_dir(Path::new("assets").join(kind.folder)).into_iter().flatten().flatten() {
        let name = entry.file_name();
        if let Some(name) = name.to_str().and_then(|name| name.strip_suffix(kind.suffix)) {
            all.insert(name.to_owned(), Source::Disk(entry.path()));
        }
    }
    all
}

/// Reads the text of a file.
///
/// # Errors
/// If it is a folder, larger than [`LARGEST_FILE`], empty, no text in UTF-8, or the system refuses.
pub fn read(kind: FileKind, source: &Source) -> Result<String, FileError> {
    let fail = |problem: String| FileError::Unreadable { file: source.to_string(), problem };
    let bytes = match source {
        Source::Shipped(path) => {
            Shipped::get(path).map(|file| file.data.into_owned()).ok_or_else(|| fail("is not shipped".into()))?
        }
        Source::Disk(path) => read_bytes(kind, path)?,
    };
    let text = String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..good].iter().filter(|&&byte| byte == b'\n').count();
        fail(format!("line {line} is no text in UTF-8; save the file as UTF-8"))
    })?;
    // Some editors put a byte order mark in front, which is no part of the text.
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    if text.trim().is_empty() {
        return Err(fail(format!("is empty; a {} file begins like `{}`", kind.what, kind.opening)));
    }
    Ok(text)
}

/// Reads a creature file.
///
/// # Errors
/// As [`read`], and where the text is no creature. Places that contradict each other are found when its body is built.
pub fn read_creature(source: &Source) -> Result<Creature, FileError> {
    parse(&read(CREATURE, source)?, &source.to_string())
}

/// Reads a road file.
///
/// # Errors
/// As [`read`], and where the text is no road. What allows no road is found when it is built.
pub fn read_road(source: &Source) -> Result<RoadFile, FileError> {
    parse(&read(ROAD, source)?, &source.to_string())
}

/// Which of `names` look like `name`.
pub(crate) fn looks_like(known: &str, name: &str) -> bool {
    edit_distance(known, name) <= 1 + name.chars().count() / 4
        || (name.chars().count() > 2 && known.to_lowercase().contains(&name.to_lowercase()))
}

fn read_bytes(kind: FileKind, path: &Path) -> Result<Vec<u8>, FileError> {
    let fail = |problem: String| FileError::Unreadable { file: path.display().to_string(), problem };
    let system = |error: io::Error| fail(format!("could not be read: {error}"));
    let too_large =
        |size: String| fail(format!("{size}; a {} file has at most {} MiB", kind.what, LARGEST_FILE / (1024 * 1024)));
    let metadata = fs::metadata(path).map_err(system)?;
    if metadata.is_dir() {
        return Err(is_folder(path, kind));
    }
    if !metadata.is_file() {
        return Err(fail(format!("is no ordinary file; give a file that ends in `{}`", kind.suffix)));
    }
    if metadata.len() > LARGEST_FILE {
        return Err(too_large(format!("has {} MiB", metadata.len().div_ceil(1024 * 1024))));
    }
    let mut bytes = Vec::new();
    // The size may have changed since it was asked for, and some file systems do not tell it.
    fs::File::open(path).map_err(system)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(system)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(too_large("is too large".into()));
    }
    Ok(bytes)
}

fn is_folder(path: &Path, kind: FileKind) -> FileError {
    FileError::Unreadable {
        file: path.display().to_string(),
        problem: format!("is a folder; give a file that ends in `{}`", kind.suffix),
    }
}

/// How many letters have to be changed, added or taken away to turn one word into the other.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = core::mem::replace(&mut row[0], i + 1);
        for (j, &to) in b.iter().enumerate() {
            let changed = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
