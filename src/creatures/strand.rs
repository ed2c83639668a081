//! Snakes and worms: a strand of cubes with waves of muscle (G. S. P. Miller, "The Motion Dynamics of Snakes and Worms", 1988).

use bevy::math::DVec3;
use serde::{Deserialize, Deserializer, Serialize, de};

use super::{MOST_PARTICLES, RawBody, RawParticle, RawSpring, Skin, numbers};
use crate::body::{BodyError, Springs, Strand, TravelingWave, TravelingWaves, Wave, WaveDirection, WaveKind};

/// A row of cubes of edge 1 from the tail at x = 0 to the head at x = segments, standing on y = 0 and symmetric about z = 0. A new gait is another list
/// of waves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Strand", deny_unknown_fields)]
pub struct StrandPlan {
    /// How many cubes there are, 2 or more.
    #[serde(deserialize_with = "segments")]
    pub segments: u32,
    /// Stiffness k of all springs, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub stiffness: f64,
    /// Damping D of all springs, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub damping: f64,
    /// Mass of each particle, above zero. Left out: 1.
    #[serde(default = "one", deserialize_with = "numbers::positive")]
    pub mass: f64,
    /// Whether segments keep their volume: they grow thicker where they grow short. Left out: they do not.
    #[serde(default)]
    pub bulge: bool,
    /// The waves of its muscles. Left out: none.
    #[serde(default)]
    pub waves: Vec<WavePlan>,
    /// Steering b: by how much the left side is longer and the right side shorter, so that it turns right. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub steering: f64,
    /// Cycles of the slowest wave over which the muscles come to work. Left out: 1.
    #[serde(default = "one", deserialize_with = "numbers::non_negative")]
    pub ramp: f64,
    /// How it is drawn. Left out: as a worm.
    #[serde(default)]
    pub skin: Skin,
}

/// A wave that drives the axial springs of segment j of n by amplitude·form(t/period ∓ (n − j − ½)/wavelength + lead).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Wave", deny_unknown_fields)]
pub struct WavePlan {
    /// Which sides of the body it drives against which.
    pub kind: WaveKind,
    /// Its form. Left out: a sine.
    #[serde(default)]
    pub form: Wave,
    /// Amplitude as a fraction of the rest length, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub amplitude: f64,
    /// Time of one cycle, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub period: f64,
    /// Length of one wave in segments, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub wavelength: f64,
    /// Which way it runs. Left out: from head to tail.
    #[serde(default)]
    pub direction: WaveDirection,
    /// By how many cycles it is ahead. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub lead: f64,
}

impl StrandPlan {
    /// The brake that holds a strand whose muscles are told to rest: without it a snake coasts on for more than its length.
    pub const BRAKE: f64 = 0.5;

    /// How many particles it has.
    pub fn particles(&self) -> usize {
        4 * (self.segments as usize + 1)
    }

    /// Its particles and springs one by one.
    pub fn raw(&self) -> RawBody {
        let particle = |i: usize| {
            let (section, corner) = ((i / 4) as f64, i % 4);
            let (y, z) = [(0.0, -0.5), (0.0, 0.5), (1.0, 0.5), (1.0, -0.5)][corner];
            RawParticle { position: (section, y, z), velocity: (0.0, 0.0, 0.0), mass: self.mass, pinned: false }
        };
        let particles: Vec<_> = (0..self.particles()).map(particle).collect();
        let place = |i: u32| particles.get(i as usize).map_or(DVec3::ZERO, |particle| DVec3::from(particle.position));
        let spring = |[a, b]: [crate::body::ParticleId; 2]| RawSpring {
            ends: (a.0, b.0),
            stiffness: self.stiffness,
            damping: self.damping,
            rest_length: Some(place(a.0).distance(place(b.0))),
            muscle: None,
        };
        let springs = Strand::ends(self.segments).map(spring).collect();
        RawBody { particles, springs, spine: Vec::new() }
    }

    /// The lattice that it is, of the springs of [`raw`](Self::raw).
    pub(super) fn strand(&self, springs: &Springs) -> Result<Strand, BodyError> {
        Ok(Strand::new(self.segments, springs)?.with_bulge(self.bulge))
    }

    /// Its muscles.
    pub(super) fn waves(&self) -> Result<TravelingWaves, BodyError> {
        let wave = |wave: &WavePlan| TravelingWave {
            kind: wave.kind,
            form: wave.form,
            amplitude: wave.amplitude,
            period: wave.period,
            wavelength: wave.wavelength,
            direction: wave.direction,
            lead: wave.lead,
        };
        TravelingWaves::new(self.waves.iter().map(wave))?.with_steering(self.steering)?.with_ramp(self.ramp)
    }
}

fn one() -> f64 {
    1.0
}

/// Reads a number of segments that makes a strand, and one for which there is memory.
fn segments<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let most = (MOST_PARTICLES / 4 - 1) as u32;
    match u32::deserialize(deserializer)? {
        segments if (2..=most).contains(&segments) => Ok(segments),
        segments => {
            Err(de::Error::custom(format_args!("{segments} is not allowed; a strand has from 2 to {most} segments")))
        }
    }
}
