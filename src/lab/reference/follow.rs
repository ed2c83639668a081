//! Following a body through its events: smooth pieces, each up to the instant at which a mass starts or stops to slide, or to a kink of a muscle.

use bevy::math::DVec3;

use crate::{body::ParticleId, lab::ProblemBody};

use super::{
    events::Ahead,
    flow::{Flow, Mode},
    kinks::kinks,
    piece::Piece,
    schemes::Scheme,
};

/// A mass that starts or stops to slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StickSlip {
    /// The body, counted from 0 in the order of the scene.
    pub body: usize,
    /// The mass.
    pub particle: ParticleId,
    /// When.
    pub time: f64,
    /// Whether it slides from there on.
    pub slides: bool,
}

/// A body at the shared times.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    /// Positions, time by time.
    pub(super) positions: Vec<DVec3>,
    /// Velocities, time by time.
    pub(super) velocities: Vec<DVec3>,
    pub(super) events: Vec<StickSlip>,
}

/// How finely a body is followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grain {
    /// Events are looked for at least this often.
    pub(super) chunk: f64,
    /// A speed that is nothing.
    pub(super) speed: f64,
    /// An acceleration that is nothing.
    pub(super) push: f64,
}

/// Why a body cannot be followed any further.
pub(super) struct Broken {
    pub(super) time: f64,
    pub(super) problem: String,
}

/// Follows one body through `times`, which ascend.
pub(super) fn follow<const D: usize>(
    body: &ProblemBody,
    times: &[f64],
    scheme: &mut impl Scheme<D>,
    grain: Grain,
) -> Result<Track, Broken> {
    let flow = Flow::<D>::new(body);
    let end = times.last().copied().unwrap_or(0.0);
    let kinks = kinks(body.muscles.as_ref(), end);
    let y = start::<D>(body);
    // Without events nothing has to be looked for.
    let grain = if flow.has_events() { grain } else { Grain { chunk: f64::INFINITY, ..grain } };
    let mut follower = Follower {
        flow: &flow,
        scheme,
        grain,
        window: window(&kinks, 0, end),
        time: 0.0,
        y,
        modes: Vec::new(),
        gaps: Vec::new(),
        slopes: Vec::new(),
        events: Vec::new(),
    };
    let mut track = Track::default();
    let mut next = 0;
    follower.modes = flow.settle(follower.window, &mut follower.y, grain.push, 1e-4 * end);
    follower.look();
    for &time in times {
        while next < kinks.len() && kinks[next] < time {
            follower.go_to(kinks[next])?;
            next += 1;
            follower.window = window(&kinks, next, end);
            follower.look();
        }
        follower.go_to(time)?;
        track.positions.extend(vectors::<D>(body, &follower.y, 0));
        track.velocities.extend(vectors::<D>(body, &follower.y, body.particles.len()));
    }
    track.events = follower.events;
    Ok(track)
}

/// Positions and velocities at the start.
fn start<const D: usize>(body: &ProblemBody) -> Vec<f64> {
    let particles = &body.particles;
    let vectors = particles.positions().chain(particles.velocities());
    vectors.flat_map(|vector| vector.to_array().into_iter().take(D)).collect()
}

/// Rows of a state from `first` on as vectors. What an axis leaves out is as it was at the start: at rest.
fn vectors<'a, const D: usize>(body: &'a ProblemBody, y: &'a [f64], first: usize) -> impl Iterator<Item = DVec3> + 'a {
    let rows = y.as_chunks::<D>().0;
    body.particles.positions().enumerate().map(move |(i, at)| {
        let mut vector = if first == 0 { at.to_array() } else { [0.0; 3] };
        vector[..D].copy_from_slice(&rows[first + i]);
        DVec3::from(vector)
    })
}

/// The times of the piece before a kink, or before the end, without the instants at which it begins and ends: a square wave may switch at 0, too.
fn window(kinks: &[f64], next: usize, end: f64) -> [f64; 2] {
    // Far more than rounding errors of a phase, far less than what could be seen.
    let inward = 1e-13 * end;
    let from = if next == 0 { 0.0 } else { kinks[next - 1] };
    let to = kinks.get(next).copied().unwrap_or(end);
    let (from, to) = (from + inward, to - inward);
    if from < to { [from, to] } else { [0.5 * (from + to); 2] }
}

/// A body on its way.
pub(super) struct Follower<'a, S, const D: usize> {
    pub(super) flow: &'a Flow<'a, D>,
    pub(super) scheme: &'a mut S,
    pub(super) grain: Grain,
    pub(super) window: [f64; 2],
    pub(super) time: f64,
    pub(super) y: Vec<f64>,
    pub(super) modes: Vec<Mode>,
    /// How far each mass of the spine is from an event, and how fast that changes.
    pub(super) gaps: Vec<f64>,
    pub(super) slopes: Vec<f64>,
    pub(super) events: Vec<StickSlip>,
}

impl<S: Scheme<D>, const D: usize> Follower<'_, S, D> {
    pub(super) fn piece(&self) -> Piece<'_, D> {
        Piece { flow: self.flow, modes: &self.modes, window: self.window }
    }

    fn broken(&self, problem: impl Into<String>) -> Broken {
        Broken { time: self.time, problem: problem.into() }
    }

    /// Goes to `end` through all events before it.
    fn go_to(&mut self, end: f64) -> Result<(), Broken> {
        /// More events in one chunk than a body has that is not shaking its friction.
        const MOST_EVENTS: u32 = 1000;
        let mut events = 0;
        while self.time < end {
            let to = if end - self.time <= 1.000_001 * self.grain.chunk { end } else { self.time + self.grain.chunk };
            let y = self.state_at(to)?;
            if !y.iter().all(|value| value.is_finite()) {
                return Err(self.broken("it is not finite"));
            }
            if let Some(spring) = self.flow.collapsed(&self.y, &y) {
                return Err(self.broken(format!("spring {spring} has no length")));
            }
            let mut ahead = Ahead { time: to, y, gaps: Vec::new(), slopes: Vec::new() };
            self.measure(&mut ahead, -1.0);
            let Some((time, node)) = self.first_event(&ahead)? else {
                (self.time, self.y, self.gaps, self.slopes) = (ahead.time, ahead.y, ahead.gaps, ahead.slopes);
                events = 0;
                continue;
            };
            events += 1;
            if events > MOST_EVENTS {
                return Err(self.broken("a mass starts and stops to slide without end"));
            }
            self.y = self.state_at(time)?;
            self.time = time;
            self.switch(node);
        }
        Ok(())
    }

    pub(super) fn state_at(&mut self, time: f64) -> Result<Vec<f64>, Broken> {
        if time <= self.time {
            return Ok(self.y.clone());
        }
        let piece = Piece { flow: self.flow, modes: &self.modes, window: self.window };
        self.scheme.advance(&piece, self.time, &self.y, time).map_err(|problem| Broken { time: self.time, problem })
    }

    /// Changes the mode of a mass.
    fn switch(&mut self, node: usize) {
        let ratchet = self.flow.is_ratchet();
        self.modes[node] = match self.modes[node] {
            Mode::Held | Mode::Back => Mode::Forward,
            Mode::Forward if ratchet => Mode::Held,
            Mode::Forward => Mode::Back,
        };
        if self.modes[node] == Mode::Held {
            self.flow.stop(node, &mut self.y);
        }
        if ratchet {
            let particle = ParticleId(self.flow.particle(node) as u32);
            let slides = self.modes[node] == Mode::Forward;
            self.events.push(StickSlip { body: 0, particle, time: self.time, slides });
        }
        self.look();
    }

    /// Works out gaps and slopes where it is.
    fn look(&mut self) {
        let mut here = Ahead { time: self.time, y: core::mem::take(&mut self.y), gaps: Vec::new(), slopes: Vec::new() };
        self.measure(&mut here, 1.0);
        (self.y, self.gaps, self.slopes) = (here.y, here.gaps, here.slopes);
    }
}
