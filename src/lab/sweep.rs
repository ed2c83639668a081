//! Speed against accuracy: every method over many steps, from its stability edge downwards.

use core::convert::Infallible;

use crate::{
    mechanics::integrators::{Method, StickRule},
    scenes::{DOCUMENT_DT, LoadedScene},
};

use super::{
    Cache, Edge, LabError, Point, Problem, Setting, Truth, Unit, WorkPrecision,
    limits::edges,
    machine::machine,
    run::{measure, steps_to, stick_matters},
};

/// How a sweep is done.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// Eight steps a method, each timed three times, instead of all down to the document's step, each timed twenty times.
    pub quick: bool,
    /// Where references are kept.
    pub cache: Cache,
}

impl Default for SweepOptions {
    fn default() -> Self {
        Self { quick: false, cache: Cache::of_platform() }
    }
}

/// Fewer steps than this no method gets, unless they take too long.
const LEAST_STEPS: usize = 8;

impl SweepOptions {
    /// How often a point is timed.
    pub fn repeats(&self) -> usize {
        if self.quick { 3 } else { 20 }
    }

    /// How many spring updates one run may take.
    fn most_work(&self) -> f64 {
        if self.quick { 1e8 } else { 1e9 }
    }
}

/// Runs every method over its steps and compares with the truth of the scene's budget, but for the one that tells the truth of speeds or shapes and those that cannot step its bodies. Methods that let friction act in their stages are run once more with friction at
/// the end of the step, where that makes a difference. The setting of the scene and that of the document are among the points. `progress` hears
/// after every point how many of how many are done and what comes next or is left out; left out are methods whose run at the stability edge takes more than a thousand million spring
/// updates (a hundred million in a quick sweep).
///
/// # Errors
/// If the truth cannot be had; see [`Truth::as_far_as_known`].
pub fn work_precision(
    scene: &LoadedScene,
    options: &SweepOptions,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> Result<WorkPrecision, LabError> {
    let problem = Problem::of(scene)?;
    progress(0, 1, "reference");
    let (problem, truth) = Truth::as_far_as_known(problem, &options.cache)?;
    Ok(sweep(&problem, &truth, options, progress))
}

/// As [`work_precision`], of a problem whose truth is known.
pub fn sweep(
    problem: &Problem,
    truth: &Truth,
    options: &SweepOptions,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> WorkPrecision {
    let measure = &mut |setting| Ok::<_, Infallible>(measure(problem, truth, setting, options.repeats()));
    let Ok(chart) = resumed_sweep(problem, truth, options, measure, progress);
    chart
}

/// As [`sweep`], with points by `measure`, which may know some of them already; see [`measure`].
///
/// # Errors
/// The first one of `measure`.
pub fn resumed_sweep<E>(
    problem: &Problem,
    truth: &Truth,
    options: &SweepOptions,
    measure: &mut dyn FnMut(Setting) -> Result<Point, E>,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> Result<WorkPrecision, E> {
    progress(0, 1, "stability edges");
    let edges = edges(problem);
    let plan = plan(problem, truth, &edges, options, progress);
    let mut points: Vec<Point> = Vec::with_capacity(plan.len());
    for (done, &setting) in plan.iter().enumerate() {
        progress(done, plan.len(), &format!("{} with dt {}", setting.method.name(), setting.dt));
        points.push(measure(setting)?);
    }
    progress(plan.len(), plan.len(), "done");
    Ok(WorkPrecision {
        scene: problem.name.clone(),
        title: problem.title.clone(),
        duration: problem.duration,
        real_time: problem.duration / problem.time_scale,
        points,
        edges,
        setting: problem.setting,
        unit: truth.unit(),
        budget: problem.budget,
        reference: reference_words(problem, truth),
        reference_error: truth.error(),
        machine: machine(),
    })
}

/// What the reference is and what confirms it, and why it may end early.
fn reference_words(problem: &Problem, truth: &Truth) -> String {
    let words = truth.words();
    if problem.shortened {
        format!("{words}; until t = {}, since later motion depends on roundings", problem.duration)
    } else {
        words.into()
    }
}

/// The document's setting: half a millisecond, semi-implicit Euler.
pub(super) const DOCUMENT: Setting =
    Setting { method: Method::SemiImplicitEuler, stick: StickRule::InStages, dt: DOCUMENT_DT };

/// All settings, method by method and from the largest step down.
fn plan(
    problem: &Problem,
    truth: &Truth,
    edges: &[Edge],
    options: &SweepOptions,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> Vec<Setting> {
    // Of gaits and blocks on the ground the document does not speak.
    let document = Some(DOCUMENT).filter(|_| truth.unit() == Unit::Length);
    let mut plan = Vec::new();
    for &edge in edges.iter().filter(|edge| truth.may_judge(problem, edge.method)) {
        let method = edge.method;
        let ladder = ladder(problem, edge, options);
        if ladder.is_empty() {
            progress(plan.len(), plan.len(), &format!("left out: {}, which takes too long", method.name()));
        }
        for stick in StickRule::ALL {
            let own: Vec<_> = document
                .into_iter()
                .chain([problem.setting])
                .filter(|own| (own.method, own.stick) == (method, stick))
                .collect();
            let is_other = stick == StickRule::InStages || stick_matters(problem, method, stick);
            let mut steps = if is_other { ladder.clone() } else { Vec::new() };
            steps.extend(own.iter().map(|own| own.dt));
            steps.sort_by(|a, b| b.total_cmp(a));
            steps.dedup();
            plan.extend(steps.into_iter().map(|dt| Setting { method, stick, dt }));
        }
    }
    plan
}

/// The steps of a method: one above its stability edge, to see it fail, then eight at least from the edge down by halves, and as far as the
/// document's step; by less than halves where eight of those would take too long, and none where already the first does. A method without an edge starts
/// at an eighth of the period.
fn ladder(problem: &Problem, edge: Edge, options: &SweepOptions) -> Vec<f64> {
    let (above, largest) = match edge.dt {
        dt if dt > 0.0 && dt < problem.duration / 10.0 => (Some(2.0 * dt), dt),
        _ => (None, problem.period.unwrap_or(problem.duration / 10.0) / 8.0),
    };
    let least = problem.duration / (options.most_work() / work_a_step(problem, edge.method)).floor();
    if least > largest {
        return Vec::new();
    }
    let halves = || (0..30).map(|halvings| largest / f64::from(1_u32 << halvings));
    let eighth = halves().nth(LEAST_STEPS - 1).unwrap_or(largest);
    let down: Vec<_> = if eighth < least {
        let part = |i: usize| i as f64 / (LEAST_STEPS - 1) as f64;
        (0..LEAST_STEPS).map(|i| least.max(largest * libm::pow(least / largest, part(i)))).collect()
    } else {
        let wanted =
            |&(i, dt): &(usize, f64)| i < LEAST_STEPS || (!options.quick && dt >= least.max(0.5 * DOCUMENT_DT));
        halves().enumerate().take_while(wanted).map(|(_, dt)| dt).collect()
    };
    above.into_iter().chain(down).collect()
}

/// About how many spring updates a run takes.
pub(super) fn work(problem: &Problem, method: Method, dt: f64) -> f64 {
    steps_to(problem.duration, dt) as f64 * work_a_step(problem, method)
}

/// About how many spring updates a step takes.
fn work_a_step(problem: &Problem, method: Method) -> f64 {
    /// Of methods that do not know before how often they evaluate the forces.
    const MANY: u64 = 20;
    let springs: usize = problem.bodies.iter().map(|body| body.springs.len().max(body.particles.len())).sum();
    (method.about().evaluations.unwrap_or(MANY) * springs as u64) as f64
}
