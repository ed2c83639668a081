//! What the plots show: a body's lengths, velocities and way over the last ticks, and what the last frames cost.

use core::ops::RangeInclusive;

use bevy::{ecs::prelude::*, math::DVec3};

use super::{gait::GaitWatch, ring::Ring};
use crate::{
    body::{ParticleId, Particles, SpineFriction},
    mechanics::{BodyParts, elastic_energy, gravity_energy, kinetic_energy, metrics::BlockShape, rest_lengths},
};

/// A mass whose velocity along the spine is smaller than this is at rest.
pub const AT_REST: f64 = 1e-6;
/// How many ticks or frames are kept: about nine seconds at 64 ticks a second.
pub const KEPT: usize = 600;
/// At most this many springs and masses are followed.
pub const MOST_SERIES: usize = 6;

/// The last ticks of one body, and the last frames.
#[derive(Clone, Debug, Resource)]
pub struct Traces {
    /// The body that is followed.
    pub body: Option<Entity>,
    /// The simulated time of each tick.
    pub time: Ring<f64>,
    /// The springs along the spine.
    pub springs: Vec<SpringTrace>,
    /// The masses of the spine, from tail to head.
    pub masses: Vec<MassTrace>,
    /// How far the centre of mass is from where it started.
    pub distance: Ring<f64>,
    /// The shape of a block on a grid; empty where the body is none.
    pub blocks: Ring<Block>,
    /// All blocks of a scene that has several, to be compared.
    pub side_by_side: Vec<BlockTrace>,
    /// The gait of an animal.
    pub gait: GaitWatch,
    /// What the last frames cost.
    pub frames: Ring<Frame>,
    capacity: usize,
}

/// The lengths of one spring.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringTrace {
    /// Its name by its ends, such as `A–B`.
    pub name: String,
    /// Its length at each tick.
    pub length: Ring<f64>,
    /// The rest length that its muscle gave it.
    pub rest: Ring<f64>,
}

/// The velocity of one mass.
#[derive(Clone, Debug, PartialEq)]
pub struct MassTrace {
    /// Its name: `A` at the tail, and so on.
    pub name: String,
    /// S·V at each tick: its velocity along the spine.
    pub velocity: Ring<f64>,
}

/// A block on a grid at one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Its shape.
    pub shape: BlockShape,
    /// Its kinetic, elastic and gravity energy.
    pub energy: f64,
}

/// One of several blocks, as it is now and what the plots compare.
#[derive(Clone, Debug, PartialEq)]
pub struct BesideBlock {
    /// Its name in the scene.
    pub name: String,
    /// The colour of its skin, as 0xRRGGBB.
    pub color: u32,
    /// How many springs it has.
    pub springs: usize,
    /// The largest stable step; infinite where nothing is unstable.
    pub limit: f64,
    /// Its shape and energy.
    pub block: Block,
}

/// One of several blocks over the last ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockTrace {
    /// As it was last.
    pub now: BesideBlock,
    /// As it was at each tick.
    pub values: Ring<Block>,
}

/// What one frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Seconds of real time since the start.
    pub time: f64,
    /// Milliseconds since the frame before.
    pub frame: f64,
    /// Milliseconds of physics.
    pub physics: f64,
}

/// A body at one tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observation {
    /// The simulated time.
    pub time: f64,
    /// Name, length and rest length of the springs along the spine.
    pub springs: Vec<(String, f64, f64)>,
    /// Name and S·V of the masses of the spine.
    pub masses: Vec<(String, f64)>,
    /// How far the centre of mass is from where it started.
    pub distance: f64,
    /// The shape of a block on a grid, where the body is one.
    pub block: Option<Block>,
    /// All blocks of the scene, where it has several and the body is one.
    pub side_by_side: Vec<BesideBlock>,
}

impl Default for Traces {
    fn default() -> Self {
        Self::new(KEPT)
    }
}

impl Traces {
    /// Empty traces of at most `capacity` ticks and as many frames.
    pub fn new(capacity: usize) -> Self {
        Self {
            body: None,
            time: Ring::new(capacity),
            springs: Vec::new(),
            masses: Vec::new(),
            distance: Ring::new(capacity),
            blocks: Ring::new(capacity),
            side_by_side: Vec::new(),
            gait: GaitWatch::default(),
            frames: Ring::new(capacity),
            capacity,
        }
    }

    /// Forgets all ticks; the frames stay.
    pub fn clear(&mut self) {
        self.time.clear();
        self.distance.clear();
        self.blocks.clear();
        self.side_by_side.clear();
        self.gait = GaitWatch::default();
        self.springs.clear();
        self.masses.clear();
    }

    /// Adds a tick of `body`. Another body, other springs or a time that went back begin anew; a tick in which no time passed adds nothing.
    pub fn record(&mut self, body: Entity, seen: &Observation) {
        let same = self.body == Some(body)
            && self.blocks.is_empty() == (seen.block.is_none() || self.time.is_empty())
            && self
                .side_by_side
                .iter()
                .map(|trace| &trace.now.name)
                .eq(seen.side_by_side.iter().map(|block| &block.name))
            && self.springs.iter().map(|trace| &trace.name).eq(seen.springs.iter().map(|(name, ..)| name))
            && self.masses.iter().map(|trace| &trace.name).eq(seen.masses.iter().map(|(name, _)| name));
        let last = self.time.last().copied();
        if !same || last.is_some_and(|last| seen.time < last) {
            self.begin(body, seen);
        } else if last == Some(seen.time) {
            return;
        }
        self.time.push(seen.time);
        self.distance.push(seen.distance);
        seen.block.into_iter().for_each(|block| self.blocks.push(block));
        for (trace, seen) in self.side_by_side.iter_mut().zip(&seen.side_by_side) {
            trace.now.clone_from(seen);
            trace.values.push(seen.block);
        }
        for (trace, (_, length, rest)) in self.springs.iter_mut().zip(&seen.springs) {
            trace.length.push(*length);
            trace.rest.push(*rest);
        }
        for (trace, (_, velocity)) in self.masses.iter_mut().zip(&seen.masses) {
            trace.velocity.push(*velocity);
        }
    }

    fn begin(&mut self, body: Entity, seen: &Observation) {
        self.clear();
        self.body = Some(body);
        self.side_by_side = (seen.side_by_side.iter())
            .map(|block| BlockTrace { now: block.clone(), values: Ring::new(self.capacity) })
            .collect();
        let ring = || Ring::new(self.capacity);
        self.springs = seen
            .springs
            .iter()
            .map(|(name, ..)| SpringTrace { name: name.clone(), length: ring(), rest: ring() })
            .collect();
        self.masses = seen.masses.iter().map(|(name, _)| MassTrace { name: name.clone(), velocity: ring() }).collect();
    }

    /// When a mass was at rest, as intervals of time from the first to the last tick at which it was.
    pub fn rests(&self, mass: usize) -> Vec<RangeInclusive<f64>> {
        let Some(trace) = self.masses.get(mass) else { return Vec::new() };
        rest_intervals(self.time.iter().copied().zip(trace.velocity.iter().copied()))
    }
}

/// The intervals in which a velocity is that of a mass at rest, from (time, velocity) in the order of time.
pub fn rest_intervals(samples: impl IntoIterator<Item = (f64, f64)>) -> Vec<RangeInclusive<f64>> {
    let mut intervals: Vec<RangeInclusive<f64>> = Vec::new();
    let mut resting = false;
    for (time, velocity) in samples {
        let rests = velocity.abs() < AT_REST;
        match intervals.last_mut() {
            Some(interval) if rests && resting => *interval = *interval.start()..=time,
            _ if rests => intervals.push(time..=time),
            _ => {}
        }
        resting = rests;
    }
    intervals
}

/// What a body does at `time`. `start` is where its centre of mass began.
pub fn observe(body: &BodyParts<'_>, start: DVec3, time: f64) -> Observation {
    let particles = body.particles;
    let spine = spine(particles, body.friction);
    let place = |particle: ParticleId| spine.iter().position(|&other| other == particle);
    let on_spine = |ends: [ParticleId; 2]| match (place(ends[0]), place(ends[1])) {
        (Some(a), Some(b)) => a.abs_diff(b) == 1,
        _ => false,
    };
    let springs = (body.springs.ends().iter().zip(rest_lengths(body, time)))
        .filter(|(ends, _)| on_spine(**ends))
        .take(MOST_SERIES)
        .filter_map(|(&[a, b], rest)| {
            let length = particles.position(a)?.distance(particles.position(b)?);
            let (first, second) = (place(a)?.min(place(b)?), place(a)?.max(place(b)?));
            Some((format!("{}–{}", letter(first), letter(second)), length, rest))
        })
        .collect();
    let masses = (spine.iter().enumerate())
        .take(MOST_SERIES)
        .filter_map(|(index, &particle)| {
            let velocity = particles.velocity(particle)?.dot(direction(particles, &spine, index));
            Some((letter(index), velocity))
        })
        .collect();
    let distance = particles.center().distance(start);
    Observation { time, springs, masses, distance, block: block(body, time), side_by_side: Vec::new() }
}

/// Shape and energy of a block on a grid at `time`; nothing where the body is none.
pub fn block(body: &BodyParts<'_>, time: f64) -> Option<Block> {
    let shape = BlockShape::measure(body.particles, body.lattice?)?;
    let energy = kinetic_energy(body.particles) + elastic_energy(body, time) + gravity_energy(body);
    Some(Block { shape, energy })
}

/// The spine from tail to head; the order of the particles where there is no friction to say it.
fn spine(particles: &Particles, friction: Option<&SpineFriction>) -> Vec<ParticleId> {
    match friction {
        // One more than is shown: the last one's direction needs its neighbour.
        // Of sections, the first particle stands for all.
        Some(friction) => {
            friction.sections().filter_map(|section| section.first().copied()).take(MOST_SERIES + 1).collect()
        }
        None => (0..particles.len().min(MOST_SERIES + 1) as u32).map(ParticleId).collect(),
    }
}

/// S = (X_next − X_previous)/|X_next − X_previous|, one-sided at the ends.
fn direction(particles: &Particles, spine: &[ParticleId], index: usize) -> DVec3 {
    let at = |index: usize| spine.get(index).and_then(|&particle| particles.position(particle)).unwrap_or_default();
    let next = (index + 1).min(spine.len().saturating_sub(1));
    (at(next) - at(index.saturating_sub(1))).normalize_or_zero()
}

/// A for the first, B for the second and so on.
fn letter(index: usize) -> String {
    u8::try_from(index)
        .ok()
        .filter(|&index| index < 26)
        .map_or_else(|| index.to_string(), |index| char::from(b'A' + index).into())
}
