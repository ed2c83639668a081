//! Bodies of the six-matrix particle system: the same clock, plan, watch and cost as bodies with springs, and another step.

use core::ops::Range;

use bevy::{
    ecs::{prelude::*, query::QueryData},
    log::warn,
    prelude::Name,
    tasks::ComputeTaskPool,
};

use crate::{
    body::{Bonds, Collisions, Columns, ParticleId, Particles, Pull, Rules},
    mechanics::{
        Timeline,
        six_matrix::{Road, SixParts, Stepper, stability_limit},
    },
};

use super::{
    Clock, Frozen, Plan, Trail, Work,
    step::Cost,
    watch::{Failure, Verdict},
};

/// Borrows a body of the six-matrix particle system for mechanics; nothing where the entity is none.
pub fn six_parts(entity: EntityRef<'_>) -> Option<SixParts<'_>> {
    Some(SixParts {
        particles: entity.get()?,
        columns: entity.get()?,
        bonds: entity.get()?,
        collisions: entity.get()?,
        rules: entity.get()?,
        road: entity.get(),
        pull: entity.get().copied(),
    })
}

/// The components of one body, beside particles and columns, that a step reads.
#[derive(QueryData)]
pub(super) struct Fixed {
    bonds: &'static Bonds,
    collisions: &'static Collisions,
    rules: &'static Rules,
    road: Option<&'static Road>,
    pull: Option<&'static Pull>,
}

impl FixedItem<'_, '_> {
    fn parts<'a>(&'a self, particles: &'a Particles, columns: &'a Columns) -> SixParts<'a> {
        let &Self { bonds, collisions, rules, road, pull } = self;
        SixParts { particles, columns, bonds, collisions, rules, road, pull: pull.copied() }
    }
}

type Changes =
    Or<(Added<Plan>, Changed<Particles>, Changed<Columns>, Changed<Bonds>, Changed<Collisions>, Changed<Rules>)>;

/// Plans every body that was changed. Its limit is that of its bonds at rest, and needs no watching.
pub(super) fn plan(mut bodies: Query<(&Particles, &Columns, Fixed, &mut Plan), Changes>) {
    for (particles, columns, fixed, mut plan) in &mut bodies {
        plan.misfit = fixed.parts(particles, columns).misfit();
        if plan.misfit.is_none() {
            plan.stability_limit = stability_limit(fixed.bonds, columns);
        }
    }
}

/// What is read of a body to watch its limit.
type Watched = (Option<&'static Name>, &'static mut Plan);

/// Warns where dt is above a limit.
pub(super) fn watch_limit(clock: Res<Clock>, mut bodies: Query<Watched, (With<Rules>, Without<Frozen>)>) {
    let dt = clock.dt();
    for (name, mut plan) in &mut bodies {
        if dt <= plan.stability_limit {
            plan.warned = None;
        } else if plan.warned != Some(dt) {
            plan.warned = Some(dt);
            warn!(
                "{}: dt {dt} is above {}, the stability limit of its bonds; expect them to burst, or choose a smaller dt",
                name.map_or("a body", Name::as_str),
                plan.limit_text(),
            );
        }
    }
}

/// What the steps of a tick need of a body.
pub(super) type Bodies = (
    &'static mut Particles,
    &'static mut Columns,
    Fixed,
    &'static Plan,
    &'static mut Verdict,
    &'static mut Work,
    &'static mut Trail,
);

/// A body on its way through a tick.
struct Item<'a> {
    particles: Mut<'a, Particles>,
    columns: Mut<'a, Columns>,
    fixed: FixedItem<'a, 'a>,
    verdict: Mut<'a, Verdict>,
    work: Mut<'a, Work>,
    trail: Mut<'a, Trail>,
    /// How often its forces were evaluated in this tick.
    evaluations: u64,
}

/// Takes these steps with every body, in parallel.
pub(super) fn step(
    bodies: &mut Query<Bodies, Without<Frozen>>,
    cost: &mut Cost,
    timeline: Timeline,
    steps: &Range<u64>,
) {
    let mut items: Vec<_> = bodies
        .iter_mut()
        .filter_map(|(particles, columns, fixed, plan, mut verdict, work, trail)| {
            if let Some(reason) = plan.misfit.clone() {
                let (step, time) = (steps.start, timeline.time_at(steps.start));
                *verdict = Verdict(Some(Failure { step, time, particle: ParticleId(0), reason }));
                return None;
            }
            Some(Item { particles, columns, fixed, verdict, work, trail, evaluations: 0 })
        })
        .collect();
    match &mut items[..] {
        [] => return,
        [one] => one.advance(timeline, steps),
        many => {
            let pool = ComputeTaskPool::get();
            let share = many.len().div_ceil(4 * pool.thread_num());
            pool.scope(|scope| {
                for part in many.chunks_mut(share) {
                    scope.spawn(async move { part.iter_mut().for_each(|item| item.advance(timeline, steps)) });
                }
            });
        }
    }
    for Item { fixed, work, evaluations, .. } in &mut items {
        work.bypass_change_detection().force_evaluations += *evaluations;
        cost.force_evaluations += *evaluations;
        cost.spring_updates += *evaluations * fixed.bonds.relation().len() as u64;
    }
}

/// Whether what is at this height is so far below all of the road that it has left it for good.
fn is_below(road: &Road, height: f64) -> bool {
    /// Higher than any creature.
    const FAR: f64 = 100.0;
    height + FAR < road.lowest()
}

impl Item<'_> {
    /// Takes these steps, up to the last after which nothing had burst.
    fn advance(&mut self, timeline: Timeline, steps: &Range<u64>) {
        let parts = self.fixed.parts(&self.particles, &self.columns);
        let mut stepper = Stepper::new(&parts);
        for step in steps.clone() {
            self.evaluations += 1;
            self.trail.note(step, || stepper.state().center());
            let Err(burst) = stepper.step(&parts, timeline.dt) else { continue };
            let reason = match burst.bond {
                Some(bond) => format!("bond {bond} is longer than ten times its initial length"),
                None => "it is not finite".into(),
            };
            let reason = match parts.road {
                Some(road) if is_below(road, stepper.state().center().y) => {
                    format!("it had fallen off its road, ever faster, until {reason}")
                }
                _ => reason,
            };
            let (step, time) = (step + 1, timeline.time_at(step + 1));
            let particle = ParticleId(burst.particle as u32);
            *self.verdict = Verdict(Some(Failure { step, time, particle, reason }));
            break;
        }
        stepper.state().write(self.particles.bypass_change_detection(), self.columns.bypass_change_detection());
    }
}
