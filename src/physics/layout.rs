//! A group of bodies in the layout that steps work on, kept from tick to tick so long as nothing about it changes.
//!
//! For a single small animal, laying it out takes as long as a third of the steps of a tick.

use core::ops::Range;

use bevy::ecs::{archetype::ArchetypeId, prelude::*};

use crate::{
    body::{ParticleId, SpringId},
    mechanics::{Advance, BodyParts, Lanes, Model, Real, State, Timeline},
};

use super::{
    step::{Item, LANES},
    watch::{Failure, Verdict},
};

/// Which body a lane holds, with which components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Source {
    pub(super) body: Entity,
    pub(super) archetype: ArchetypeId,
    /// Whether one dimension is enough.
    pub(super) on_axis: bool,
}

/// A place in the order of groups.
#[derive(Default)]
pub(super) struct Slot {
    sources: Vec<Source>,
    layout: Option<Box<dyn Layout>>,
}

impl Slot {
    /// The bodies that it was for last.
    pub(super) fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// Takes these steps with a group: in the layout of the last ones where it holds the same bodies, else in a new one.
    pub(super) fn step(&mut self, group: &mut [Item<'_>], timeline: Timeline, steps: Range<u64>) {
        let same = self.sources.iter().eq(group.iter().map(|item| &item.source));
        if !same || group.iter().any(|item| item.turned) {
            self.layout = None;
            self.sources.clear();
            self.sources.extend(group.iter().map(|item| item.source));
        }
        let Some(mut layout) = self.layout.take().or_else(|| lay_out(group, timeline.dt)) else { return };
        if layout.step(group, timeline, steps) {
            self.layout = Some(layout);
        }
    }
}

/// Lays out a group of bodies alike; nothing where there is none.
fn lay_out(group: &[Item<'_>], dt: f64) -> Option<Box<dyn Layout>> {
    let on_axis = group.first()?.source.on_axis;
    Some(match (group.len(), on_axis) {
        (1, true) => Box::new(Laid::<f64, 1>::new(group, dt)?),
        (1, false) => Box::new(Laid::<f64, 3>::new(group, dt)?),
        (_, true) => Box::new(Laid::<Lanes<LANES>, 1>::new(group, dt)?),
        (_, false) => Box::new(Laid::<Lanes<LANES>, 3>::new(group, dt)?),
    })
}

/// A layout of any width and dimension.
trait Layout: Send {
    /// Takes these steps with the group that was laid out. Whether the layout can be used again: not after an explosion.
    fn step(&mut self, group: &mut [Item<'_>], timeline: Timeline, steps: Range<u64>) -> bool;
}

struct Laid<R, const D: usize> {
    model: Model<R, D>,
    /// Read from the particles before the steps and written back after them: others may have moved them.
    state: State<R, D>,
}

impl<R: Real, const D: usize> Laid<R, D> {
    fn new(group: &[Item<'_>], dt: f64) -> Option<Self> {
        let (first, others) = group.split_first()?;
        let (first, others) = (first.body(), others.iter().map(Item::body));
        Some(Self { model: Model::new(&first, others, dt), state: State::new(first.particles.len()) })
    }
}

impl<R: Real, const D: usize> Layout for Laid<R, D> {
    fn step(&mut self, group: &mut [Item<'_>], timeline: Timeline, steps: Range<u64>) -> bool {
        let Self { model, state } = self;
        let Some(last) = group.len().checked_sub(1) else { return false };
        for lane in 0..R::LANES {
            state.set_lane(lane, &group[lane.min(last)].particles);
        }
        model.begin_tick();
        let (method, first, count) = (group[0].body().method, steps.start, steps.end - steps.start);
        Advance { model, state, method, timeline, first, steps: count }.run();
        model.note(state);
        let mut intact = true;
        for (lane, item) in group.iter_mut().enumerate() {
            if model.has_exploded(lane) || model.has_refused(lane) {
                intact = false;
                retrace::<D>(item, timeline, steps.clone());
            } else {
                item.evaluations += model.evaluations(lane);
                state.write_lane(lane, item.particles.bypass_change_detection());
                item.take_torn(model, lane);
            }
        }
        intact
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
                Some(spring) => {
                    let before = model.explosion(&good, 0);
                    too_long(&item.body(), spring, before.is_some_and(|before| before.spring.is_some()))
                }
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

/// What is said of a spring that is too long, where springs `were` so before the step or not.
fn too_long(body: &BodyParts<'_>, spring: usize, were: bool) -> String {
    // Springs are counted in u32.
    let rest = body.springs.get(SpringId(spring as u32)).map_or(0.0, |spring| spring.rest_length);
    let why = if were {
        ", and springs were so before this step: rest lengths are too small for the pose, whatever dt is"
    } else {
        ""
    };
    format!("spring {spring} is longer than ten rest lengths of {rest}{why}")
}
