//! The exact flow between events, for bodies on an axis.
//!
//! On an axis a body is piecewise linear: between the moments at which a mass sticks or slips, a ramp ends, a square wave switches, a rest length
//! is clamped, a spring passes through zero length or a hand pulls with all that it may, y' = Ay + b(t) with a constant A. Its solution y(t+τ) = e^(Aτ)y(t) + … is the sum of its
//! Taylor series, of which each term is one evaluation of the forces on the terms before; segments are short enough (‖A‖τ ≤ 2) for some twenty terms to
//! reach the last place. The same polynomials tell when the next event comes, and the segment ends there. Order: none, the error is that of
//! rounding; dt only says when the state is shown. No step is unstable. The action of the exponential by a truncated Taylor series is that
//! of A. Al-Mohy and N. Higham, SIAM J. Sci. Comput. 33 (2011) 488; the events are those of `friction`.

mod events;
mod series;

use crate::mechanics::{Model, State, forces::direction, kinks::until_kink};

use super::{About, Integrator};
use events::Event;
use series::{Series, Signs};

pub(super) const ABOUT: About = About {
    name: "ExactFlow",
    summary: "exact between events that are located; for bodies on an axis",
    order: 0,
    evaluations: None,
};

/// A fraction of the time on which anything changes, in which nothing does: events nearer than this happen at once.
const INSTANT: f64 = 1e-15;

/// So many segments in one step say that the events do not end.
const MOST_SEGMENTS: usize = 1_000_000;

/// How friction holds or brakes a mass in a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slide {
    /// No friction acts on it.
    Free,
    /// It slides forward, against the drag.
    Forward,
    /// It slides back, which only a spine without ratchet lets it.
    Back,
    /// It rests, because it is pushed back.
    Stuck,
}

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct ExactFlow {
    /// How each mass slides.
    slide: Vec<Slide>,
    /// What the events of this instant have said of each mass.
    turned: Vec<Option<Slide>>,
    /// The sign of S for each mass: +1 forward along x, −1 back, 0 off the spine.
    forward: Vec<f64>,
    /// +1 where the second end of a spring is at the greater x, else −1.
    side: Vec<f64>,
    /// Whether the least rest length holds.
    clamped: Vec<bool>,
    /// +1 or −1 where a hand pulls with all that it may, along x or against it; else 0.
    capped: f64,
    series: Series,
}

impl<const D: usize> Integrator<f64, D> for ExactFlow {
    fn new(particles: usize) -> Self {
        Self {
            slide: vec![Slide::Free; particles],
            turned: vec![None; particles],
            forward: vec![0.0; particles],
            side: Vec::new(),
            clamped: Vec::new(),
            capped: 0.0,
            series: Series::new(particles),
        }
    }

    fn step(&mut self, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64) {
        if D != 1 {
            model.refused = 1.0;
            return;
        }
        let start = state.clone();
        let ratchet = model.friction.is_some_and(|friction| friction.ratchet);
        self.look(model, state);
        let longest = 2.0 / series::fastest_rate(model);
        let instant = INSTANT * longest;
        self.turned.fill(None);
        let mut at = 0.0;
        for _ in 0..MOST_SEGMENTS {
            if at >= model.dt {
                model.note_lengths(state);
                return;
            }
            self.series.begin(model, state, time + at);
            self.clamp(model);
            let length = until_kink(&model.muscles, time + at, longest.min(model.dt - at));
            self.settle(model, state);
            let signs = Signs { side: &self.side, clamped: &self.clamped, capped: self.capped };
            self.series.extend(model, &self.slide, signs, length);
            model.evaluations += self.series.terms() as f64;
            let event = events::first(self, model, length, instant);
            let reach = event.as_ref().map_or(length, |(reach, _)| *reach);
            // A push that is rounding turns a mass again and again where the state goes on for it, by ever so little.
            if event.is_none() || reach > instant {
                self.series.write(state, reach);
                self.turned.fill(None);
                // What is left of the step after its last segment is rounding.
                at = if event.is_none() && length >= model.dt - at { model.dt } else { at + reach };
            }
            match event.map(|(_, event)| event) {
                None => {}
                Some(Event::Rests(mass)) => {
                    state.velocity[mass][0] = 0.0;
                    self.turned[mass] = Some(match self.slide[mass] {
                        _ if ratchet => Slide::Stuck,
                        Slide::Forward => Slide::Back,
                        _ => Slide::Forward,
                    });
                }
                Some(Event::Slips(mass)) => self.turned[mass] = Some(Slide::Forward),
                Some(Event::Passes(spring)) => {
                    self.side[spring] = -self.side[spring];
                    self.look_forward(model, state);
                }
                Some(Event::Turns) => self.look_forward(model, state),
                Some(Event::Clamps(spring)) => self.clamped[spring] = !self.clamped[spring],
                Some(Event::Caps(side)) => self.capped = if self.capped == 0.0 { side } else { 0.0 },
            }
        }
        *state = start;
        model.refused = 1.0;
    }
}

impl ExactFlow {
    /// Signs of springs and spine at the beginning of a step.
    fn look<const D: usize>(&mut self, model: &Model<f64, D>, state: &State<f64, D>) {
        self.side.clear();
        self.side.extend(model.springs.iter().map(|spring| {
            let [a, b] = spring.ends.map(|end| state.position[end as usize][0]);
            if b < a { -1.0 } else { 1.0 }
        }));
        self.clamped.clear();
        self.clamped.resize(model.springs.len(), false);
        self.look_at_hand(model, state);
        self.look_forward(model, state);
    }

    fn look_at_hand<const D: usize>(&mut self, model: &Model<f64, D>, state: &State<f64, D>) {
        self.capped = model.pull.map_or(0.0, |pull| {
            let force = pull.along_x(0, state.position[pull.particle][0], state.velocity[pull.particle][0]);
            if force.abs() > pull.most() { force.signum() } else { 0.0 }
        });
    }

    fn look_forward<const D: usize>(&mut self, model: &Model<f64, D>, state: &State<f64, D>) {
        for row in &model.spine {
            let along = direction(state.position[row.previous as usize], state.position[row.next as usize]).1;
            self.forward[row.particle as usize] = along[0];
        }
    }

    /// Which rest lengths are at their least now.
    fn clamp<const D: usize>(&mut self, model: &Model<f64, D>) {
        for muscle in 0..model.muscles.len() {
            let spring = model.muscles[muscle].spring as usize;
            let above = self.series.above_least(muscle);
            // An event has just put it to zero, and says itself to which side it goes.
            if above.abs() > 1e-9 {
                self.clamped[spring] = above < 0.0;
            }
        }
    }

    /// How each mass slides from here on. Events have said it of those that turned.
    fn settle<const D: usize>(&mut self, model: &Model<f64, D>, state: &mut State<f64, D>) {
        self.slide.fill(Slide::Free);
        let friction = model.friction.filter(|friction| friction.ratchet || friction.has_drag);
        let Some(friction) = friction else { return };
        let masses = model.spine.iter().map(|row| row.particle as usize);
        let feels = |mass: &usize| model.inverse_mass[*mass] > 0.0;
        if friction.ratchet {
            let held = model.pull.map(|pull| (pull.particle, state.velocity[pull.particle][0]));
            for mass in masses.clone().filter(feels) {
                let v = &mut state.velocity[mass][0];
                *v = if *v * self.forward[mass] < 0.0 { 0.0 } else { *v };
            }
            self.series.restart_velocities(state);
            // The force of the hand leaps with the velocity that the ratchet takes.
            if held.is_some_and(|(particle, before)| state.velocity[particle][0] != before) {
                self.look_at_hand(model, state);
            }
        }
        for mass in masses.filter(feels) {
            let forward = self.forward[mass];
            if forward == 0.0 {
                continue;
            }
            let speed = state.velocity[mass][0] * forward;
            let signs = Signs { side: &self.side, clamped: &self.clamped, capped: self.capped };
            let push = forward * self.series.push(model, mass, signs);
            self.slide[mass] = if let Some(slide) = self.turned[mass] {
                slide
            } else if speed > 0.0 {
                Slide::Forward
            } else if friction.ratchet {
                if push > 0.0 { Slide::Forward } else { Slide::Stuck }
            } else if speed < 0.0 || push < 0.0 {
                Slide::Back
            } else {
                Slide::Forward
            };
        }
    }
}
