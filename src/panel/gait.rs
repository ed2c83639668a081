//! The gait of the animal that the panel shows, now and over its last cycles.

use bevy::ecs::prelude::*;

use super::ring::Ring;
use crate::mechanics::{
    BodyParts,
    metrics::{Gait, GaitMetrics},
};

/// How often a cycle a gait is measured: often enough to be read, and seldom enough to cost nothing.
const A_CYCLE: usize = 8;
/// How many measurements are kept: those of about 32 cycles.
pub const KEPT: usize = 32 * A_CYCLE;

/// Watches the gait of one animal.
#[derive(Clone, Debug)]
pub struct GaitWatch {
    gait: Option<(Entity, Gait)>,
    /// When it was looked at last, and when it was measured last, in simulated time.
    seen: f64,
    measured: f64,
    /// The last measurements, at most [`KEPT`]; none before a cycle is over.
    pub history: Ring<Measured>,
}

/// A gait at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The simulated time at the end of the cycles that were measured.
    pub time: f64,
    /// What was measured over the last cycles.
    pub metrics: GaitMetrics,
}

impl Default for GaitWatch {
    fn default() -> Self {
        Self { gait: None, seen: 0.0, measured: 0.0, history: Ring::new(KEPT) }
    }
}

impl GaitWatch {
    /// Looks at a body after a tick that ended at `time`, in steps of `dt`. Another body or a time that went back begin anew, and so do other waves.
    pub fn look(&mut self, entity: Entity, body: &BodyParts<'_>, time: f64, dt: f64) {
        let known = self.gait.as_ref().is_some_and(|(known, gait)| {
            let period = body.waves.and_then(|waves| waves.longest_period());
            *known == entity && time >= self.seen && Some(gait.period()) == period
        });
        if !known {
            self.gait = Gait::new(body).map(|gait| (entity, gait));
            self.measured = time;
            self.history.clear();
        }
        self.seen = time;
        let Some((_, gait)) = &mut self.gait else { return };
        gait.sample(body, time, dt);
        if time - self.measured < gait.period() / A_CYCLE as f64 {
            return;
        }
        self.measured = time;
        match gait.measure() {
            Some(metrics) => self.history.push(Measured { time, metrics }),
            // Steps have become longer than cycles, and the gait that was known is no longer that of now.
            None => self.history.clear(),
        }
    }

    /// Whether the body that was seen last has a gait.
    pub fn is_of_animal(&self) -> bool {
        self.gait.is_some()
    }
}
