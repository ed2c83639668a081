//! The gait of a strand, measured over its last cycles.

use std::collections::VecDeque;

use bevy::math::{DVec2, DVec3};
use serde::Serialize;

use crate::{
    body::{Strand, WaveKind},
    mechanics::BodyParts,
};

use super::{
    bend, cell_volume,
    fourier::{Spectrum, reflected},
    heading, is_lifted, length_at_rest,
    path::Path,
    section_center, section_width, segment_length, spine_vector, strains,
};

/// How often a cycle is looked at.
pub const SAMPLES_A_CYCLE: usize = 200;
/// Over how many cycles at the end a gait is measured.
const CYCLES: usize = 4;
/// Every so many samples one counts for the path and the bends.
const COARSE: usize = 2;
/// Over how many cycles the path is kept that sections are to follow, where no sample is left out. A body that gets on by 1/28 of its length a cycle or more
/// has left behind what is older when its gait is measured.
const PATH_CYCLES: usize = 32;
/// By how many cycles a sample may be late: by half a step.
const LATE: f64 = 0.5 / SAMPLES_A_CYCLE as f64;

/// Watches a strand, and measures its gait. Feed it often, from the start on: it takes a sample when one is due.
///
/// It keeps the samples of the last four cycles and the path of the last 32, however long it watches.
#[derive(Clone, Debug)]
pub struct Gait {
    strand: Strand,
    /// The time of a cycle.
    period: f64,
    /// The wavelength of the lateral wave, if there is one.
    wavelength: Option<f64>,
    /// The length of the body at rest.
    length: f64,
    /// Those of the last cycles.
    samples: VecDeque<Sample>,
    /// Which sample comes next, counted in parts of a cycle from time 0.
    due: u64,
    /// When the first sample was taken, in cycles.
    first: f64,
    /// How many samples were taken.
    taken: usize,
    /// The way of the section behind the head, from above.
    path: Path,
    /// The smallest volume of a segment in any sample.
    smallest_cell: f64,
}

#[derive(Clone, Debug)]
struct Sample {
    cycles: f64,
    center: DVec3,
    heading: f64,
    /// The centres of the sections from above.
    sections: Vec<DVec2>,
    lengths: Vec<f64>,
    bends: Vec<f64>,
    widths: Vec<f64>,
    worst_strain: f64,
    /// The mean of the squared strains.
    square_strain: f64,
    lifted: f64,
    /// Of the grounded sections, the sums of the speeds across and of all speeds.
    slip: [f64; 2],
}

/// The gait of a strand over its last cycles, four of them or as many as there were.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GaitMetrics {
    /// Over how many cycles it was measured.
    pub cycles: usize,
    /// How far the centre of mass comes in a cycle, along the ground (lengths).
    pub distance: f64,
    /// The same in lengths of the body at rest.
    pub body_lengths: f64,
    /// The part of the distance that leads forward, along the mean direction from tail to head (lengths).
    pub forward: f64,
    /// The way it goes against the mean direction from tail to head, in degrees; positive is to the right.
    pub angle: f64,
    /// By how much the direction from tail to head turns in a cycle, in degrees; positive is to the right.
    pub turn: f64,
    /// Of the motion of the sections on the ground, the part that leads across the spine: Σ|q·v|/Σ|v| with the mean velocity v of the two lower masses.
    pub slip: f64,
    /// The part of the sections whose lower masses are both off the ground.
    pub lifted: f64,
    /// How far the sections from the second to the fourth from the head are from the path of the second from the head, on average (lengths): from where that
    /// was in the last 32 cycles.
    pub path_error: f64,
    /// The largest |l/L − 1| of all springs.
    pub worst_strain: f64,
    /// The root of the mean square of l/L − 1 over all springs.
    pub rms_strain: f64,
    /// The part of the lengths of the segments that is not their fundamental, √(1 − its variance/all variance).
    pub harmonic: f64,
    /// The same of the bends of the segments: what does not come back in every cycle, or is not a sine.
    pub residue: f64,
    /// The wave of bends that runs back over the one that runs forward. Nothing without a lateral wave.
    pub reflected: Option<f64>,
    /// By how much the width of a section changes, of the section that changes most (lengths).
    pub width_swing: f64,
    /// The smallest volume of a segment since the start.
    pub smallest_cell: f64,
}

impl Gait {
    /// A watch over a strand with waves; nothing where the body is none.
    pub fn new(body: &BodyParts<'_>) -> Option<Self> {
        let strand = body.strand?;
        let waves = body.waves?;
        let lateral = waves.iter().find(|wave| wave.kind == WaveKind::Lateral && wave.amplitude > 0.0);
        Some(Self {
            strand,
            period: waves.longest_period()?,
            wavelength: lateral.map(|wave| wave.wavelength),
            length: length_at_rest(body.springs, strand),
            samples: VecDeque::new(),
            due: 0,
            first: 0.0,
            taken: 0,
            path: Path::new(PATH_CYCLES * SAMPLES_A_CYCLE / COARSE),
            smallest_cell: f64::INFINITY,
        })
    }

    /// The time of a cycle, that of the slowest wave.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Looks at the body at `time` if it is time to, within half a step.
    pub fn sample(&mut self, body: &BodyParts<'_>, time: f64, dt: f64) {
        let part = ((time + 0.5 * dt) / self.period * SAMPLES_A_CYCLE as f64) as u64;
        // Cycles that are too short to be counted are not looked at.
        if part < self.due || part == u64::MAX {
            return;
        }
        self.due = part + 1;
        let (particles, strand) = (body.particles, self.strand);
        let sections = 0..strand.sections();
        let segments = 0..strand.segments();
        let strains = strains(body, time);
        let mut slip = [0.0; 2];
        let mut lifted = 0.0;
        for section in sections.clone() {
            if is_lifted(particles, strand, section, body.ground) {
                lifted += 1.0 / strand.sections() as f64;
                continue;
            }
            let [left, right] = [0, 1].map(|c| particles.velocity(strand.section(section)[c]).unwrap_or_default());
            let v = 0.5 * (left + right);
            let along = spine_vector(particles, strand, section);
            let side = DVec2::new(along.z, -along.x).normalize_or_zero();
            let v = DVec2::new(v.x, v.z);
            slip[0] += side.dot(v).abs();
            slip[1] += v.length();
        }
        let cycles = time / self.period;
        let sections: Vec<_> = sections.map(|i| from_above(section_center(particles, strand, i))).collect();
        if self.taken == 0 {
            self.first = cycles;
        }
        if self.taken.is_multiple_of(COARSE) {
            self.path.push(sections[strand.segments() - 1]);
        }
        self.taken += 1;
        self.smallest_cell =
            segments.clone().map(|i| cell_volume(particles, strand, i)).fold(self.smallest_cell, f64::min);
        // One more than the last cycles ask for may be late by half a step.
        while self.samples.front().is_some_and(|sample| sample.cycles < cycles - CYCLES as f64 - 2.0 * LATE) {
            self.samples.pop_front();
        }
        self.samples.push_back(Sample {
            cycles,
            center: particles.center(),
            heading: heading(particles, strand),
            widths: (0..sections.len()).map(|i| section_width(particles, strand, i)).collect(),
            sections,
            lengths: segments.clone().map(|i| segment_length(particles, strand, i)).collect(),
            bends: segments.map(|i| bend(particles, strand, i)).collect(),
            worst_strain: strains.iter().map(|strain| strain.abs()).fold(0.0, f64::max),
            square_strain: strains.iter().map(|strain| strain * strain).sum::<f64>() / strains.len() as f64,
            lifted,
            slip,
        });
    }

    /// The gait so far; nothing before a whole cycle is over, and where there are no two samples in the last cycles, as cycles are shorter than steps.
    pub fn measure(&self) -> Option<GaitMetrics> {
        let end = self.samples.back()?;
        let cycles = ((end.cycles - self.first + LATE) as usize).min(CYCLES);
        if cycles == 0 {
            return None;
        }
        let from = self.samples.partition_point(|sample| sample.cycles < end.cycles - cycles as f64 - LATE);
        let last: Vec<_> = self.samples.range(from..).collect();
        // The end of the last cycle is the start of the next.
        let (_, whole) = last.split_last()?;
        let start = whole.first().filter(|start| end.cycles - start.cycles > 0.0)?;
        let way = from_above(end.center - start.center) / (end.cycles - start.cycles);
        let headings = unwrapped(last.iter().map(|sample| sample.heading));
        let mean_heading = headings.iter().sum::<f64>() / headings.len() as f64;
        let direction = DVec2::new(libm::cos(mean_heading), libm::sin(mean_heading));
        let across = DVec2::new(-direction.y, direction.x);
        let mean =
            |of: &dyn Fn(&Sample) -> f64| whole.iter().map(|sample| of(sample)).sum::<f64>() / whole.len() as f64;
        let sum = |part: usize| whole.iter().map(|sample| sample.slip[part]).sum::<f64>();
        let bends: Vec<_> = whole.iter().copied().step_by(COARSE).collect();
        let bends = self.spectra(&bends, |sample, segment| sample.bends[segment]);
        let lengths = self.spectra(whole, |sample, segment| sample.lengths[segment]);
        Some(GaitMetrics {
            cycles,
            distance: way.length(),
            body_lengths: way.length() / self.length,
            forward: way.dot(direction),
            angle: libm::atan2(way.dot(across), way.dot(direction)).to_degrees(),
            turn: (headings[headings.len() - 1] - headings[0]).to_degrees() / cycles as f64,
            slip: if sum(1) > 0.0 { sum(0) / sum(1) } else { 0.0 },
            lifted: mean(&|sample| sample.lifted),
            path_error: self.path_error(whole),
            worst_strain: whole.iter().map(|sample| sample.worst_strain).fold(0.0, f64::max),
            rms_strain: mean(&|sample| sample.square_strain).sqrt(),
            harmonic: Spectrum::rest(&lengths),
            residue: Spectrum::rest(&bends),
            reflected: self.wavelength.and_then(|wavelength| {
                let behind = |segment: usize| self.strand.segments() as f64 - segment as f64 - 0.5;
                let places = bends.iter().enumerate().map(|(i, bend)| (behind(i), bend.fundamental));
                reflected(places, wavelength)
            }),
            width_swing: self.width_swing(whole),
            smallest_cell: self.smallest_cell,
        })
    }

    fn spectra(&self, samples: &[&Sample], of: impl Fn(&Sample, usize) -> f64) -> Vec<Spectrum> {
        let spectrum = |segment| Spectrum::of(samples.iter().map(|sample| (sample.cycles, of(sample, segment))));
        (0..self.strand.segments()).map(spectrum).collect()
    }

    fn path_error(&self, whole: &[&Sample]) -> f64 {
        let followers = 1..self.strand.segments().saturating_sub(2);
        let distances: Vec<_> = (whole.iter().step_by(COARSE))
            .flat_map(|sample| followers.clone().map(|section| self.path.distance(sample.sections[section])))
            .collect();
        if distances.is_empty() { 0.0 } else { distances.iter().sum::<f64>() / distances.len() as f64 }
    }

    fn width_swing(&self, whole: &[&Sample]) -> f64 {
        let swing = |section: usize| {
            let widths = whole.iter().map(|sample| sample.widths[section]);
            widths.clone().fold(f64::NEG_INFINITY, f64::max) - widths.fold(f64::INFINITY, f64::min)
        };
        (0..self.strand.sections()).map(swing).fold(0.0, f64::max)
    }
}

fn from_above(v: DVec3) -> DVec2 {
    DVec2::new(v.x, v.z)
}

/// Angles without their jumps by whole turns.
fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = Vec::new();
    for angle in angles {
        let turns = all.last().map_or(0.0, |last| libm::round((last - angle) / core::f64::consts::TAU));
        all.push(angle + turns * core::f64::consts::TAU);
    }
    all
}
