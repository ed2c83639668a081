//! All steps of a tick, in one parallel pass over the bodies.
//!
//! Bodies of equal topology are stepped side by side in lanes, each group from its first step of the tick to its last while its state is
//! in the cache. Which bodies share a group, and which thread has it, changes no bits.

use bevy::{ecs::prelude::*, tasks::ComputeTaskPool, time::Time};
use core::ops::Range;
use std::time::Instant;

use crate::{
    body::{ParticleId, Particles, Rules, Tearing},
    mechanics::{Advance, BodyParts, Lanes, Model, Real, State, Timeline},
};

use super::{
    Clock, Frozen, Plan, Steer,
    plan::{Parts, PartsItem},
    six,
    watch::{Failure, Verdict},
};

/// How many bodies are stepped side by side: one AVX-512 register of f64, two of AVX, four of SSE2.
const LANES: usize = 8;

/// Fewer spring updates than these in a tick are not shared among threads: waking one takes longer.
const WORTH_SHARING: u64 = 10_000;
/// A step of a method with a solver takes as long as about so many evaluations: some ten steps of Runge–Kutta 4 (`benches/methods.rs`).
const SOLVER_EVALUATIONS: u64 = 40;

/// What the physics has cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Resource)]
pub struct Cost {
    /// Forces on a whole body, counted since the start.
    pub force_evaluations: u64,
    /// Forces on one spring, counted since the start.
    pub spring_updates: u64,
    /// Steps of the last tick.
    pub steps: u64,
    /// Seconds that the steps of the last tick took.
    pub seconds: f64,
}

/// What one body has cost since it was spawned or restarted. Physics keeps it.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Evaluations of its forces.
    pub force_evaluations: u64,
}

/// What the steps of a tick need of a body.
type Bodies = (
    &'static mut Particles,
    Parts,
    Option<&'static mut Tearing>,
    &'static Plan,
    &'static mut Verdict,
    &'static mut Work,
    Option<&'static mut Steer>,
);

/// A body on its way through a tick.
struct Item<'a> {
    particles: Mut<'a, Particles>,
    parts: PartsItem<'a, 'a>,
    tearing: Option<Mut<'a, Tearing>>,
    plan: &'a Plan,
    verdict: Mut<'a, Verdict>,
    work: Mut<'a, Work>,
    steer: Option<Mut<'a, Steer>>,
    on_axis: bool,
    /// How often its forces were evaluated in this tick, up to the step in which it exploded if it did.
    evaluations: u64,
}

impl Item<'_> {
    fn body(&self) -> BodyParts<'_> {
        self.parts.body(&self.particles, self.tearing.as_deref(), self.steer.as_deref())
    }

    /// Takes what the model has come to, of the body in this lane.
    fn take_torn<R: Real, const D: usize>(&mut self, model: &Model<R, D>, lane: usize) {
        if let Some(tearing) = &mut self.tearing {
            // The model knows it already.
            tearing.bypass_change_detection().set_torn(model.torn(lane));
        }
    }

    /// Lets a steered body look where it is, before this step. Gives back before which step it wants to look again.
    fn steer(&mut self, timeline: Timeline, step: u64) -> Option<u64> {
        // What it comes to is no change that a plan would have to follow.
        let steer = self.steer.as_mut()?.bypass_change_detection();
        steer.look(&self.parts.body(&self.particles, None, None), timeline, step)
    }

    fn matches(&self, other: &Self) -> bool {
        self.plan.topology == other.plan.topology
            && self.on_axis == other.on_axis
            && self.body().same_topology(&other.body())
    }
}

/// Takes all steps of this tick with every body that is not frozen.
pub(super) fn step(
    time: Res<Time>,
    mut clock: ResMut<Clock>,
    mut cost: ResMut<Cost>,
    mut bodies: Query<Bodies, (Without<Frozen>, Without<Rules>)>,
    mut six: Query<six::Bodies, Without<Frozen>>,
) {
    let start = Instant::now();
    let steps = clock.take_steps(time.delta_secs_f64());
    (cost.steps, cost.seconds) = (steps, 0.0);
    if steps == 0 {
        return;
    }
    let (timeline, range) = (clock.timeline(), clock.step()..clock.step() + steps);
    let mut items: Vec<_> = bodies
        .iter_mut()
        .filter_map(|(particles, parts, tearing, plan, mut verdict, work, steer)| {
            if let Some(reason) = plan.misfit.clone() {
                let (step, time) = (range.start, timeline.time_at(range.start));
                *verdict = Verdict(Some(Failure { step, time, particle: ParticleId(0), reason }));
                return None;
            }
            let body = parts.body(&particles, None, None);
            let on_axis = body.on_axis();
            Some(Item { particles, parts, tearing, plan, verdict, work, steer, on_axis, evaluations: 0 })
        })
        .collect();
    items.sort_by_key(|item| (item.plan.topology, item.on_axis));
    let mut failed = Vec::new();
    let mut from = range.start;
    while from < range.end {
        // Who steers looks at the same steps whatever the ticks are, so ticks change no bits.
        let due = items.iter_mut().filter_map(|item| item.steer(timeline, from));
        let end = due.fold(range.end, u64::min);
        step_all(&mut items, timeline, from..end);
        failed.extend(items.extract_if(.., |item| item.verdict.0.is_some()));
        from = end;
    }
    for item in items.iter_mut().chain(&mut failed) {
        item.work.bypass_change_detection().force_evaluations += item.evaluations;
        cost.force_evaluations += item.evaluations;
        cost.spring_updates += item.evaluations * item.body().springs.len() as u64;
    }
    six::step(&mut six, &mut cost, timeline, &range);
    clock.advance(steps);
    cost.seconds = start.elapsed().as_secs_f64();
}

/// Takes these steps with every body.
fn step_all(items: &mut [Item<'_>], timeline: Timeline, range: Range<u64>) {
    let mut groups: Vec<_> = items
        .chunk_by_mut(Item::matches)
        .flat_map(|alike| {
            let width = side_by_side(alike);
            alike.chunks_mut(width)
        })
        .collect();
    if groups.len() < 2 || work(&groups, &range) < WORTH_SHARING {
        groups.iter_mut().for_each(|group| step_group(group, timeline, range.clone()));
        return;
    }
    let pool = ComputeTaskPool::get();
    let share = groups.len().div_ceil(4 * pool.thread_num());
    pool.scope(|scope| {
        for part in groups.chunks_mut(share) {
            let range = range.clone();
            scope.spawn(async move {
                for group in part {
                    step_group(group, timeline, range.clone());
                }
            });
        }
    });
}

/// How many spring updates these steps take, about.
fn work(groups: &[&mut [Item<'_>]], steps: &Range<u64>) -> u64 {
    let step = |item: &Item<'_>| {
        let body = item.body();
        body.springs.len() as u64 * body.method.about().evaluations.unwrap_or(SOLVER_EVALUATIONS)
    };
    groups.iter().flat_map(|group| group.iter().map(step)).sum::<u64>() * (steps.end - steps.start)
}

/// How many of these bodies are stepped side by side.
fn side_by_side(alike: &[Item<'_>]) -> usize {
    if alike.first().is_some_and(|first| first.body().side_by_side()) { LANES } else { 1 }
}

fn step_group(group: &mut [Item<'_>], timeline: Timeline, steps: Range<u64>) {
    match (group.len(), group.first().is_some_and(|first| first.on_axis)) {
        (0, _) => {}
        (1, true) => step_lanes::<f64, 1>(group, timeline, steps),
        (1, false) => step_lanes::<f64, 3>(group, timeline, steps),
        (_, true) => step_lanes::<Lanes<LANES>, 1>(group, timeline, steps),
        (_, false) => step_lanes::<Lanes<LANES>, 3>(group, timeline, steps),
    }
}

fn step_lanes<R: Real, const D: usize>(group: &mut [Item<'_>], timeline: Timeline, steps: Range<u64>) {
    let Some((first, others)) = group.split_first() else { return };
    let (first, others) = (first.body(), others.iter().map(Item::body));
    let (method, particles) = (first.method, first.particles.len());
    let mut model = Model::<R, D>::new(&first, others, timeline.dt);
    let mut state = State::new(particles);
    for lane in 0..R::LANES {
        state.set_lane(lane, &group[lane.min(group.len() - 1)].particles);
    }
    let steps_to_take = steps.end - steps.start;
    Advance { model: &mut model, state: &mut state, method, timeline, first: steps.start, steps: steps_to_take }.run();
    model.note(&state);
    for (lane, item) in group.iter_mut().enumerate() {
        if model.has_exploded(lane) || model.has_refused(lane) {
            retrace::<D>(item, timeline, steps.clone());
        } else {
            item.evaluations += model.evaluations(lane);
            state.write_lane(lane, item.particles.bypass_change_detection());
            item.take_torn(&model, lane);
        }
    }
}

/// Takes the steps of a tick again, one by one and with one body alone, up to the last after which it had not exploded. The body's bits alone are those
/// that it had in its lane, so this finds the step, whatever ticks and frames there were.
fn retrace<const D: usize>(item: &mut Item<'_>, timeline: Timeline, steps: Range<u64>) {
    let before = item.evaluations;
    let body = item.body();
    let method = body.method;
    let mut model = Model::<f64, D>::new(&body, [], timeline.dt);
    let mut state = State::new(body.particles.len());
    state.set_lane(0, body.particles);
    for step in steps {
        let good = state.clone();
        Advance { model: &mut model, state: &mut state, method, timeline, first: step, steps: 1 }.run();
        item.evaluations = before + model.evaluations(0);
        let (particle, reason) = if model.has_refused(0) {
            (0, format!("{} did not converge", method.name()))
        } else if let Some(explosion) = model.explosion(&state, 0) {
            let reason = match explosion.spring {
                Some(spring) => format!("spring {spring} is longer than ten rest lengths"),
                None => "it is not finite".into(),
            };
            (explosion.particle, reason)
        } else {
            continue;
        };
        let particle = ParticleId(particle as u32);
        good.write_lane(0, item.particles.bypass_change_detection());
        item.take_torn(&model, 0);
        *item.verdict = Verdict(Some(Failure { step: step + 1, time: timeline.time_at(step + 1), particle, reason }));
        return;
    }
    state.write_lane(0, item.particles.bypass_change_detection());
    item.take_torn(&model, 0);
}
