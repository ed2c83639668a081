//! Waves of muscle that travel along a strand.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{
    BodyError, LEAST_REST_FRACTION, Muscles, Requirement, Wave, check, error::check_inverse, guidance::Ramp,
    muscles::Epoch,
};

/// Which sides of a segment a wave makes longer and shorter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
pub enum WaveKind {
    /// All four axial edges together: the segment stretches and shortens.
    Longitudinal,
    /// The left ones against the right ones: the body bends sideways, to the right where the wave is positive.
    Lateral,
    /// The upper ones against the lower ones: the body bends in its upright plane, its ends down where the wave is positive.
    Vertical,
}

/// Which way a wave runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
pub enum WaveDirection {
    /// σ = +1.
    #[default]
    HeadToTail,
    /// σ = −1.
    TailToHead,
}

/// One wave as plain data: it drives segment j of n by amplitude·form(t/period − σ(n − j − ½)/wavelength + lead).
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct TravelingWave {
    /// Which sides it drives.
    pub kind: WaveKind,
    /// The form of one cycle.
    pub form: Wave,
    /// Amplitude, as a fraction of the rest length; zero or more.
    pub amplitude: f64,
    /// Time of one cycle; above zero.
    pub period: f64,
    /// Length of one wave in segments; above zero.
    pub wavelength: f64,
    /// Which way it runs.
    pub direction: WaveDirection,
    /// By how many cycles it is ahead; ¼ is a lead of 90°.
    pub lead: f64,
}

impl TravelingWave {
    fn check(&self, index: usize) -> Result<(), BodyError> {
        for (field, value, requirement) in [
            ("amplitude", self.amplitude, Requirement::NonNegative),
            ("period", self.period, Requirement::Positive),
            ("wavelength", self.wavelength, Requirement::Positive),
            ("lead", self.lead, Requirement::Finite),
        ] {
            check(value, requirement, || format!("waves[{index}].{field}"))?;
        }
        check_inverse(self.period, "period", || format!("waves[{index}].period"))
    }
}

/// The muscles of a [`Strand`](super::Strand): waves along it, steering, and how strongly they work.
///
/// They drive the axial rest length of segment j at corner c to L·max(0.2, 1 + ρ(long + s(lateral + b) + h·vertical)), each the sum of the waves of that
/// kind, with s = +1 on the left and −1 on the right, h = +1 above and −1 below, steering b (positive turns right, +z for a head at +x) and the activity ρ, which
/// grows from 0 to 1 over the ramp and falls back to 0 over as long when the muscles are told to rest.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct TravelingWaves {
    waves: Vec<TravelingWave>,
    epochs: Vec<Epoch>,
    steering: f64,
    ramp: f64,
    /// From 0, at rest, to 1.
    activity: Ramp,
}

impl TravelingWaves {
    /// The muscles of a strand with these waves, no steering, and a ramp of one cycle from time zero.
    ///
    /// # Errors
    /// If an amplitude is negative, a period or wavelength is not above zero, or a number is not finite.
    pub fn new(waves: impl IntoIterator<Item = TravelingWave>) -> Result<Self, BodyError> {
        let waves: Vec<_> = waves.into_iter().collect();
        waves.iter().enumerate().try_for_each(|(index, wave)| wave.check(index))?;
        let epochs = vec![Epoch::default(); waves.len()];
        let mut all = Self { waves, epochs, steering: 0.0, ramp: 1.0, activity: Ramp::steady(1.0) };
        all.ramp_from(0.0, 0.0);
        Ok(all)
    }

    /// Sets the steering b, as a fraction of the rest length.
    ///
    /// # Errors
    /// If it is not finite.
    pub fn with_steering(mut self, steering: f64) -> Result<Self, BodyError> {
        self.steering = check(steering, Requirement::Finite, || "waves.steering".into())?;
        Ok(self)
    }

    /// Sets the ramp, in cycles of the slowest wave; with 0 the muscles work fully at once.
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn with_ramp(mut self, ramp: f64) -> Result<Self, BodyError> {
        self.set_ramp(ramp, 0.0)?;
        Ok(self)
    }

    /// How many waves there are.
    pub fn len(&self) -> usize {
        self.waves.len()
    }

    /// Whether there is no wave.
    pub fn is_empty(&self) -> bool {
        self.waves.is_empty()
    }

    /// The waves in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = TravelingWave> + '_ {
        self.waves.iter().copied()
    }

    /// The wave at `index`, or nothing where there is no such wave.
    pub fn get(&self, index: usize) -> Option<TravelingWave> {
        self.waves.get(index).copied()
    }

    /// Replaces a wave at time `time`. A changed period takes effect from there on: the wave goes on from where it is.
    ///
    /// # Errors
    /// As [`new`](Self::new), and where there is no such wave; nothing is changed then.
    pub fn set(&mut self, index: usize, wave: TravelingWave, time: f64) -> Result<(), BodyError> {
        let Some(old) = self.get(index) else {
            return Err(BodyError::Inconsistent {
                path: format!("waves[{index}]"),
                problem: format!("there is no such wave; this body has {}", self.len()),
            });
        };
        wave.check(index)?;
        let active = self.activity_at(time);
        self.waves[index] = wave;
        if wave.period != old.period {
            self.epochs[index] = Epoch { time, cycles: self.epochs[index].cycles_at(time, old.period) };
            self.ramp_from(active, time);
        }
        Ok(())
    }

    /// The steering b.
    pub fn steering(&self) -> f64 {
        self.steering
    }

    /// Changes the steering b at once.
    ///
    /// # Errors
    /// If it is not finite; nothing is changed then.
    pub fn set_steering(&mut self, steering: f64) -> Result<(), BodyError> {
        self.steering = check(steering, Requirement::Finite, || "waves.steering".into())?;
        Ok(())
    }

    /// The ramp, in cycles of the slowest wave.
    pub fn ramp(&self) -> f64 {
        self.ramp
    }

    /// Changes the ramp at time `time`; what it has come to stays.
    ///
    /// # Errors
    /// If it is negative or not finite; nothing is changed then.
    pub fn set_ramp(&mut self, ramp: f64, time: f64) -> Result<(), BodyError> {
        check(ramp, Requirement::NonNegative, || "waves.ramp".into())?;
        let active = self.activity_at(time);
        self.ramp = ramp;
        self.ramp_from(active, time);
        Ok(())
    }

    /// Whether the muscles work, or are told to: `false` once they are told to rest, also while they still ramp out.
    pub fn is_active(&self) -> bool {
        self.activity.to > 0.0
    }

    /// Tells the muscles to work or to rest from time `time` on. They come to it over the ramp, and while they are told to rest the friction of the body
    /// [brakes](super::SpineFriction::brake).
    pub fn set_active(&mut self, active: bool, time: f64) {
        if active != self.is_active() {
            let now = self.activity_at(time);
            self.activity.to = if active { 1.0 } else { 0.0 };
            self.ramp_from(now, time);
        }
    }

    /// ρ at `time`, from 0 to 1: how strongly the muscles work.
    pub fn activity_at(&self, time: f64) -> f64 {
        self.activity.at(time)
    }

    /// The longest period of all waves, or nothing where there is no wave.
    pub fn longest_period(&self) -> Option<f64> {
        self.waves.iter().map(|wave| wave.period).reduce(f64::max)
    }

    /// By how much the waves and the steering can drive a rest length at most, as a fraction of it. Above
    /// [0.8](LEAST_REST_FRACTION) the least rest length may cut the waves.
    pub fn reach(&self) -> f64 {
        self.waves.iter().map(|wave| wave.amplitude).sum::<f64>() + self.steering.abs()
    }

    /// Whether the least rest length may cut the waves.
    pub fn is_cut(&self) -> bool {
        // What a sum rounds is no mistake.
        self.reach() > 1.0 - LEAST_REST_FRACTION + 1e-12
    }

    /// Counts cycles and the ramp from time zero again, as at the start of a scene.
    pub fn rewind(&mut self) {
        self.epochs.fill(Epoch::default());
        self.ramp_from(0.0, 0.0);
    }

    /// Where each wave's cycles are counted from.
    pub(crate) fn epochs(&self) -> &[Epoch] {
        &self.epochs
    }

    /// How strongly the muscles work.
    pub(crate) fn activity(&self) -> Ramp {
        self.activity
    }

    fn ramp_from(&mut self, from: f64, time: f64) {
        let cycle = self.longest_period().unwrap_or(0.0);
        self.activity = Ramp::towards(from, self.activity.to, time, self.ramp * cycle);
    }
}

/// The longest period of all muscles and waves of a body, or nothing where it has none.
pub fn longest_period(muscles: Option<&Muscles>, waves: Option<&TravelingWaves>) -> Option<f64> {
    let muscles = muscles.into_iter().flat_map(Muscles::iter).map(|muscle| muscle.period);
    muscles.chain(waves.and_then(TravelingWaves::longest_period)).reduce(f64::max)
}
