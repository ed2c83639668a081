//! What a body is made of: components of one entity, plain data with its invariants, and no systems.
//!
//! A body is **one entity**. [`Particles`], [`Springs`], [`Muscles`], [`Strand`], [`Lattice`], [`TravelingWaves`], [`SpineFriction`], [`CoulombFriction`], [`Gravity`] and
//! [`Ground`] are its components, and each holds flat arrays indexed by particle or by spring, so that a whole body fits the first cache and a step
//! reads memory in order. A body has only the components that its scene needs: without [`Gravity`] there is no gravity.
//!
//! A body of the second model of motion, the six-matrix particle system, has no springs but [`Columns`], [`Bonds`], [`Collisions`] and [`Rules`].
//!
//! Every component is built by a constructor that refuses what cannot be and says which element was wrong
//! ([`BodyError`]). Single elements are read and written as plain structs ([`Particle`], [`Spring`], [`Muscle`]).
//!
//! Lengths, masses and times are pure numbers in whatever units a scene chooses; nothing here assumes SI.

mod columns;
mod coulomb;
mod drive;
mod error;
mod friction;
mod gravity;
mod ground;
mod guidance;
mod lattice;
mod mass_damping;
mod muscles;
mod particles;
mod pull;
mod relation;
mod rules;
mod springs;
mod strand;
mod tearing;
mod waves;

pub use columns::Columns;
pub use coulomb::{Coefficients, CoulombFriction};
pub use drive::{Beams, Drive, Sense, Side, Table, Wheel};
pub use error::{BodyError, Requirement, check};
pub use friction::SpineFriction;
pub use gravity::Gravity;
pub use ground::{Ground, Patch, Surface, Terrain};
pub use guidance::Guidance;
pub(crate) use guidance::Ramp;
pub use lattice::{Lattice, Neighbours};
pub use mass_damping::MassDamping;
pub(crate) use muscles::Epoch;
pub use muscles::{LEAST_REST_FRACTION, Muscle, Muscles, Wave};
pub use particles::{Particle, ParticleId, Particles};
pub use pull::Pull;
pub use relation::{Bonds, Collisions, Felt, Relation};
pub use rules::{Contraction, Counter, Free, Leg, Rule, Rules, Weight};
pub use springs::{Spring, SpringId, Springs};
pub use strand::{Strand, StrandSpring};
pub use tearing::Tearing;
pub use waves::{TravelingWave, TravelingWaves, WaveDirection, WaveKind, longest_period};
