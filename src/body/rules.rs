//! The reaction R and the memory update M of the six-matrix particle system, as rules that a creature is made of.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{BodyError, Drive, ParticleId, Requirement, check};

/// What particles do of themselves, in the order in which it is added up. A body with this component moves by the six-matrix model of motion and has no
/// [`Springs`](super::Springs) and no method of integration: its forces are added to the velocity in each step and not multiplied by dt
/// (Holopainen and Rönkkö 2007, section 2).
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Rules {
    rules: Vec<Rule>,
}

/// One rule.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub enum Rule {
    /// A phase that is counted in memory.
    Counter(Counter),
    /// A muscle.
    Contraction(Contraction),
    /// A leg.
    Leg(Leg),
    /// Weight.
    Weight(Weight),
    /// Wheels with eyes.
    Drive(Drive),
}

/// The phase of a muscle, m(i,1): M = (m(i,1) + 1 − 2·half·⟨half − 1 < m(i,1)⟩, 0, 0). It counts 0, 1, …, half, 1 − half, …, 0, …
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct Counter {
    /// The particles that count.
    pub on: Vec<ParticleId>,
    /// How many steps contraction and relaxation last each, above zero; 1000 in print.
    pub half: f64,
}

/// A muscle that works while its particles count above zero: R = strength·⟨0 < m(i,1)⟩·(p_to − p_from).
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct Contraction {
    /// The particles that it moves; each goes by its own counter.
    pub on: Vec<ParticleId>,
    /// From where to where it pulls.
    pub along: [ParticleId; 2],
    /// How strongly; 0.1 in print.
    pub strength: f64,
}

/// When a leg may move. At any time it does or it grips.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum Free {
    /// While the muscle contracts: 0 ≤ m(clock,1).
    Contracting,
    /// While it relaxes: m(clock,1) < 0.
    Relaxing,
}

/// A leg, which is one particle. With β = 1 while it is free, γ = 1 − β, and the road particle α that is nearest to it:
/// R = seek·(p_α − p) + push·β·(p − p_from) + grip·γ·(m − p), M = γm + βp.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct Leg {
    /// The particle.
    pub particle: ParticleId,
    /// Whose counter it goes by.
    pub clock: ParticleId,
    /// When it is free.
    pub free: Free,
    /// How strongly it is drawn to the nearest road particle, however far that is; 0.5 in print. Where there is no road, it is not.
    pub seek: f64,
    /// How strongly it is pushed away from another particle while it is free; 0.2 in print for the front leg, 0 for the tail leg.
    pub push: f64,
    /// That particle.
    pub from: ParticleId,
    /// How strongly it is drawn back to where it stood when it was free last; 1 in print.
    pub grip: f64,
}

/// Weight: R = (0, −pull, 0).
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct Weight {
    /// The particles that have it.
    pub on: Vec<ParticleId>,
    /// 0.32 in print: 32 ft/s² times dt.
    pub pull: f64,
}

impl Rules {
    /// The rules of a body of `particles` particles.
    ///
    /// # Errors
    /// If a rule names a particle that is not there, or has a number that is not allowed.
    pub fn new(rules: impl IntoIterator<Item = Rule>, particles: usize) -> Result<Self, BodyError> {
        let rules: Vec<_> = rules.into_iter().collect();
        rules.iter().enumerate().try_for_each(|(i, rule)| rule.check(&format!("rules[{i}]"), particles))?;
        Ok(Self { rules })
    }

    /// All rules in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Rule> + '_ {
        self.rules.iter()
    }

    /// Changes the numbers of one rule by `change`; what it is made of stays.
    ///
    /// # Errors
    /// As [`new`](Self::new); nothing is changed then.
    pub fn change(&mut self, rule: usize, particles: usize, change: impl FnOnce(&mut Rule)) -> Result<(), BodyError> {
        let Some(old) = self.rules.get_mut(rule) else { return Ok(()) };
        let mut new = old.clone();
        change(&mut new);
        new.check(&format!("rules[{rule}]"), particles)?;
        *old = new;
        Ok(())
    }

    /// Whether every particle that they name is one of so many.
    pub(crate) fn fit(&self, particles: usize) -> bool {
        self.rules.iter().all(|rule| rule.check("rules", particles).is_ok())
    }
}

impl Rule {
    fn check(&self, path: &str, particles: usize) -> Result<(), BodyError> {
        let finite =
            |field: &str, value: f64| check(value, Requirement::Finite, || format!("{path}.{field}")).map(|_| ());
        match self {
            Self::Counter(Counter { on, half }) => {
                there(path, "on", on, particles)?;
                check(*half, Requirement::Positive, || format!("{path}.half")).map(|_| ())
            }
            Self::Contraction(Contraction { on, along, strength }) => {
                there(path, "on", on, particles)?;
                there(path, "along", along, particles)?;
                finite("strength", *strength)
            }
            Self::Leg(leg) => {
                there(path, "particle", &[leg.particle, leg.clock, leg.from], particles)?;
                finite("seek", leg.seek)?;
                finite("push", leg.push)?;
                finite("grip", leg.grip)
            }
            Self::Weight(Weight { on, pull }) => {
                there(path, "on", on, particles)?;
                finite("pull", *pull)
            }
            Self::Drive(drive) => drive.check(path, particles),
        }
    }
}

/// Checks that particles exist.
pub(super) fn there(path: &str, field: &str, ids: &[ParticleId], particles: usize) -> Result<(), BodyError> {
    match ids.iter().find(|id| id.index() >= particles) {
        None => Ok(()),
        Some(&ParticleId(index)) => {
            Err(BodyError::Missing { path: format!("{path}.{field}"), what: "particle", index, count: particles })
        }
    }
}
