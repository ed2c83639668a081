//! When the drive of a muscle is not smooth: at the end of its ramp, and where a square wave switches.

use crate::body::Wave;

use super::model::MuscleRow;

/// How many half cycles of a square wave have passed at `cycles`.
pub(super) fn half_cycles(cycles: f64) -> f64 {
    (2.0 * cycles).floor()
}

/// How near two times are that rounding errors of a phase do not tell apart.
pub(super) fn instant(time: f64) -> f64 {
    1e-12 * (1.0 + time.abs())
}

/// How long from `time` on no ramp of a muscle ends and no square wave switches, at most `longest`.
pub(super) fn until_kink(muscles: &[MuscleRow<f64>], time: f64, longest: f64) -> f64 {
    let mut least = longest;
    for muscle in muscles {
        let cycles = muscle.epoch_cycles + (time - muscle.epoch_time) * muscle.frequency;
        let at = cycles - muscle.phase;
        let next = match muscle.wave {
            Wave::Sine => f64::INFINITY,
            Wave::Square => 0.5 * (half_cycles(at) + 1.0) - at,
        };
        let ramp = if cycles < muscle.ramp { muscle.ramp - cycles } else { f64::INFINITY };
        // A kink that rounding puts just before it is is passed, and not approached for ever.
        least = least.min((next.min(ramp) / muscle.frequency).max(instant(time)));
    }
    least
}
