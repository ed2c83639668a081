//! The matrices of a body near its pose, in coordinates weighted by the square roots of the masses.

use bevy::math::DVec3;
use faer::{
    Mat,
    sparse::{SparseColMat, Triplet},
};

use crate::{
    body::{Particle, ParticleId, Particles, SpringId},
    mechanics::{BodyParts, rest_lengths},
};

use super::Across;

/// By how much a particle is moved, in the shortest rest length, to see how rest lengths follow it.
const MOVE: f64 = 1e-5;

/// One coordinate that can change.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coordinate {
    pub(crate) particle: usize,
    pub(crate) axis: usize,
    /// 1/√m.
    pub(crate) weight: f64,
}

/// The coordinates of a body that can change.
pub(super) fn coordinates(body: &BodyParts<'_>, dimensions: usize) -> Vec<Coordinate> {
    let particles = body.particles.masses().iter().zip(body.particles.pinned()).enumerate();
    particles
        .filter(|(_, (_, pinned))| !**pinned)
        .flat_map(|(particle, (mass, _))| {
            (0..dimensions).map(move |axis| Coordinate { particle, axis, weight: 1.0 / mass.sqrt() })
        })
        .collect()
}

/// M^(−½)KM^(−½) and M^(−½)CM^(−½), without what rest lengths do that follow the pose.
pub(super) fn matrices(
    body: &BodyParts<'_>,
    rest: &[f64],
    dimensions: usize,
    coordinates: &[Coordinate],
    across: Across,
) -> Option<(SparseColMat<usize, f64>, SparseColMat<usize, f64>)> {
    let (mut stiffness, mut damping) = (Vec::new(), Vec::new());
    entries(body, rest, dimensions, coordinates, across, |row, col, k, c| {
        stiffness.push(Triplet { row, col, val: k });
        damping.push(Triplet { row, col, val: c });
    });
    let count = coordinates.len();
    let matrix = |entries: &[_]| SparseColMat::try_new_from_triplets(count, count, entries).ok();
    Some((matrix(&stiffness)?, matrix(&damping)?))
}

/// Which coordinate each axis of each particle is.
fn index(body: &BodyParts<'_>, coordinates: &[Coordinate]) -> Vec<Option<usize>> {
    let mut index = vec![None; 3 * body.particles.len()];
    for (i, coordinate) in coordinates.iter().enumerate() {
        index[3 * coordinate.particle + coordinate.axis] = Some(i);
    }
    index
}

/// Each spring's parts of the two matrices: row, column, stiffness, damping. A spring of length l along n resists with k along n, and across with k(1 − L/l).
fn entries(
    body: &BodyParts<'_>,
    rest: &[f64],
    dimensions: usize,
    coordinates: &[Coordinate],
    across: Across,
    mut add: impl FnMut(usize, usize, f64, f64),
) {
    let index = index(body, coordinates);
    let torn = |i: usize| body.tearing.is_some_and(|tearing| tearing.is_torn(SpringId(i as u32)));
    let springs = body.springs.iter().zip(rest).enumerate().filter(|(i, _)| !torn(*i));
    for (_, (spring, rest)) in springs {
        let [a, b] = spring.ends.map(|end| body.particles.position(end).unwrap_or(DVec3::ZERO));
        let length = a.distance(b);
        if length == 0.0 {
            continue;
        }
        let along = ((b - a) / length).to_array();
        let across = match across {
            Across::Resisted if dimensions > 1 => spring.stiffness * (1.0 - rest / length),
            _ => 0.0,
        };
        for (p, end) in spring.ends.into_iter().enumerate() {
            for (q, other) in spring.ends.into_iter().enumerate() {
                let sign = if p == q { 1.0 } else { -1.0 };
                for i in 0..dimensions {
                    for j in 0..dimensions {
                        let at = (index[3 * end.index() + i], index[3 * other.index() + j]);
                        let (Some(row), Some(column)) = at else { continue };
                        let same = if i == j { across } else { 0.0 };
                        let weight = sign * coordinates[row].weight * coordinates[column].weight;
                        let axial = along[i] * along[j];
                        let stiffness = weight * ((spring.stiffness - across) * axial + same);
                        add(row, column, stiffness, weight * spring.damping * axial);
                    }
                }
            }
        }
    }
}

/// What rest lengths add to M^(−½)KM^(−½) that follow the pose, as those of a strand that bulges: a spring then resists by
/// k(dl − dL), and what drives L need not be at its ends.
pub(super) fn following(
    body: &BodyParts<'_>,
    time: f64,
    dimensions: usize,
    coordinates: &[Coordinate],
) -> Option<Mat<f64>> {
    body.strand.filter(|strand| strand.bulge())?;
    let index = index(body, coordinates);
    let shortest = body.springs.iter().map(|spring| spring.rest_length).fold(f64::INFINITY, f64::min);
    let by = MOVE * shortest;
    let mut matrix = Mat::zeros(coordinates.len(), coordinates.len());
    for (column, coordinate) in coordinates.iter().enumerate() {
        let [ahead, behind] = [by, -by].map(|by| {
            let particles = moved(body.particles, *coordinate, by);
            rest_lengths(&BodyParts { particles: &particles, ..*body }, time)
        });
        for (spring, (ahead, behind)) in body.springs.iter().zip(ahead.into_iter().zip(behind)) {
            let pull = spring.stiffness * (ahead - behind) / (2.0 * by) * coordinate.weight;
            let [a, b] = spring.ends.map(|end| body.particles.position(end).unwrap_or(DVec3::ZERO));
            let along = (b - a).normalize_or_zero().to_array();
            for (end, sign) in spring.ends.into_iter().zip([1.0, -1.0]) {
                for (axis, along) in along.into_iter().enumerate().take(dimensions) {
                    if let Some(row) = index[3 * end.index() + axis] {
                        matrix[(row, column)] += sign * coordinates[row].weight * along * pull;
                    }
                }
            }
        }
    }
    Some(matrix)
}

/// The particles with one of them moved along an axis.
fn moved(particles: &Particles, at: Coordinate, by: f64) -> Particles {
    let mut particles = particles.clone();
    let id = ParticleId(at.particle as u32);
    if let Some(particle) = particles.get(id) {
        let mut position = particle.position;
        position[at.axis] += by;
        // A place near that of a particle is as good as that.
        let _ = particles.set(id, Particle { position, ..particle });
    }
    particles
}
