//! Muscles: springs whose rest length is driven.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{BodyError, Requirement, SpringId, Springs, check, error::check_inverse};

/// A driven rest length never falls below this fraction of the rest length: a spring of no length has no direction, and what is
/// driven through zero turns inside out (clamp of the muscle law in Wriggle's model of Miller's animals).
pub const LEAST_REST_FRACTION: f64 = 0.2;

/// The form of a muscle's wave over one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
pub enum Wave {
    /// sin(2πc) at c cycles.
    #[default]
    Sine,
    /// The sign of the sine: +1, −1, and 0 where the sine is 0.
    Square,
}

/// One muscle as plain data. It drives the rest length of a spring to
/// L(t) = L·(1 + ρ·amplitude·wave(t/period − phase)), with ρ = min(1, t/(ramp·period)).
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct Muscle {
    /// The spring that it drives.
    pub spring: SpringId,
    /// The form of its wave.
    pub wave: Wave,
    /// Amplitude, as a fraction of the rest length; zero or more. Above 0.8 the least rest length cuts the wave.
    pub amplitude: f64,
    /// Time of one cycle; above zero.
    pub period: f64,
    /// Lag behind the clock in cycles; positive is later.
    pub phase: f64,
    /// Cycles over which the amplitude grows from zero; 0 for none.
    pub ramp: f64,
}

impl Muscle {
    fn check(&self, index: usize, springs: usize) -> Result<(), BodyError> {
        if self.spring.index() >= springs {
            return Err(BodyError::Missing {
                path: format!("muscles[{index}].spring"),
                what: "spring",
                index: self.spring.0,
                count: springs,
            });
        }
        self.check_numbers(|| format!("muscles[{index}]"))
    }

    /// Whether its numbers can be, of a muscle that is called `name` where it comes from.
    pub(crate) fn check_numbers(&self, name: impl Fn() -> String) -> Result<(), BodyError> {
        for (field, value, requirement) in [
            ("amplitude", self.amplitude, Requirement::NonNegative),
            ("period", self.period, Requirement::Positive),
            ("phase", self.phase, Requirement::Finite),
            ("ramp", self.ramp, Requirement::NonNegative),
        ] {
            check(value, requirement, || format!("{}.{field}", name()))?;
        }
        check_inverse(self.period, "period", || format!("{}.period", name()))
    }
}

/// Where a muscle's cycles are counted from: `cycles` at `time`. It moves when a period changes, so that the wave goes on from
/// where it is instead of jumping.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
pub(crate) struct Epoch {
    pub(crate) time: f64,
    pub(crate) cycles: f64,
}

impl Epoch {
    pub(super) fn cycles_at(self, time: f64, period: f64) -> f64 {
        self.cycles + (time - self.time) / period
    }
}

/// The muscles of a body, at most one a spring.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Muscles {
    springs: usize,
    muscles: Vec<Muscle>,
    epochs: Vec<Epoch>,
}

impl Muscles {
    /// Builds the muscles of a body that has `springs`.
    ///
    /// # Errors
    /// If a muscle drives a spring that is not there or that another drives already, an amplitude or ramp is negative, a period is not
    /// above zero, or a number is not finite.
    pub fn new(muscles: impl IntoIterator<Item = Muscle>, springs: &Springs) -> Result<Self, BodyError> {
        let mut driven = vec![false; springs.len()];
        let mut all = Self { springs: springs.len(), ..Self::default() };
        for (index, muscle) in muscles.into_iter().enumerate() {
            muscle.check(index, springs.len())?;
            if core::mem::replace(&mut driven[muscle.spring.index()], true) {
                return Err(BodyError::Inconsistent {
                    path: format!("muscles[{index}].spring"),
                    problem: format!("spring {} has a muscle already; a spring has at most one", muscle.spring.0),
                });
            }
            all.muscles.push(muscle);
            all.epochs.push(Epoch::default());
        }
        Ok(all)
    }

    /// How many muscles there are.
    pub fn len(&self) -> usize {
        self.muscles.len()
    }

    /// Whether there is no muscle.
    pub fn is_empty(&self) -> bool {
        self.muscles.is_empty()
    }

    /// The muscles in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Muscle> + '_ {
        self.muscles.iter().copied()
    }

    /// The muscle at `index`, or nothing where there is no such muscle.
    pub fn get(&self, index: usize) -> Option<Muscle> {
        self.muscles.get(index).copied()
    }

    /// Replaces a muscle at time `time`. A changed period takes effect from there on: the wave goes on from where it is.
    ///
    /// # Errors
    /// As [`new`](Self::new), where there is no such muscle, and if it would drive another spring; nothing is changed then.
    pub fn set(&mut self, index: usize, muscle: Muscle, time: f64) -> Result<(), BodyError> {
        let Some(old) = self.get(index) else {
            return Err(BodyError::Inconsistent {
                path: format!("muscles[{index}]"),
                problem: format!("there is no such muscle; this body has {}", self.len()),
            });
        };
        muscle.check(index, self.springs)?;
        if muscle.spring != old.spring {
            return Err(BodyError::Inconsistent {
                path: format!("muscles[{index}].spring"),
                problem: "a muscle stays with its spring; build new Muscles instead".into(),
            });
        }
        if muscle.period != old.period {
            self.epochs[index] = Epoch { time, cycles: self.epochs[index].cycles_at(time, old.period) };
        }
        self.muscles[index] = muscle;
        Ok(())
    }

    /// Counts cycles from time zero again, as at the start of a scene.
    pub fn rewind(&mut self) {
        self.epochs.fill(Epoch::default());
    }

    /// Where each muscle's cycles are counted from.
    pub(crate) fn epochs(&self) -> &[Epoch] {
        &self.epochs
    }
}
