//! A race of methods: the same creature once for each, measured against one of them, the truth.

use bevy::{
    ecs::prelude::*,
    math::{DVec3, Vec3},
};

use crate::{
    body::Particles,
    physics::{Clock, Frozen, Shown},
};

/// A runner of a race.
#[derive(Clone, Component, Copy, Debug, PartialEq)]
pub struct Runner {
    /// Which lane it has, from 1; the truth has 0.
    pub lane: usize,
    /// The body that it is measured against.
    pub truth: Entity,
    /// How far its lane is from that of the truth.
    pub offset: DVec3,
    /// How far its worst particle is from where the truth has it, now (lengths).
    pub error: f64,
    /// The largest error since the start (lengths).
    pub worst: f64,
    /// The simulated time of these errors; a clock that stands before it was restarted.
    measured: f64,
}

impl Runner {
    /// The colours of the lanes, the truth's first: those of Okabe and Ito, red, green and blue. Further lanes begin again after the truth's.
    const COLORS: [[u8; 3]; 8] = [
        [0xf2, 0xf2, 0xf2],
        [0xe6, 0x9f, 0x00],
        [0x56, 0xb4, 0xe9],
        [0x00, 0x9e, 0x73],
        [0xf0, 0xe4, 0x42],
        [0x00, 0x72, 0xb2],
        [0xd5, 0x5e, 0x00],
        [0xcc, 0x79, 0xa7],
    ];

    /// The colour of its lane.
    pub fn color(&self) -> [u8; 3] {
        let last = Self::COLORS.len() - 1;
        Self::COLORS[if self.lane == 0 { 0 } else { 1 + (self.lane - 1) % last }]
    }
}

/// Where the truth shows each particle of a runner in this frame.
#[derive(Clone, Component, Debug, Default)]
pub struct Ghost(pub Vec<Vec3>);

/// Makes a race of these bodies.
pub(super) fn line_up(world: &mut World, bodies: &[Entity], truth: usize) {
    let start = |body: Entity| world.get::<Particles>(body).and_then(|particles| particles.positions().next());
    let Some(origin) = start(bodies[truth]) else { return };
    let offsets: Vec<_> = bodies.iter().map(|body| start(*body).unwrap_or_default() - origin).collect();
    let others = (0..bodies.len()).filter(|i| *i != truth);
    for (lane, i) in [truth].into_iter().chain(others).enumerate() {
        let runner = Runner { lane, truth: bodies[truth], offset: offsets[i], error: 0.0, worst: 0.0, measured: 0.0 };
        world.entity_mut(bodies[i]).insert(runner);
        if lane > 0 {
            world.entity_mut(bodies[i]).insert(Ghost::default());
        }
    }
}

/// Measures every runner after a tick. One that is frozen keeps the errors with which it left.
pub(super) fn measure(
    clock: Res<Clock>,
    bodies: Query<&Particles>,
    mut runners: Query<(&Particles, &mut Runner), Without<Frozen>>,
) {
    for (particles, mut runner) in &mut runners {
        let Ok(truth) = bodies.get(runner.truth) else { continue };
        let pairs = particles.positions().zip(truth.positions());
        let error = pairs.map(|(x, truth)| x.distance(truth + runner.offset)).fold(0.0, f64::max);
        let before = if clock.time() < runner.measured { 0.0 } else { runner.worst };
        (runner.error, runner.worst, runner.measured) = (error, error.max(before), clock.time());
    }
}

/// Puts the ghosts where the truth is shown.
pub(super) fn haunt(truths: Query<&Shown>, mut ghosts: Query<(&Runner, &mut Ghost)>) {
    for (runner, mut ghost) in &mut ghosts {
        let Ok(truth) = truths.get(runner.truth) else { continue };
        ghost.0.clear();
        ghost.0.extend(truth.positions().iter().map(|x| *x + runner.offset.as_vec3()));
    }
}
