//! The linear systems of Newton's iteration: one block a spring, in the pattern of the springs.

use faer::{
    Col, Side,
    prelude::Solve,
    sparse::{
        SparseColMatRef, SymbolicSparseColMat,
        linalg::solvers::{Llt, SymbolicLlt},
    },
};

use crate::mechanics::{
    Model, State,
    forces::direction,
    friction::{Frame, dot},
};

use super::{Diverged, Scheme, project, stuck_masses};

/// Bodies of more unknowns than this are solved by conjugate gradients.
const MOST_FACTORISED: usize = 48;

/// The matrix M + dt·(b·C + a·dt·K).
#[derive(Clone, Debug)]
pub(super) struct Linear<const D: usize> {
    /// The block of each mass.
    diagonal: Vec<[[f64; D]; D]>,
    /// The block of each spring, which is −(its stiffness and damping).
    springs: Vec<[[f64; D]; D]>,
    factor: Option<Factor>,
    gradient: Gradient<D>,
}

/// A factorisation whose pattern is known.
#[derive(Clone, Debug)]
struct Factor {
    symbolic: SymbolicLlt<usize>,
    pattern: SymbolicSparseColMat<usize>,
    values: Vec<f64>,
    /// Where each entry of the blocks goes: those of masses, then those of springs.
    places: Vec<usize>,
    solution: Col<f64>,
}

/// Scratch of the conjugate gradients.
#[derive(Clone, Debug, Default)]
struct Gradient<const D: usize> {
    residual: Vec<[f64; D]>,
    direction: Vec<[f64; D]>,
    image: Vec<[f64; D]>,
}

impl<const D: usize> Linear<D> {
    pub(super) fn new(model: &Model<f64, D>) -> Self {
        let masses = model.inverse_mass.len();
        Self {
            diagonal: vec![[[0.0; D]; D]; masses],
            springs: vec![[[0.0; D]; D]; model.springs.len()],
            // Without memory for a factor there are still conjugate gradients.
            factor: if masses * D <= MOST_FACTORISED { Factor::new(model) } else { None },
            gradient: Gradient {
                residual: vec![[0.0; D]; masses],
                direction: vec![[0.0; D]; masses],
                image: vec![[0.0; D]; masses],
            },
        }
    }

    /// Sets up the matrix at a stage.
    pub(super) fn assemble(
        &mut self,
        scheme: &Scheme,
        model: &Model<f64, D>,
        stage: &State<f64, D>,
        frames: &[Frame<f64, D>],
        stuck: &[bool],
    ) {
        let dt = model.dt;
        let (of_damping, of_stiffness) = (dt * scheme.velocity, dt * dt * scheme.position_new);
        let thickness = model.damping.map_or(0.0, |damping| damping.rate);
        for (block, &inverse_mass) in self.diagonal.iter_mut().zip(&model.inverse_mass) {
            let mass = if inverse_mass > 0.0 { (1.0 + of_damping * thickness) / inverse_mass } else { 1.0 };
            *block = core::array::from_fn(|row| core::array::from_fn(|column| if row == column { mass } else { 0.0 }));
        }
        for ((block, spring), &rest) in self.springs.iter_mut().zip(&model.springs).zip(&model.rest) {
            let [a, b] = spring.ends.map(|end| end as usize);
            let (length, along) = direction(stage.position[a], stage.position[b]);
            let across = if length > rest { spring.stiffness * (1.0 - rest / length) } else { 0.0 };
            let line = of_damping * spring.damping + of_stiffness * (spring.stiffness - across);
            *block = core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    let same = if row == column { of_stiffness * across } else { 0.0 };
                    line * along[row] * along[column] + same
                })
            });
            for end in [a, b].into_iter().filter(|end| model.inverse_mass[*end] > 0.0) {
                for (sum, row) in self.diagonal[end].iter_mut().zip(&*block) {
                    for (sum, value) in sum.iter_mut().zip(row) {
                        *sum += value;
                    }
                }
            }
        }
        if let Some(pull) = &model.pull {
            let mass = pull.particle;
            let slope = pull.slope(stage.position[mass], stage.velocity[mass], [of_damping, of_stiffness]);
            for (sum, value) in self.diagonal[mass].as_flattened_mut().iter_mut().zip(slope.as_flattened()) {
                *sum += value;
            }
        }
        if let Some(friction) = model.friction {
            for (row, frame) in model.spine.iter().zip(frames) {
                let mass = row.particle as usize;
                if model.inverse_mass[mass] == 0.0 {
                    continue;
                }
                let weight = of_damping * frame.touches / model.inverse_mass[mass];
                // With the ratchet nothing slides back, however rounding has it.
                let slides = if friction.ratchet || dot(stage.velocity[mass], frame.forward) >= 0.0 {
                    friction.drag
                } else {
                    0.0
                };
                add(&mut self.diagonal[mass], frame.forward, weight * slides);
                let grip = model.grip_at(&friction, stage.position[mass]).rate;
                add(&mut self.diagonal[mass], frame.side, weight * grip);
                if friction.has_isotropic {
                    for (axis, row) in self.diagonal[mass].iter_mut().enumerate() {
                        let mut along = [0.0; D];
                        along[axis] = 1.0;
                        let sliding = model.sliding(frame, along);
                        for (value, part) in row.iter_mut().zip(sliding) {
                            *value += weight * friction.isotropic.rate * part;
                        }
                    }
                }
            }
        }
        if let Some(factor) = &mut self.factor {
            factor.fill(model, frames, stuck, &self.diagonal, &self.springs);
        }
    }

    /// Solves for the vector, in place, within what stuck and pinned masses can follow. Conjugate gradients leave so much of it.
    pub(super) fn solve(
        &mut self,
        model: &Model<f64, D>,
        frames: &[Frame<f64, D>],
        stuck: &[bool],
        vector: &mut [[f64; D]],
        left: f64,
    ) -> Result<(), Diverged> {
        if let Some(factor) = &mut self.factor {
            factor.solve(vector)?;
            project(model, frames, stuck, vector);
            return Ok(());
        }
        self.conjugate_gradients(model, frames, stuck, vector, left)
    }

    /// image = matrix · vector
    pub(super) fn image(&self, model: &Model<f64, D>, vector: &[[f64; D]], image: &mut [[f64; D]]) {
        multiply(model, &self.diagonal, &self.springs, vector, image);
    }

    fn conjugate_gradients(
        &mut self,
        model: &Model<f64, D>,
        frames: &[Frame<f64, D>],
        stuck: &[bool],
        vector: &mut [[f64; D]],
        left: f64,
    ) -> Result<(), Diverged> {
        let Self { diagonal, springs, gradient: Gradient { residual, direction, image }, .. } = self;
        residual.copy_from_slice(vector);
        vector.fill([0.0; D]);
        // Jacobi's preconditioner.
        let eased = |mass: usize, r: [f64; D]| -> [f64; D] {
            core::array::from_fn(|axis| r[axis] / diagonal[mass][axis][axis])
        };
        for (mass, (d, r)) in direction.iter_mut().zip(&*residual).enumerate() {
            *d = eased(mass, *r);
        }
        project(model, frames, stuck, direction);
        let product = |a: &[[f64; D]], b: &[[f64; D]]| a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum::<f64>();
        let mut size = product(residual, direction);
        let enough = size * left * left;
        for _ in 0..10 * D * vector.len() + 100 {
            if size <= enough {
                return Ok(());
            }
            multiply(model, diagonal, springs, direction, image);
            project(model, frames, stuck, image);
            let step = size / product(direction, image);
            for mass in 0..vector.len() {
                for axis in 0..D {
                    vector[mass][axis] += step * direction[mass][axis];
                    residual[mass][axis] -= step * image[mass][axis];
                }
            }
            for (mass, (row, r)) in image.iter_mut().zip(&*residual).enumerate() {
                *row = eased(mass, *r);
            }
            project(model, frames, stuck, image);
            let next = product(residual, image);
            let keep = next / size;
            size = next;
            for (d, eased) in direction.iter_mut().zip(&*image) {
                for axis in 0..D {
                    d[axis] = eased[axis] + keep * d[axis];
                }
            }
        }
        Err(Diverged)
    }
}

impl Factor {
    fn new<const D: usize>(model: &Model<f64, D>) -> Option<Self> {
        let masses = model.inverse_mass.len();
        let blocks = (0..masses).map(|mass| (mass, mass)).chain(model.springs.iter().map(|spring| {
            let [a, b] = spring.ends.map(|end| end as usize);
            (a.max(b), a.min(b))
        }));
        let entries: Vec<_> = blocks
            .flat_map(|(row, column)| (0..D * D).map(move |entry| (row * D + entry / D, column * D + entry % D)))
            .collect();
        let mut sorted: Vec<_> =
            entries.iter().filter(|(row, column)| row >= column).map(|(row, column)| (*column, *row)).collect();
        sorted.sort_unstable();
        sorted.dedup();
        let mut starts = vec![0; masses * D + 1];
        for (column, _) in &sorted {
            starts[column + 1] += 1;
        }
        for column in 0..masses * D {
            starts[column + 1] += starts[column];
        }
        let rows = sorted.iter().map(|(_, row)| *row).collect();
        let pattern = SymbolicSparseColMat::new_checked(masses * D, masses * D, starts, None, rows);
        let symbolic = SymbolicLlt::try_new(pattern.as_ref(), Side::Lower).ok()?;
        // Entries above the diagonal are those below, mirrored, and have no place.
        let places =
            entries.iter().map(|&(row, column)| sorted.binary_search(&(column, row)).unwrap_or(usize::MAX)).collect();
        Some(Self {
            symbolic,
            values: vec![0.0; pattern.compute_nnz()],
            pattern,
            places,
            solution: Col::zeros(masses * D),
        })
    }

    /// Writes the blocks into the matrix; stuck and pinned masses get rows of their own.
    fn fill<const D: usize>(
        &mut self,
        model: &Model<f64, D>,
        frames: &[Frame<f64, D>],
        stuck: &[bool],
        diagonal: &[[[f64; D]; D]],
        springs: &[[[f64; D]; D]],
    ) {
        let mut held: Vec<Option<[f64; D]>> = vec![None; diagonal.len()];
        for (mass, frame) in stuck_masses(model, frames, stuck) {
            held[mass] = Some(frame.spine);
        }
        let free = |mass: usize, v: [f64; D]| match held[mass] {
            Some(along) => {
                let amount = dot(v, along);
                core::array::from_fn(|axis| v[axis] - amount * along[axis])
            }
            None => v,
        };
        // P B P' with the projections of the masses on both sides.
        let confined = |left: usize, right: usize, block: [[f64; D]; D]| -> [[f64; D]; D] {
            let rows = block.map(|row| free(right, row));
            let columns: [[f64; D]; D] =
                core::array::from_fn(|column| free(left, core::array::from_fn(|row| rows[row][column])));
            core::array::from_fn(|row| core::array::from_fn(|column| columns[column][row]))
        };
        self.values.fill(0.0);
        let mut places = self.places.iter();
        let mut put = |block: [[f64; D]; D]| {
            for entry in 0..D * D {
                if let Some(value) = places.next().and_then(|&place| self.values.get_mut(place)) {
                    *value += block[entry / D][entry % D];
                }
            }
        };
        for (mass, &block) in diagonal.iter().enumerate() {
            let mut block = confined(mass, mass, block);
            if let Some(along) = held[mass] {
                add(&mut block, along, 1.0);
            }
            put(block);
        }
        for (block, spring) in springs.iter().zip(&model.springs) {
            let [a, b] = spring.ends.map(|end| end as usize);
            let moves = model.inverse_mass[a] > 0.0 && model.inverse_mass[b] > 0.0;
            let block = block.map(|row| row.map(|value| if moves { -value } else { 0.0 }));
            put(confined(a.max(b), a.min(b), block));
        }
    }

    fn solve<const D: usize>(&mut self, vector: &mut [[f64; D]]) -> Result<(), Diverged> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &self.values[..]);
        let factor = Llt::try_new_with_symbolic(self.symbolic.clone(), matrix, Side::Lower).map_err(|_| Diverged)?;
        for (index, value) in vector.iter().flatten().enumerate() {
            self.solution[index] = *value;
        }
        factor.solve_in_place(self.solution.as_mut());
        for (index, value) in vector.iter_mut().flatten().enumerate() {
            *value = self.solution[index];
        }
        Ok(())
    }
}

/// image = matrix · vector
fn multiply<const D: usize>(
    model: &Model<f64, D>,
    diagonal: &[[[f64; D]; D]],
    springs: &[[[f64; D]; D]],
    vector: &[[f64; D]],
    image: &mut [[f64; D]],
) {
    for ((row, block), v) in image.iter_mut().zip(diagonal).zip(vector) {
        *row = core::array::from_fn(|axis| dot(block[axis], *v));
    }
    for (block, spring) in springs.iter().zip(&model.springs) {
        let [a, b] = spring.ends.map(|end| end as usize);
        for axis in 0..D {
            image[a][axis] -= dot(block[axis], vector[b]);
            image[b][axis] -= dot(block[axis], vector[a]);
        }
    }
}

/// block += weight · along · alongᵀ
fn add<const D: usize>(block: &mut [[f64; D]; D], along: [f64; D], weight: f64) {
    for row in 0..D {
        for column in 0..D {
            block[row][column] += weight * along[row] * along[column];
        }
    }
}
