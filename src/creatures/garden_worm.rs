//! The garden worm: three masses and two springs in a row ("Simulating motion dynamics of a worm using a 3 mass-2 spring
//! system", Anirudh Ravi).

use serde::{Deserialize, Serialize};

use super::{RawBody, RawMuscle, RawParticle, RawSpring, numbers};
use crate::body::Wave;

/// Three equal masses A (tail), B and C (head) on the x axis, joined by two equal springs whose muscles pull one after the other.
///
/// The document gives the model; the values that it leaves open are the defaults here: with them the worm crawls 0.70
/// lengths a cycle and every mass rests for a quarter to a third of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GardenWorm {
    /// Stiffness k of both springs, zero or more. Default 1.5.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub stiffness: f64,
    /// Damping D of both springs, zero or more. Default 0.9.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub damping: f64,
    /// Mass of each particle, above zero. Default 1.
    #[serde(deserialize_with = "numbers::positive")]
    pub mass: f64,
    /// Rest length L of both springs, above zero. Default 1.
    #[serde(deserialize_with = "numbers::positive")]
    pub rest_length: f64,
    /// Amplitude of both muscles, a fraction of L, zero or more. Default 0.3.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub amplitude: f64,
    /// Time of a cycle, above zero. Default 6.
    #[serde(deserialize_with = "numbers::positive")]
    pub period: f64,
    /// Lag of the front spring BC behind AB, in cycles. Default 0.25.
    #[serde(deserialize_with = "numbers::finite")]
    pub phase: f64,
    /// Cycles over which the amplitude grows from zero. Default 1.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub ramp: f64,
}

impl Default for GardenWorm {
    fn default() -> Self {
        Self {
            stiffness: 1.5,
            damping: 0.9,
            mass: 1.0,
            rest_length: 1.0,
            amplitude: 0.3,
            period: 6.0,
            phase: 0.25,
            ramp: 1.0,
        }
    }
}

impl GardenWorm {
    /// How many particles it has.
    pub const PARTICLES: usize = 3;
    /// The forward drag μ_f with which it comes to rest: the ratchet alone would let it glide for ever.
    pub const DRAG: f64 = 0.5;

    /// The same as lists of particles and springs.
    pub fn raw(&self) -> RawBody {
        let particle = |i: f64| RawParticle {
            position: (i * self.rest_length, 0.0, 0.0),
            velocity: (0.0, 0.0, 0.0),
            mass: self.mass,
            pinned: false,
        };
        let spring = |ends, phase| RawSpring {
            ends,
            stiffness: self.stiffness,
            damping: self.damping,
            rest_length: Some(self.rest_length),
            muscle: Some(RawMuscle {
                wave: Wave::Sine,
                amplitude: self.amplitude,
                period: self.period,
                phase,
                ramp: self.ramp,
            }),
        };
        RawBody {
            particles: vec![particle(0.0), particle(1.0), particle(2.0)],
            springs: vec![spring((0, 1), 0.0), spring((1, 2), self.phase)],
            spine: vec![0, 1, 2],
        }
    }
}
