//! `wriggle list`: what there is, and the parameters of a scene.

use std::io::{self, Write};

use clap::Args;

use super::{CliError, Headless, Outcome, warn};
use crate::{
    creatures::{
        JellyPlan, Plan, RoadForm,
        library::{self, CREATURE, ROAD, SCENE, Source},
    },
    mechanics::integrators::Method,
    scenes::{self, parameters},
};

#[derive(Args, Debug)]
pub(super) struct ListArguments {
    /// Print every parameter of this scene or creature: path, value, usual range, unit
    #[arg(long, value_name = "SCENE")]
    paths: Option<String>,
}

pub(super) fn list(arguments: &ListArguments) -> Result<Outcome, CliError> {
    let rows = match &arguments.paths {
        Some(scene) => paths(scene)?,
        None => names(),
    };
    let mut out = io::stdout().lock();
    write_table(&mut out, &rows).and_then(|()| out.flush()).map_err(CliError::stdout)?;
    Ok(Outcome::Done)
}

fn paths(scene: &str) -> Result<Vec<Vec<String>>, CliError> {
    let scene = scenes::load(scene)?;
    warn(&scene);
    let mut run = Headless::new(scene, None)?;
    let mut rows = vec![["path", "value", "range", "unit", "what it is"].map(String::from).to_vec()];
    rows.extend(parameters::list(run.world_mut()).into_iter().map(|parameter| {
        vec![
            parameter.path,
            parameter.value.to_string(),
            format!("{} to {}", parameter.range.start(), parameter.range.end()),
            parameter.unit.into(),
            parameter.help.into(),
        ]
    }));
    Ok(rows)
}

fn names() -> Vec<Vec<String>> {
    let mut rows = vec![vec!["Scenes (wriggle play NAME):".into()]];
    rows.extend(library::list(SCENE).into_iter().map(|(name, source)| {
        let title = match scenes::read_scene(&source) {
            Ok(file) => file.title,
            Err(error) => error.to_string(),
        };
        row(name, title, &source)
    }));
    rows.push(vec!["Creatures (wriggle run NAME):".into()]);
    rows.extend(library::list(CREATURE).into_iter().map(|(name, source)| {
        let kind = match library::read_creature(&source) {
            Ok(creature) => match creature.body {
                Plan::Raw(raw) => format!("{} particles, {} springs", raw.particles.len(), raw.springs.len()),
                Plan::GardenWorm(_) => "garden worm".into(),
                Plan::Strand(strand) => format!("strand of {} segments", strand.segments),
                Plan::Jelly(JellyPlan { size: (x, y, z), .. }) => format!("jelly of {x} × {y} × {z}"),
                Plan::Inchworm(_) => "inchworm: a muscle with two legs, for a road".into(),
                Plan::Roller(_) => "roller: two wheels and four beams, for a road".into(),
                Plan::Composed(composed) => {
                    format!("{} particles, {} rules, for a road", composed.particles(), composed.rules.len())
                }
            },
            Err(error) => error.to_string(),
        };
        row(name, kind, &source)
    }));
    rows.push(vec!["Roads (road: \"NAME\" in a scene file):".into()]);
    rows.extend(library::list(ROAD).into_iter().map(|(name, source)| {
        let kind = match library::read_road(&source) {
            Ok(road) => match road.form {
                RoadForm::Strip(_) => "a straight strip".into(),
                RoadForm::Rough(_) => "rings of particles along two curves".into(),
                RoadForm::Helix(_) => "a ramp that winds upwards".into(),
                RoadForm::Course(course) => format!("along {} points", course.points.len()),
            },
            Err(error) => error.to_string(),
        };
        row(name, kind, &source)
    }));
    rows.push(vec!["Methods (--method NAME):".into()]);
    rows.extend(Method::ALL.map(|method| vec![format!("  {}", method.name()), method.about().summary.into()]));
    rows
}

fn row(name: String, title: String, source: &Source) -> Vec<String> {
    vec![format!("  {name}"), title, source.to_string()]
}

/// Writes columns as wide as their widest cell; a row of one cell is a heading.
pub(super) fn write_table(out: &mut impl Write, rows: &[Vec<String>]) -> io::Result<()> {
    let mut widths = Vec::new();
    for row in rows.iter().filter(|row| row.len() > 1) {
        widths.resize(widths.len().max(row.len()), 0);
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.chars().count().max(*width);
        }
    }
    for row in rows {
        let mut line = String::new();
        for (cell, &width) in row.iter().zip(&widths) {
            line.push_str(&format!("{cell:width$}  "));
        }
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}
