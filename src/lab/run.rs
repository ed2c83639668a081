//! One run of a problem by one method with one step: how far from the reference it ends up, and what it costs.

use core::time::Duration;
use std::time::Instant;

use bevy::math::DVec3;

use crate::{
    body::Particles,
    mechanics::{
        Advance, Model, State, Timeline, ground_distance,
        integrators::{Method, StickRule},
    },
};

use super::{Errors, Point, Problem, ProblemBody, Reference, Setting, Truth, energy::Energy};

/// A rest of a step that is a rounding error.
const ROUNDING: f64 = 1e-9;

/// Runs a problem once to see how far it is from the truth, and then again as often as `repeats` says to see how long it takes.
///
/// A shared time that no step ends at is met by one shorter step from the last step before it, which the run itself does not see. Only stepping is
/// timed: all bodies one after the other on one thread, after a run that warms up. What would take more than a minute is repeated less often, three times
/// at least; what blows up is not.
pub fn measure(problem: &Problem, truth: &Truth, setting: Setting, repeats: usize) -> Point {
    /// How long a point may take.
    const LONGEST: Duration = Duration::from_secs(60);
    let errors = truth.errors_of(problem, setting);
    let steps = steps_to(problem.duration, setting.dt);
    let started = Instant::now();
    let (warm_up, evaluations) = stepping(problem, setting, steps);
    let mut seconds: Vec<f64> = Vec::with_capacity(repeats);
    if errors.is_some() {
        while seconds.len() < repeats && (seconds.len() < 3 || started.elapsed() < LONGEST) {
            seconds.push(stepping(problem, setting, steps).0);
        }
    }
    if seconds.is_empty() {
        seconds.push(warm_up);
    }
    seconds.sort_by(f64::total_cmp);
    let half = seconds.len() / 2;
    let median = if seconds.len() % 2 == 1 { seconds[half] } else { 0.5 * (seconds[half - 1] + seconds[half]) };
    let runs = seconds.len();
    Point { setting, steps, evaluations, runs, seconds: seconds[0], median_seconds: median, errors }
}

/// How many steps of `dt` it takes to get to `time`.
pub(super) fn steps_to(time: f64, dt: f64) -> u64 {
    (time / dt - ROUNDING).ceil().max(1.0) as u64
}

/// Steps all bodies and gives back the seconds that took and the evaluations.
pub(super) fn stepping(problem: &Problem, setting: Setting, steps: u64) -> (f64, u64) {
    let (mut seconds, mut evaluations) = (0.0, 0);
    for body in &problem.bodies {
        let on_axis = body.parts(setting.method, setting.stick).on_axis();
        let run = if on_axis { step_body::<1> } else { step_body::<3> };
        let (more_seconds, more_evaluations) = run(body, setting, steps);
        (seconds, evaluations) = (seconds + more_seconds, evaluations + more_evaluations);
    }
    (seconds, evaluations)
}

fn step_body<const D: usize>(body: &ProblemBody, setting: Setting, steps: u64) -> (f64, u64) {
    let mut run = Run::<D>::new(body, setting, 0.0);
    let started = Instant::now();
    // Whether it blew up is known from the run that was compared.
    let _ = run.advance(steps);
    (started.elapsed().as_secs_f64(), run.model.evaluations(0))
}

/// Whether it makes a difference to a method that friction acts so in its steps, and not in its stages: over a period, by the bits of all positions.
pub(super) fn stick_matters(problem: &Problem, method: Method, stick: StickRule) -> bool {
    /// No more steps than this are taken to see it, and no fewer than that.
    const MOST_STEPS: f64 = 4096.0;
    const LEAST_STEPS: f64 = 128.0;
    if problem.bodies.iter().all(|body| body.friction.is_none()) || (stick == StickRule::Located && !method.locates()) {
        return false;
    }
    let period = problem.period.unwrap_or(0.1 * problem.duration);
    let limit = problem.stability_limit(method, StickRule::InStages);
    let dt = (period / LEAST_STEPS).min(if limit > 0.0 { 0.25 * limit } else { f64::INFINITY });
    let steps = (period / dt).clamp(LEAST_STEPS, MOST_STEPS) as u64;
    problem.bodies.iter().any(|body| {
        let end = |stick| {
            let setting = Setting { method, stick, dt };
            let on_axis = body.parts(method, stick).on_axis();
            if on_axis { end_of::<1>(body, setting, steps) } else { end_of::<3>(body, setting, steps) }
        };
        end(StickRule::InStages) != end(stick)
    })
}

/// The bits of all positions after some steps.
fn end_of<const D: usize>(body: &ProblemBody, setting: Setting, steps: u64) -> Vec<u64> {
    let mut run = Run::<D>::new(body, setting, 0.0);
    let _ = run.advance(steps);
    run.state.position.iter().flatten().map(|value| value.to_bits()).collect()
}

/// The errors of a run at the shared times; `None` where it blows up or its method refuses a step.
pub(super) fn errors(problem: &Problem, reference: &Reference, setting: Setting) -> Option<Errors> {
    let times = problem.times();
    let cycle = problem.samples_a_cycle();
    let mut sum = Sum { cycle: cycle.map(|_| 0.0), ..Sum::default() };
    for (index, body) in problem.bodies.iter().enumerate() {
        let exact = Exact { reference, index, cycle };
        if body.parts(setting.method, setting.stick).on_axis() {
            compare::<1>(body, setting, &times, exact, &mut sum)?;
        } else {
            compare::<3>(body, setting, &times, exact, &mut sum)?;
        }
    }
    let Sum { largest, distance, cycle, energy, .. } = sum;
    let rms = (sum.squares / sum.count.max(1.0)).sqrt();
    Some(Errors { largest, rms, distance, cycle, energy, penetration: None })
}

/// What errors are made from.
#[derive(Default)]
struct Sum {
    largest: f64,
    /// In squares of lengths of the bodies.
    squares: f64,
    count: f64,
    distance: f64,
    cycle: Option<f64>,
    energy: Option<f64>,
}

impl Sum {
    fn add(&mut self, positions: &[DVec3], exact: &[DVec3], length: f64) {
        for (position, exact) in positions.iter().zip(exact) {
            let distance = position.distance(*exact);
            self.largest = self.largest.max(distance);
            self.squares += (distance / length).powi(2);
            self.count += 1.0;
        }
    }
}

/// What a body is compared with.
#[derive(Clone, Copy)]
struct Exact<'r> {
    reference: &'r Reference,
    /// Which body it is.
    index: usize,
    /// How many shared times a cycle lasts.
    cycle: Option<usize>,
}

fn compare<const D: usize>(
    body: &ProblemBody,
    setting: Setting,
    times: &[f64],
    exact: Exact<'_>,
    sum: &mut Sum,
) -> Option<()> {
    let mut run = Run::<D>::new(body, setting, 0.0);
    let (mut particles, mut positions) = (body.particles.clone(), Vec::new());
    let length = body.length();
    // How far ahead of the reference the centre of mass is, at the end of the last cycle and now.
    let (mut last, mut ahead) = (DVec3::ZERO, DVec3::ZERO);
    for (sample, &time) in times.iter().enumerate() {
        run.particles_at(body, time, &mut particles)?;
        positions.clear();
        positions.extend(particles.positions());
        let known = exact.reference.positions(exact.index, sample);
        sum.add(&positions, known, length);
        let energy = exact.reference.energies[exact.index].apart(Energy::of(body, &particles, time), sample);
        sum.energy = sum.energy.into_iter().chain(energy).reduce(f64::max);
        ahead = center(body, &positions) - center(body, known);
        if let (Some(largest), Some(cycle)) = (&mut sum.cycle, exact.cycle)
            && (sample + 1).is_multiple_of(cycle)
        {
            *largest = largest.max(ahead.distance(last));
            last = ahead;
        }
    }
    sum.distance = sum.distance.max(ahead.length());
    Some(())
}

/// The centre of mass; of particles that have none, the mean of their positions.
pub(super) fn center(body: &ProblemBody, positions: &[DVec3]) -> DVec3 {
    let masses = body.particles.masses();
    let total: f64 = masses.iter().sum();
    if total == 0.0 {
        return positions.iter().sum::<DVec3>() / positions.len().max(1) as f64;
    }
    positions.iter().zip(masses).map(|(&position, &mass)| position * mass).sum::<DVec3>() / total
}

/// How deep the deepest of these places is below the ground of a body; nothing where it has none.
pub(super) fn penetration(body: &ProblemBody, positions: &[DVec3]) -> Option<f64> {
    let ground = body.ground.as_ref()?;
    Some(positions.iter().map(|&position| -ground_distance(ground, position).0).fold(0.0, f64::max))
}

/// A body on its way.
pub(super) struct Run<const D: usize> {
    model: Model<f64, D>,
    state: State<f64, D>,
    setting: Setting,
    timeline: Timeline,
    /// How many steps it has taken.
    done: u64,
}

impl<const D: usize> Run<D> {
    /// A body before its first step, which begins at `start`.
    pub(super) fn new(body: &ProblemBody, setting: Setting, start: f64) -> Self {
        let mut state = State::new(body.particles.len());
        state.set_lane(0, &body.particles);
        let model = Model::new(&body.parts(setting.method, setting.stick), [], setting.dt);
        Self { model, state, setting, timeline: Timeline { dt: setting.dt, base_step: 0, base_time: start }, done: 0 }
    }

    /// Takes steps. `None` where the body has blown up or a step was refused.
    fn advance(&mut self, steps: u64) -> Option<()> {
        let (model, state, timeline, first) = (&mut self.model, &mut self.state, self.timeline, self.done);
        Advance { model, state, method: self.setting.method, timeline, first, steps }.run();
        self.done += steps;
        let failed =
            self.model.has_exploded(0) || self.model.has_refused(0) || self.model.explosion(&self.state, 0).is_some();
        (!failed).then_some(())
    }

    /// Goes on to a time that is not before its last step and tells where the particles are then. Where no step ends, one shorter step is taken that the
    /// run itself does not see. `None` where the body has blown up or a step was refused.
    pub(super) fn positions_at(&mut self, body: &ProblemBody, time: f64, positions: &mut Vec<DVec3>) -> Option<()> {
        self.look_at(body, time, |run| run.positions(body, positions))
    }

    /// The same with velocities; what an axis leaves out stays as it is.
    fn particles_at(&mut self, body: &ProblemBody, time: f64, particles: &mut Particles) -> Option<()> {
        self.look_at(body, time, |run| run.state.write_lane(0, particles))
    }

    fn look_at(&mut self, body: &ProblemBody, time: f64, look: impl FnOnce(&Self)) -> Option<()> {
        let setting = self.setting;
        let steps = (time / setting.dt + ROUNDING).floor() as u64;
        if steps > self.done {
            self.advance(steps - self.done)?;
        }
        let start = steps as f64 * setting.dt;
        if time - start > ROUNDING * setting.dt {
            let mut part = Self::new(body, Setting { dt: time - start, ..setting }, start);
            part.state.clone_from(&self.state);
            part.advance(1)?;
            look(&part);
        } else {
            look(self);
        }
        Some(())
    }

    /// Where the particles are; what an axis leaves out is as it was at the start.
    fn positions(&self, body: &ProblemBody, positions: &mut Vec<DVec3>) {
        positions.clear();
        positions.extend(body.particles.positions().zip(&self.state.position).map(|(at, row)| {
            let mut vector = at.to_array();
            vector[..D].copy_from_slice(row);
            DVec3::from(vector)
        }));
    }
}
