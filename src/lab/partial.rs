//! The points of a sweep that is not finished, so that it can go on after an interruption.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{GalleryError, Point, Setting};
use crate::scenes::write;

/// A file with one point a line, after a line that says of what.
#[derive(Debug)]
pub struct Partial {
    path: PathBuf,
    file: File,
    points: Vec<Point>,
}

/// The first line.
#[derive(PartialEq, Eq, Serialize, Deserialize)]
struct Head {
    problem: String,
    /// Times of two machines do not belong into one chart.
    machine: String,
}

impl Partial {
    /// Opens a file to go on with it, or a new one if there is none of this problem from this machine and this program.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn open(path: PathBuf, problem: &str, machine: String) -> Result<Self, GalleryError> {
        let head = Head { problem: problem.into(), machine };
        let points = read(&path, &head);
        // Written anew without what an interruption has left of a line.
        let opened = lines(&head, &points).and_then(|text| {
            write(&path, text.as_bytes())?;
            OpenOptions::new().append(true).open(&path)
        });
        match opened {
            Ok(file) => Ok(Self { path, file, points }),
            Err(error) => Err(GalleryError::File { file: path, error }),
        }
    }

    /// What has been measured with a setting, if it has.
    pub fn known(&self, setting: Setting) -> Option<Point> {
        // A number that was written and read again may differ in its last bit.
        let same = |other: Setting| {
            (other.method, other.stick) == (setting.method, setting.stick)
                && libm::fabs(other.dt - setting.dt) <= 1e-12 * setting.dt
        };
        let point = self.points.iter().find(|point| same(point.setting))?;
        Some(Point { setting, ..*point })
    }

    /// How many points are known.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether no point is known.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Adds a point.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn push(&mut self, point: Point) -> Result<(), GalleryError> {
        let line = serde_json::to_string(&point).map_err(io::Error::from);
        let written = line.and_then(|line| self.file.write_all(format!("{line}\n").as_bytes()));
        written.map_err(|error| GalleryError::File { file: self.path.clone(), error })?;
        self.points.push(point);
        Ok(())
    }
}

fn lines(head: &Head, points: &[Point]) -> io::Result<String> {
    let mut text = serde_json::to_string(head)? + "\n";
    for point in points {
        text += &(serde_json::to_string(point)? + "\n");
    }
    Ok(text)
}

/// The points of a file with the same head, up to the first line that is damaged.
fn read(path: &Path, head: &Head) -> Vec<Point> {
    let Ok(text) = fs::read_to_string(path) else { return Vec::new() };
    let mut lines = text.lines();
    let same =
        lines.next().and_then(|line| serde_json::from_str::<Head>(line).ok()).is_some_and(|found| found == *head);
    if !same {
        return Vec::new();
    }
    lines.map_while(|line| serde_json::from_str(line).ok()).collect()
}
