//! Finding the first instant at which a mass starts or stops to slide.
//!
//! A chunk of time has an event of a mass where its gap is closed at the end, or closes and opens again in between. The instant is found by integrating
//! anew to every trial, so that it is as exact as the integration itself.

use super::{
    flow::Mode,
    follow::{Broken, Follower},
    schemes::Scheme,
};

/// A state further on, with what is to be known about events there.
pub(super) struct Ahead {
    pub(super) time: f64,
    pub(super) y: Vec<f64>,
    pub(super) gaps: Vec<f64>,
    pub(super) slopes: Vec<f64>,
}

impl<S: Scheme<D>, const D: usize> Follower<'_, S, D> {
    /// Fills in gaps, and their slopes as seen from the side of `side`.
    pub(super) fn measure(&self, at: &mut Ahead, side: f64) {
        if !self.flow.has_events() {
            return;
        }
        let piece = self.piece();
        piece.gaps(at.time, &at.y, &mut at.gaps);
        let mut derivative = vec![0.0; at.y.len()];
        piece.derivative(at.time, &at.y, &mut derivative);
        let little = side * 1e-4 * self.grain.chunk;
        let beside: Vec<_> = at.y.iter().zip(&derivative).map(|(y, slope)| y + little * slope).collect();
        piece.gaps(at.time + little, &beside, &mut at.slopes);
        for (slope, gap) in at.slopes.iter_mut().zip(&at.gaps) {
            *slope = (*slope - gap) / little;
        }
    }

    fn nothing(&self, node: usize) -> f64 {
        if self.modes[node] == Mode::Held { self.grain.push } else { self.grain.speed }
    }

    fn gap_at(&mut self, time: f64, node: usize) -> Result<f64, Broken> {
        let y = self.state_at(time)?;
        let mut gaps = Vec::new();
        self.piece().gaps(time, &y, &mut gaps);
        Ok(gaps[node])
    }

    /// The first event between here and `ahead`.
    pub(super) fn first_event(&mut self, ahead: &Ahead) -> Result<Option<(f64, usize)>, Broken> {
        let mut first: Option<(f64, usize)> = None;
        for node in 0..ahead.gaps.len() {
            let nothing = self.nothing(node);
            let beyond = if ahead.gaps[node] < -nothing || self.gaps[node] < -nothing {
                ahead.time
            } else {
                match self.dip(ahead, node) {
                    Some(time) if self.gap_at(time, node)? < -nothing => time,
                    _ => continue,
                }
            };
            let time = self.crossing(node, beyond)?;
            if first.is_none_or(|(earliest, _)| time < earliest) {
                first = Some((time, node));
            }
        }
        Ok(first)
    }

    /// Where between here and `ahead` a gap may have closed and opened again: near the least of its cubic.
    fn dip(&self, ahead: &Ahead, node: usize) -> Option<f64> {
        let h = ahead.time - self.time;
        let (g0, g1) = (self.gaps[node], ahead.gaps[node]);
        let (m0, m1) = (self.slopes[node] * h, ahead.slopes[node] * h);
        if !(m0 < 0.0 && m1 > 0.0) {
            return None;
        }
        // g(θ) = g0 + m0·θ + b·θ² + a·θ³; at its least g' = m0 + 2bθ + 3aθ² = 0 with g'' > 0.
        let (a, b) = (m0 + m1 - 2.0 * (g1 - g0), 3.0 * (g1 - g0) - 2.0 * m0 - m1);
        let root = (b * b - 3.0 * a * m0).max(0.0).sqrt();
        let at = (-m0 / (b + root)).clamp(0.0, 1.0);
        let least = g0 + at * (m0 + at * (b + at * a));
        (least < 0.05 * (m1 - m0)).then_some(self.time + at * h)
    }

    /// Where a gap closes, between here and `beyond`, where it is closed: by regula falsi in the Illinois variant, integrating anew to every trial.
    fn crossing(&mut self, node: usize, beyond: f64) -> Result<f64, Broken> {
        const MOST_TRIALS: u32 = 200;
        let (mut low, mut high) = (self.time, beyond);
        let (mut open, mut closed) = (self.gaps[node], self.gap_at(high, node)?);
        if open <= 0.0 {
            return Ok(low);
        }
        let mut last = 0;
        for trial in 0..MOST_TRIALS {
            let mut middle = (low * closed - high * open) / (closed - open);
            // Halving now and then bounds the work.
            if trial % 8 == 7 || !(low < middle && middle < high) {
                middle = 0.5 * (low + high);
            }
            if middle <= low || middle >= high || high - low < 1e-15 * high {
                break;
            }
            let gap = self.gap_at(middle, node)?;
            if gap > 0.0 {
                (low, open) = (middle, gap);
                closed *= if last == 1 { 0.5 } else { 1.0 };
                last = 1;
            } else if gap < 0.0 {
                (high, closed) = (middle, gap);
                open *= if last == -1 { 0.5 } else { 1.0 };
                last = -1;
            } else {
                return Ok(middle);
            }
        }
        Ok(high)
    }
}
