//! `wriggle choose`: the cheapest method and step that are good enough for a scene.

use std::io::{self, Write};

use clap::Args;

use super::{CliError, Outcome, list::write_table, progress::progress, warn};
use crate::{
    lab::{Cache, Candidate, Choice, Problem, Search, Truth, Unit, choose as find},
    scenes,
};

#[derive(Args, Debug)]
pub(super) struct ChooseArguments {
    /// A scene or creature by name, or a file (`*.scene.ron`, `*.creature.ron`)
    scene: String,
    /// Look no further than for the cheapest: faster, and without the frontier
    #[arg(long)]
    cheapest: bool,
    /// Print what was found as one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn choose(arguments: &ChooseArguments) -> Result<Outcome, CliError> {
    let scene = scenes::load(&arguments.scene)?;
    warn(&scene);
    let problem = Problem::of(&scene)?;
    let bar = progress("{wide_bar} {pos}/{len}  {msg}", None);
    bar.set_message("reference");
    let (problem, truth) = Truth::as_far_as_known(problem, &Cache::of_platform())?;
    let search = if arguments.cheapest { Search::Cheapest } else { Search::Frontier };
    let choice = find(&problem, &truth, search, &mut |done, total, what| {
        bar.set_length(total as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    })?;
    bar.finish_and_clear();
    let mut out = io::stdout().lock();
    if arguments.json {
        let text = serde_json::to_string_pretty(&choice).map_err(|error| CliError::stdout(error.into()))?;
        writeln!(out, "{text}").and_then(|()| out.flush()).map_err(CliError::stdout)?;
    } else {
        print(&mut out, &choice, search).and_then(|()| out.flush()).map_err(CliError::stdout)?;
    }
    Ok(Outcome::Done)
}

fn print(out: &mut impl Write, found: &Choice, search: Search) -> io::Result<()> {
    let Choice { scene, budget, duration, .. } = found;
    match found.unit {
        Unit::Length => writeln!(out, "{scene}: an error of at most {budget:.4e} until t = {duration}")?,
        Unit::PartOfSpeed | Unit::PartOfCell => {
            let (what, when) = match found.unit {
                Unit::PartOfCell => ("shape, height and volume of blocks", "until"),
                _ => ("speeds of gaits", "at"),
            };
            writeln!(
                out,
                "{scene}: {what} within {} % {when} t = {duration}, known to {:.2e} %",
                100.0 * budget,
                100.0 * found.reference_error
            )?;
        }
    }
    if found.shortened {
        writeln!(out, "no longer, since later motion depends on roundings: steps that are small do not agree on it")?;
    }
    let mut rows = vec![["  method", "friction", "dt", "cost", "error", "of budget"].map(String::from).to_vec()];
    if search == Search::Frontier {
        rows.insert(0, vec!["  frontier".to_owned()]);
        rows.extend(found.frontier.iter().map(|candidate| row(candidate, found)));
    }
    let document = if found.document.is_some() { ", and the document's" } else { "" };
    rows.push(vec![format!("  the scene's own setting{document}")]);
    rows.extend(core::iter::once(&found.own).chain(&found.document).map(|candidate| row(candidate, found)));
    rows.push(vec!["  cheapest within the budget".into()]);
    rows.push(row(&found.choice, found));
    write_table(out, &rows)?;
    writeln!(
        out,
        "cost: force evaluations; error: the worst over dt, 0.9 dt and 0.8 dt; the scene's setting costs {:.2} times the cheapest",
        found.own.cost / found.choice.cost
    )
}

fn row(candidate: &Candidate, found: &Choice) -> Vec<String> {
    let Candidate { setting, error, cost } = candidate;
    let (error, part) = match error {
        Some(error) => (format!("{error:.3e}"), format!("{:.3}", error / found.budget)),
        None => ("blows up".into(), "-".into()),
    };
    let mark = if candidate == &found.choice { "* " } else { "  " };
    vec![
        format!("{mark}{}", setting.method.name()),
        setting.stick.words().into(),
        setting.dt.to_string(),
        format!("{cost:.0}"),
        error,
        part,
    ]
}
