//! All steps of a tick, in one parallel pass over the bodies.
//!
//! Bodies of equal topology are stepped side by side in lanes, each group from its first step of the tick to its last while its state is
//! in the cache. Which bodies share a group, and which thread has it, changes no bits.

use bevy::{
    ecs::{archetype::Archetype, prelude::*},
    tasks::ComputeTaskPool,
    time::Time,
};
use core::ops::Range;
use std::time::Instant;

use crate::{
    body::{ParticleId, Particles, Pull, Rules, Tearing},
    mechanics::{BodyParts, Model, Real, Timeline},
};

use super::{
    Clock, Frozen, Plan, Steer,
    layout::{Slot, Source},
    plan::{Changes, Parts, PartsItem},
    six,
    watch::{Failure, Verdict},
};

/// How many bodies are stepped side by side: one AVX-512 register of f64, two of AVX, four of SSE2.
pub(super) const LANES: usize = 8;

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
    (Entity, &'static Archetype),
    &'static mut Particles,
    Parts,
    Option<&'static mut Tearing>,
    &'static Plan,
    &'static mut Verdict,
    &'static mut Work,
    Option<&'static mut Steer>,
);

/// The bodies that are stepped here.
type Stepped = (Without<Frozen>, Without<Rules>);

/// Bodies whose layout is no longer right. What steps change themselves does not count, and components that come and go change the archetype.
type Relaid = (Or<(Changes, Changed<Pull>, Changed<Steer>)>, Without<Rules>);

/// A body on its way through a tick.
pub(super) struct Item<'a> {
    pub(super) source: Source,
    pub(super) particles: Mut<'a, Particles>,
    parts: PartsItem<'a, 'a>,
    tearing: Option<Mut<'a, Tearing>>,
    plan: &'a Plan,
    pub(super) verdict: Mut<'a, Verdict>,
    work: Mut<'a, Work>,
    steer: Option<Mut<'a, Steer>>,
    /// Whether it goes another way from the next step on.
    pub(super) turned: bool,
    /// How often its forces were evaluated in this tick, up to the step in which it exploded if it did.
    pub(super) evaluations: u64,
}

impl Item<'_> {
    pub(super) fn body(&self) -> BodyParts<'_> {
        self.parts.body(&self.particles, self.tearing.as_deref(), self.steer.as_deref())
    }

    /// Takes what the model has come to, of the body in this lane.
    pub(super) fn take_torn<R: Real, const D: usize>(&mut self, model: &Model<R, D>, lane: usize) {
        if let Some(tearing) = &mut self.tearing {
            // The model knows it already.
            tearing.bypass_change_detection().set_torn(model.torn(lane));
        }
    }

    /// Lets a steered body look where it is, before this step. Gives back before which step it wants to look again.
    fn steer(&mut self, timeline: Timeline, step: u64) -> Option<u64> {
        // What it comes to is no change that a plan would have to follow.
        let steer = self.steer.as_mut()?.bypass_change_detection();
        let before = steer.guidance();
        let next = steer.look(&self.parts.body(&self.particles, None, None), timeline, step);
        self.turned = steer.guidance() != before;
        next
    }

    fn matches(&self, other: &Self) -> bool {
        self.plan.topology == other.plan.topology
            && self.source.on_axis == other.source.on_axis
            && self.body().same_topology(&other.body())
    }
}

/// What the last tick knew of its bodies, with steps of `dt`. Nothing of it is left once a body changes. What did not change is not looked at again: where bodies
/// are many, that waits for memory.
#[derive(Default)]
pub(super) struct Kept {
    dt: f64,
    /// The bodies in the order in which they are found.
    found: Vec<Source>,
    /// Their groups in order.
    slots: Vec<Slot>,
}

/// Takes all steps of this tick with every body that is not frozen.
pub(super) fn step(
    time: Res<Time>,
    mut clock: ResMut<Clock>,
    mut cost: ResMut<Cost>,
    mut kept: Local<Kept>,
    mut queries: ParamSet<(Query<(), Relaid>, Query<Bodies, Stepped>)>,
    mut six: Query<six::Bodies, Without<Frozen>>,
) {
    let start = Instant::now();
    // So seldom that all may be laid out anew for one that changed.
    if kept.dt != clock.dt() || !queries.p0().is_empty() {
        *kept = Kept { dt: clock.dt(), ..Kept::default() };
    }
    let Kept { found, slots, .. } = &mut *kept;
    let steps = clock.take_steps(time.delta_secs_f64());
    (cost.steps, cost.seconds) = (steps, 0.0);
    if steps == 0 {
        return;
    }
    let (timeline, range) = (clock.timeline(), clock.step()..clock.step() + steps);
    let mut bodies = queries.p1();
    let mut known = found.iter();
    let mut items: Vec<_> = bodies
        .iter_mut()
        .filter_map(|((body, archetype), particles, parts, tearing, plan, mut verdict, work, steer)| {
            if let Some(reason) = plan.misfit.clone() {
                let (step, time) = (range.start, timeline.time_at(range.start));
                *verdict = Verdict(Some(Failure { step, time, particle: ParticleId(0), reason }));
                return None;
            }
            let known = known.next().filter(|known| (known.body, known.archetype) == (body, archetype.id()));
            let source = known.copied().unwrap_or_else(|| {
                let on_axis = parts.body(&particles, None, None).on_axis();
                Source { body, archetype: archetype.id(), on_axis }
            });
            Some(Item { source, particles, parts, tearing, plan, verdict, work, steer, turned: false, evaluations: 0 })
        })
        .collect();
    found.clear();
    found.extend(items.iter().map(|item| item.source));
    items.sort_by_key(|item| (item.plan.topology, item.source.on_axis));
    let mut failed = Vec::new();
    let mut from = range.start;
    while from < range.end {
        // Who steers looks at the same steps whatever the ticks are, so ticks change no bits.
        let due = items.iter_mut().filter_map(|item| item.steer(timeline, from));
        let end = due.fold(range.end, u64::min);
        step_all(&mut items, slots, timeline, from..end);
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
fn step_all(items: &mut [Item<'_>], slots: &mut Vec<Slot>, timeline: Timeline, range: Range<u64>) {
    let groups = if slots.iter().flat_map(Slot::sources).eq(items.iter().map(|item| &item.source)) {
        same_groups(items, slots)
    } else {
        new_groups(items)
    };
    let shared = groups.len() > 1 && work(&groups, &range) >= WORTH_SHARING;
    slots.resize_with(groups.len(), Slot::default);
    let mut groups: Vec<_> = slots.iter_mut().zip(groups).collect();
    if !shared {
        groups.iter_mut().for_each(|(slot, group)| slot.step(group, timeline, range.clone()));
        return;
    }
    let pool = ComputeTaskPool::get();
    let share = groups.len().div_ceil(4 * pool.thread_num());
    pool.scope(|scope| {
        for part in groups.chunks_mut(share) {
            let range = range.clone();
            scope.spawn(async move {
                for (slot, group) in part {
                    slot.step(group, timeline, range.clone());
                }
            });
        }
    });
}

/// The groups in which they were stepped last.
fn same_groups<'a, 'b>(mut items: &'a mut [Item<'b>], slots: &[Slot]) -> Vec<&'a mut [Item<'b>]> {
    slots.iter().filter_map(|slot| items.split_off_mut(..slot.sources().len())).collect()
}

/// Bodies that match, as many as are stepped side by side.
fn new_groups<'a, 'b>(items: &'a mut [Item<'b>]) -> Vec<&'a mut [Item<'b>]> {
    let alike = items.chunk_by_mut(Item::matches);
    alike
        .flat_map(|alike| {
            let width = side_by_side(alike);
            alike.chunks_mut(width)
        })
        .collect()
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
