//! What a frame shows of the bodies: positions between two ticks, in f32.

use bevy::{
    ecs::prelude::*,
    math::{DVec3, Vec3},
    prelude::ReflectComponent,
    reflect::Reflect,
    time::Time,
    transform::components::Transform,
};

use super::Clock;
use crate::body::{ParticleId, Particles};

/// The positions at which the particles of a body are shown in this frame: on the way of the last tick that took steps, by how
/// much time has passed since. Written once a frame in [`PhysicsSystems::Sync`](super::PhysicsSystems::Sync), never read by
/// the physics.
#[derive(Clone, Component, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct Shown {
    positions: Vec<Vec3>,
}

impl Shown {
    /// Where each particle is shown, in order.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }
}

/// Where the particles were before the last tick that took steps.
#[derive(Clone, Component, Debug, Default)]
pub struct Previous {
    pub(super) position: [Vec<f64>; 3],
}

/// A body that crawls along x for ever is shown on a stretch of the x axis that it enters again at the start: once its hindmost particle has passed
/// `end`, the whole body is shown `length` further back, and so on at every lap. Its true position and its
/// distance travelled go on; only what is shown is moved.
#[derive(Clone, Component, Copy, Debug, Reflect)]
#[reflect(Component)]
pub struct ShownLap {
    /// Where, in x, the hindmost particle ends the lap.
    pub end: f64,
    /// By how much the body is then shown further back; above zero.
    pub length: f64,
}

impl ShownLap {
    /// How far back a body is shown whose hindmost particle is at `hindmost`.
    pub fn offset(self, hindmost: f64) -> f64 {
        (((hindmost - self.end) / self.length).floor() + 1.0).max(0.0) * self.length
    }
}

/// Keeps the entity's [`Transform`] where a particle is shown: for meshes, cameras and labels.
#[derive(Clone, Component, Copy, Debug, Reflect)]
#[reflect(Component)]
#[require(Transform)]
pub struct FollowParticle {
    /// The body's entity.
    pub body: Entity,
    /// The particle that is followed.
    pub particle: ParticleId,
}

/// Remembers where the particles are, before a tick moves them. A tick without steps leaves what is remembered.
pub(super) fn remember(time: Res<Time>, clock: Res<Clock>, mut bodies: Query<(&Particles, &mut Previous)>) {
    if !clock.will_step(time.delta_secs_f64()) {
        return;
    }
    for (particles, mut previous) in &mut bodies {
        previous.position.clone_from(particles.position_columns());
    }
}

/// Writes [`Shown`] between the last two ticks, at this fraction of the way.
pub(super) fn show(In(fraction): In<f64>, mut bodies: Query<(&Particles, &Previous, Option<&ShownLap>, &mut Shown)>) {
    for (particles, previous, lap, mut shown) in &mut bodies {
        let offset = lap.map_or(0.0, |lap| {
            lap.offset(particles.position_columns()[0].iter().copied().fold(f64::INFINITY, f64::min))
        });
        shown.positions.clear();
        shown.positions.extend(particles.positions().enumerate().map(|(i, now)| {
            let [x, y, z] = &previous.position;
            let before = x.get(i).map_or(now, |&x| DVec3::new(x, y[i], z[i]));
            (before.lerp(now, fraction) - DVec3::X * offset).as_vec3()
        }));
    }
}

/// Moves every follower to its particle.
pub(super) fn follow(bodies: Query<&Shown>, mut followers: Query<(&FollowParticle, &mut Transform)>) {
    for (follow, mut transform) in &mut followers {
        let shown = bodies.get(follow.body).ok().and_then(|shown| shown.positions.get(follow.particle.index()));
        if let Some(&position) = shown {
            transform.translation = position;
        }
    }
}
