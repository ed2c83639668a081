//! What is measured of a sweep or a study that is not finished, so that it can go on after an interruption.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::{GalleryError, Point, Setting, StiffRun};
use crate::{mechanics::integrators::Method, scenes::write};

/// A file with one point of a sweep, or one run of a study, a line, after a line that says of what.
#[derive(Debug)]
pub struct Partial<Entry = Point> {
    path: PathBuf,
    file: File,
    entries: Vec<Entry>,
}

/// What a study of stiffness has found at a factor, by one method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudiedRun {
    /// By how much every stiffness is multiplied.
    pub factor: f64,
    /// The method and its cheapest good run.
    #[serde(flatten)]
    pub run: StiffRun,
}

/// The first line.
#[derive(PartialEq, Eq, Serialize, Deserialize)]
struct Head {
    problem: String,
    /// Times of two machines do not belong into one chart.
    machine: String,
}

impl<Entry: Serialize + DeserializeOwned> Partial<Entry> {
    /// Opens a file to go on with it, or a new one if there is none of this problem from this machine and this program.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn open(path: PathBuf, problem: &str, machine: String) -> Result<Self, GalleryError> {
        let head = Head { problem: problem.into(), machine };
        let entries = read(&path, &head);
        // Written anew without what an interruption has left of a line.
        let opened = lines(&head, &entries).and_then(|text| {
            write(&path, text.as_bytes())?;
            OpenOptions::new().append(true).open(&path)
        });
        match opened {
            Ok(file) => Ok(Self { path, file, entries }),
            Err(error) => Err(GalleryError::File { file: path, error }),
        }
    }

    /// How many are known.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether none is known.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds one.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn push(&mut self, entry: Entry) -> Result<(), GalleryError> {
        let line = serde_json::to_string(&entry).map_err(io::Error::from);
        let written = line.and_then(|line| self.file.write_all(format!("{line}\n").as_bytes()));
        written.map_err(|error| GalleryError::File { file: self.path.clone(), error })?;
        self.entries.push(entry);
        Ok(())
    }
}

impl Partial<Point> {
    /// What has been measured with a setting, if it has.
    pub fn known(&self, setting: Setting) -> Option<Point> {
        // A number that was written and read again may differ in its last bit.
        let same = |other: Setting| {
            (other.method, other.stick) == (setting.method, setting.stick)
                && libm::fabs(other.dt - setting.dt) <= 1e-12 * setting.dt
        };
        let point = self.entries.iter().find(|point| same(point.setting))?;
        Some(Point { setting, ..*point })
    }
}

impl Partial<StudiedRun> {
    /// What has been found by a method at a factor, if it has.
    pub fn known(&self, factor: f64, method: Method) -> Option<StiffRun> {
        let same = |entry: &&StudiedRun| entry.factor == factor && entry.run.method == method;
        self.entries.iter().find(same).map(|entry| entry.run)
    }
}

fn lines(head: &Head, entries: &[impl Serialize]) -> io::Result<String> {
    let mut text = serde_json::to_string(head)? + "\n";
    for entry in entries {
        text += &(serde_json::to_string(entry)? + "\n");
    }
    Ok(text)
}

/// The entries of a file with the same head, up to the first line that is damaged.
fn read<Entry: DeserializeOwned>(path: &Path, head: &Head) -> Vec<Entry> {
    let Ok(text) = fs::read_to_string(path) else { return Vec::new() };
    let mut lines = text.lines();
    let same =
        lines.next().and_then(|line| serde_json::from_str::<Head>(line).ok()).is_some_and(|found| found == *head);
    if !same {
        return Vec::new();
    }
    lines.map_while(|line| serde_json::from_str(line).ok()).collect()
}
