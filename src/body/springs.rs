//! The springs of a body.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, ParticleId, Particles, Requirement, check};

/// One of a body's springs, counted from 0 in the order of its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub struct SpringId(pub u32);

impl SpringId {
    /// The id as an index into arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One spring as plain data. Its force along the line from one end to the other is f = k(L − l) − D·dl/dt
/// (Miller 1988, as quoted in "The Motion Dynamics of Snakes and Worms", G. S. Owen).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The two particles that it joins.
    pub ends: [ParticleId; 2],
    /// Stiffness k, force a length; zero or more.
    pub stiffness: f64,
    /// Spring damping coefficient D, force a velocity; zero or more.
    pub damping: f64,
    /// Rest length L without any muscle; above zero.
    pub rest_length: f64,
}

impl Spring {
    fn check(&self, index: usize, particles: usize) -> Result<(), BodyError> {
        for end in self.ends {
            if end.index() >= particles {
                return Err(BodyError::Missing {
                    path: format!("springs[{index}].ends"),
                    what: "particle",
                    index: end.0,
                    count: particles,
                });
            }
        }
        if self.ends[0] == self.ends[1] {
            return Err(BodyError::Inconsistent {
                path: format!("springs[{index}].ends"),
                problem: format!("joins particle {} to itself; give two different particles", self.ends[0].0),
            });
        }
        check(self.stiffness, Requirement::NonNegative, || format!("springs[{index}].stiffness"))?;
        check(self.damping, Requirement::NonNegative, || format!("springs[{index}].damping"))?;
        check(self.rest_length, Requirement::Positive, || format!("springs[{index}].rest_length"))?;
        Ok(())
    }
}

/// The springs of a body, one array a field.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Springs {
    particles: usize,
    ends: Vec<[ParticleId; 2]>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    rest_length: Vec<f64>,
}

impl Springs {
    /// Builds the springs of a body that has `particles`.
    ///
    /// # Errors
    /// If an end is not a particle, a spring joins a particle to itself, a stiffness or damping is negative or not finite, or a rest
    /// length is not above zero.
    pub fn new(springs: impl IntoIterator<Item = Spring>, particles: &Particles) -> Result<Self, BodyError> {
        let mut all = Self { particles: particles.len(), ..Self::default() };
        for (index, spring) in springs.into_iter().enumerate() {
            spring.check(index, all.particles)?;
            all.ends.push(spring.ends);
            all.stiffness.push(spring.stiffness);
            all.damping.push(spring.damping);
            all.rest_length.push(spring.rest_length);
        }
        Ok(all)
    }

    /// How many springs there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no spring.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The spring as plain data, or nothing where there is no such spring.
    pub fn get(&self, id: SpringId) -> Option<Spring> {
        let i = id.index();
        (i < self.len()).then(|| Spring {
            ends: self.ends[i],
            stiffness: self.stiffness[i],
            damping: self.damping[i],
            rest_length: self.rest_length[i],
        })
    }

    /// Replaces a spring.
    ///
    /// # Errors
    /// As [`new`](Self::new), and where there is no such spring; nothing is changed then.
    pub fn set(&mut self, id: SpringId, spring: Spring) -> Result<(), BodyError> {
        let i = id.index();
        if i >= self.len() {
            return Err(BodyError::Missing {
                path: format!("springs[{i}]"),
                what: "spring",
                index: id.0,
                count: self.len(),
            });
        }
        spring.check(i, self.particles)?;
        self.ends[i] = spring.ends;
        self.stiffness[i] = spring.stiffness;
        self.damping[i] = spring.damping;
        self.rest_length[i] = spring.rest_length;
        Ok(())
    }

    /// All springs in order, as plain data.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Spring> + '_ {
        (0..self.len()).map(|i| Spring {
            ends: self.ends[i],
            stiffness: self.stiffness[i],
            damping: self.damping[i],
            rest_length: self.rest_length[i],
        })
    }

    /// The ends of every spring, in order.
    pub fn ends(&self) -> &[[ParticleId; 2]] {
        &self.ends
    }
}
