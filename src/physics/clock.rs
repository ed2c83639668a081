//! The clock of a scene: a whole number of steps of one dt.

use bevy::{ecs::prelude::*, prelude::ReflectResource, reflect::Reflect};

use crate::{
    body::{BodyError, Requirement, check},
    mechanics::Timeline,
};

/// How many steps a tick takes.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub enum Pace {
    /// As many whole steps as fit the tick's real time × this scale; what is left over is carried to the next tick.
    TimeScale(f64),
    /// Exactly this many, whatever the tick's real time: for command lines and tests.
    Steps(u64),
}

/// The clock of the scene.
///
/// dt belongs to the scene and not to the frame: the time scale only sets how many whole steps a tick takes. Time is
/// t = t_base + (n − n_base)·dt with a whole number n, so it does not drift, and the base moves when dt changes, so that a
/// moved slider makes no jump.
#[derive(Clone, Debug, PartialEq, Reflect, Resource)]
#[reflect(Resource)]
pub struct Clock {
    timeline: Timeline,
    pace: Pace,
    step: u64,
    carry: f64,
    /// How many steps the last tick took that took any.
    last_steps: u64,
    /// How many steps the next tick takes instead of those that are due.
    leap: u64,
}

/// The garden worm's document steps by half a millisecond.
impl Default for Clock {
    fn default() -> Self {
        let timeline = Timeline { dt: 0.0005, base_step: 0, base_time: 0.0 };
        Self { timeline, pace: Pace::TimeScale(1.0), step: 0, carry: 0.0, last_steps: 0, leap: 0 }
    }
}

impl Clock {
    /// The largest time scale: beyond it a slow machine would never catch up.
    pub const LARGEST_TIME_SCALE: f64 = 1000.0;
    /// The most steps that a tick takes for a time scale; with a dt that would need more, time passes more slowly than it should.
    pub const MOST_STEPS_A_TICK: u64 = 100_000;

    /// A clock at time 0 with a step of `dt` that shows `time_scale` units of simulated time a second.
    ///
    /// # Errors
    /// If dt is not above zero, or the time scale is negative or not finite.
    pub fn new(dt: f64, time_scale: f64) -> Result<Self, BodyError> {
        let mut clock = Self::default();
        clock.set_dt(dt)?;
        clock.set_time_scale(time_scale)?;
        Ok(clock)
    }

    /// The step dt, in units of simulated time.
    pub fn dt(&self) -> f64 {
        self.timeline.dt
    }

    /// Changes dt from now on; time goes on from where it is.
    ///
    /// # Errors
    /// If dt is not above zero; nothing is changed then.
    pub fn set_dt(&mut self, dt: f64) -> Result<(), BodyError> {
        check(dt, Requirement::Positive, || "clock.dt".into())?;
        self.timeline = Timeline { dt, base_step: self.step, base_time: self.time() };
        Ok(())
    }

    /// The simulated time that passes in a second, or nothing where the pace is a number of steps.
    pub fn time_scale(&self) -> Option<f64> {
        match self.pace {
            Pace::TimeScale(scale) => Some(scale),
            Pace::Steps(_) => None,
        }
    }

    /// Changes the time scale: 0 stands still, 1 is a unit of time a second.
    ///
    /// # Errors
    /// If it is negative, above [`LARGEST_TIME_SCALE`](Self::LARGEST_TIME_SCALE) or not finite; nothing is changed then.
    pub fn set_time_scale(&mut self, scale: f64) -> Result<(), BodyError> {
        check(scale, Requirement::NonNegative, || "clock.time_scale".into())?;
        if scale > Self::LARGEST_TIME_SCALE {
            return Err(BodyError::Inconsistent {
                path: "clock.time_scale".into(),
                problem: format!("{scale} is not allowed; give at most {}", Self::LARGEST_TIME_SCALE),
            });
        }
        self.pace = Pace::TimeScale(scale);
        Ok(())
    }

    /// Changes how many steps a tick takes.
    pub fn set_steps_per_tick(&mut self, steps: u64) {
        self.pace = Pace::Steps(steps);
    }

    /// Has the next tick take exactly this many steps, whatever is due; 0 takes it back.
    pub fn leap(&mut self, steps: u64) {
        self.leap = steps;
    }

    /// How many steps have been taken since the start.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// The simulated time now.
    pub fn time(&self) -> f64 {
        self.timeline.time_at(self.step)
    }

    /// The time of every step since dt was last changed.
    pub fn timeline(&self) -> Timeline {
        self.timeline
    }

    /// Back to time 0, with the same dt and pace.
    pub fn rewind(&mut self) {
        self.timeline = Timeline { base_step: 0, base_time: 0.0, ..self.timeline };
        (self.step, self.carry, self.last_steps, self.leap) = (0, 0.0, 0, 0);
    }

    /// The whole steps of a tick that lasts `seconds` of real time, and what is carried on to the next.
    fn due(&self, seconds: f64) -> (u64, f64) {
        match self.pace {
            _ if self.leap > 0 => (self.leap, self.carry),
            Pace::Steps(steps) => (steps, 0.0),
            Pace::TimeScale(scale) => {
                let due = self.carry + seconds * scale / self.timeline.dt;
                if due >= Self::MOST_STEPS_A_TICK as f64 {
                    // What cannot be caught up with is not carried on.
                    return (Self::MOST_STEPS_A_TICK, 0.0);
                }
                (due as u64, due.fract())
            }
        }
    }

    /// Whether a tick that lasts `seconds` takes any step.
    pub(super) fn will_step(&self, seconds: f64) -> bool {
        self.due(seconds).0 > 0
    }

    /// Takes the whole steps of a tick that lasts `seconds` of real time, and says how many they are.
    pub(super) fn take_steps(&mut self, seconds: f64) -> u64 {
        let (steps, carry) = self.due(seconds);
        (self.carry, self.leap) = (carry, 0);
        steps
    }

    /// Moves on by `steps`, once the bodies have taken them.
    pub(super) fn advance(&mut self, steps: u64) {
        self.step += steps;
        self.last_steps = steps;
    }

    /// How far a frame is on the way from where the last tick that took steps began to where it ended. `overstep` is the part of the next tick that has
    /// passed, of `seconds` each. What is shown is late by a tick, or by a step where steps are longer: then it moves on through the
    /// ticks that take none.
    pub(super) fn shown_fraction(&self, overstep: f64, seconds: f64) -> f64 {
        let Pace::TimeScale(scale) = self.pace else { return overstep };
        let steps_a_tick = seconds * scale / self.timeline.dt;
        let passed = self.last_steps as f64 + self.carry + overstep * steps_a_tick - steps_a_tick.max(1.0);
        // A step that is due comes only with the next tick; until then the motion goes on as it was.
        let most = if steps_a_tick < 1.0 { 1.0 + steps_a_tick } else { 1.0 };
        if self.last_steps == 0 { 1.0 } else { (passed / self.last_steps as f64).clamp(0.0, most) }
    }
}
