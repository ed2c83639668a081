//! The cheapest run of a method that is good enough.

use crate::{
    lab::{
        Point, Problem, Setting, SweepOptions, Truth,
        choose::{steps, worst_error},
        run::measure,
        sweep::work,
    },
    mechanics::integrators::{Method, StickRule},
};

/// How many spring updates a run may take.
const MOST_WORK: f64 = 1e8;

/// Goes down from half of the stability limit to the first step that is good enough by the rule of [`choose`](crate::lab::choose()): the worst error
/// over the step and 0.9 and 0.8 of it is within the budget. A run costs the less the larger its step is, so this one is the cheapest; it is timed.
///
/// A run that takes longer than anybody waits for at so many factors is not tried.
pub fn cheapest_run(problem: &Problem, truth: &Truth, method: Method, options: &SweepOptions) -> Option<Point> {
    let stick = StickRule::InStages;
    let settings = steps(problem, method, stick).into_iter().map(|dt| Setting { method, stick, dt });
    let mut short = settings.take_while(|setting| work(problem, method, setting.dt) <= MOST_WORK);
    let fails = |error| error > problem.budget;
    let good = |setting: &Setting| worst_error(problem, truth, *setting, fails).is_some_and(|error| !fails(error));
    short.find(good).map(|setting| measure(problem, truth, setting, options.repeats()))
}
