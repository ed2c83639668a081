//! Which method and step are the cheapest that are good enough.
//!
//! With friction an error is not monotone in the step: a run may be good by accident. The error of a candidate is therefore the worst over its
//! step and over 0.9 and 0.8 of it. Its cost is counted in evaluations of the forces; that of methods which do more between evaluations, or whose
//! evaluations cannot be counted before, is the time they take in units of an evaluation of RK4.

use serde::Serialize;

use crate::mechanics::integrators::{Method, StickRule};

use super::{
    LabError, Problem, Setting, Truth, Unit,
    run::{stepping, steps_to, stick_matters},
    sweep::{DOCUMENT, work},
};

/// A method with a step, judged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Candidate {
    /// The method and its step.
    pub setting: Setting,
    /// The largest error over the step and 0.9 and 0.8 of it, in the unit of the budget; `None` where one of them blows up.
    pub error: Option<f64>,
    /// What a run of the problem costs, in evaluations of the forces of a body by RK4.
    pub cost: f64,
}

/// What was found for a problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// The scene's name.
    pub scene: String,
    /// The simulated time of a run.
    pub duration: f64,
    /// Whether that is less than ten cycles, since nobody knows how the motion goes on.
    pub shortened: bool,
    /// The error that the scene can afford.
    pub budget: f64,
    /// What an error is.
    pub unit: Unit,
    /// The cheapest candidate within the budget.
    pub choice: Candidate,
    /// The scene's own setting, judged in the same way.
    pub own: Candidate,
    /// The document's setting, judged in the same way; nothing where gaits or blocks are judged, of which that document does not speak.
    pub document: Option<Candidate>,
    /// The candidates that no other beats in both error and cost, from the cheapest up.
    pub frontier: Vec<Candidate>,
    /// How far the reference is from what confirms it.
    pub reference_error: f64,
}

/// How far to look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// Only as far as the cheapest can be; the frontier is incomplete, and the errors of what is not good enough are of the first run that says so.
    Cheapest,
    /// Every method down to a thousandth of the budget, or to where others beat it by far, for the whole frontier.
    Frontier,
}

/// The cheapest candidate whose error is within the budget; of two that cost the same, the more exact.
pub fn cheapest(candidates: &[Candidate], budget: f64) -> Option<Candidate> {
    let fits = candidates.iter().filter(|candidate| candidate.error.is_some_and(|error| error <= budget));
    fits.copied().min_by(order)
}

/// The candidates that no other beats in both error and cost, from the cheapest up.
pub fn frontier(candidates: &[Candidate]) -> Vec<Candidate> {
    let mut sorted: Vec<_> = candidates.iter().copied().filter(|candidate| candidate.error.is_some()).collect();
    sorted.sort_by(order);
    let mut least = f64::INFINITY;
    sorted.retain(|candidate| {
        let error = candidate.error.unwrap_or(f64::INFINITY);
        let better = error < least;
        least = least.min(error);
        better
    });
    sorted
}

fn order(a: &Candidate, b: &Candidate) -> core::cmp::Ordering {
    let error = |candidate: &Candidate| candidate.error.unwrap_or(f64::INFINITY);
    a.cost.total_cmp(&b.cost).then(error(a).total_cmp(&error(b)))
}

/// Finds the cheapest method and step within the problem's budget, with a step of at most half of the stability limit. `progress` hears how many of how
/// many methods are done and which comes next.
///
/// # Errors
/// If nothing that was tried is within the budget.
pub fn choose(
    problem: &Problem,
    truth: &Truth,
    search: Search,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> Result<Choice, LabError> {
    let (unit, budget) = (truth.unit(), problem.budget);
    let judge = Judge { problem, truth, budget, evaluation: seconds_an_evaluation(problem) };
    let mut methods: Vec<_> = Method::ALL.into_iter().filter(|method| truth.may_judge(problem, *method)).collect();
    // Those that are likely to be cheap come first, so that the others need not be followed far.
    methods.sort_by_key(|method| core::cmp::Reverse(method.about().order));
    let mut candidates = Vec::new();
    for (done, &method) in methods.iter().enumerate() {
        progress(done, methods.len(), method.name());
        for stick in StickRule::ALL {
            if stick == StickRule::InStages || stick_matters(problem, method, stick) {
                let steps = steps(problem, method, stick);
                follow(&judge, method, stick, &steps, search, &mut candidates);
            }
        }
    }
    progress(methods.len(), methods.len(), "done");
    let choice =
        cheapest(&candidates, budget).ok_or_else(|| LabError::NothingFits { scene: problem.name.clone(), budget })?;
    Ok(Choice {
        scene: problem.name.clone(),
        duration: problem.duration,
        shortened: problem.shortened,
        budget,
        unit,
        choice,
        own: judge.candidate(problem.setting),
        document: (unit == Unit::Length).then(|| judge.candidate(DOCUMENT)),
        frontier: frontier(&candidates),
        reference_error: truth.error(),
    })
}

/// Judges the steps of one method from the largest down, as far as they can matter.
fn follow(
    judge: &Judge<'_>,
    method: Method,
    stick: StickRule,
    steps: &[f64],
    search: Search,
    candidates: &mut Vec<Candidate>,
) {
    /// Nobody waits for more spring updates in one run.
    const MOST_WORK: f64 = 2e8;
    /// After an octave of steps beaten by far, smaller ones will not change that.
    const HOPELESS: usize = 4;
    /// Beaten by far: a cheaper candidate has so much less of an error.
    const FAR: f64 = 4.0;
    let budget = judge.budget;
    // Frontiers end at so much of the budget. Speeds and shapes are told by a method that is not much more exact than those that it judges.
    let little = match judge.truth.unit() {
        Unit::Length => 1e-3,
        Unit::PartOfSpeed => 0.25,
        Unit::PartOfCell => 0.05,
    };
    let mut beaten = 0;
    // The largest step that is still to be tried. What is good enough is only followed in octaves.
    let mut most = f64::INFINITY;
    for &dt in steps {
        if dt > most {
            continue;
        }
        let setting = Setting { method, stick, dt };
        if work(judge.problem, method, dt) > MOST_WORK {
            return;
        }
        let cost = judge.cost(setting);
        let is_dear = || cheapest(candidates, budget).is_some_and(|best| cost > best.cost);
        if search == Search::Cheapest && is_dear() {
            return;
        }
        // So much of an error is beaten by far; `None` where nothing is as cheap.
        let rivals = candidates.iter().filter(|other| other.cost <= cost).filter_map(|other| other.error);
        let far = rivals.reduce(f64::min).map(|least| FAR * least);
        // A run that settles it is enough: what is beaten by a part of its steps is beaten by all of them.
        let settled = |error: f64| match search {
            Search::Cheapest => error > budget,
            Search::Frontier => far.is_some_and(|far| error >= far),
        };
        let candidate = Candidate { setting, error: worst_error(judge.problem, judge.truth, setting, settled), cost };
        let is_beaten = far.is_some_and(|far| candidate.error.is_none_or(|error| error >= far));
        beaten = if is_beaten { beaten + 1 } else { 0 };
        candidates.push(candidate);
        if beaten == HOPELESS {
            return;
        }
        let enough = match search {
            Search::Cheapest => budget,
            // Nothing can be said of errors that the truth itself may have.
            Search::Frontier => judge.truth.error().max(little * budget),
        };
        if candidate.error.is_some_and(|error| error <= enough) {
            return;
        }
        if candidate.error.is_some_and(|error| error <= budget) {
            most = 0.5 * dt * (1.0 + 1e-9);
        }
    }
}

/// The steps to try, from half of the stability limit down in fourths of octaves, in round numbers.
pub(super) fn steps(problem: &Problem, method: Method, stick: StickRule) -> Vec<f64> {
    const A_STEP: f64 = 0.840_896_415_253_714_5; // 2^(−¼)
    let without_limit = problem.period.unwrap_or(problem.duration / 10.0) / 8.0;
    let largest = (0.5 * problem.stability_limit(method, stick)).min(without_limit);
    if largest <= 0.0 {
        return Vec::new();
    }
    let down = core::iter::successors(Some(largest), |dt| Some(dt * A_STEP));
    let least = (0.25 * DOCUMENT.dt).min(0.1 * largest);
    let mut steps: Vec<_> = down.take_while(|&dt| dt > least).map(rounded_down).collect();
    steps.dedup();
    steps
}

/// The largest number of two digits that is not above.
fn rounded_down(dt: f64) -> f64 {
    let unit = libm::pow(10.0, libm::floor(libm::log10(dt)) - 1.0);
    // Read back from its digits, it is the number that one would write.
    format!("{:.1e}", (dt / unit + 1e-9).floor() * unit).parse().unwrap_or(dt)
}

/// The largest error over the step and 0.9 and 0.8 of it, or of the first of them where that settles it; `None` where one of them blows up.
pub(super) fn worst_error(
    problem: &Problem,
    truth: &Truth,
    setting: Setting,
    settled: impl Fn(f64) -> bool,
) -> Option<f64> {
    let mut worst = 0.0;
    for part in [1.0, 0.9, 0.8] {
        worst = f64::max(worst, truth.errors_of(problem, Setting { dt: part * setting.dt, ..setting })?.largest);
        if settled(worst) {
            break;
        }
    }
    Some(worst)
}

/// What candidates are judged with.
struct Judge<'a> {
    problem: &'a Problem,
    truth: &'a Truth,
    budget: f64,
    /// How many seconds RK4 takes for an evaluation.
    evaluation: f64,
}

impl Judge<'_> {
    fn candidate(&self, setting: Setting) -> Candidate {
        let error = worst_error(self.problem, self.truth, setting, |_| false);
        Candidate { setting, error, cost: self.cost(setting) }
    }

    fn cost(&self, setting: Setting) -> f64 {
        /// So many steps can be timed.
        const LEAST_TIMED: u64 = 200;
        let steps = steps_to(self.problem.duration, setting.dt);
        match setting.method.about().evaluations {
            Some(_) if setting.stick == StickRule::Located => stepping(self.problem, setting, steps).1 as f64,
            Some(evaluations) => (steps * evaluations) as f64 * self.problem.bodies.len() as f64,
            None => {
                // A cycle tells what a step costs: a run lasts ten.
                let timed = steps.min((steps / 10).max(LEAST_TIMED));
                least_seconds(self.problem, setting, timed) / self.evaluation * (steps as f64 / timed as f64)
            }
        }
    }
}

fn seconds_an_evaluation(problem: &Problem) -> f64 {
    let method = Method::RungeKutta4;
    let limit = problem.stability_limit(method, StickRule::InStages).min(0.01 * problem.duration);
    let setting = Setting { method, stick: StickRule::InStages, dt: 0.5 * limit };
    /// Enough to be timed.
    const STEPS: u64 = 2000;
    let (_, evaluations) = stepping(problem, setting, STEPS);
    least_seconds(problem, setting, STEPS) / evaluations.max(1) as f64
}

/// The shortest of a few runs.
fn least_seconds(problem: &Problem, setting: Setting, steps: u64) -> f64 {
    (0..5).map(|_| stepping(problem, setting, steps).0).fold(f64::INFINITY, f64::min)
}
