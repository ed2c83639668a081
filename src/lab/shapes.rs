//! How the blocks of a scene fall, land and keep their shape: what is asked of scenes whose masses meet the ground at moments that no reference locates.

use crate::mechanics::{
    integrators::{Method, StickRule},
    metrics::BlockShape,
};

use super::{
    Errors, LabError, Problem, ProblemBody, Setting,
    run::{Run, center, penetration},
};

/// How many numbers say how a block is at a moment.
pub(super) const MEASURES: usize = 3;

/// A block on its way: its moments, and how deep any of its particles ever was below the ground.
type Way = (Vec<Moment>, Option<f64>);

/// A block at a moment: its shape error and the height of its centre of mass in spacings, and its volume over that of the undeformed grid.
type Moment = [f64; MEASURES];

/// The shapes of a problem's blocks at shared times, by a method that is no candidate and in small steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Shapes {
    /// Block by block, all times in order.
    pub(super) moments: Vec<Moment>,
    pub(super) error: f64,
}

impl Shapes {
    /// The method that tells them.
    pub const METHOD: Method = Method::RungeKutta4;

    /// What they are and what confirms them.
    pub const WORDS: &str = "shape error, height and volume of each block by Runge–Kutta 4 in a sixteenth of the scene's step, confirmed by an eighth";

    /// At so many times blocks are compared, evenly until the end.
    pub const TIMES: usize = 200;

    /// Steps all blocks in a sixteenth of the scene's step, and in an eighth to see how far the shapes can be trusted.
    ///
    /// # Errors
    /// If a body is no block on a grid, or blows up.
    pub fn solve(problem: &Problem) -> Result<Self, LabError> {
        let unsupported = |what| LabError::Unsupported { scene: problem.name.clone(), what };
        if let Some(other) = problem.bodies.iter().find(|body| body.lattice.is_none()) {
            return Err(unsupported(format!("the shape of `{}`, which is no block on a grid", other.name)));
        }
        let limit = problem.stability_limit(Self::METHOD, StickRule::InStages);
        let largest = problem.setting.dt.min(0.5 * limit);
        let fine = |parts: f64| {
            let setting = Setting { method: Self::METHOD, stick: StickRule::InStages, dt: largest / parts };
            all_moments(problem, setting)
                .map(|(moments, _)| moments)
                .ok_or_else(|| unsupported(format!("blocks that blow up with dt = {}", setting.dt)))
        };
        let reference = Self { moments: fine(16.0)?, error: 0.0 };
        let error = reference.differences(&fine(8.0)?).fold(0.0, f64::max);
        Ok(Self { error, ..reference })
    }

    /// By which part of a cell they change when the steps become twice as large.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// By how much a method misses the shapes; nothing where a block blows up.
    pub(super) fn errors_of(&self, problem: &Problem, setting: Setting) -> Option<Errors> {
        let (others, penetration) = all_moments(problem, setting)?;
        let square: f64 = self.differences(&others).map(|difference| difference * difference).sum();
        let last = |moments: &[Moment], body: usize| moments[(body + 1) * Self::TIMES - 1][1];
        let heights = (0..problem.bodies.len()).map(|body| (last(&self.moments, body) - last(&others, body)).abs());
        Some(Errors {
            largest: self.differences(&others).fold(0.0, f64::max),
            rms: (square / (MEASURES * others.len()).max(1) as f64).sqrt(),
            distance: heights.fold(0.0, f64::max),
            cycle: None,
            energy: None,
            penetration,
        })
    }

    /// How far all measures are apart.
    fn differences(&self, others: &[Moment]) -> impl Iterator<Item = f64> {
        self.moments.iter().flatten().zip(others.iter().flatten()).map(|(own, other)| (own - other).abs())
    }
}

/// All blocks at all times, each on a thread of its own; nothing where one blows up.
fn all_moments(problem: &Problem, setting: Setting) -> Option<Way> {
    let mut ways = vec![None; problem.bodies.len()];
    std::thread::scope(|scope| {
        for (body, found) in problem.bodies.iter().zip(&mut ways) {
            scope.spawn(move || *found = moments_of(body, setting, problem.duration));
        }
    });
    let ways = ways.into_iter().collect::<Option<Vec<Way>>>()?;
    let penetration = ways.iter().filter_map(|(_, penetration)| *penetration).reduce(f64::max);
    Some((ways.into_iter().flat_map(|(moments, _)| moments).collect(), penetration))
}

fn moments_of(body: &ProblemBody, setting: Setting, duration: f64) -> Option<Way> {
    let lattice = body.lattice?;
    let (mut run, mut positions) = (Run::<3>::new(body, setting, 0.0), Vec::new());
    let mut deepest = None;
    let times = (1..=Shapes::TIMES).map(|i| duration * (i as f64 / Shapes::TIMES as f64));
    let moments = times.map(|time| {
        run.positions_at(body, time, &mut positions)?;
        deepest = deepest.into_iter().chain(penetration(body, &positions)).reduce(f64::max);
        let shape = BlockShape::of_places(&positions, lattice)?;
        Some([shape.shape_error, center(body, &positions).y, shape.volume.unwrap_or(1.0)])
    });
    let moments = moments.collect::<Option<_>>()?;
    Some((moments, deepest))
}
