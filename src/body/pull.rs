//! A hand that pulls at a body.

use bevy::{ecs::prelude::*, math::DVec3, prelude::ReflectComponent, reflect::Reflect};

use super::ParticleId;

/// Pulls a particle of the body towards a place.
///
/// A body with springs: F = κ(target − x) − D·v, and no more than four times what the force is one length away. κ is a quarter of the stiffness of all springs at the particle, so that the pull is soft beside them; of a body that is heavy for that it is half its weight, so that
/// the force may become twice its weight and any particle lifts it, and at most the stiffness of those springs, which would be stretched beyond what the watch allows.
/// Of a particle without springs it is its mass. The hand is damped critically, D = 2√(κ(m + a)), and has a mass of its own, a = dt·D, without which it would make
/// steps unstable that the body alone bears; the smaller the step the lighter the hand, and it weighs nothing. A body on an axis is pulled along it. By the exact flow the
/// hand has no mass.
///
/// A body of the six-matrix particle system ([`Rules`](super::Rules)): as much is added to the velocity of the particle in each step as makes
/// v' = w + κ(target − p) − D·v', where w is v' without the hand; κ is a quarter of the stiffness of the bonds at the particle, each twice their factor (½ without bonds), and
/// D = h + 2√(hM) with h = dt·κ for M particles. It is at most 1.25 times the weight of the body, or of as many particles of weight 0.32, and what its bonds bear.
///
/// The pull is part of the physics: the same pulls at the same steps give the same bits. Take the component off to let go.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Pull {
    /// The particle; nothing is pulled where there is no such particle.
    pub particle: ParticleId,
    /// Where it is pulled to.
    pub target: DVec3,
}
