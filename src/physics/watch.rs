//! The watch: a body that explodes is frozen in its last good state, and the rest of the scene goes on.

use bevy::{
    ecs::prelude::*,
    log::error,
    prelude::{Name, ReflectComponent},
    reflect::Reflect,
};

use crate::body::ParticleId;

use super::{Clock, Plan};

/// When and where a body failed, and why.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Failure {
    pub(super) step: u64,
    pub(super) time: f64,
    pub(super) particle: ParticleId,
    pub(super) reason: String,
}

/// What a tick's steps found, for the watch.
#[derive(Clone, Component, Debug, Default)]
pub struct Verdict(pub(super) Option<Failure>);

/// On a body that is not stepped any more, because it would not be finite, or a spring of it would be longer than ten rest lengths. It is as
/// it was one step before. [`Restart`](super::Restart) thaws it.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Frozen {
    /// The step that would have exploded, counted from 1.
    pub step: u64,
    /// The time after that step.
    pub time: f64,
    /// The particle that would have gone wrong.
    pub particle: ParticleId,
    /// What would have been wrong.
    pub reason: String,
}

/// Tells that a body was frozen.
#[derive(Clone, Debug, Message)]
pub struct BodyFrozen {
    /// The body.
    pub body: Entity,
    /// What happened, for people: body, particle, step, dt and stability limit.
    pub text: String,
}

/// Tells that a segment of a strand is inside out. The body goes on, and may find its shape again.
#[derive(Clone, Debug, Message)]
pub struct BodyInverted {
    /// The body.
    pub body: Entity,
    /// What happened, for people: body, segment, step and time.
    pub text: String,
}

/// Freezes every body of which a step found that it explodes.
pub(super) fn watch(
    clock: Res<Clock>,
    mut bodies: Query<(Entity, Option<&Name>, &Plan, &mut Verdict), Changed<Verdict>>,
    mut messages: MessageWriter<BodyFrozen>,
    mut commands: Commands,
) {
    for (body, name, plan, mut verdict) in &mut bodies {
        let Some(Failure { step, time, particle, reason }) = verdict.bypass_change_detection().0.take() else {
            continue;
        };
        let text = format!(
            "{}: particle {} exploded at step {step} (time {time:.6}): {reason}. dt is {}, the stability limit {}. \
             The body is frozen in its last good state.",
            name.map_or("a body", Name::as_str),
            particle.0,
            clock.dt(),
            plan.limit_text(),
        );
        error!("{text}");
        messages.write(BodyFrozen { body, text });
        commands.entity(body).insert(Frozen { step, time, particle, reason });
    }
}
