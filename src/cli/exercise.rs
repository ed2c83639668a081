//! `wriggle exercise`: the exercise "Mass-Spring-Damper model", answered.

use std::{
    fs,
    io::{self, IsTerminal, Write},
    path::PathBuf,
};

use clap::Args;

use super::{CliError, Outcome};
use crate::{
    lab::exercise::{self, ExerciseOptions},
    scenes::write,
};

#[derive(Args, Debug)]
pub(super) struct ExerciseArguments {
    /// A folder for exercise.html, which has the figures, and exercise.txt; made if it is not there [default: the text is printed]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Shorter runs of a smaller block
    #[arg(long)]
    quick: bool,
}

pub(super) fn exercise(arguments: &ExerciseArguments) -> Result<Outcome, CliError> {
    let options = match arguments.quick {
        false => ExerciseOptions::default(),
        true => ExerciseOptions { count: 3, time: 600.0, halvings: 4, trial: 750 },
    };
    if let Some(folder) = &arguments.out {
        // Known before anything is measured.
        fs::create_dir_all(folder).map_err(|error| CliError::Output { place: folder.display().to_string(), error })?;
    }
    let answered = exercise::exercise(&options, &mut |done| {
        if io::stderr().is_terminal() {
            eprintln!("answered {done} of 5");
        }
    })?;
    let text = exercise::text(&answered);
    let mut out = io::stdout().lock();
    match &arguments.out {
        None => write!(out, "{text}").map_err(CliError::stdout)?,
        Some(folder) => {
            let page = exercise::html(&answered).map_err(crate::lab::GalleryError::from)?;
            for (name, content) in [("exercise.html", &page), ("exercise.txt", &text)] {
                let file = folder.join(name);
                let place = file.display().to_string();
                write(&file, content.as_bytes()).map_err(|error| CliError::Output { place: place.clone(), error })?;
                writeln!(out, "{place}").map_err(CliError::stdout)?;
            }
        }
    }
    out.flush().map_err(CliError::stdout)?;
    Ok(Outcome::Done)
}
