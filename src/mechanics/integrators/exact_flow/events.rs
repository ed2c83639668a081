//! What ends a segment: the first root of any of its polynomials.

use core::ops::Range;

use crate::mechanics::Model;

use super::{
    ExactFlow, Slide,
    series::{Polynomial, Series},
};

/// Into how many parts a segment is cut to find its roots.
const PARTS: usize = 8;

/// What ends a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// A sliding mass comes to rest.
    Rests(usize),
    /// A resting mass is no longer pushed back.
    Slips(usize),
    /// A spring's ends pass each other.
    Passes(usize),
    /// The neighbours of a mass of the spine pass each other.
    Turns,
    /// A rest length comes to its least, or leaves it.
    Clamps(usize),
    /// A hand comes to pull with all that it may on a side, or no longer does.
    Caps(f64),
}

/// When the first event of a segment comes, and what it is. A mass that has turned at this instant is not asked again before it is over.
pub(super) fn first<const D: usize>(
    flow: &ExactFlow,
    model: &Model<f64, D>,
    length: f64,
    instant: f64,
) -> Option<(f64, Event)> {
    let series = &flow.series;
    let mut first: Option<(f64, Event)> = None;
    let mut offer = |of: &Polynomial, sign: f64, from: f64, event| {
        let until = first.as_ref().map_or(length, |(at, _)| *at);
        if let Some(at) = root(series, of, sign, from..until).filter(|at| first.is_none() || *at < until) {
            first = Some((at, event));
        }
    };
    for (mass, &slide) in flow.slide.iter().enumerate() {
        let forward = flow.forward[mass];
        let from = if flow.turned[mass].is_some() { instant } else { 0.0 };
        match slide {
            Slide::Free => {}
            Slide::Forward => offer(&series.velocity[mass], forward, from, Event::Rests(mass)),
            Slide::Back => offer(&series.velocity[mass], -forward, from, Event::Rests(mass)),
            Slide::Stuck => offer(&series.push[mass], -forward, from, Event::Slips(mass)),
        }
    }
    for (spring, row) in model.springs.iter().enumerate() {
        offer(&series.way(row.ends[0], row.ends[1]), flow.side[spring], 0.0, Event::Passes(spring));
    }
    for row in model.spine.iter().filter(|row| row.previous != row.particle && row.particle != row.next) {
        offer(&series.way(row.previous, row.next), flow.forward[row.particle as usize], 0.0, Event::Turns);
    }
    for (index, muscle) in model.muscles.iter().enumerate() {
        let spring = muscle.spring as usize;
        let sign = if flow.clamped[spring] { -1.0 } else { 1.0 };
        offer(&series.above_least_series(index), sign, 0.0, Event::Clamps(spring));
    }
    if let Some(pull) = &model.pull {
        for side in [1.0, -1.0].into_iter().filter(|side| flow.capped == 0.0 || flow.capped == *side) {
            let sign = if flow.capped == 0.0 { -1.0 } else { 1.0 };
            offer(&series.above_most(pull, side), sign, 0.0, Event::Caps(side));
        }
    }
    first
}

/// The first τ of a range from which on sign·p(τ) is below zero. At its beginning it is at zero or above.
fn root(series: &Series, of: &Polynomial, sign: f64, range: Range<f64>) -> Option<f64> {
    if range.is_empty() || sign * of[0] > series.reach(of, range.end) {
        return None;
    }
    let value = |at: f64| sign * series.value(of, at);
    let slope = |at: f64| sign * series.slope(of, at);
    let mut from = range.start;
    for part in 1..=PARTS {
        let to = range.start + (range.end - range.start) * part as f64 / PARTS as f64;
        if value(to) < 0.0 {
            // What starts at zero and goes down at once has no root of its own: it falls from where it is.
            return Some(bisect(|at| value(at) < 0.0, from, to));
        }
        // It may dip below zero and come back within one part.
        if slope(from) < 0.0 && slope(to) > 0.0 {
            let lowest = bisect(|at| slope(at) > 0.0, from, to);
            if value(lowest) < 0.0 && from + lowest > 0.0 && value(from) > 0.0 {
                return Some(bisect(|at| value(at) < 0.0, from, lowest));
            }
        }
        from = to;
    }
    None
}

/// The place between `from` and `to` from which on `beyond` holds, to the last bit.
fn bisect(beyond: impl Fn(f64) -> bool, mut from: f64, mut to: f64) -> f64 {
    loop {
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            return to;
        }
        if beyond(middle) { to = middle } else { from = middle }
    }
}
