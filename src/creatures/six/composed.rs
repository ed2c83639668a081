//! A creature of the six-matrix particle system as a file writes it.

use serde::{Deserialize, Serialize};

use crate::{
    body::{Beams, Free, Sense, Side, Table},
    creatures::numbers,
};

/// A creature in its own frame: p⁰ as the particles' places, b and c by groups and distances, R and M by rules.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Composed {
    /// The particles, numbered group after group.
    pub groups: Vec<GroupPlan>,
    /// b: which particles keep the distance that they have at the start.
    #[serde(default)]
    pub bonds: Vec<PairPlan>,
    /// c: which particles of the body push each other apart. All collide with the road. Left out: none.
    #[serde(default)]
    pub collisions: Vec<PairPlan>,
    /// R and M. Left out: none.
    #[serde(default)]
    pub rules: Vec<RulePlan>,
    /// Which way it goes in its own frame, for placing it on a road. Left out: +z.
    #[serde(default = "z", deserialize_with = "numbers::vector")]
    pub forward: (f64, f64, f64),
    /// How it is drawn. Left out: particle by particle.
    #[serde(default)]
    pub skin: SixSkin,
}

/// Particles that have a name together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Group", deny_unknown_fields)]
pub struct GroupPlan {
    /// The name by which bonds and rules call them.
    pub name: String,
    /// Where they are.
    pub shape: Shape,
    /// d: the part of its velocity that each keeps in a step. Left out: 1.
    #[serde(default = "one", deserialize_with = "numbers::finite")]
    pub damping: f64,
}

/// Where the particles of a group are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// A straight row: particle i is at from + i·step.
    Row {
        /// How many.
        count: u32,
        /// Where the first is.
        #[serde(deserialize_with = "numbers::vector")]
        from: (f64, f64, f64),
        /// From one to the next.
        #[serde(deserialize_with = "numbers::vector")]
        step: (f64, f64, f64),
    },
    /// A wheel about an axis along x: particle i is at center + radius·(0, cos(π·angle·i), sin(π·angle·i)).
    Ring {
        /// How many.
        count: u32,
        /// Its middle.
        #[serde(deserialize_with = "numbers::vector")]
        center: (f64, f64, f64),
        /// Its radius.
        #[serde(deserialize_with = "numbers::finite")]
        radius: f64,
        /// From one to the next, in half turns.
        #[serde(deserialize_with = "numbers::finite")]
        angle: f64,
    },
    /// One by one.
    Points(Vec<(f64, f64, f64)>),
}

/// Pairs of particles: each of the groups `of` feels each of the groups `with`, itself excepted. It is a relation in one direction: name a group on both
/// sides where both are to feel it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Pairs", deny_unknown_fields)]
pub struct PairPlan {
    /// The groups that feel it.
    pub of: Vec<String>,
    /// The groups that they feel.
    pub with: Vec<String>,
    /// Only those nearer than this at the start, and not in the same place. Left out: also the far ones.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_positive")]
    pub nearer: Option<f64>,
    /// Only those farther than this at the start. Left out: also the near ones.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_non_negative")]
    pub farther: Option<f64>,
}

/// One particle: the name of its group, and its number in it from 0.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ParticlePlace(pub String, pub u32);

/// A stretch of a group: its name, the number of the first particle and that of the first one behind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RangePlace(pub String, pub u32, pub u32);

/// A rule with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum RulePlan {
    /// A muscle with a phase that it counts.
    Muscle(MusclePlan),
    /// A leg.
    Leg(LegPlan),
    /// Weight.
    Gravity(WeightPlan),
    /// Wheels with eyes.
    WheelDrive(DrivePlan),
}

/// A muscle: R = strength·⟨0 < m(i,1)⟩·(p_to − p_from) on a stretch of particles, and a counter M on whole groups.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Muscle", deny_unknown_fields)]
pub struct MusclePlan {
    /// The groups whose particles count the phase.
    pub counting: Vec<String>,
    /// How many steps contraction and relaxation last each, above zero. Left out: 1000.
    #[serde(default = "thousand", deserialize_with = "numbers::positive")]
    pub half: f64,
    /// The particles that it moves; they must count.
    pub on: RangePlace,
    /// From where it pulls …
    pub from: ParticlePlace,
    /// … to where.
    pub to: ParticlePlace,
    /// How strongly.
    #[serde(deserialize_with = "numbers::finite")]
    pub strength: f64,
}

/// A leg; see [`body::Leg`](crate::body::Leg).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Leg", deny_unknown_fields)]
pub struct LegPlan {
    /// The particle. Its memory begins with the place where it starts.
    pub particle: ParticlePlace,
    /// Whose counter it goes by.
    pub clock: ParticlePlace,
    /// When it may move.
    pub free: Free,
    /// How strongly it is drawn to the nearest road particle. Left out: 0.5.
    #[serde(default = "half", deserialize_with = "numbers::finite")]
    pub seek: f64,
    /// How strongly it is pushed away from another particle while it is free. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub push: f64,
    /// That particle. Left out: itself, so that nothing pushes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<ParticlePlace>,
    /// How strongly it is drawn to its memory while it grips. Left out: 1.
    #[serde(default = "one", deserialize_with = "numbers::finite")]
    pub grip: f64,
}

/// Weight: R = (0, −pull, 0).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Gravity", deny_unknown_fields)]
pub struct WeightPlan {
    /// The groups that have it.
    pub on: Vec<String>,
    /// What it adds to a velocity in a step, downwards. Left out: 0.32.
    #[serde(default = "printed_weight", deserialize_with = "numbers::finite")]
    pub pull: f64,
}

/// Wheels with eyes; see [`body::Drive`](crate::body::Drive).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "WheelDrive", deny_unknown_fields)]
pub struct DrivePlan {
    /// The left end of the axle, from which beams go out …
    pub left: ParticlePlace,
    /// … and the right end.
    pub right: ParticlePlace,
    /// The wheels.
    pub wheels: Vec<WheelPlan>,
    /// How the beams lie. Left out: as restored.
    #[serde(default)]
    pub beams: Beams,
    /// What is decided. Left out: as restored.
    #[serde(default)]
    pub table: Table,
    /// How the present rotation is found. Left out: as restored.
    #[serde(default)]
    pub sense: Sense,
    /// What a touching rim particle loses of its velocity in a step. Left out: 0.02.
    #[serde(default = "friction", deserialize_with = "numbers::finite")]
    pub friction: f64,
    /// The desired momentum. Left out: 20.
    #[serde(default = "twenty", deserialize_with = "numbers::finite")]
    pub speed: f64,
    /// What the sum of rim speeds is divided by. Left out: 20.
    #[serde(default = "twenty", deserialize_with = "numbers::positive")]
    pub mean: f64,
    /// The largest control force. Left out: 10.
    #[serde(default = "ten", deserialize_with = "numbers::positive")]
    pub limit: f64,
}

/// A wheel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Wheel", deny_unknown_fields)]
pub struct WheelPlan {
    /// The group of its rim, three particles or more in the order top, rear, bottom, front.
    pub rim: String,
    /// Its middle.
    pub hub: ParticlePlace,
    /// From where its axis points …
    pub from: ParticlePlace,
    /// … to where: to the right.
    pub to: ParticlePlace,
    /// Which goal direction it follows.
    pub side: Side,
}

/// How a creature of the six-matrix particle system is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, bevy::reflect::Reflect, Serialize, Deserialize)]
pub enum SixSkin {
    /// A ball a particle.
    #[default]
    Plain,
    /// A tube with segments through all particles that are no legs, in their order, and legs.
    Organic,
    /// Tyres, axles and beams.
    Mechanical,
}

fn z() -> (f64, f64, f64) {
    (0.0, 0.0, 1.0)
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

fn printed_weight() -> f64 {
    0.32
}

fn thousand() -> f64 {
    1000.0
}

fn friction() -> f64 {
    0.02
}

fn ten() -> f64 {
    10.0
}

fn twenty() -> f64 {
    20.0
}
