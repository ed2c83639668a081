//! `wriggle run`: a scene or creature without a picture.

use std::{
    fs::File,
    io::{self, BufWriter, Write},
    time::Instant,
};

use bevy::tasks::ComputeTaskPool;
use clap::Args;

use super::{
    CliError, Headless, Outcome,
    progress::progress,
    report::{Report, write_record, write_record_head},
    values, warn,
};
use crate::{
    body::Rules,
    mechanics::integrators::Method,
    physics::body_parts,
    scenes::{self, parameters},
};

/// What is run where `--for` does not say how long.
const DEFAULT_TIME: f64 = 60.0;
/// What moves a scene of creatures without springs.
const SIX_MATRIX: &str = "SixMatrix";
/// More steps than anybody waits for.
const MOST_STEPS: f64 = 1e12;

#[derive(Args, Debug, Default)]
pub(super) struct RunArguments {
    /// A scene or creature by name, or a file (`*.scene.ron`, `*.creature.ron`)
    scene: String,
    /// For how long, in simulated time; a whole number of dt [default: 60]
    #[arg(long = "for", allow_negative_numbers = true, value_name = "T", value_parser = values::non_negative)]
    time: Option<f64>,
    /// The step, in simulated time [default: the scene's]
    #[arg(long, allow_negative_numbers = true, value_name = "DT", value_parser = values::positive)]
    dt: Option<f64>,
    /// The method of integration [default: the scene's]
    #[arg(long, value_name = "NAME", value_parser = values::method)]
    method: Option<Method>,
    /// Set a parameter, as often as needed; `wriggle list --paths SCENE` prints the paths
    #[arg(long, value_name = "PATH=VALUE", value_parser = values::assignment)]
    set: Vec<(String, f64)>,
    /// Write every particle's position and velocity as CSV; `-` for standard output
    #[arg(long, value_name = "F.csv")]
    record: Option<String>,
    /// How often to record, in simulated time; a whole number of dt [default: every step]
    #[arg(long, allow_negative_numbers = true, value_name = "T", value_parser = values::positive, requires = "record")]
    every: Option<f64>,
    /// Print the result as one JSON object
    #[arg(long)]
    json: bool,
    /// How many threads the bodies share [default: one a core]
    #[arg(long, allow_negative_numbers = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

pub(super) fn run(arguments: &RunArguments) -> Result<Outcome, CliError> {
    let to_stdout = arguments.record.as_deref() == Some("-");
    if to_stdout && arguments.json {
        return Err(CliError::Usage(
            "--json and --record - would both write to standard output; record to a file".into(),
        ));
    }
    if let Some(place) = arguments.record.as_deref().filter(|place| place.ends_with(".ron")) {
        return Err(CliError::Usage(format!(
            "--record {place} would put a table where scenes and creatures are; give a name that ends in .csv"
        )));
    }
    if arguments.dt.is_some() && arguments.set.iter().any(|(path, _)| path == "clock.dt") {
        return Err(CliError::Usage("--dt and --set clock.dt would both give the step; give one of them".into()));
    }
    let mut scene = scenes::load(&arguments.scene)?;
    if let Some(method) = arguments.method {
        scene.file.method = method;
    }
    warn(&scene);
    let (name, method) = (scene.source.stem(), scene.file.method);
    let mut run = Headless::new(scene, arguments.threads.map(usize::from))?;
    let only_six = run.bodies().next().is_some() && run.bodies().all(|(_, body, _)| body.contains::<Rules>());
    if arguments.method.is_some() && only_six {
        return Err(CliError::Usage(
            "--method is for bodies with springs; those of this scene move by the six-matrix particle system".into(),
        ));
    }
    let method = if only_six { SIX_MATRIX } else { method.name() };
    if let Some(dt) = arguments.dt {
        parameters::set(run.world_mut(), "clock.dt", dt)?;
    }
    for (path, value) in &arguments.set {
        parameters::set(run.world_mut(), path, *value)?;
    }
    for (name, body, _) in run.bodies() {
        if let Some(reason) = body_parts(body).and_then(|body| body.refused_by_method()) {
            return Err(CliError::Usage(format!(
                "the method of `{name}` cannot step it: {reason}; give another method"
            )));
        }
    }
    let (steps, interval) = lengths(arguments, &run)?;

    let mut record = arguments.record.as_deref().map(Record::create).transpose()?;
    let started = Instant::now();
    let mut report = Report::start(name, method, &run);
    let bar = progress("{wide_bar} {percent:>3} %  {human_pos}/{human_len} steps  {eta} left", Some(steps));
    let mut done = 0;
    if let Some(record) = &mut record {
        record.write(|out| write_record_head(out).and_then(|()| write_record(out, &run)))?;
    }
    report.watch(&run);
    let sampling = report.steps_between_samples(&run);
    while done < steps {
        let after = |every: u64| (done / every + 1).saturating_mul(every);
        let next = after(interval).min(sampling.map_or(steps, after)).min(steps);
        let said = run.step(next - done);
        if !said.is_empty() {
            bar.suspend(|| said.iter().for_each(|line| eprintln!("{line}")));
        }
        done = next;
        bar.set_position(done);
        report.watch(&run);
        if let Some(record) = &mut record
            && done.is_multiple_of(interval)
        {
            record.write(|out| write_record(out, &run))?;
        }
    }
    if let Some(record) = &mut record {
        record.write(|out| out.flush())?;
    }
    bar.finish_and_clear();
    report.finish(&run, started.elapsed().as_secs_f64(), ComputeTaskPool::get().thread_num());
    print(arguments, to_stdout, &report)?;
    Ok(if run.has_frozen() { Outcome::Frozen } else { Outcome::Done })
}

/// How many steps to take, and how many at a time.
fn lengths(arguments: &RunArguments, run: &Headless) -> Result<(u64, u64), CliError> {
    let dt = run.clock().dt();
    let steps = match arguments.time {
        Some(time) => values::steps_of_flag("--for", time, dt).map_err(CliError::Usage)?,
        // What nobody asked for need not be met to the last bit.
        None => match (DEFAULT_TIME / dt).round() {
            steps if (1.0..=MOST_STEPS).contains(&steps) => steps as u64,
            steps => {
                return Err(CliError::Usage(format!(
                    "{DEFAULT_TIME} units of time are {steps:e} steps of dt {dt:e}; say with --for how long to run"
                )));
            }
        },
    };
    let interval = match (arguments.every, &arguments.record) {
        (Some(every), _) => match values::steps_of_flag("--every", every, dt).map_err(CliError::Usage)? {
            0 => return Err(CliError::Usage(format!("--every {every} is less than a step of dt {dt}"))),
            interval => interval,
        },
        (None, Some(_)) => 1,
        // As many as keep the progress of a large scene moving; the same for every run of a scene.
        (None, None) => {
            (4_000_000 / run.bodies().map(|(_, _, body)| body.len() as u64).sum::<u64>().max(1)).clamp(1, 1000)
        }
    };
    Ok((steps, interval))
}

fn print(arguments: &RunArguments, to_stdout: bool, report: &Report) -> Result<(), CliError> {
    let text = if arguments.json {
        serde_json::to_string_pretty(report).map_err(|error| CliError::stdout(error.into()))?
    } else {
        report.to_string()
    };
    if to_stdout {
        eprintln!("{text}");
        return Ok(());
    }
    let mut out = io::stdout().lock();
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(CliError::stdout)
}

/// Where a recording goes.
struct Record {
    place: String,
    out: Box<dyn Write>,
}

impl RunArguments {
    /// A run of a scene as it is.
    pub(super) fn of(scene: &str) -> Self {
        Self { scene: scene.into(), ..Self::default() }
    }
}

impl Record {
    fn create(place: &str) -> Result<Self, CliError> {
        if place == "-" {
            return Ok(Self { place: "standard output".into(), out: Box::new(BufWriter::new(io::stdout())) });
        }
        let file = File::create(place).map_err(|error| CliError::Output { place: place.into(), error })?;
        Ok(Self { place: place.into(), out: Box::new(BufWriter::new(file)) })
    }

    fn write(&mut self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), CliError> {
        write(&mut *self.out).map_err(|error| CliError::Output { place: self.place.clone(), error })
    }
}
