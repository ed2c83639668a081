//! How the muscles of a strand are guided while it goes.

/// A number that changes evenly with time: at `since` it is `from`, and from there it goes at `rate` to `to`.
#[derive(Clone, Copy, Debug, PartialEq, bevy::reflect::Reflect)]
pub(crate) struct Ramp {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) since: f64,
    /// Towards `to`, so below zero where that is less; 0 where it is there already.
    pub(crate) rate: f64,
}

impl Ramp {
    /// What does not change.
    pub(crate) const fn steady(value: f64) -> Self {
        Self { from: value, to: value, since: 0.0, rate: 0.0 }
    }

    /// From `from` at `time` to `to`, so fast that a change by 1 takes `duration`; at once where that is zero.
    pub(crate) fn towards(from: f64, to: f64, time: f64, duration: f64) -> Self {
        if duration > 0.0 && from != to {
            Self { from, to, since: time, rate: if to > from { 1.0 / duration } else { -1.0 / duration } }
        } else {
            Self { from: to, to, since: time, rate: 0.0 }
        }
    }

    /// The number at `time`.
    pub(crate) fn at(self, time: f64) -> f64 {
        let (least, most) = (self.from.min(self.to), self.from.max(self.to));
        (self.from + self.rate * (time - self.since)).clamp(least, most)
    }

    /// From where it is at `time` on to `to`, so fast that a change by 1 takes `duration`.
    pub(crate) fn turned(self, to: f64, time: f64, duration: f64) -> Self {
        if to == self.to { self } else { Self::towards(self.at(time), to, time, duration) }
    }
}

/// What a guide adds to the [`TravelingWaves`](super::TravelingWaves) of a body. It belongs to what a body does at the moment and not to what it is: no
/// creature or scene file has it. The default changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, bevy::reflect::Reflect)]
pub struct Guidance {
    /// Added to the steering b.
    pub(crate) turn: Ramp,
    /// The factor of the vertical waves, from 1 (as they are) through 0 (none) to −1 (half a cycle ahead, which makes a lead of ¼ one of −¼).
    pub(crate) lift: Ramp,
    /// The factor of the activity, from 0 to 1.
    pub(crate) activity: Ramp,
}

impl Default for Guidance {
    fn default() -> Self {
        Self { turn: Ramp::steady(0.0), lift: Ramp::steady(1.0), activity: Ramp::steady(1.0) }
    }
}

impl Guidance {
    /// What is added to the steering b at `time`.
    pub fn turn_at(&self, time: f64) -> f64 {
        self.turn.at(time)
    }

    /// The factor of the vertical waves at `time`, from −1 to 1.
    pub fn lift_at(&self, time: f64) -> f64 {
        self.lift.at(time)
    }

    /// The factor of the activity at `time`, from 0 to 1.
    pub fn activity_at(&self, time: f64) -> f64 {
        self.activity.at(time)
    }

    /// Whether the muscles may work: `false` once they are told to rest, also while they still ramp out.
    pub fn is_active(&self) -> bool {
        self.activity.to > 0.0
    }
}
