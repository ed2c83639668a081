//! Pure functions on a body's data: forces, friction, contact, energy, stability, and the methods of integration.
//!
//! A step does not work on components. [`Model`] and [`State`] hold one body, or several of equal topology side by side in the lanes of a
//! [`Real`], in the layout that the arithmetic wants; the methods in [`integrators`] are written once for
//! all of them. Every operation on a lane is the operation on an `f64`, so a body's bits do not depend on what is stepped
//! beside it.
//!
//! [`six_matrix`] is the second model of motion, whose forces are per step; it shares none of this.

mod advance;
mod contact;
mod coulomb;
mod energy;
mod forces;
mod friction;
mod ground;
pub mod integrators;
mod kinks;
mod lattice;
pub(crate) mod linear;
pub mod metrics;
mod model;
mod pull;
mod quad;
mod real;
pub mod six_matrix;
mod stability;
mod strand;
mod tearing;
mod wave;

pub use advance::{Advance, Timeline};
pub use energy::{angular_momentum, elastic_energy, gravity_energy, kinetic_energy, momentum};
pub use forces::{rest_length, rest_lengths};
pub use ground::{ground_distance, ground_grip};
pub use model::{BodyParts, Explosion, Model, State};
pub use real::{Lanes, Real};
pub use stability::{Damping, Rates, StabilityBound, stability_bound};
pub use wave::sin_cycles;
