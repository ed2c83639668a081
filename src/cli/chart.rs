//! `wriggle chart`: what accuracy costs in each scene, drawn.

use std::{
    collections::BTreeMap,
    io::{self, Write},
    path::PathBuf,
};

use clap::Args;

use super::{CliError, Outcome, progress::progress_of, warn};
use crate::{
    creatures::library::{self, SCENE},
    lab::{
        Gallery, GalleryError, IS_DEBUG_BUILD, LabError, Problem, StiffRun, StiffnessStudy, StudiedRun, SweepOptions,
        Truth, WorkPrecision, chart::stiffness, cheapest_run, factors, measure, resumed_stiffness_study, resumed_sweep,
        study_stem,
    },
    mechanics::integrators::Method,
    scenes::{self, LoadedScene},
};

#[derive(Args, Debug)]
pub(super) struct ChartArguments {
    /// Scenes or creatures by name, or files [default: every scene that `wriggle list` shows]
    scene: Vec<String>,
    /// The folder for NAME.csv, NAME.svg, NAME.png and NAME.json of each scene, the same of NAME-stiffness, and for index.html; made if
    /// it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Fewer steps of each method, fewer stiffnesses and fewer timed runs
    #[arg(long)]
    quick: bool,
}

pub(super) fn chart(arguments: &ChartArguments) -> Result<Outcome, CliError> {
    let scenes = loaded(&arguments.scene)?;
    let gallery = Gallery::open(&arguments.out)?;
    let options = SweepOptions { quick: arguments.quick, ..SweepOptions::default() };
    if IS_DEBUG_BUILD {
        eprintln!(
            "warning: this is a debug build, and its seconds are not those of a release build; evaluations and errors are the same"
        );
    }
    let mut out = io::stdout().lock();
    for (name, scene) in &scenes {
        warn(scene);
        // A scene that cannot be charted leaves the others their charts.
        let problem = match Problem::of(scene) {
            Err(error @ LabError::Unsupported { .. }) => {
                eprintln!("{error}; it gets no chart");
                continue;
            }
            problem => problem?,
        };
        let key = key(&problem, &options);
        let finished = gallery.finished(name, &key);
        let is_new = finished.is_none();
        let chart = match finished {
            Some(chart) => chart,
            None => match measured(&problem, &options, &gallery, &key) {
                // Nor does one that has no reference take them from others.
                Err(CliError::Lab(error @ LabError::Unsupported { .. })) => {
                    eprintln!("{error}; it gets no chart");
                    continue;
                }
                chart => chart?,
            },
        };
        // What is read from JSON may differ in its last bits, so a table that is there is left as it is.
        if is_new || !gallery.is_drawn(name) {
            gallery.keep(&key, &chart)?;
            gallery.write_page()?;
        }
        let how = if is_new { "measured" } else { "measured before" };
        let file = gallery.file(name, "svg");
        writeln!(out, "{name}: {} runs, {how}; {}", chart.points.len(), file.display()).map_err(CliError::stdout)?;
        let (study, how) = match studied(&problem, &options, &gallery, &key) {
            Err(CliError::Lab(error @ LabError::Unsupported { .. })) => {
                eprintln!("{error}; what its stiffness costs is not studied");
                continue;
            }
            study => study?,
        };
        let (verdict, file) = (stiffness::verdict(&study), gallery.file(&study_stem(name), "svg"));
        writeln!(out, "{name}: {verdict} {how}; {}", file.display()).map_err(CliError::stdout)?;
    }
    let page = gallery.write_page()?;
    writeln!(out, "all charts: {}", page.display()).and_then(|()| out.flush()).map_err(CliError::stdout)?;
    Ok(Outcome::Done)
}

/// Reads all scenes before any is measured, by the names that their files will have.
fn loaded(names: &[String]) -> Result<BTreeMap<String, LoadedScene>, CliError> {
    let all: Vec<String> = match names {
        [] => library::list(SCENE).into_keys().collect(),
        names => names.to_vec(),
    };
    let mut scenes = BTreeMap::new();
    for name in &all {
        let scene = scenes::load(name)?;
        let stem = scene.source.stem();
        if let Some(other) = scenes.insert(stem.clone(), scene) {
            return Err(CliError::Usage(format!(
                "{name}: the files of its chart would have the same names as those of {}; give `{stem}` once",
                other.source
            )));
        }
    }
    if let Some(name) = scenes.keys().find(|name| scenes.contains_key(&study_stem(name))) {
        return Err(CliError::Usage(format!(
            "{}: the files of its chart would have the same names as those of the stiffness of `{name}`; chart it into another folder",
            study_stem(name)
        )));
    }
    Ok(scenes)
}

/// The number changes with what is measured of a run.
const POINTS: &str = "points 2";

/// What a chart depends on: a chart is measured again when this has changed.
fn key(problem: &Problem, options: &SweepOptions) -> String {
    let Problem { title, setting, time_scale, budget, unit, .. } = problem;
    let methods = Method::ALL.map(Method::name).join(" ");
    let version = env!("CARGO_PKG_VERSION");
    let build = if IS_DEBUG_BUILD { "debug" } else { "release" };
    let quick = options.quick;
    format!(
        "{:032x} {title:?} {setting:?} scale {time_scale} budget {budget} {unit:?} quick {quick} {methods} {version} {build} {POINTS}",
        problem.hash()
    )
}

fn measured(
    problem: &Problem,
    options: &SweepOptions,
    gallery: &Gallery,
    key: &str,
) -> Result<WorkPrecision, CliError> {
    let bar = progress_of(&problem.name, "runs");
    bar.set_message("reference");
    bar.tick();
    let (problem, truth) = Truth::as_far_as_known(problem.clone(), &options.cache)?;
    let problem = &problem;
    let mut partial = gallery.partial(&problem.name, key)?;
    if !partial.is_empty() {
        bar.suspend(|| eprintln!("{}: going on after {} runs", problem.name, partial.len()));
    }
    let mut point = |setting| match partial.known(setting) {
        Some(point) => Ok(point),
        None => {
            let point = measure(problem, &truth, setting, options.repeats());
            partial.push(point)?;
            Ok::<_, GalleryError>(point)
        }
    };
    let chart = resumed_sweep(problem, &truth, options, &mut point, &mut |done, all, what| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    })?;
    bar.finish_and_clear();
    Ok(chart)
}

/// The study of stiffness of a scene, and whether it was measured now.
fn studied(
    problem: &Problem,
    options: &SweepOptions,
    gallery: &Gallery,
    key: &str,
) -> Result<(StiffnessStudy, &'static str), CliError> {
    let key = format!("{key} stiffness {:?}", factors(options.quick));
    let finished = gallery.finished_study(&problem.name, &key);
    let how = if finished.is_some() { "Measured before" } else { "Measured" };
    if let Some(study) = finished {
        if !gallery.is_study_drawn(&problem.name) {
            gallery.keep_study(&key, &study)?;
        }
        return Ok((study, how));
    }
    let bar = progress_of(&problem.name, "runs");
    // What has no reference leaves nothing begun.
    bar.set_message("reference");
    options.cache.reference(problem)?;
    let mut partial = gallery.partial_study(&problem.name, &key)?;
    if !partial.is_empty() {
        bar.suspend(|| eprintln!("{}: going on after {} runs", study_stem(&problem.name), partial.len()));
    }
    let mut find = |factor, stiff: &Problem, truth: &Truth, method| match partial.known(factor, method) {
        Some(run) => Ok(run),
        None => {
            let run = StiffRun { method, run: cheapest_run(stiff, truth, method, options) };
            partial.push(StudiedRun { factor, run })?;
            Ok::<_, CliError>(run)
        }
    };
    let study = resumed_stiffness_study(problem, options, &mut find, &mut |done, all, what| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(what.to_owned());
    })?;
    bar.finish_and_clear();
    gallery.keep_study(&key, &study)?;
    gallery.write_page()?;
    Ok((study, how))
}
