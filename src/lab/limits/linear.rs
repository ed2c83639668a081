//! A body near its pose: x'' = −Kx − Cx', in coordinates weighted by the square roots of the masses.

use bevy::math::DVec3;
use faer::{Mat, Side};

use crate::{body::MassDamping, mechanics::BodyParts};

/// A direction in which nothing resists counts as none below this part of the stiffest.
const NOTHING: f64 = 1e-10;

/// One coordinate that can change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate {
    pub(super) particle: usize,
    pub(super) axis: usize,
    /// 1/√m.
    pub(super) weight: f64,
}

/// The linearised body, without friction, contact and gravity and with its muscles at rest.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    /// The coordinates that can change.
    pub(super) coordinates: Vec<Coordinate>,
    /// Columns: the directions that springs resist or damp, orthonormal.
    pub(super) resisted: Mat<f64>,
    /// Columns: the others.
    pub(super) free: Mat<f64>,
    /// K in the resisted directions.
    pub(super) stiffness: Mat<f64>,
    /// C of the springs in the resisted directions.
    pub(super) damping: Mat<f64>,
    /// Damping in proportion to mass, in all directions.
    pub(super) mass_damping: Option<MassDamping>,
    /// The fastest of all rates, from above: no root of the body is larger. 0 where nothing moves anything.
    pub(super) rate: f64,
}

/// What is left of a body without friction, contact and gravity and with its muscles at rest.
pub(super) fn bare<'a>(body: &BodyParts<'a>) -> BodyParts<'a> {
    BodyParts { muscles: None, waves: None, friction: None, coulomb: None, gravity: None, ground: None, ..*body }
}

impl Linear {
    /// Linearises the body in its present pose; nothing where its eigenvalues cannot be found.
    pub(super) fn of(body: &BodyParts<'_>) -> Option<Self> {
        let dimensions = if bare(body).on_axis() { 1 } else { 3 };
        let coordinates = coordinates(body, dimensions);
        let (stiffness, damping) = matrices(body, dimensions, &coordinates);
        let (hardest, most) = (largest(&stiffness), largest(&damping));
        let either = Mat::from_fn(coordinates.len(), coordinates.len(), |i, j| {
            share(stiffness[(i, j)], hardest) + share(damping[(i, j)], most)
        });
        let found = either.self_adjoint_eigen(Side::Lower).ok()?;
        let values: Vec<f64> = found.S().column_vector().iter().copied().collect();
        let columns = |keep: &dyn Fn(f64) -> bool| {
            let kept: Vec<_> = (0..values.len()).filter(|&i| keep(values[i].abs())).collect();
            Mat::from_fn(values.len(), kept.len(), |i, j| found.U()[(i, kept[j])])
        };
        let resisted = columns(&|value| value > NOTHING);
        let free = columns(&|value| value <= NOTHING);
        let within = |matrix: &Mat<f64>| resisted.transpose() * matrix * &resisted;
        let (stiffness, damping) = (within(&stiffness), within(&damping));
        let norm = |matrix: &Mat<f64>| spectrum(matrix).map(|values| values.into_iter().fold(0.0, f64::max));
        let by_mass = body.mass_damping.map_or(0.0, |damping| match damping {
            MassDamping::Rate(rate) => rate,
            MassDamping::PerStep(_) => 0.0,
        });
        let rate = norm(&stiffness)?.sqrt().max(norm(&damping)? + by_mass);
        Some(Self { coordinates, resisted, free, stiffness, damping, mass_damping: body.mass_damping, rate })
    }

    /// The rate c of damping in proportion to mass with steps of `dt`.
    pub(super) fn mass_rate(&self, dt: f64) -> f64 {
        self.mass_damping.map_or(0.0, |damping| damping.rate_at(dt))
    }
}

/// The eigenvalues of a symmetric matrix, in rising order.
pub(super) fn spectrum(matrix: &Mat<f64>) -> Option<Vec<f64>> {
    if matrix.nrows() == 0 { Some(Vec::new()) } else { matrix.self_adjoint_eigenvalues(Side::Lower).ok() }
}

fn largest(matrix: &Mat<f64>) -> f64 {
    matrix.col_iter().flat_map(|column| column.iter().copied()).map(f64::abs).fold(0.0, f64::max)
}

fn share(value: f64, largest: f64) -> f64 {
    if largest > 0.0 { value / largest } else { 0.0 }
}

fn coordinates(body: &BodyParts<'_>, dimensions: usize) -> Vec<Coordinate> {
    let particles = body.particles.masses().iter().zip(body.particles.pinned()).enumerate();
    particles
        .filter(|(_, (_, pinned))| !**pinned)
        .flat_map(|(particle, (mass, _))| {
            (0..dimensions).map(move |axis| Coordinate { particle, axis, weight: 1.0 / mass.sqrt() })
        })
        .collect()
}

/// M^(−½)KM^(−½) and M^(−½)CM^(−½). A spring of length l along n resists with k along n, and across with k(1 − L/l).
fn matrices(body: &BodyParts<'_>, dimensions: usize, coordinates: &[Coordinate]) -> (Mat<f64>, Mat<f64>) {
    let count = coordinates.len();
    let mut index = vec![None; 3 * body.particles.len()];
    for (i, coordinate) in coordinates.iter().enumerate() {
        index[3 * coordinate.particle + coordinate.axis] = Some(i);
    }
    let (mut stiffness, mut damping) = (Mat::zeros(count, count), Mat::zeros(count, count));
    for spring in body.springs.iter() {
        let [a, b] = spring.ends.map(|end| body.particles.position(end).unwrap_or(DVec3::ZERO));
        let length = a.distance(b);
        if length == 0.0 {
            continue;
        }
        let along = ((b - a) / length).to_array();
        let across = if dimensions == 1 { 0.0 } else { spring.stiffness * (1.0 - spring.rest_length / length) };
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
                        stiffness[(row, column)] += weight * ((spring.stiffness - across) * axial + same);
                        damping[(row, column)] += weight * spring.damping * axial;
                    }
                }
            }
        }
    }
    (stiffness, damping)
}
