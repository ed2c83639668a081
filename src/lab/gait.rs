//! How fast the animals of a scene go: what is asked of scenes whose trajectories no reference follows, since contacts are located in none.

use bevy::math::DVec2;

use crate::mechanics::integrators::{Method, StickRule};

use super::{
    Errors, LabError, Problem, ProblemBody, Setting,
    run::{Run, center, penetration},
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
    pub const WORDS: &str = "the speed of each gait over its last four cycles, or all of them, by Runge–Kutta 4 in a sixteenth of the scene's step, confirmed by an eighth";

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
            all_gaits(problem, setting).map(speeds).ok_or_else(|| blown(setting.dt))
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
        let gaits = all_gaits(problem, setting)?;
        let penetration = gaits.iter().filter_map(|gait| gait.penetration).reduce(f64::max);
        let others = speeds(gaits);
        let parts: Vec<_> = self.parts(&others).collect();
        let ways = problem.bodies.iter().zip(self.speeds.iter().zip(&others));
        Some(Errors {
            largest: parts.iter().copied().fold(0.0, f64::max),
            rms: (parts.iter().map(|part| part * part).sum::<f64>() / parts.len().max(1) as f64).sqrt(),
            distance: ways.map(|(body, (own, other))| (own - other).abs() * cycles(problem, body)).fold(0.0, f64::max),
            cycle: None,
            energy: None,
            penetration,
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

/// How a body goes.
#[derive(Clone, Copy, Debug)]
struct Gait {
    speed: f64,
    /// How deep any particle ever was below the ground.
    penetration: Option<f64>,
}

fn speeds(gaits: Vec<Gait>) -> Vec<f64> {
    gaits.into_iter().map(|gait| gait.speed).collect()
}

/// How each body goes, each on a thread of its own; nothing where one blows up.
fn all_gaits(problem: &Problem, setting: Setting) -> Option<Vec<Gait>> {
    let gait = |body: &ProblemBody| {
        let on_axis = body.parts(setting.method, setting.stick).on_axis();
        let gait = if on_axis { gait::<1> } else { gait::<3> };
        gait(body, setting, problem.duration, cycles(problem, body))
    };
    let mut gaits = vec![None; problem.bodies.len()];
    std::thread::scope(|scope| {
        for (body, found) in problem.bodies.iter().zip(&mut gaits) {
            scope.spawn(move || *found = gait(body));
        }
    });
    gaits.into_iter().collect()
}

/// How fast the centre of mass goes over the `last` part of a run, seen from above, and how deep the body comes.
fn gait<const D: usize>(body: &ProblemBody, setting: Setting, duration: f64, last: f64) -> Option<Gait> {
    /// At so many times it is seen how deep it is, evenly until the end.
    const TIMES: usize = 200;
    let (mut run, mut positions) = (Run::<D>::new(body, setting, 0.0), Vec::new());
    let mut penetration = None;
    let mut above = |time| {
        run.positions_at(body, time, &mut positions)?;
        penetration = penetration.into_iter().chain(self::penetration(body, &positions)).reduce(f64::max);
        let at = center(body, &positions);
        Some(DVec2::new(at.x, at.z))
    };
    let start = duration - last;
    let times = || (1..TIMES).map(|i| duration * (i as f64 / TIMES as f64));
    for time in times().take_while(|&time| time < start) {
        above(time)?;
    }
    let from = above(start)?;
    for time in times().skip_while(|&time| time <= start) {
        above(time)?;
    }
    let speed = above(duration)?.distance(from) / last;
    Some(Gait { speed, penetration })
}
