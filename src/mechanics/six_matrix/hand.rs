//! H: what a hand adds to the velocity of the particle that it holds, beside B, C and R.
//!
//! ```text
//! w = d·v + B + C + R                               what it would go at without the hand
//! H = (S − D·w)/(1 + D)                             v' = w + H
//! S = κ(target − p)                                 S and H are both cut off at the same size
//! ```
//!
//! So v' = w + S − D·v': a spring, and a damper that acts at the end of the step. With h = t·κ and D = h + 2√(hM) the M particles of the body,
//! moving as one and keeping all their velocity, come to the target critically damped: (M + D)λ² − (2M + D − h)λ + M has the double root 1/(1 + √(h/M)).
//! What moves less of the body is damped more.
//!
//! **No step that is stable without the hand is unstable with it.** Let −K be the derivative of the forces, symmetric as it is for bonds and contacts that
//! both ends feel. A motion v ~ λⁿ then has, with a, δ and k for its means of 1 + D, d and K + κ (D and κ for the held particle alone),
//! aλ² − (a + δ − tk)λ + δ = 0, and |λ| ≤ 1 for δ ≤ a and 0 ≤ tk ≤ 2(a + δ). Without the hand this is tK ≤ 2(1 + d) as quadratic forms, which is also necessary:
//! else there is a λ below −1. The hand adds tκ to the left and 2D to the right, and tκ = h ≤ D. Where S is cut off it has less of κ, and where the part c of H is left,
//! the hand is one of cκ/(1 + D − cD) and cD/(1 + D − cD), in the same ratio.
//!
//! Rules whose forces one end alone feels are not in it, as they are not in the [limit](super::stability_limit).

use bevy::math::DVec3;

use crate::body::{Felt, Rule};

use super::{SixParts, bonds};

/// What part of the stiffness of its bonds a particle is pulled with.
const PART: f64 = 0.25;
/// The largest pull, in weights of the body: every particle lifts it.
const MOST_WEIGHTS: f64 = 1.25;
/// The weight of a particle, which also those are pulled by that have none.
const WEIGHT: f64 = 0.32;
/// No pull is larger than what draws a particle alone, across its bonds, by so many initial lengths of the shortest; a bond bursts at ten.
const MOST_LENGTHS: f64 = 6.0;

/// A [`Pull`](crate::body::Pull) as a step reads it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hand {
    pub(super) particle: usize,
    target: DVec3,
    /// κ, a force per step and length.
    stiffness: f64,
    /// D, without unit.
    damping: f64,
    /// The largest S and H.
    most: f64,
}

impl Hand {
    /// The hand at a body that is stepped by `dt`; nothing where none is, or where it holds no particle.
    pub(super) fn of(body: &SixParts<'_>, dt: f64) -> Option<Self> {
        let pull = body.pull.filter(|pull| pull.particle.index() < body.particles.len())?;
        let particle = pull.particle.index();
        let count = body.particles.len() as f64;
        let (factor, squares) = felt_bonds(body, particle);
        let aside = MOST_LENGTHS * squares.iter().copied().fold(f64::INFINITY, f64::min).sqrt();
        // (p_j − p_i)(1 − L²/‖p_j − p_i‖²) across a bond of length L, where ‖p_j − p_i‖² = L² + y².
        let across = |square: &f64| factor * aside * aside * aside / (square + aside * aside);
        let weight = weight(body).max(WEIGHT * count);
        let stiffness = PART * 2.0 * factor * squares.len() as f64;
        let by_step = dt * stiffness;
        Some(Self {
            particle,
            target: pull.target,
            stiffness,
            damping: by_step + 2.0 * (by_step * count).sqrt(),
            most: squares.iter().map(across).sum::<f64>().min(MOST_WEIGHTS * weight),
        })
    }

    /// H of its particle, which is here and would go at this velocity without the hand.
    pub(super) fn pull(&self, position: DVec3, without: DVec3) -> DVec3 {
        let spring = (self.stiffness * (self.target - position)).clamp_length_max(self.most);
        ((spring - self.damping * without) / (1.0 + self.damping)).clamp_length_max(self.most)
    }
}

/// The factor of the bonds that a particle feels, and the squares of their initial lengths; of one that feels none, those of a single bond of a radius.
fn felt_bonds(body: &SixParts<'_>, particle: usize) -> (f64, Vec<f64>) {
    let pairs = body.bonds.relation().pairs().zip(body.bonds.squares());
    let felt = pairs.filter(|((i, j, felt), _)| match felt {
        Felt::Both => *i == particle || *j == particle,
        Felt::First => *i == particle,
        Felt::Second => *j == particle,
    });
    let squares: Vec<_> = felt.map(|(_, square)| bonds::length_squared(*square)).collect();
    let factor = body.bonds.stiffness();
    if factor > 0.0 && !squares.is_empty() { (factor, squares) } else { (1.0, vec![1.0]) }
}

/// What the rules pull all particles down with.
fn weight(body: &SixParts<'_>) -> f64 {
    let weights = body.rules.iter().map(|rule| match rule {
        Rule::Weight(weight) => weight.pull * weight.on.len() as f64,
        _ => 0.0,
    });
    weights.sum()
}
