//! A creature file as data.

use std::borrow::Cow;

use serde::{Deserialize, Deserializer, Serialize, de};

use super::{
    Composed, GardenWorm, Inchworm, JellyPlan, Look, MOST_PARTICLES, Roller, SixSkin, StrandPlan, numbers, parse,
};
use crate::body::{Ground, MassDamping, Wave};

/// A creature: what `*.creature.ron` holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Creature", deny_unknown_fields)]
pub struct Creature {
    /// The version of the format: 1.
    #[serde(deserialize_with = "parse::version")]
    pub version: u32,
    /// Its masses and springs.
    pub body: Plan,
    /// Friction along its spine. Left out: what its kind needs; a raw body without it feels none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Dry friction along and across its spine. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coulomb: Option<Coulomb>,
    /// Damping in proportion to mass, as `Rate(c)` or as the `PerStep(λ)` of damped Verlet. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<MassDamping>,
    /// The strain l/L − 1 at which its springs tear for good, above zero. Left out: they hold.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_positive")]
    pub tear: Option<f64>,
    /// The ground that it stands on where its file is run alone; a scene has its own. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// The name or file of the road that it moves on where its file is run alone, for creatures of the six-matrix particle system; a scene has its own. Left out:
    /// none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub road: Option<String>,
    /// Gravity where its file is run alone; a scene has its own. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_non_negative")]
    pub gravity: Option<f64>,
}

/// Reads nothing but the version of a creature file.
#[derive(Deserialize)]
#[serde(rename = "Creature")]
pub(crate) struct OnlyVersion {
    #[serde(rename = "version", deserialize_with = "parse::version")]
    _version: u32,
}

impl parse::CurrentVersion for Creature {
    type OnlyVersion = OnlyVersion;
}

/// What a creature is made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Body")]
pub enum Plan {
    /// Particles and springs one by one.
    Raw(RawBody),
    /// Three masses in a row.
    GardenWorm(GardenWorm),
    /// A row of cubes with travelling waves.
    Strand(StrandPlan),
    /// A block on a cubic grid.
    Jelly(JellyPlan),
    /// Sixty particles that are one muscle, and two legs.
    Inchworm(Inchworm),
    /// An axle with two wheels and four beams.
    Roller(Roller),
    /// Groups, relations and rules of the six-matrix particle system.
    Composed(Composed),
}

impl Plan {
    /// What it is made of as a creature of the six-matrix particle system; nothing where it has springs.
    pub fn composed(&self) -> Option<Cow<'_, Composed>> {
        match self {
            Self::Inchworm(inchworm) => Some(Cow::Owned(inchworm.composed())),
            Self::Roller(roller) => Some(Cow::Owned(roller.composed())),
            Self::Composed(composed) => Some(Cow::Borrowed(composed)),
            Self::Raw(_) | Self::GardenWorm(_) | Self::Strand(_) | Self::Jelly(_) => None,
        }
    }
}

/// Lists of particles and springs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawBody {
    /// The particles, at least one.
    #[serde(deserialize_with = "particles")]
    pub particles: Vec<RawParticle>,
    /// The springs. Left out: none.
    #[serde(default)]
    pub springs: Vec<RawSpring>,
    /// Particles from tail to head, for friction. Left out: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spine: Vec<u32>,
}

/// One particle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Particle", deny_unknown_fields)]
pub struct RawParticle {
    /// Where it starts: x forward, y up, z right.
    #[serde(deserialize_with = "numbers::vector")]
    pub position: (f64, f64, f64),
    /// Its velocity at the start. Left out: at rest.
    #[serde(default, deserialize_with = "numbers::vector")]
    pub velocity: (f64, f64, f64),
    /// Its mass, above zero; of a pinned particle it may be zero. Left out: 1.
    #[serde(default = "one", deserialize_with = "numbers::non_negative")]
    pub mass: f64,
    /// Whether it stays where it is. Left out: it moves.
    #[serde(default)]
    pub pinned: bool,
}

/// One spring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Spring", deny_unknown_fields)]
pub struct RawSpring {
    /// The particles that it joins, counted from 0.
    pub ends: (u32, u32),
    /// Stiffness k, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub stiffness: f64,
    /// Damping D, zero or more. Left out: 0.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub damping: f64,
    /// Rest length L, above zero. Left out: how far its ends are from each other at the start.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_positive")]
    pub rest_length: Option<f64>,
    /// What drives its rest length. Left out: nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub muscle: Option<RawMuscle>,
}

/// The muscle of a spring: L(t) = L·(1 + ρ·amplitude·wave(t/period − phase)), ρ = min(1, t/(ramp·period)).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Muscle", deny_unknown_fields)]
pub struct RawMuscle {
    /// The form of the wave. Left out: a sine.
    #[serde(default)]
    pub wave: Wave,
    /// Amplitude as a fraction of the rest length, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub amplitude: f64,
    /// Time of one cycle, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub period: f64,
    /// Lag in cycles, positive is later. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub phase: f64,
    /// Cycles over which the amplitude grows from zero. Left out: 0, at once.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub ramp: f64,
}

/// Friction along and across the spine, as rates (1 a unit of time).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Whether a mass can slide back along the spine (`false`) or not. Left out: it cannot.
    #[serde(default = "yes")]
    pub ratchet: bool,
    /// Forward drag μ_f, zero or more. Left out: what the creature's kind needs, 0 for a raw body.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_non_negative")]
    pub drag: Option<f64>,
    /// Side grip μ_l, zero or more. Left out: 0.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub grip: f64,
    /// Friction in all directions μ_iso, zero or more. Left out: 0.
    #[serde(default, skip_serializing_if = "is_zero", deserialize_with = "numbers::non_negative")]
    pub isotropic: f64,
    /// The least drag and side grip while its waves are told to rest, zero or more. Left out: what the creature's kind needs, 0 for a raw body.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_non_negative")]
    pub brake: Option<f64>,
}

/// Dry friction along and across the spine, as coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Against sliding forward, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub forward: f64,
    /// Against sliding backward, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub backward: f64,
    /// Against sliding across, zero or more. Left out: 0.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub sideways: f64,
    /// What presses a mass on, as an acceleration, zero or more. Left out: gravity, and 9.81 where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_non_negative")]
    pub load: Option<f64>,
}

impl Default for Friction {
    fn default() -> Self {
        Self { ratchet: true, drag: None, grip: 0.0, isotropic: 0.0, brake: None }
    }
}

impl Creature {
    /// How many particles its body has, counted without building it.
    pub fn particle_count(&self) -> usize {
        match &self.body {
            Plan::Raw(raw) => raw.particles.len(),
            Plan::GardenWorm(_) => GardenWorm::PARTICLES,
            Plan::Strand(strand) => strand.particles(),
            Plan::Jelly(jelly) => jelly.particles(),
            Plan::Inchworm(_) => Inchworm::PARTICLES,
            Plan::Roller(_) => Roller::PARTICLES,
            Plan::Composed(composed) => composed.particles(),
        }
    }

    /// How it wants to be drawn.
    pub fn look(&self) -> Look {
        match &self.body {
            // What is torn has no skin.
            Plan::Jelly(_) if self.tear.is_none() => Look::Jelly,
            Plan::Raw(_) | Plan::Jelly(_) => Look::Plain,
            Plan::Strand(strand) => Look::Strand(strand.skin),
            Plan::GardenWorm(_) => Look::GardenWorm,
            Plan::Inchworm(_) => Look::SixMatrix(SixSkin::Organic),
            Plan::Roller(_) => Look::SixMatrix(SixSkin::Mechanical),
            Plan::Composed(composed) => Look::SixMatrix(composed.skin),
        }
    }
}

impl From<Plan> for Creature {
    /// A creature with what its kind needs and nothing else.
    fn from(body: Plan) -> Self {
        Self {
            version: 1,
            body,
            friction: None,
            coulomb: None,
            damping: None,
            tear: None,
            ground: None,
            road: None,
            gravity: None,
        }
    }
}

impl From<GardenWorm> for Creature {
    fn from(worm: GardenWorm) -> Self {
        Plan::GardenWorm(worm).into()
    }
}

impl From<RawBody> for Creature {
    fn from(raw: RawBody) -> Self {
        Plan::Raw(raw).into()
    }
}

impl From<Inchworm> for Creature {
    fn from(inchworm: Inchworm) -> Self {
        Plan::Inchworm(inchworm).into()
    }
}

impl From<Roller> for Creature {
    fn from(roller: Roller) -> Self {
        Plan::Roller(roller).into()
    }
}

impl From<Composed> for Creature {
    fn from(composed: Composed) -> Self {
        Plan::Composed(composed).into()
    }
}

impl From<StrandPlan> for Creature {
    fn from(strand: StrandPlan) -> Self {
        Plan::Strand(strand).into()
    }
}

impl From<JellyPlan> for Creature {
    fn from(jelly: JellyPlan) -> Self {
        Plan::Jelly(jelly).into()
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

/// Reads particles and stops at the first that is one too many, before it takes memory.
fn particles<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RawParticle>, D::Error> {
    struct Particles;

    impl<'de> de::Visitor<'de> for Particles {
        type Value = Vec<RawParticle>;

        fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
            f.write_str("a list of particles")
        }

        fn visit_seq<A: de::SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
            let mut particles = Vec::new();
            while let Some(particle) = list.next_element()? {
                if particles.len() == MOST_PARTICLES {
                    return Err(de::Error::custom(format_args!("a scene has at most {MOST_PARTICLES} particles")));
                }
                particles.push(particle);
            }
            Ok(particles)
        }
    }

    deserializer.deserialize_seq(Particles)
}
