//! A body near its pose: x'' = −Kx − Cx', in coordinates weighted by the square roots of the masses.
//!
//! Of a large body the stiffest direction alone is found, by a Krylov method on the sparse K. Where damping goes with stiffness that direction decides
//! the limits of all methods with a formula: they fall with κ where γ goes with it.

use bevy::math::DVec3;
use faer::{
    Col, Mat, Par, Side,
    dyn_stack::{MemBuffer, MemStack},
    matrix_free::eigen::{partial_self_adjoint_eigen, partial_self_adjoint_eigen_scratch},
    sparse::{SparseColMat, Triplet},
};

use crate::{
    body::{MassDamping, Particle, ParticleId, Particles, Strand},
    mechanics::{BodyParts, Damping, rest_lengths, stability_bound},
};

/// A direction in which nothing resists counts as none below this part of the stiffest.
const NOTHING: f64 = 1e-10;
/// The eigenvalues of bodies of more coordinates take minutes.
const MOST_COORDINATES: usize = 400;
/// The stiffest direction is found to this part of its stiffness.
const PRECISION: f64 = 1e-7;
/// By how much a particle is moved, in the shortest rest length, to see how rest lengths follow it.
const MOVE: f64 = 1e-5;

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
    /// Columns: the directions that springs resist or damp, orthonormal; of a large body the stiffest alone.
    pub(super) resisted: Mat<f64>,
    /// K in all directions, without what rest lengths do that follow the pose.
    pub(super) springs: SparseColMat<usize, f64>,
    /// The direction of length 1 that this resists most.
    pub(super) stiffest: Vec<f64>,
    /// Columns: the others; of a large body one of them, if there is any for sure.
    pub(super) free: Mat<f64>,
    /// K in the resisted directions. Not symmetric where rest lengths follow the pose, as those of a strand that bulges.
    pub(super) stiffness: Mat<f64>,
    /// C of the springs in the resisted directions.
    pub(super) damping: Mat<f64>,
    /// Damping in proportion to mass, in all directions.
    pub(super) mass_damping: Option<MassDamping>,
    /// The fastest of all rates, from above: no root of the body is larger. 0 where nothing moves anything.
    pub(super) rate: f64,
    /// Whether K is symmetric.
    pub(super) symmetric: bool,
    /// Whether these directions decide how large a step may be: not those of a large body that is damped otherwise than in proportion to its stiffness.
    pub(super) decisive: bool,
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
        if coordinates.len() > MOST_COORDINATES {
            return Self::stiffest(body, dimensions, coordinates);
        }
        let (springs, damping) = matrices(body, dimensions, &coordinates)?;
        let (stiffness, damping) = (springs.to_dense(), damping.to_dense());
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
        let following = following(body, dimensions, &coordinates);
        let norm = |matrix: &Mat<f64>| spectrum(matrix).map(|values| values.into_iter().fold(0.0, f64::max));
        let (stiffness, damping) = (within(&stiffness), within(&damping));
        let stiffest = match stiffness.ncols() {
            0 => Col::zeros(coordinates.len()),
            last => &resisted * stiffness.self_adjoint_eigen(Side::Lower).ok()?.U().col(last - 1),
        };
        let followed = following.as_ref().map_or(0.0, Mat::norm_l2);
        let rate = (norm(&stiffness)? + followed).sqrt().max(norm(&damping)? + by_mass(body));
        let stiffness =
            following.as_ref().map_or_else(|| stiffness.clone(), |following| &stiffness + within(following));
        let (symmetric, mass_damping) = (following.is_none(), body.mass_damping);
        Some(Self {
            coordinates,
            resisted,
            springs,
            stiffest: stiffest.iter().copied().collect(),
            free,
            stiffness,
            damping,
            mass_damping,
            rate,
            symmetric,
            decisive: true,
        })
    }

    /// The stiffest direction of a large body; nothing for one whose rest lengths follow its pose.
    fn stiffest(body: &BodyParts<'_>, dimensions: usize, coordinates: Vec<Coordinate>) -> Option<Self> {
        if body.strand.is_some_and(Strand::bulge) {
            return None;
        }
        let count = coordinates.len();
        let (springs, damping) = matrices(body, dimensions, &coordinates)?;
        let direction = stiffest_direction(&springs)?;
        let along = |matrix: &SparseColMat<usize, f64>| direction.transpose() * (matrix * &direction);
        let (stiffness, damping) = (along(&springs), along(&damping));
        let none_is_pinned = !body.particles.pinned().contains(&true);
        let drifting = usize::from(none_is_pinned);
        let mass: f64 = body.particles.masses().iter().sum();
        Some(Self {
            resisted: Mat::from_fn(count, 1, |i, _| direction[i]),
            springs,
            stiffest: direction.iter().copied().collect(),
            // The whole body along x.
            free: Mat::from_fn(count, drifting, |i, _| match coordinates[i] {
                Coordinate { axis: 0, weight, .. } => 1.0 / (weight * mass.sqrt()),
                _ => 0.0,
            }),
            stiffness: Mat::from_fn(1, 1, |_, _| stiffness),
            damping: Mat::from_fn(1, 1, |_, _| damping),
            mass_damping: body.mass_damping,
            rate: stiffness.sqrt().max(damping + by_mass(body)),
            symmetric: true,
            decisive: stability_bound(body, 0.0).damping == Damping::Proportional,
            coordinates,
        })
    }

    /// Whether a spring resists anything.
    pub(super) fn is_stiff(&self) -> bool {
        !is_zero(&self.springs)
    }

    /// A time in which nothing much happens but a step of `dt`: speeds in it compare with positions.
    pub(super) fn time(&self, dt: f64) -> f64 {
        dt.max(1.0 / self.rate)
    }

    /// Twice the energy of a disturbance, v·v + x·Kx: where each coordinate is, and then how fast, in [`Self::time`].
    pub(super) fn energy(&self, disturbance: &[f64], dt: f64) -> f64 {
        let (positions, velocities) = disturbance.split_at(self.coordinates.len());
        let positions = Col::from_iter(positions.iter().copied());
        let elastic = positions.transpose() * (&self.springs * &positions);
        let kinetic: f64 = velocities.iter().map(|v| v * v).sum();
        elastic + kinetic / self.time(dt).powi(2)
    }

    /// The rate c of damping in proportion to mass with steps of `dt`.
    pub(super) fn mass_rate(&self, dt: f64) -> f64 {
        self.mass_damping.map_or(0.0, |damping| damping.rate_at(dt))
    }
}

/// Whether nothing in a matrix is anything but zero.
fn is_zero(matrix: &SparseColMat<usize, f64>) -> bool {
    matrix.val().iter().all(|value| *value == 0.0)
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

/// The rate of damping in proportion to mass, where that does not depend on the step.
fn by_mass(body: &BodyParts<'_>) -> f64 {
    match body.mass_damping {
        Some(MassDamping::Rate(rate)) => rate,
        _ => 0.0,
    }
}

/// The direction of length 1 that a symmetric matrix stretches most; zero for a matrix that is.
fn stiffest_direction(matrix: &SparseColMat<usize, f64>) -> Option<Col<f64>> {
    let count = matrix.ncols();
    if is_zero(matrix) {
        return Some(Col::zeros(count));
    }
    // Of no regularity, so that it has a part of the stiffest direction.
    let start = Col::from_fn(count, |i| ((i * 37 + i / 3 * 53) % 101) as f64 / 50.0 - 1.01);
    let start = &start / start.norm_l2();
    let (mut directions, mut values) = (Mat::zeros(count, 1), [0.0]);
    let settings = Default::default();
    let mut memory = MemBuffer::try_new(partial_self_adjoint_eigen_scratch(matrix, 1, Par::Seq, settings)).ok()?;
    let stack = MemStack::new(&mut memory);
    let found = partial_self_adjoint_eigen(
        directions.as_mut(),
        &mut values,
        matrix,
        start.as_ref(),
        PRECISION,
        Par::Seq,
        stack,
        settings,
    );
    (found.n_converged_eigen == 1).then(|| directions.col(0).to_owned())
}

/// M^(−½)KM^(−½) and M^(−½)CM^(−½), without what rest lengths do that follow the pose.
fn matrices(
    body: &BodyParts<'_>,
    dimensions: usize,
    coordinates: &[Coordinate],
) -> Option<(SparseColMat<usize, f64>, SparseColMat<usize, f64>)> {
    let (mut stiffness, mut damping) = (Vec::new(), Vec::new());
    entries(body, dimensions, coordinates, |row, col, k, c| {
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
    dimensions: usize,
    coordinates: &[Coordinate],
    mut add: impl FnMut(usize, usize, f64, f64),
) {
    let index = index(body, coordinates);
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
fn following(body: &BodyParts<'_>, dimensions: usize, coordinates: &[Coordinate]) -> Option<Mat<f64>> {
    body.strand.filter(|strand| strand.bulge())?;
    let (index, bare) = (index(body, coordinates), bare(body));
    let shortest = body.springs.iter().map(|spring| spring.rest_length).fold(f64::INFINITY, f64::min);
    let by = MOVE * shortest;
    let mut matrix = Mat::zeros(coordinates.len(), coordinates.len());
    for (column, coordinate) in coordinates.iter().enumerate() {
        let [ahead, behind] = [by, -by].map(|by| {
            let particles = moved(body.particles, *coordinate, by);
            rest_lengths(&BodyParts { particles: &particles, ..bare }, 0.0)
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
