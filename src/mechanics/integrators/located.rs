//! Explicit Runge–Kutta methods whose steps stop where a mass comes to rest or starts to slip.
//!
//! From one such event to the next every mass of the spine either slides, and no friction but drag and grip acts on it along the spine, or is held, and
//! then S·v = 0. That motion is smooth, so a method keeps its order. A step is tried to its end with what holds at its start. If
//! a sliding mass would slide back there, or a held one is pushed forward, the first such event is located, the step is taken to it alone, and what is
//! left of it begins anew.
//!
//! An event is located on a parabola through sliding speeds, or on a line through the pushes of two stages. It is late or early by O(dt²) or less, and
//! what that does is of the square of it: a mass that comes to rest hardly moves then, and one that starts to slip hardly has a push. So
//! location costs no evaluation beyond those of the steps that it parts.
//!
//! A step is also parted where the drive of a muscle is not smooth: at the end of a ramp, and where a square wave switches. The stages of a piece see the
//! wave as it is within that piece. The waves of a strand are taken as they come. Source: E. Hairer, S. P. Nørsett, G. Wanner, "Solving ordinary
//! differential equations I" (1993), II.6, for the parting of steps at discontinuities.

use core::marker::PhantomData;

use crate::{
    body::Wave,
    mechanics::{
        Model, State,
        friction::{dot, subtract},
        kinks::{instant, until_kink},
        model::SpineRow,
    },
};

use super::{Integrator, stages::Stage};

/// A push that would stop a mass within this part of the step holds it: rounding errors must not decide.
const AT_ONCE: f64 = 1e-9;
/// So many events a mass are located between two kinks of a step; what is left of it then is taken as it comes.
const EVENTS_A_MASS: usize = 4;

/// A method that is nothing but its stages.
pub trait Staged {
    /// They are evaluated in this order.
    const STAGES: &'static [Stage];
}

/// A mass of the spine within a piece of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Mode {
    /// Whether friction holds it.
    held: bool,
    /// S·v at the start.
    speed: f64,
    /// d(S·v)/dt at the start, with what holds it left out.
    push: f64,
    /// The same in the last stage.
    last_push: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    Rests(usize),
    Slips(usize),
}

/// Scratch of a method with located events.
#[derive(Clone, Debug)]
pub struct Located<S, const D: usize> {
    /// Where the current piece began.
    start: State<f64, D>,
    stage: State<f64, D>,
    acceleration: Vec<[f64; D]>,
    sum: State<f64, D>,
    /// One a row of the spine.
    modes: Vec<Mode>,
    /// Forces are evaluated at times in between only: at the moment at which a square wave switches, it is on neither side.
    window: [f64; 2],
    method: PhantomData<S>,
}

impl<S: Staged, const D: usize> Integrator<f64, D> for Located<S, D> {
    fn new(particles: usize) -> Self {
        let state = || State::new(particles);
        Self {
            start: state(),
            stage: state(),
            acceleration: vec![[0.0; D]; particles],
            sum: state(),
            modes: Vec::new(),
            window: [0.0; 2],
            method: PhantomData,
        }
    }

    fn step(&mut self, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64) {
        // The pieces hold masses themselves; what else friction does is a force.
        let ratchet = model.friction.as_mut().is_some_and(|friction| core::mem::replace(&mut friction.ratchet, false));
        self.modes.resize(if ratchet { model.spine.len() } else { 0 }, Mode::default());
        let mut done = 0.0;
        loop {
            let left = model.dt - done;
            let smooth = until_kink(&model.muscles, time + done, left);
            self.smooth(model, state, time + done, smooth);
            done += smooth;
            if smooth >= left {
                break;
            }
        }
        if let Some(friction) = &mut model.friction {
            friction.ratchet = ratchet;
        }
        model.admit_velocity(&state.position, &mut state.velocity);
        model.apply_contact(state);
    }
}

impl<S: Staged, const D: usize> Located<S, D> {
    /// Moves on by `length`, in which no muscle has a kink, from event to event.
    fn smooth(&mut self, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64, length: f64) {
        let jumps = model.muscles.iter().any(|muscle| muscle.wave == Wave::Square);
        let inward = if jumps { 0.25 * instant(time) } else { 0.0 };
        self.window = [time + inward, time + length - inward];
        let (mut done, mut last) = (0.0, None);
        for _ in 0..EVENTS_A_MASS * self.modes.len() {
            let left = length - done;
            // The pieces up to an event at the very end may add up to more than the whole, by a rounding error.
            if left <= 0.0 {
                return;
            }
            self.start.clone_from(state);
            self.piece(model, state, time + done, left, last);
            let Some((at, event)) = self.first_event(model, state, left) else { return };
            state.clone_from(&self.start);
            if at > 0.0 {
                self.piece(model, state, time + done, at, last);
                done += at;
            }
            if let Event::Rests(row) = event {
                hold(model, model.spine[row], state);
            }
            last = Some(event);
        }
        if done < length {
            self.piece(model, state, time + done, length - done, last);
        }
    }

    /// Moves on by `length`, with masses held or not as they are at the start. Of the mass with which the last piece ended it is known, where the push on
    /// it is still as good as nothing.
    fn piece(
        &mut self,
        model: &mut Model<f64, D>,
        state: &mut State<f64, D>,
        time: f64,
        length: f64,
        last: Option<Event>,
    ) {
        let particles = state.position.len();
        self.sum.position.fill([0.0; D]);
        self.sum.velocity.fill([0.0; D]);
        for (index, stage) in S::STAGES.iter().enumerate() {
            let reach = if index == 0 { 0.0 } else { stage.at * length };
            for i in 0..particles {
                for axis in 0..D {
                    let (v, a) = (self.stage.velocity[i][axis], self.acceleration[i][axis]);
                    self.stage.position[i][axis] = state.position[i][axis] + if index == 0 { 0.0 } else { v * reach };
                    self.stage.velocity[i][axis] = state.velocity[i][axis] + if index == 0 { 0.0 } else { a * reach };
                }
            }
            for (row, mode) in self.modes.iter_mut().enumerate() {
                let row = model.spine[row];
                let frame = model.frame(row, &self.stage.position);
                let speed = dot(self.stage.velocity[row.particle as usize], frame.spine);
                if index == 0 {
                    // A mass never slides back: as a spine turns, what slid forward may do so for a moment.
                    mode.speed = if frame.touches > 0.0 { speed.max(0.0) } else { speed };
                }
                if (index == 0 && speed < 0.0 && frame.touches > 0.0) || (index > 0 && mode.held) {
                    subtract(&mut self.stage.velocity[row.particle as usize], frame.spine, speed);
                }
            }
            let now = (time + stage.at * length).max(self.window[0]).min(self.window[1]);
            model.acceleration(now, &self.stage.position, &self.stage.velocity, &mut self.acceleration);
            model.admit_acceleration(&self.stage.position, &self.stage.velocity, &mut self.acceleration);
            for (index_of_row, mode) in self.modes.iter_mut().enumerate() {
                let row = model.spine[index_of_row];
                let frame = model.frame(row, &self.stage.position);
                let mass = row.particle as usize;
                let turn = model.spine_turn(row, &self.stage.position, &self.stage.velocity);
                let push = dot(self.acceleration[mass], frame.spine) + dot(self.stage.velocity[mass], turn);
                if index == 0 {
                    let soon = mode.speed + push * length * AT_ONCE;
                    let stays = match last {
                        Some(Event::Rests(row)) if row == index_of_row => true,
                        Some(Event::Slips(row)) if row == index_of_row => false,
                        _ => push < 0.0 && soon <= 0.0,
                    };
                    (mode.held, mode.push) = (stays && frame.touches > 0.0, push);
                }
                mode.last_push = push;
                if mode.held {
                    subtract(&mut self.acceleration[mass], frame.spine, push);
                }
            }
            for i in 0..particles {
                for axis in 0..D {
                    self.sum.position[i][axis] += self.stage.velocity[i][axis] * stage.weight;
                    self.sum.velocity[i][axis] += self.acceleration[i][axis] * stage.weight;
                }
            }
        }
        for i in 0..particles {
            for axis in 0..D {
                state.position[i][axis] += self.sum.position[i][axis] * length;
                state.velocity[i][axis] += self.sum.velocity[i][axis] * length;
            }
        }
        for (row, mode) in self.modes.iter().enumerate() {
            if mode.held {
                hold(model, model.spine[row], state);
            }
        }
    }

    /// The first event of a piece that was tried to its end, and when it comes.
    fn first_event(&self, model: &Model<f64, D>, end: &State<f64, D>, length: f64) -> Option<(f64, Event)> {
        let last = S::STAGES.last().map_or(1.0, |stage| stage.at) * length;
        let event = |(row, mode): (usize, &Mode)| {
            if mode.held {
                let slope = (mode.last_push - mode.push) / last;
                return (mode.push + slope * length > 0.0).then(|| (-mode.push / slope, Event::Slips(row)));
            }
            let frame = model.frame(model.spine[row], &end.position);
            let speed = dot(end.velocity[model.spine[row].particle as usize], frame.spine);
            let stops = frame.touches > 0.0 && mode.speed >= 0.0 && speed < 0.0;
            stops.then(|| (first_zero(mode.speed, mode.push, speed, length), Event::Rests(row)))
        };
        let events = self.modes.iter().enumerate().filter_map(event);
        events.map(|(at, event)| (at.clamp(0.0, length), event)).min_by(|(a, _), (b, _)| a.total_cmp(b))
    }
}

/// Takes from a mass all that it slides along the spine.
fn hold<const D: usize>(model: &Model<f64, D>, row: SpineRow, state: &mut State<f64, D>) {
    let spine = model.frame(row, &state.position).spine;
    let v = &mut state.velocity[row.particle as usize];
    subtract(v, spine, dot(*v, spine));
}

/// Where the parabola with this value ≥ 0 and slope at 0, and this value < 0 at `length`, first falls below zero.
fn first_zero(value: f64, slope: f64, end: f64, length: f64) -> f64 {
    let curve = (end - value - slope * length) / (length * length);
    let root = (slope * slope - 4.0 * curve * value).max(0.0).sqrt();
    // Both roots without cancellation: q/curve and value/q.
    let q = -0.5 * (slope + root.copysign(slope));
    let within = |at: &f64| *at > 0.0 && *at <= length;
    [q / curve, value / q].into_iter().filter(within).min_by(f64::total_cmp).unwrap_or(0.0)
}
