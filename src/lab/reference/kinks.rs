//! When the drive of a muscle is not smooth: at the end of its ramp, where a square wave switches, and where the least rest length cuts the wave.

use crate::{
    body::{Epoch, LEAST_REST_FRACTION, Muscle, Muscles, Wave},
    mechanics::sin_cycles,
};

/// Into how many parts a cycle is divided in search of where the wave is cut.
const PARTS: usize = 64;

/// The times strictly between 0 and `end` at which a rest length has a kink or a jump, in order.
pub(super) fn kinks(muscles: Option<&Muscles>, end: f64) -> Vec<f64> {
    let mut times = Vec::new();
    for (muscle, &epoch) in muscles.into_iter().flat_map(|muscles| muscles.iter().zip(muscles.epochs())) {
        let time = |cycles: f64| epoch.time + (cycles - epoch.cycles) * muscle.period;
        if muscle.ramp > 0.0 {
            times.push(time(muscle.ramp));
        }
        match muscle.wave {
            Wave::Square => {
                let cycles = |at: f64| epoch.cycles + (at - epoch.time) / muscle.period;
                let halves = |at: f64| 2.0 * (cycles(at) - muscle.phase);
                let (first, last) = (halves(0.0).floor() as i64, halves(end).ceil() as i64);
                times.extend((first..=last).map(|half| time(0.5 * half as f64 + muscle.phase)));
            }
            Wave::Sine if muscle.amplitude > 1.0 - LEAST_REST_FRACTION => times.extend(cuts(&muscle, epoch, end)),
            Wave::Sine => {}
        }
    }
    times.retain(|&time| 0.0 < time && time < end);
    times.sort_by(f64::total_cmp);
    times
}

/// Where a sine wave comes to its least rest length and leaves it.
fn cuts(muscle: &Muscle, epoch: Epoch, end: f64) -> Vec<f64> {
    // How far the rest length is above its least, in rest lengths.
    let above = |time: f64| {
        let cycles = epoch.cycles + (time - epoch.time) / muscle.period;
        let ramp = if cycles < muscle.ramp { cycles / muscle.ramp } else { 1.0 };
        1.0 + ramp * muscle.amplitude * sin_cycles(cycles - muscle.phase) - LEAST_REST_FRACTION
    };
    let part = muscle.period / PARTS as f64;
    let parts = (end / part).ceil() as usize;
    let crossing = |i: usize| {
        let (mut low, mut high) = (i as f64 * part, (i + 1) as f64 * part);
        let sign = above(low) < 0.0;
        if (above(high) < 0.0) == sign {
            return None;
        }
        // Halving until no number is between.
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return Some(high);
            }
            if (above(middle) < 0.0) == sign { low = middle } else { high = middle }
        }
    };
    (0..parts).filter_map(crossing).collect()
}
