//! The masses of a body.

use bevy::{ecs::prelude::*, math::DVec3, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, Requirement, check, error::check_inverse};

/// One of a body's particles, counted from 0 in the order of its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub struct ParticleId(pub u32);

impl ParticleId {
    /// The id as an index into arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One particle as plain data: what [`Particles`] is built from and reads out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Where it is: x forward, y up, z right, in lengths of the scene.
    pub position: DVec3,
    /// Its velocity, in lengths a unit of time.
    pub velocity: DVec3,
    /// Its mass, above zero and large enough for its inverse to be finite; of a pinned particle it may be zero.
    pub mass: f64,
    /// A pinned particle never moves, whatever pulls at it; its inverse mass counts as zero.
    pub pinned: bool,
}

impl Particle {
    /// A particle of mass 1 at rest, free to move.
    pub fn at(position: DVec3) -> Self {
        Self { position, velocity: DVec3::ZERO, mass: 1.0, pinned: false }
    }

    fn check(&self, index: usize) -> Result<(), BodyError> {
        for (field, vector) in [("position", self.position), ("velocity", self.velocity)] {
            for value in vector.to_array() {
                check(value, Requirement::Finite, || format!("particles[{index}].{field}"))?;
            }
        }
        // A pinned particle moves as little without a mass.
        let requirement = if self.pinned { Requirement::NonNegative } else { Requirement::Positive };
        check(self.mass, requirement, || format!("particles[{index}].mass"))?;
        if !self.pinned {
            check_inverse(self.mass, "mass", || format!("particles[{index}].mass"))?;
        }
        if self.pinned && self.velocity != DVec3::ZERO {
            return Err(BodyError::Inconsistent {
                path: format!("particles[{index}].velocity"),
                problem: "a pinned particle never moves; give velocity (0, 0, 0) or pinned: false".into(),
            });
        }
        Ok(())
    }
}

/// The particles of a body: positions, velocities and masses in f64, one array a coordinate.
///
/// Coordinates are stored apart from each other because steppers read them lane by lane. Games read
/// [`position`](Self::position) or iterate over [`positions`](Self::positions).
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Particles {
    position: [Vec<f64>; 3],
    velocity: [Vec<f64>; 3],
    mass: Vec<f64>,
    pinned: Vec<bool>,
}

impl Particles {
    /// Builds the particles of a body.
    ///
    /// # Errors
    /// If there is none, a number is not finite, a mass is not above zero or its inverse is infinite, or a pinned particle has a velocity.
    pub fn new(particles: impl IntoIterator<Item = Particle>) -> Result<Self, BodyError> {
        let mut all = Self::default();
        for (index, particle) in particles.into_iter().enumerate() {
            particle.check(index)?;
            for axis in 0..3 {
                all.position[axis].push(particle.position[axis]);
                all.velocity[axis].push(particle.velocity[axis]);
            }
            all.mass.push(particle.mass);
            all.pinned.push(particle.pinned);
        }
        if all.is_empty() {
            return Err(BodyError::Inconsistent {
                path: "particles".into(),
                problem: "a body has at least one particle".into(),
            });
        }
        Ok(all)
    }

    /// How many particles there are.
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// Whether there is no particle. Never true of what [`new`](Self::new) built.
    pub fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    /// The particle as plain data, or nothing where there is no such particle.
    pub fn get(&self, id: ParticleId) -> Option<Particle> {
        let i = id.index();
        (i < self.len()).then(|| Particle {
            position: vector(&self.position, i),
            velocity: vector(&self.velocity, i),
            mass: self.mass[i],
            pinned: self.pinned[i],
        })
    }

    /// Replaces a particle.
    ///
    /// # Errors
    /// As [`new`](Self::new), and where there is no such particle; nothing is changed then.
    pub fn set(&mut self, id: ParticleId, particle: Particle) -> Result<(), BodyError> {
        let i = id.index();
        if i >= self.len() {
            return Err(BodyError::Missing {
                path: format!("particles[{i}]"),
                what: "particle",
                index: id.0,
                count: self.len(),
            });
        }
        particle.check(i)?;
        for axis in 0..3 {
            self.position[axis][i] = particle.position[axis];
            self.velocity[axis][i] = particle.velocity[axis];
        }
        self.mass[i] = particle.mass;
        self.pinned[i] = particle.pinned;
        Ok(())
    }

    /// Where a particle is, or nothing where there is no such particle.
    pub fn position(&self, id: ParticleId) -> Option<DVec3> {
        (id.index() < self.len()).then(|| vector(&self.position, id.index()))
    }

    /// The velocity of a particle, or nothing where there is no such particle.
    pub fn velocity(&self, id: ParticleId) -> Option<DVec3> {
        (id.index() < self.len()).then(|| vector(&self.velocity, id.index()))
    }

    /// All positions in order.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        (0..self.len()).map(|i| vector(&self.position, i))
    }

    /// All velocities in order.
    pub fn velocities(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        (0..self.len()).map(|i| vector(&self.velocity, i))
    }

    /// All masses in order.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// Which particles are pinned, in order.
    pub fn pinned(&self) -> &[bool] {
        &self.pinned
    }

    /// The centre of mass; of particles that have none, the mean of their positions.
    pub fn center(&self) -> DVec3 {
        let total: f64 = self.mass.iter().sum();
        if total == 0.0 {
            return self.positions().sum::<DVec3>() / self.len() as f64;
        }
        let weighted: DVec3 = self.positions().zip(&self.mass).map(|(position, &mass)| position * mass).sum();
        weighted / total
    }

    /// The positions as arrays of x, y and z.
    pub(crate) fn position_columns(&self) -> &[Vec<f64>; 3] {
        &self.position
    }

    /// The velocities as arrays of x, y and z.
    pub(crate) fn velocity_columns(&self) -> &[Vec<f64>; 3] {
        &self.velocity
    }

    /// Positions and velocities as arrays of x, y and z, for steppers, which keep them finite by the watch.
    pub(crate) fn state_columns_mut(&mut self) -> (&mut [Vec<f64>; 3], &mut [Vec<f64>; 3]) {
        (&mut self.position, &mut self.velocity)
    }

    /// Takes positions and velocities from `other`, a body of as many particles; masses stay.
    pub(crate) fn set_state(&mut self, other: &Self) {
        self.position.clone_from(&other.position);
        self.velocity.clone_from(&other.velocity);
    }
}

fn vector(columns: &[Vec<f64>; 3], i: usize) -> DVec3 {
    DVec3::new(columns[0][i], columns[1][i], columns[2][i])
}
