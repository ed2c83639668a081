//! The force of a hand on one particle.

use super::{BodyParts, Model, Real};

/// So many times the stiffness, the force is no larger.
const MOST_LENGTHS: f64 = 4.0;
/// What part of the stiffness of its springs a particle is pulled with.
const PART: f64 = 0.25;

/// A [`Pull`](crate::body::Pull) as the force loop reads it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PullRow {
    particle: usize,
    target: [f64; 3],
    stiffness: f64,
    damping: f64,
}

impl PullRow {
    /// The pull at a body; nothing where its particle is pinned or does not exist.
    pub(super) fn of(body: &BodyParts<'_>) -> Option<Self> {
        let pull = body.pull?;
        let particle = body.particles.get(pull.particle).filter(|particle| !particle.pinned)?;
        let at_it = body.springs.iter().filter(|spring| spring.ends.contains(&pull.particle));
        let springs: f64 = at_it.map(|spring| spring.stiffness).sum();
        let stiffness = if springs > 0.0 { PART * springs } else { particle.mass };
        Some(Self {
            particle: pull.particle.index(),
            target: pull.target.to_array(),
            stiffness,
            damping: 2.0 * (stiffness * particle.mass).sqrt(),
        })
    }
}

impl<R: Real, const D: usize> Model<R, D> {
    /// Adds what the pull accelerates its particle with. Bodies that are pulled are stepped by themselves.
    #[inline(never)]
    pub(super) fn pull(&self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let Some(PullRow { particle, target, stiffness, damping }) = self.pull else { return };
        let mut force = [0.0; D];
        for (axis, (force, target)) in force.iter_mut().zip(target).enumerate() {
            *force =
                stiffness * (target - position[particle][axis].lane(0)) - damping * velocity[particle][axis].lane(0);
        }
        let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        let most = MOST_LENGTHS * stiffness;
        let cut = if size > most { most / size } else { 1.0 };
        for (a, force) in acceleration[particle].iter_mut().zip(force) {
            *a += R::splat(force * cut) * self.inverse_mass[particle];
        }
    }
}
