//! How fast the animals of a scene go: what is asked of scenes whose trajectories no reference follows, since contacts are located in none.

use bevy::math::DVec2;

use crate::mechanics::integrators::{Method, StickRule};

use super::{
    Errors, LabError, Problem, ProblemBody, Setting,
    run::{Run, center},
};

/// The speeds of the gaits of a problem's bodies, by a method that is no candidate and in small steps.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitSpeeds {
    pub(super) speeds: Vec<f64>,
    pub(super) error: f64,
}

impl GaitSpeeds {
    /// The method that tells them.
    pub const METHOD: Method = Method::RungeKutta4;

    /// What they are and what confirms them.
    pub const WORDS: &str = "the speed of each gait over its last four cycles by Runge–Kutta 4 in a sixteenth of the scene's step, confirmed by an eighth";

    /// Steps all bodies in a sixteenth of the scene's step, and in an eighth to see how far the speeds can be trusted.
    ///
    /// # Errors
    /// If a body blows up.
    pub fn solve(problem: &Problem) -> Result<Self, LabError> {
        let blown = |dt| LabError::Unsupported {
            scene: problem.name.clone(),
            what: format!("gaits that blow up with dt = {dt}"),
        };
        let limit = problem.stability_limit(Self::METHOD, StickRule::InStages);
        let largest = problem.setting.dt.min(0.5 * limit);
        let fine = |parts: f64| {
            let setting = Setting { method: Self::METHOD, stick: StickRule::InStages, dt: largest / parts };
            all_speeds(problem, setting).ok_or_else(|| blown(setting.dt))
        };
        let reference = Self { speeds: fine(16.0)?, error: 0.0 };
        let error = reference.apart(&fine(8.0)?);
        Ok(Self { error, ..reference })
    }

    /// The speed of each body: how far its centre of mass comes along the ground in a unit of time, over the last four of its cycles.
    pub fn speeds(&self) -> &[f64] {
        &self.speeds
    }

    /// By which part of a speed they change when the steps become twice as large.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// By how much a method misses the speeds; nothing where a body blows up.
    pub(super) fn errors_of(&self, problem: &Problem, setting: Setting) -> Option<Errors> {
        let others = all_speeds(problem, setting)?;
        let parts: Vec<_> = self.parts(&others).collect();
        let ways = problem.bodies.iter().zip(self.speeds.iter().zip(&others));
        Some(Errors {
            largest: parts.iter().copied().fold(0.0, f64::max),
            rms: (parts.iter().map(|part| part * part).sum::<f64>() / parts.len().max(1) as f64).sqrt(),
            distance: ways.map(|(body, (own, other))| (own - other).abs() * cycles(problem, body)).fold(0.0, f64::max),
        })
    }

    /// The largest difference as a part of a body's speed.
    fn apart(&self, others: &[f64]) -> f64 {
        self.parts(others).fold(0.0, f64::max)
    }

    /// The differences as parts of the speeds. What is meant to stay where it is has no speed to be compared with: it may move at its part of a tenth of
    /// the fastest's.
    fn parts(&self, others: &[f64]) -> impl Iterator<Item = f64> {
        let fastest = self.speeds.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        self.speeds.iter().zip(others).map(move |(own, other)| (own - other).abs() / own.max(0.1 * fastest))
    }
}

/// The time over which the speed of a body is taken: its last four cycles.
fn cycles(problem: &Problem, body: &ProblemBody) -> f64 {
    (4.0 * body.period().unwrap_or(problem.duration / 10.0)).min(problem.duration)
}

/// The speed of each body, each on a thread of its own; nothing where one blows up.
fn all_speeds(problem: &Problem, setting: Setting) -> Option<Vec<f64>> {
    let speed = |body: &ProblemBody| {
        let last = cycles(problem, body);
        let on_axis = body.parts(setting.method, setting.stick).on_axis();
        let way = if on_axis { way::<1> } else { way::<3> };
        Some(way(body, setting, [problem.duration - last, problem.duration])? / last)
    };
    let mut speeds = vec![None; problem.bodies.len()];
    std::thread::scope(|scope| {
        for (body, found) in problem.bodies.iter().zip(&mut speeds) {
            scope.spawn(move || *found = speed(body));
        }
    });
    speeds.into_iter().collect()
}

/// How far the centre of mass comes between two times, seen from above.
fn way<const D: usize>(body: &ProblemBody, setting: Setting, times: [f64; 2]) -> Option<f64> {
    let (mut run, mut positions) = (Run::<D>::new(body, setting, 0.0), Vec::new());
    let mut above = |time| {
        run.positions_at(body, time, &mut positions)?;
        let at = center(body, &positions);
        Some(DVec2::new(at.x, at.z))
    };
    let start = above(times[0])?;
    Some(above(times[1])?.distance(start))
}
