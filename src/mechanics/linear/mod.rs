//! A body near its pose: x'' = −Kx − Cx', in coordinates weighted by the square roots of the masses.
//!
//! Of a large body the stiffest direction alone is found, by a Krylov method on the sparse K. Where damping goes with stiffness that direction decides
//! the limits of all methods with a formula: they fall with κ where γ goes with it.

mod eigenvalues;
mod matrices;
mod roots;
mod search;

use faer::{
    Col, Mat, Par, Side,
    dyn_stack::{MemBuffer, MemStack},
    matrix_free::eigen::{partial_self_adjoint_eigen, partial_self_adjoint_eigen_scratch},
    sparse::SparseColMat,
};

use crate::body::{MassDamping, Strand};

use super::{BodyParts, Damping, rest_lengths, stability_bound};

use matrices::{coordinates, following, matrices};

pub(crate) use eigenvalues::eigenvalues;
pub(crate) use matrices::Coordinate;
pub(crate) use roots::polynomial_limit;
pub(crate) use search::{MOST, bisect, first_unstable};

/// A direction in which nothing resists counts as none below this part of the stiffest.
const NOTHING: f64 = 1e-10;
/// The eigenvalues of bodies of more coordinates take longer than a third of a second.
pub(crate) const MOST_COORDINATES: usize = 400;
/// The stiffest direction is found to this part of its stiffness.
const PRECISION: f64 = 1e-7;

/// Whether springs resist across their lines, by k(1 − L/l), as stretched ones do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Across {
    /// As they do.
    Resisted,
    /// Along their lines alone.
    Ignored,
}

/// The linearised body, without friction, contact and gravity.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// How many axes its particles can move along: one for a body on an axis that no gravity and no ground moves off.
    pub(crate) dimensions: usize,
    /// The coordinates that can change.
    pub(crate) coordinates: Vec<Coordinate>,
    /// Columns: the directions that springs resist or damp, orthonormal; of a large body the stiffest alone.
    pub(crate) resisted: Mat<f64>,
    /// K in all directions, without what rest lengths do that follow the pose.
    pub(crate) springs: SparseColMat<usize, f64>,
    /// The direction of length 1 that this resists most.
    pub(crate) stiffest: Vec<f64>,
    /// Columns: the others; of a large body one of them, if there is any for sure.
    pub(crate) free: Mat<f64>,
    /// K in the resisted directions. Not symmetric where rest lengths follow the pose, as those of a strand that bulges.
    pub(crate) stiffness: Mat<f64>,
    /// C of the springs in the resisted directions.
    pub(crate) damping: Mat<f64>,
    /// Damping in proportion to mass, in all directions.
    pub(crate) mass_damping: Option<MassDamping>,
    /// The fastest of all rates, from above: no root of the body is larger. 0 where nothing moves anything.
    pub(crate) rate: f64,
    /// Whether K is symmetric.
    pub(crate) symmetric: bool,
    /// Whether these directions decide how large a step may be: not those of a large body that is damped otherwise than in proportion to its stiffness.
    pub(crate) decisive: bool,
}

impl Linear {
    /// Linearises the body in its present pose with its muscles at rest; nothing where its eigenvalues cannot be found.
    pub(crate) fn of(body: &BodyParts<'_>) -> Option<Self> {
        let (dimensions, body) = (dimensions(body), body.bare());
        Self::full(&body, dimensions, 0.0, Across::Resisted).or_else(|| Self::stiffest(&body, dimensions))
    }

    /// Linearises a body in its present pose, with its rest lengths as at `time`; nothing for one with too many coordinates
    /// for all of its eigenvalues to be found.
    pub(crate) fn of_few(body: &BodyParts<'_>, time: f64, across: Across) -> Option<Self> {
        Self::full(body, dimensions(body), time, across)
    }

    fn full(body: &BodyParts<'_>, dimensions: usize, time: f64, across: Across) -> Option<Self> {
        let coordinates = coordinates(body, dimensions);
        if coordinates.len() > MOST_COORDINATES {
            return None;
        }
        let (springs, damping) = matrices(body, &rest_lengths(body, time), dimensions, &coordinates, across)?;
        // Of what is not finite nothing can be found.
        if springs.val().iter().chain(damping.val()).any(|value| !value.is_finite()) {
            return None;
        }
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
        let following = following(body, time, dimensions, &coordinates);
        let norm =
            |matrix: &Mat<f64>| spectrum(matrix).map(|values| values.into_iter().map(f64::abs).fold(0.0, f64::max));
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
            dimensions,
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
    fn stiffest(body: &BodyParts<'_>, dimensions: usize) -> Option<Self> {
        let coordinates = coordinates(body, dimensions);
        if body.strand.is_some_and(Strand::bulge) {
            return None;
        }
        let count = coordinates.len();
        let (springs, damping) = matrices(body, &rest_lengths(body, 0.0), dimensions, &coordinates, Across::Resisted)?;
        let direction = stiffest_direction(&springs)?;
        let along = |matrix: &SparseColMat<usize, f64>| direction.transpose() * (matrix * &direction);
        let (stiffness, damping) = (along(&springs), along(&damping));
        let none_is_pinned = !body.particles.pinned().contains(&true);
        let drifting = usize::from(none_is_pinned);
        let mass: f64 = body.particles.masses().iter().sum();
        Some(Self {
            dimensions,
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
    pub(crate) fn is_stiff(&self) -> bool {
        !is_zero(&self.springs)
    }

    /// A time in which nothing much happens but a step of `dt`: speeds in it compare with positions.
    pub(crate) fn time(&self, dt: f64) -> f64 {
        dt.max(1.0 / self.rate)
    }

    /// Twice the energy of a disturbance, v·v + x·Kx: where each coordinate is, and then how fast, in [`Self::time`].
    pub(crate) fn energy(&self, disturbance: &[f64], dt: f64) -> f64 {
        let (positions, velocities) = disturbance.split_at(self.coordinates.len());
        let positions = Col::from_iter(positions.iter().copied());
        let elastic = positions.transpose() * (&self.springs * &positions);
        let kinetic: f64 = velocities.iter().map(|v| v * v).sum();
        elastic + kinetic / self.time(dt).powi(2)
    }

    /// The rate c of damping in proportion to mass with steps of `dt`.
    pub(crate) fn mass_rate(&self, dt: f64) -> f64 {
        self.mass_damping.map_or(0.0, |damping| damping.rate_at(dt))
    }
}

/// How many coordinates of a body can change.
pub(crate) fn coordinate_count(body: &BodyParts<'_>) -> usize {
    dimensions(body) * body.particles.pinned().iter().filter(|pinned| !**pinned).count()
}

/// How many axes its particles can move along.
fn dimensions(body: &BodyParts<'_>) -> usize {
    if body.on_axis() { 1 } else { 3 }
}

/// Whether nothing in a matrix is anything but zero.
fn is_zero(matrix: &SparseColMat<usize, f64>) -> bool {
    matrix.val().iter().all(|value| *value == 0.0)
}

/// The eigenvalues of a symmetric matrix, in rising order.
pub(crate) fn spectrum(matrix: &Mat<f64>) -> Option<Vec<f64>> {
    if matrix.nrows() == 0 { Some(Vec::new()) } else { matrix.self_adjoint_eigenvalues(Side::Lower).ok() }
}

fn largest(matrix: &Mat<f64>) -> f64 {
    matrix.col_iter().flat_map(|column| column.iter().copied()).map(f64::abs).fold(0.0, f64::max)
}

fn share(value: f64, largest: f64) -> f64 {
    if largest > 0.0 { value / largest } else { 0.0 }
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
