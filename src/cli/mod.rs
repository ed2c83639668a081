//! The command line, one file a command.

use std::{io, process::ExitCode};

use clap::{Parser, Subcommand};
use thiserror::Error;

use crate::{
    body::BodyError,
    creatures::FileError,
    lab::{GalleryError, LabError},
    scenes::{LoadedScene, parameters::ParameterError},
};

mod chart;
mod choose;
mod exercise;
mod headless;
mod limits;
mod list;
mod play;
mod progress;
mod report;
mod run;
#[cfg_attr(not(feature = "window"), path = "no_shot.rs")]
mod shot;
mod values;

pub use headless::{Headless, headless_garden};
pub use report::state_hash;

/// A simulator of small soft creatures made of masses and springs.
#[derive(Debug, Parser)]
#[command(name = "wriggle", version, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    play: play::PlayArguments,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Open a scene in a window (what `wriggle` does by itself)
    Play(play::PlayArguments),
    /// List scenes, creatures and methods, or the parameters of a scene
    List(list::ListArguments),
    #[cfg_attr(feature = "window", doc = "Draw a scene into a picture, without a window")]
    #[cfg_attr(not(feature = "window"), doc = "Draw a scene into a picture (not in this build: it has no renderer)")]
    Shot(shot::ShotArguments),
    /// Run a scene or a creature without drawing it
    Run(run::RunArguments),
    /// Find the cheapest method and step whose error a scene can afford
    Choose(choose::ChooseArguments),
    /// Measure what accuracy costs with every method, and draw it
    Chart(chart::ChartArguments),
    /// Print how large a step may be, for every body and method
    Limits(limits::LimitsArguments),
    /// Answer the exercise "Mass-Spring-Damper model" with runs made on the spot
    Exercise(exercise::ExerciseArguments),
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Done: exit code 0.
    Done,
    /// Done, but the watch froze a body: exit code 1.
    Frozen,
}

/// Why a command did not run: exit code 2.
#[derive(Debug, Error)]
pub enum CliError {
    /// A scene or creature file is missing or bad.
    #[error(transparent)]
    File(#[from] FileError),
    /// A parameter cannot be set.
    #[error("--set: {0}")]
    Parameter(#[from] ParameterError),
    /// A scene cannot be measured.
    #[error(transparent)]
    Lab(#[from] LabError),
    /// Charts cannot be kept.
    #[error(transparent)]
    Gallery(#[from] GalleryError),
    /// A body cannot be built.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// Flags contradict the scene or each other.
    #[error("{0}")]
    Usage(String),
    /// A picture cannot be drawn or written.
    #[cfg(feature = "window")]
    #[error(transparent)]
    Shot(#[from] crate::view::ShotError),
    /// Reading or writing failed.
    #[error("could not write to {place}: {error}")]
    Output {
        /// Where to.
        place: String,
        /// What the system says.
        error: io::Error,
    },
}

impl CliError {
    fn stdout(error: io::Error) -> Self {
        Self::Output { place: "standard output".into(), error }
    }
}

/// Says what a scene's files allow and probably do not mean.
fn warn(scene: &LoadedScene) {
    for warning in &scene.warnings {
        eprintln!("warning: {warning}");
    }
}

/// Parses the command line and runs its command.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        None => play::play(&arguments.play),
        Some(Command::Play(arguments)) => play::play(&arguments),
        Some(Command::List(arguments)) => list::list(&arguments),
        Some(Command::Shot(arguments)) => shot::shot(&arguments),
        Some(Command::Run(arguments)) => run::run(&arguments),
        Some(Command::Choose(arguments)) => choose::choose(&arguments),
        Some(Command::Chart(arguments)) => chart::chart(&arguments),
        Some(Command::Limits(arguments)) => limits::print(&arguments),
        Some(Command::Exercise(arguments)) => exercise::exercise(&arguments),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Frozen) => ExitCode::from(1),
        // Whoever reads the output has seen enough: `wriggle run … | head`.
        Err(CliError::Output { error, .. }) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
