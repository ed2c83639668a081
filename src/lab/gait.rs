//! How fast the animals of a scene go: what is asked of scenes whose trajectories no reference follows, since contacts are located in none.

use bevy::math::DVec2;

use crate::mechanics::integrators::{Method, StickRule};

use super::{
    LabError, Problem, ProblemBody, Setting,
    run::{Run, center},
};

/// The speeds of the gaits of a problem's bodies, by a method that is no candidate and in small steps.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitSpeeds {
    speeds: Vec<f64>,
    error: f64,
}

impl GaitSpeeds {
    /// The method that tells them.
    pub const METHOD: Method = Method::RungeKutta4;

    /// Steps all bodies in a sixteenth of the scene's step, and in an eighth to see how far the speeds can be trusted.
    ///
    /// # Errors
    /// If a body blows up, or both steps tell speeds that are farther apart than the problem's budget.
    pub fn solve(problem: &Problem) -> Result<Self, LabError> {
        let unsure = |what| LabError::Unsupported { scene: problem.name.clone(), what };
        let limit = problem.stability_limit(Self::METHOD, StickRule::InStages);
        let largest = problem.setting.dt.min(0.5 * limit);
        let fine = |parts: f64| {
            let setting = Setting { method: Self::METHOD, stick: StickRule::InStages, dt: largest / parts };
            speeds(problem, setting).ok_or_else(|| unsure(format!("gaits that blow up with dt = {}", setting.dt)))
        };
        let reference = Self { speeds: fine(16.0)?, error: 0.0 };
        let error = reference.apart(&fine(8.0)?);
        if problem.gait_speed.is_some_and(|budget| error > budget) {
            return Err(unsure(format!(
                "gaits whose speeds change by {:.2} % when steps that are small become twice as large",
                100.0 * error
            )));
        }
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

    /// The largest part by which a method misses the speed of a body; nothing where one blows up.
    pub(super) fn error_of(&self, problem: &Problem, setting: Setting) -> Option<f64> {
        Some(self.apart(&speeds(problem, setting)?))
    }

    /// The largest difference as a part of a body's speed. What is meant to stay where it is has no speed to be compared with: it may move at its
    /// part of a tenth of the fastest's.
    fn apart(&self, others: &[f64]) -> f64 {
        let fastest = self.speeds.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let pairs = self.speeds.iter().zip(others);
        pairs.map(|(own, other)| (own - other).abs() / own.max(0.1 * fastest)).fold(0.0, f64::max)
    }
}

/// The speed of each body; nothing where one blows up.
fn speeds(problem: &Problem, setting: Setting) -> Option<Vec<f64>> {
    let whole = problem.duration / 10.0;
    let speed = |body: &ProblemBody| {
        let last = (4.0 * body.period().unwrap_or(whole)).min(problem.duration);
        let on_axis = body.parts(setting.method, setting.stick).on_axis();
        let way = if on_axis { way::<1> } else { way::<3> };
        Some(way(body, setting, [problem.duration - last, problem.duration])? / last)
    };
    problem.bodies.iter().map(speed).collect()
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
