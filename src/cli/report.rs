//! What a run has to tell: the table of a recording, and the result.

use core::fmt;
use std::io::{self, Write};

use bevy::math::DVec3;
use serde::Serialize;

use super::Headless;
use crate::{
    body::{Bonds, Lattice, Particles, Springs, Tearing},
    mechanics::metrics::{BlockShape, Gait, GaitMetrics, SAMPLES_A_CYCLE},
    physics::{Frozen, body_parts},
};

/// FNV-1a 64 over the little-endian bits of all positions, then of all velocities, body by body.
pub fn state_hash<'a>(bodies: impl Iterator<Item = &'a Particles> + Clone) -> u64 {
    let positions = bodies.clone().flat_map(Particles::positions);
    let velocities = bodies.flat_map(Particles::velocities);
    let bytes = positions.chain(velocities).flat_map(|vector| vector.to_array()).flat_map(f64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Writes the names of the columns of a recording.
pub(super) fn write_record_head(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "time,body,particle,x,y,z,vx,vy,vz")
}

/// Writes one line a particle, with as many digits as it takes to read back the same bits.
pub(super) fn write_record(out: &mut dyn Write, run: &Headless) -> io::Result<()> {
    let time = run.clock().time();
    for (name, _, particles) in run.bodies() {
        for (i, (p, v)) in particles.positions().zip(particles.velocities()).enumerate() {
            writeln!(out, "{time},{name},{i},{},{},{},{},{},{}", p.x, p.y, p.z, v.x, v.y, v.z)?;
        }
    }
    Ok(())
}

/// The result of a run, as `--json` prints it.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    scene: String,
    method: &'static str,
    dt: f64,
    time: f64,
    steps: u64,
    wall_seconds: f64,
    force_evaluations: u64,
    spring_updates: u64,
    hash: String,
    threads: usize,
    bodies: Vec<BodyReport>,
    /// What watches the gait of each body, where it has one.
    #[serde(skip)]
    gaits: Vec<Option<Gait>>,
}

#[derive(Debug, Serialize)]
struct BodyReport {
    name: String,
    particles: usize,
    /// Springs, or bonds.
    springs: usize,
    start: [f64; 3],
    center: [f64; 3],
    distance: f64,
    status: &'static str,
    /// What it was frozen for, if it was.
    #[serde(skip_serializing_if = "Option::is_none")]
    frozen: Option<FrozenReport>,
    /// Its gait over its last cycles, where it is a strand with waves.
    #[serde(skip_serializing_if = "Option::is_none")]
    gait: Option<GaitMetrics>,
    /// Its shape at the end, where it is a block on a grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    block: Option<BlockShape>,
    /// How many of its springs are torn, where they can tear.
    #[serde(skip_serializing_if = "Option::is_none")]
    torn: Option<usize>,
}

/// The step that a body did not survive; its state is that of the step before.
#[derive(Debug, Serialize)]
struct FrozenReport {
    step: u64,
    time: f64,
    particle: u32,
    reason: String,
}

impl Report {
    /// Notes where the bodies are at the start.
    pub(super) fn start(scene: String, method: &'static str, run: &Headless) -> Self {
        let bodies = run.bodies().map(|(name, body, particles)| {
            let start = particles.center().to_array();
            let bonds = body.get::<Bonds>().map_or(0, |bonds| bonds.relation().len());
            let springs = body.get::<Springs>().map_or(bonds, Springs::len);
            BodyReport {
                name: name.into(),
                particles: particles.len(),
                springs,
                start,
                center: start,
                distance: 0.0,
                status: "running",
                frozen: None,
                gait: None,
                block: None,
                torn: None,
            }
        });
        let gaits = run.bodies().map(|(_, body, _)| Gait::new(&body_parts(body)?));
        Self {
            scene,
            method,
            dt: run.clock().dt(),
            time: 0.0,
            steps: 0,
            wall_seconds: 0.0,
            force_evaluations: 0,
            spring_updates: 0,
            hash: String::new(),
            threads: 0,
            bodies: bodies.collect(),
            gaits: gaits.collect(),
        }
    }

    /// How many steps there are between two samples of a gait, for the body that asks for the fewest; nothing where no body has a gait.
    pub(super) fn steps_between_samples(&self, run: &Headless) -> Option<u64> {
        let shortest = self.gaits.iter().flatten().map(Gait::period).reduce(f64::min)?;
        Some((shortest / SAMPLES_A_CYCLE as f64 / run.clock().dt()).round().max(1.0) as u64)
    }

    /// Looks at the gaits of all bodies.
    pub(super) fn watch(&mut self, run: &Headless) {
        let (time, dt) = (run.clock().time(), run.clock().dt());
        for (gait, (_, body, _)) in self.gaits.iter_mut().zip(run.bodies()) {
            if let (Some(gait), Some(parts)) = (gait, body_parts(body)) {
                gait.sample(&parts, time, dt);
            }
        }
    }

    /// Notes how it ended.
    pub(super) fn finish(&mut self, run: &Headless, wall_seconds: f64, threads: usize) {
        let (clock, cost) = (run.clock(), run.cost());
        (self.time, self.steps) = (clock.time(), clock.step());
        (self.wall_seconds, self.threads) = (wall_seconds, threads);
        (self.force_evaluations, self.spring_updates) = (cost.force_evaluations, cost.spring_updates);
        self.hash = format!("{:016x}", state_hash(run.bodies().map(|(_, _, particles)| particles)));
        for ((report, gait), (_, body, particles)) in self.bodies.iter_mut().zip(&self.gaits).zip(run.bodies()) {
            report.center = particles.center().to_array();
            report.distance = DVec3::from(report.start).distance(particles.center());
            report.block = body.get::<Lattice>().and_then(|&lattice| BlockShape::measure(particles, lattice));
            report.torn = body.get::<Tearing>().map(Tearing::count);
            report.gait = gait.as_ref().and_then(Gait::measure);
            report.status = if body.contains::<Frozen>() { "frozen" } else { "running" };
            report.frozen = body.get::<Frozen>().map(|frozen| FrozenReport {
                step: frozen.step,
                time: frozen.time,
                particle: frozen.particle.0,
                reason: frozen.reason.clone(),
            });
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// A scene of thousands is summed up by its first bodies.
        const SHOWN: usize = 20;
        let Self { scene, method, dt, time, steps, wall_seconds, hash, .. } = self;
        write!(f, "{scene}: {steps} steps of {dt} with {method} to t = {time}, in {wall_seconds:.2} s (hash {hash})")?;
        for body in self.bodies.iter().take(SHOWN) {
            let [x, y, z] = body.center;
            write!(
                f,
                "\n  {}: {}, {:.4} from its start, at ({x:.4}, {y:.4}, {z:.4})",
                body.name, body.status, body.distance
            )?;
            if let Some(gait) = &body.gait {
                write!(f, ", {:.3} of its length a cycle", gait.body_lengths)?;
                let health = if gait.smallest_cell < 0.0 { " (inside out)" } else { "" };
                write!(f, ", smallest cell {:.2}{health}", gait.smallest_cell)?;
            }
            if let Some(block) = &body.block {
                write!(f, ", shape error {:.4}, {} cells inside out", block.shape_error, block.inverted)?;
            }
            if let Some(torn) = body.torn {
                write!(f, ", {torn} springs torn")?;
            }
        }
        match self.bodies.len().saturating_sub(SHOWN) {
            0 => Ok(()),
            more => write!(f, "\n  and {more} more (--json has all)"),
        }
    }
}
