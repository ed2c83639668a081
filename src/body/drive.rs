//! Wheels with eyes: observation by beams, decision by a table, and steering.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use super::{BodyError, ParticleId, Requirement, check, rules::there};

/// Wheels that are driven by what beams see of the road (Holopainen and Rönkkö 2007, section 4). A rim particle feels
/// R = −friction·⟨it touches the road⟩·v + θ·norm((p − hub) × axis), θ = max(−limit, min(φ, limit)),
/// φ = speed·ω + ⟨ω ≠ 0⟩·(ς/mean)·Σ‖v_hub − v_k‖ over the rim; ς is against the present rotation, ω the goal direction that the table gives.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct Drive {
    /// The left and the right end of the axle, from which the beams go out.
    pub eyes: [ParticleId; 2],
    /// The wheels, as many as there are.
    pub wheels: Vec<Wheel>,
    /// How the beams lie.
    pub beams: Beams,
    /// What is decided.
    pub table: Table,
    /// How the present rotation is found.
    pub sense: Sense,
    /// What a touching rim particle loses of its velocity in a step; 0.02 in print. It decides whether the creature can turn.
    pub friction: f64,
    /// The desired momentum of a wheel that is driven; 20 in print.
    pub speed: f64,
    /// What the sum of rim speeds is divided by; 20 in print, the number of rim particles.
    pub mean: f64,
    /// The largest control force; 10 in print.
    pub limit: f64,
}

/// A wheel.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct Wheel {
    /// The particles around it in the order top, rear, bottom, front; three or more.
    pub rim: Vec<ParticleId>,
    /// Its middle.
    pub hub: ParticleId,
    /// From where to where its axis points: to the right.
    pub axis: [ParticleId; 2],
    /// Which of the two goal directions it follows.
    pub side: Side,
}

/// A side of a creature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum Side {
    /// The left.
    Left,
    /// The right.
    Right,
}

/// How four beams lie: with a = p_right − p_left, n = norm(a × (0, lift, 0)) and ñ = (out·n₁, n₂, out·n₃), front beams go along (front·n₁, down, front·n₃) × a,
/// side beams along (side·n₁, down, side·n₃) × (a ± ñ), + on the left. They are whole lines. A beam hits a road particle whose distance from it is below `reach`.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Beams {
    /// The vertical component of y; −20 restored. +20 turns the beams backwards.
    pub lift: f64,
    /// How far front beams are ahead; 9 in print.
    pub front: f64,
    /// How far side beams are ahead; 7 in print.
    pub side: f64,
    /// How steeply they go down; 20 in print.
    pub down: f64,
    /// How far side beams are outside; 3 in print.
    pub out: f64,
    /// How near a road particle must be; 1.5 in print.
    pub reach: f64,
}

impl Default for Beams {
    fn default() -> Self {
        Self { lift: -20.0, front: 9.0, side: 7.0, down: 20.0, out: 3.0, reach: 1.5 }
    }
}

/// Goal directions of the left and the right wheels, 1 forwards, −1 backwards and 0 free, by what misses the road. Rows are tried from the last one up.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Table {
    /// No beam.
    pub none: (f64, f64),
    /// Only the left side beam.
    pub left_side: (f64, f64),
    /// Only the right side beam.
    pub right_side: (f64, f64),
    /// Both side beams.
    pub both_sides: (f64, f64),
    /// The left or the right front beam.
    pub front: (f64, f64),
}

impl Default for Table {
    /// As restored from print, which lost its minus signs: the wheel opposite to the beam that misses brakes.
    fn default() -> Self {
        Self {
            none: (1.0, 1.0),
            left_side: (0.0, -1.0),
            right_side: (-1.0, 0.0),
            both_sides: (-1.0, -1.0),
            front: (-1.0, -1.0),
        }
    }
}

/// How ς, the present direction of a wheel, is found from the topmost rim particle τ and the lowest β: ς = 1 if Σ(2σ(k) − 1)·v(k,2) < 0, else −1,
/// where σ picks the rim particles behind the axle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum Sense {
    /// σ(k) = ⟨τ > β⟩(⟨k > τ⟩ + ⟨k < β⟩) + ⟨τ < β⟩⟨τ < k ∧ k < β⟩.
    #[default]
    Restored,
    /// σ(k) = (⟨τ > β ∧ k > τ⟩ + ⟨τ > β ∧ k < β⟩)·⟨τ < β ∧ τ < k ∧ k < β⟩, with ∧ for all that print lost. It is never 1: wheels spin up and tear.
    Printed,
    /// The same product with ⇒ for the first lost symbol of each bracket: it drives as the restored sum does.
    Implied,
    /// As restored, with the signs of ς changed over. Wheels spin up without bound.
    Reversed,
}

impl Drive {
    pub(super) fn check(&self, path: &str, particles: usize) -> Result<(), BodyError> {
        there(path, "eyes", &self.eyes, particles)?;
        for (i, wheel) in self.wheels.iter().enumerate() {
            let path = format!("{path}.wheels[{i}]");
            there(&path, "rim", &wheel.rim, particles)?;
            there(&path, "hub", &[wheel.hub], particles)?;
            there(&path, "axis", &wheel.axis, particles)?;
            if wheel.rim.len() < 3 {
                let count = wheel.rim.len();
                let problem =
                    format!("has {count} particles; a wheel has three or more, in the order top, rear, bottom, front");
                return Err(BodyError::Inconsistent { path: format!("{path}.rim"), problem });
            }
        }
        let Beams { lift, front, side, down, out, reach } = self.beams;
        let Table { none, left_side, right_side, both_sides, front: ahead } = self.table;
        let finite = [
            ("friction", self.friction),
            ("speed", self.speed),
            ("beams.lift", lift),
            ("beams.front", front),
            ("beams.side", side),
            ("beams.down", down),
            ("beams.out", out),
        ];
        for (field, value) in finite {
            check(value, Requirement::Finite, || format!("{path}.{field}"))?;
        }
        for (field, value) in [("mean", self.mean), ("limit", self.limit), ("beams.reach", reach)] {
            check(value, Requirement::Positive, || format!("{path}.{field}"))?;
        }
        let rows = [
            ("none", none),
            ("left_side", left_side),
            ("right_side", right_side),
            ("both_sides", both_sides),
            ("front", ahead),
        ];
        for (row, (left, right)) in rows {
            if [left, right].iter().any(|goal| ![-1.0, 0.0, 1.0].contains(goal)) {
                let problem = format!(
                    "({left}, {right}) is not allowed; give −1 (backwards), 0 (free) or 1 (forwards) for each side"
                );
                return Err(BodyError::Inconsistent { path: format!("{path}.table.{row}"), problem });
            }
        }
        Ok(())
    }
}
