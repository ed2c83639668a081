//! A folder of charts: for each scene its numbers, its table and its pictures, and one page for all.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use thiserror::Error;

use super::{
    Partial, StiffnessStudy, StudiedRun, WorkPrecision,
    chart::{self, ChartError},
    csv,
    machine::machine,
    page, stiffness_csv,
};
use crate::scenes::write;

/// A folder of charts that can be written to.
#[derive(Clone, Debug)]
pub struct Gallery {
    folder: PathBuf,
}

/// Why charts cannot be kept.
#[derive(Debug, Error)]
pub enum GalleryError {
    /// The folder is none, or it cannot be written to.
    #[error("{}: {problem}; give a folder that can be written to, or the name of a new one", folder.display())]
    Folder {
        /// Which.
        folder: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// A file cannot be written.
    #[error("could not write to {}: {error}", file.display())]
    File {
        /// Which.
        file: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
}

/// A chart as `NAME.json` has it.
#[derive(Serialize, Deserialize)]
struct Kept<Chart> {
    /// What was measured, and how: a chart is measured again when this has changed.
    problem: String,
    #[serde(flatten)]
    chart: Chart,
}

impl Gallery {
    /// Opens a folder, and makes it if it is not there.
    ///
    /// # Errors
    /// If it is no folder or cannot be written to, so that this is known before anything is measured.
    pub fn open(folder: impl Into<PathBuf>) -> Result<Self, GalleryError> {
        let folder = folder.into();
        let problem = if folder.as_os_str().is_empty() {
            Some("is no name of a folder".into())
        } else if folder.exists() && !folder.is_dir() {
            Some("is no folder".into())
        } else {
            let tried = fs::create_dir_all(&folder).and_then(|()| tempfile::tempfile_in(&folder));
            tried.err().map(|error| format!("cannot be written to ({error})"))
        };
        match problem {
            Some(problem) => Err(GalleryError::Folder { folder, problem }),
            None => Ok(Self { folder }),
        }
    }

    /// The file of a scene that ends in `suffix`.
    pub fn file(&self, scene: &str, suffix: &str) -> PathBuf {
        self.folder.join(format!("{scene}.{suffix}"))
    }

    /// The chart of a scene, if it was kept whole and with the same `problem`.
    pub fn finished(&self, scene: &str, problem: &str) -> Option<WorkPrecision> {
        let kept: Kept<WorkPrecision> = read(&self.file(scene, "json"))?;
        (kept.problem == problem && kept.chart.scene == scene).then_some(kept.chart)
    }

    /// The study of stiffness of a scene, if it was kept whole and with the same `problem`.
    pub fn finished_study(&self, scene: &str, problem: &str) -> Option<StiffnessStudy> {
        let kept: Kept<StiffnessStudy> = read(&self.file(&study_stem(scene), "json"))?;
        (kept.problem == problem && kept.chart.scene == scene).then_some(kept.chart)
    }

    /// Whether the table and the pictures of a scene are there.
    pub fn is_drawn(&self, scene: &str) -> bool {
        ["csv", "svg", "png"].iter().all(|suffix| self.file(scene, suffix).is_file())
    }

    /// Whether the table and the pictures of a scene's study of stiffness are there.
    pub fn is_study_drawn(&self, scene: &str) -> bool {
        self.is_drawn(&study_stem(scene))
    }

    /// Goes on with the sweep of a scene that was interrupted, or begins one.
    ///
    /// # Errors
    /// If the file of its points cannot be written.
    pub fn partial(&self, scene: &str, problem: &str) -> Result<Partial, GalleryError> {
        Partial::open(self.part(scene), problem, machine())
    }

    /// Goes on with the study of stiffness of a scene that was interrupted, or begins one.
    ///
    /// # Errors
    /// If the file of its runs cannot be written.
    pub fn partial_study(&self, scene: &str, problem: &str) -> Result<Partial<StudiedRun>, GalleryError> {
        Partial::open(self.part(&study_stem(scene)), problem, machine())
    }

    fn part(&self, stem: &str) -> PathBuf {
        self.file(stem, "part.jsonl")
    }

    /// Keeps a chart as `NAME.csv`, `NAME.svg`, `NAME.png` and `NAME.json`. The last is written last: where it is, the chart is whole.
    ///
    /// # Errors
    /// If the chart cannot be drawn or a file cannot be written; what was there before is still there then.
    pub fn keep(&self, problem: &str, chart: &WorkPrecision) -> Result<(), GalleryError> {
        let [svg, png] = [chart::svg(chart)?.into_bytes(), chart::png(chart)?];
        self.keep_files(&chart.scene, [csv(chart).into_bytes(), svg, png], &Kept { problem: problem.into(), chart })?;
        self.remove_part(&chart.scene)
    }

    /// What was left of an interruption is whole now.
    fn remove_part(&self, stem: &str) -> Result<(), GalleryError> {
        let file = self.part(stem);
        match fs::remove_file(&file) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(GalleryError::File { file, error }),
            _ => Ok(()),
        }
    }

    /// Keeps a study of stiffness as `NAME-stiffness.csv` and so on, as [`Gallery::keep`] does with a chart.
    ///
    /// # Errors
    /// If it cannot be drawn or a file cannot be written; what was there before is still there then.
    pub fn keep_study(&self, problem: &str, study: &StiffnessStudy) -> Result<(), GalleryError> {
        let [svg, png] = [chart::stiffness::svg(study)?.into_bytes(), chart::stiffness::png(study)?];
        let kept = Kept { problem: problem.into(), chart: study };
        let stem = study_stem(&study.scene);
        self.keep_files(&stem, [stiffness_csv(study).into_bytes(), svg, png], &kept)?;
        self.remove_part(&stem)
    }

    /// Writes a table, the pictures and last what they are made from.
    fn keep_files(&self, stem: &str, files: [Vec<u8>; 3], kept: &impl Serialize) -> Result<(), GalleryError> {
        for (suffix, bytes) in ["csv", "svg", "png"].into_iter().zip(files) {
            self.write(&self.file(stem, suffix), &bytes)?;
        }
        let file = self.file(stem, "json");
        let json = serde_json::to_vec_pretty(kept)
            .map_err(|error| GalleryError::File { file: file.clone(), error: error.into() })?;
        self.write(&file, &json)
    }

    /// Writes `index.html` with all charts of the folder, by name, and says where it is.
    ///
    /// # Errors
    /// If a chart cannot be drawn or the file cannot be written.
    pub fn write_page(&self) -> Result<PathBuf, GalleryError> {
        let mut charts: Vec<WorkPrecision> = self.all_kept();
        charts.sort_by(|a, b| a.scene.cmp(&b.scene));
        let file = self.folder.join("index.html");
        self.write(&file, page(&charts, &self.all_kept())?.as_bytes())?;
        Ok(file)
    }

    /// All that was kept of one kind; a file of the other is none of it.
    fn all_kept<Chart: DeserializeOwned>(&self) -> Vec<Chart> {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let files = entries.filter(|path| path.extension().is_some_and(|extension| extension == "json"));
        files.filter_map(|path| Some(read::<Chart>(&path)?.chart)).collect()
    }

    fn write(&self, file: &Path, bytes: &[u8]) -> Result<(), GalleryError> {
        write(file, bytes).map_err(|error| GalleryError::File { file: file.to_owned(), error })
    }
}

/// What the files of a scene's study of stiffness are called, without their ends.
pub fn study_stem(scene: &str) -> String {
    format!("{scene}-stiffness")
}

/// A chart that was kept; a damaged or foreign file is none.
fn read<Chart: DeserializeOwned>(file: &Path) -> Option<Kept<Chart>> {
    serde_json::from_slice(&fs::read(file).ok()?).ok()
}
