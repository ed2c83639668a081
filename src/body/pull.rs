//! A hand that pulls at a body.

use bevy::{ecs::prelude::*, math::DVec3, prelude::ReflectComponent, reflect::Reflect};

use super::ParticleId;

/// Pulls a particle of the body towards a place: F = κ(target − x) − 2√(κm)v, and no more than four times what the force is one length away.
///
/// κ is a quarter of the stiffness of all springs at the particle, so that the pull is soft beside them and hardly lowers the largest stable step; of a particle without
/// springs it is its mass. A body on an axis is pulled along it. The pull is part of the physics: the same pulls at the same steps give the same bits. Take
/// the component off to let go.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Pull {
    /// The particle; nothing is pulled where there is no such particle.
    pub particle: ParticleId,
    /// Where it is pulled to.
    pub target: DVec3,
}
