//! `wriggle limits`: how large a step may be, for every scene and method.

use std::io::{self, Write};

use clap::Args;

use super::{CliError, Outcome, list::write_table, progress::progress_of, warn};
use crate::{
    creatures::library::{self, SCENE},
    lab::limits::{Limits, limits},
    scenes,
};

#[derive(Args, Debug)]
pub(super) struct LimitsArguments {
    /// Scenes or creatures by name, or files [default: all scenes]
    scenes: Vec<String>,
    /// Print the limits as one JSON list
    #[arg(long)]
    json: bool,
}

pub(super) fn print(arguments: &LimitsArguments) -> Result<Outcome, CliError> {
    let names = match &arguments.scenes[..] {
        [] => library::list(SCENE).into_keys().collect(),
        scenes => scenes.to_vec(),
    };
    let loaded = names.iter().map(|name| scenes::load(name)).collect::<Result<Vec<_>, _>>()?;
    let mut all = Vec::new();
    for scene in &loaded {
        warn(scene);
        let bar = progress_of(&scene.source.stem(), "bodies and methods");
        let rows = limits(scene, &|done, of| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        });
        bar.finish_and_clear();
        all.extend(rows?);
    }
    let mut out = io::stdout().lock();
    if arguments.json {
        let text = serde_json::to_string_pretty(&all).map_err(|error| CliError::stdout(error.into()))?;
        writeln!(out, "{text}")
    } else {
        write_table(&mut out, &table(&all))
    }
    .and_then(|()| out.flush())
    .map_err(CliError::stdout)?;
    Ok(Outcome::Done)
}

fn table(all: &[Limits]) -> Vec<Vec<String>> {
    let mut rows = vec![
        ["scene", "body", "method", "predicted", "bound", "linearised", "explodes", ""].map(String::from).to_vec(),
    ];
    rows.extend(all.iter().map(|row| {
        vec![
            row.scene.clone(),
            row.body.clone(),
            row.method.into(),
            number(row.predicted),
            number(Some(row.bound)),
            number(row.linearised),
            number(row.explodes),
            row.reason.unwrap_or_default().into(),
        ]
    }));
    rows
}

/// Four digits; a limit that there is not is `none`, one that is not known a dash.
fn number(limit: Option<f64>) -> String {
    match limit {
        None => "-".into(),
        Some(f64::INFINITY) => "none".into(),
        Some(limit) if limit >= 0.01 => format!("{limit:.4}"),
        Some(0.0) => "0".into(),
        Some(limit) => format!("{limit:.3e}"),
    }
}
