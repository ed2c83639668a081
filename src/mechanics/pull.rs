//! The force of a hand on one particle, and the mass that the hand has.
//!
//! A spring and a damper as they are would lower the largest stable step of the body. The hand therefore has a mass of its own, a = dt·D, which moves with the particle:
//! as if its damper acted at the end of the step. For any motion of the whole, with the mass of the hand as a part t of the mass that moves, the pair (h·γ, h²·κ) of
//! rates that a method sees is then (1 − t) of the body's own and t of (1, h·κ/D), and h·κ/D ≤ ¼. Steps of semi-implicit Euler are stable while h²κ + 2hγ ≤ 4,
//! of the other methods within regions of that plane which hold that point and all between it and what is stable without a hand: **no step that is stable without
//! the hand is unstable with it**. As dt becomes small, the hand has no mass. The exact flow, which is stable at any step, feels a hand without mass.

use super::{BodyParts, Model, Real, integrators::Method};

/// So many times the stiffness, the force is no larger.
const MOST_LENGTHS: f64 = 4.0;
/// What part of the stiffness of its springs a particle is pulled with.
const PART: f64 = 0.25;
/// What part of the weight of the body a length pulls at least: at its most the pull is twice the weight.
const PART_OF_WEIGHT: f64 = 0.5;

/// A [`Pull`](crate::body::Pull) as the force loop reads it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PullRow {
    pub(super) particle: usize,
    target: [f64; 3],
    stiffness: f64,
    damping: f64,
    /// The mass of the hand.
    pub(super) mass: f64,
    /// What the hand bears up of itself: gravity takes masses by their acceleration, and it has no weight.
    lift: f64,
}

impl PullRow {
    /// The pull at a body that is stepped by `dt`; nothing where its particle is pinned or does not exist.
    pub(super) fn of(body: &BodyParts<'_>, dt: f64) -> Option<Self> {
        let pull = body.pull?;
        let dt = if body.method == Method::ExactFlow { 0.0 } else { dt };
        let particle = body.particles.get(pull.particle).filter(|particle| !particle.pinned)?;
        let gravity = body.gravity.map_or(0.0, |gravity| gravity.acceleration());
        let at_it = body.springs.iter().filter(|spring| spring.ends.contains(&pull.particle));
        let springs: f64 = at_it.map(|spring| spring.stiffness).sum();
        let stiffness = if springs > 0.0 {
            let masses = body.particles.masses().iter().zip(body.particles.pinned());
            let weight: f64 = masses.filter(|(_, pinned)| !**pinned).map(|(mass, _)| gravity * mass).sum();
            (PART * springs).max((PART_OF_WEIGHT * weight).min(springs))
        } else {
            particle.mass * (PART_OF_WEIGHT * gravity).max(1.0)
        };
        // D = 2√(κ(m + dt·D)).
        let by_step = dt * stiffness;
        let damping = 2.0 * (by_step + (by_step * by_step + stiffness * particle.mass).sqrt());
        let mass = dt * damping;
        Some(Self {
            particle: pull.particle.index(),
            target: pull.target.to_array(),
            stiffness,
            damping,
            mass,
            lift: gravity * mass,
        })
    }

    /// One coefficient of the force along x without the cap as a series in time, from those of the place and of the velocity. The first, k = 0, is the force itself.
    pub(super) fn along_x(&self, k: usize, x: f64, v: f64) -> f64 {
        let constant = if k == 0 { self.stiffness * self.target[0] } else { 0.0 };
        constant - self.stiffness * x - self.damping * v
    }

    /// How much the force without the cap falls with the place and with the velocity.
    pub(super) fn slopes(&self) -> [f64; 2] {
        [self.stiffness, self.damping]
    }

    /// The force is no larger than this.
    pub(super) fn most(&self) -> f64 {
        MOST_LENGTHS * self.stiffness
    }

    /// The force without what bears up the hand, and how much of it the cap leaves.
    fn force<R: Real, const D: usize>(&self, position: [R; D], velocity: [R; D]) -> ([f64; D], f64) {
        let force: [f64; D] = core::array::from_fn(|axis| {
            self.stiffness * (self.target[axis] - position[axis].lane(0)) - self.damping * velocity[axis].lane(0)
        });
        let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        let most = self.most();
        (force, if size > most { most / size } else { 1.0 })
    }

    /// How much the force falls with the velocity, where positions count with it by the second weight and velocities by the first.
    pub(super) fn slope<const D: usize>(
        &self,
        position: [f64; D],
        velocity: [f64; D],
        [of_damping, of_stiffness]: [f64; 2],
    ) -> [[f64; D]; D] {
        let (force, cut) = self.force(position, velocity);
        let slope = cut * (of_damping * self.damping + of_stiffness * self.stiffness);
        // What is capped changes its direction alone.
        let square = if cut < 1.0 { force.iter().map(|f| f * f).sum() } else { f64::INFINITY };
        core::array::from_fn(|row| {
            core::array::from_fn(|column| {
                let same = if row == column { 1.0 } else { 0.0 };
                slope * (same - force[row] * force[column] / square)
            })
        })
    }
}

impl<R: Real, const D: usize> Model<R, D> {
    /// What the pull accelerates its particle with, and which that is. Bodies that are pulled are stepped by themselves.
    #[inline(never)]
    pub(super) fn pull(&self, position: &[[R; D]], velocity: &[[R; D]]) -> Option<(usize, [R; D])> {
        let row = self.pull?;
        let (mut force, cut) = row.force(position[row.particle], velocity[row.particle]);
        force.iter_mut().for_each(|force| *force *= cut);
        if D == 3 {
            force[1] += row.lift;
        }
        let inverse_mass = self.inverse_mass[row.particle];
        Some((row.particle, force.map(|force| R::splat(force) * inverse_mass)))
    }
}
