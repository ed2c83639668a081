//! What can be set of a body of the six-matrix particle system.

use bevy::{ecs::world::EntityRef, prelude::*};

use super::{facts::Facts, quantity::Group};
use crate::body::{
    BodyError, Bonds, Collisions, Columns, Contraction, Counter, Drive, Leg, Particles, Requirement, Rule, Rules,
    Weight,
};

/// A constant of the formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum SixQuantity {
    Damping,
    BondStiffness,
    CollisionStiffness,
    Strength,
    Half,
    Seek,
    Push,
    Grip,
    Pull,
    Friction,
    Speed,
    Mean,
    Limit,
    Lift,
    Front,
    Side,
    Down,
    Out,
    Reach,
}

impl SixQuantity {
    pub(super) fn facts(self) -> Facts {
        use Requirement::{Finite, NonNegative, Positive};
        const DRIVE: Group = Group::Drive;
        match self {
            Self::Damping => {
                (Group::Particles, "damping", Finite, (0.9, 1.0), "of v", "d: what is kept of a velocity in a step")
            }
            Self::BondStiffness => {
                (Group::Bonds, "stiffness", NonNegative, (0.1, 4.0), "factor", "factor of all bond forces")
            }
            Self::CollisionStiffness => {
                (Group::Collisions, "stiffness", NonNegative, (0.1, 32.0), "factor", "factor of all collision forces")
            }
            Self::Strength => (Group::Muscle, "strength", Finite, (0.0, 0.3), "1/step", "force of the muscle"),
            Self::Half => (
                Group::Muscle,
                "half",
                Positive,
                (100.0, 3000.0),
                "steps",
                "how long contraction and relaxation last each",
            ),
            Self::Seek => (
                Group::Legs,
                "seek",
                Finite,
                (0.0, 1.0),
                "1/step",
                "how strongly a leg is drawn to the nearest road particle",
            ),
            Self::Push => {
                (Group::Legs, "push", Finite, (0.0, 0.5), "1/step", "how strongly a free leg is pushed ahead")
            }
            Self::Grip => {
                (Group::Legs, "grip", Finite, (0.0, 2.0), "1/step", "how strongly a leg that grips holds its place")
            }
            Self::Pull => (
                Group::Weight,
                "pull",
                Finite,
                (0.0, 1.0),
                "length/(time·step)",
                "weight: what is added to a velocity in a step",
            ),
            Self::Friction => (
                DRIVE,
                "friction",
                NonNegative,
                (0.02, 0.5),
                "1/step",
                "road friction: how much of the curves wheels make",
            ),
            Self::Speed => (DRIVE, "speed", Finite, (0.0, 40.0), "length/time", "desired momentum of a wheel"),
            Self::Mean => {
                (DRIVE, "mean", Positive, (5.0, 80.0), "particles", "what the sum of rim speeds is divided by")
            }
            Self::Limit => (DRIVE, "limit", Positive, (1.0, 20.0), "length/(time·step)", "largest control force"),
            Self::Lift => (
                DRIVE,
                "lift",
                Finite,
                (-40.0, 40.0),
                "length",
                "the vertical that beams are built on; above 0 they point back",
            ),
            Self::Front => (DRIVE, "front", Finite, (0.0, 20.0), "length", "how far front beams are ahead"),
            Self::Side => (DRIVE, "side", Finite, (0.0, 20.0), "length", "how far side beams are ahead"),
            Self::Down => (DRIVE, "down", Finite, (-40.0, 40.0), "length", "how steeply beams go down"),
            Self::Out => (DRIVE, "out", Finite, (0.0, 10.0), "length", "how far side beams are outside"),
            Self::Reach => {
                (DRIVE, "reach", Positive, (0.5, 4.0), "length", "how near to a beam a road particle is hit")
            }
        }
    }

    /// The values of a body, one an element; none where the body has no such thing.
    pub(super) fn read(self, body: EntityRef) -> Vec<f64> {
        match self {
            Self::Damping => body.get::<Columns>().map(|columns| columns.damping().to_vec()).unwrap_or_default(),
            Self::BondStiffness => body.get::<Bonds>().map(Bonds::stiffness).into_iter().collect(),
            Self::CollisionStiffness => body.get::<Collisions>().map(Collisions::stiffness).into_iter().collect(),
            _ => {
                let rules = body.get::<Rules>().into_iter().flat_map(Rules::iter);
                rules.filter_map(|rule| self.of_rule(&mut rule.clone()).copied()).collect()
            }
        }
    }

    /// Writes one element of a body.
    pub(super) fn write(self, body: &mut EntityWorldMut, element: usize, value: f64) -> Result<(), BodyError> {
        match self {
            Self::Damping => match body.get_mut::<Columns>() {
                Some(mut columns) => columns.set_damping(element, value),
                None => Ok(()),
            },
            Self::BondStiffness => match body.get_mut::<Bonds>() {
                Some(mut bonds) => bonds.set_stiffness(value),
                None => Ok(()),
            },
            Self::CollisionStiffness => match body.get_mut::<Collisions>() {
                Some(mut collisions) => collisions.set_stiffness(value),
                None => Ok(()),
            },
            _ => {
                let particles = body.get::<Particles>().map_or(0, Particles::len);
                let Some(mut rules) = body.get_mut::<Rules>() else { return Ok(()) };
                let having = |(_, rule): &(usize, &Rule)| self.of_rule(&mut (*rule).clone()).is_some();
                let Some((index, _)) = rules.iter().enumerate().filter(having).nth(element) else { return Ok(()) };
                rules.change(index, particles, |rule| {
                    if let Some(old) = self.of_rule(rule) {
                        *old = value;
                    }
                })
            }
        }
    }

    /// Its place in a rule, if the rule has it.
    fn of_rule(self, rule: &mut Rule) -> Option<&mut f64> {
        match (self, rule) {
            (Self::Strength, Rule::Contraction(Contraction { strength, .. })) => Some(strength),
            (Self::Half, Rule::Counter(Counter { half, .. })) => Some(half),
            (Self::Seek, Rule::Leg(Leg { seek, .. })) => Some(seek),
            (Self::Push, Rule::Leg(Leg { push, .. })) => Some(push),
            (Self::Grip, Rule::Leg(Leg { grip, .. })) => Some(grip),
            (Self::Pull, Rule::Weight(Weight { pull, .. })) => Some(pull),
            (_, Rule::Drive(drive)) => self.of_drive(drive),
            _ => None,
        }
    }

    fn of_drive(self, drive: &mut Drive) -> Option<&mut f64> {
        let beams = &mut drive.beams;
        Some(match self {
            Self::Friction => &mut drive.friction,
            Self::Speed => &mut drive.speed,
            Self::Mean => &mut drive.mean,
            Self::Limit => &mut drive.limit,
            Self::Lift => &mut beams.lift,
            Self::Front => &mut beams.front,
            Self::Side => &mut beams.side,
            Self::Down => &mut beams.down,
            Self::Out => &mut beams.out,
            Self::Reach => &mut beams.reach,
            _ => return None,
        })
    }
}
