//! The matrices b and c of the six-matrix particle system, without their zeros.

use core::ops::Range;

use bevy::{ecs::prelude::*, math::DVec3, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, Requirement, check};

/// Which of the two particles of a pair feels the other: row i of a matrix says what acts on i, and rows may differ from columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
pub enum Felt {
    /// Each feels the other.
    Both,
    /// Only the one of lower number.
    First,
    /// Only the one of higher number.
    Second,
}

/// A matrix of zeros and ones between the particles of a body, kept as its pairs (i, j) with i < j, row after row.
///
/// Who goes through the pairs in order and adds what each gives to both of its ends adds for every particle in the order of the other's number, and so
/// gets the bits of a sum over a dense row.
#[derive(Clone, Debug, Default, PartialEq, Eq, Reflect)]
pub struct Relation {
    /// Where the pairs of each particle begin; one more than there are particles.
    starts: Vec<u32>,
    others: Vec<u32>,
    felt: Vec<Felt>,
}

impl Relation {
    /// The relation of `particles` particles in which i feels j where `feels(i, j)`. Asks about every pair once in each direction.
    pub fn new(particles: usize, feels: impl Fn(usize, usize) -> bool) -> Self {
        let mut relation = Self { starts: vec![0], others: Vec::new(), felt: Vec::new() };
        for i in 0..particles {
            for j in i + 1..particles {
                let felt = match (feels(i, j), feels(j, i)) {
                    (true, true) => Felt::Both,
                    (true, false) => Felt::First,
                    (false, true) => Felt::Second,
                    (false, false) => continue,
                };
                relation.others.push(j as u32);
                relation.felt.push(felt);
            }
            relation.starts.push(relation.others.len() as u32);
        }
        relation
    }

    /// How many particles it is for.
    pub fn particles(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// How many pairs there are.
    pub fn len(&self) -> usize {
        self.others.len()
    }

    /// Whether no particle feels another.
    pub fn is_empty(&self) -> bool {
        self.others.is_empty()
    }

    /// How many ones the matrix has: a pair counts once for each that feels the other.
    pub fn ones(&self) -> usize {
        self.felt.iter().map(|felt| if *felt == Felt::Both { 2 } else { 1 }).sum()
    }

    /// All pairs in order.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, Felt)> + '_ {
        let row = move |i: usize| self.row(i).map(move |at| (i, self.others[at] as usize, self.felt[at]));
        (0..self.particles()).flat_map(row)
    }

    /// Where the pairs of i with higher numbers are.
    #[inline]
    pub(crate) fn row(&self, i: usize) -> Range<usize> {
        self.starts[i] as usize..self.starts[i + 1] as usize
    }

    /// The particle of higher number of a pair, and who feels the other.
    #[inline]
    pub(crate) fn at(&self, pair: usize) -> (usize, Felt) {
        (self.others[pair] as usize, self.felt[pair])
    }
}

/// The bonds b of a body, which try to keep the distances that the particles had at the start.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Bonds {
    relation: Relation,
    /// p⁰, wherever the body is put.
    rest: Vec<DVec3>,
    /// ‖p⁰_j − p⁰_i‖² pair by pair.
    squares: Vec<f64>,
    stiffness: f64,
}

impl Bonds {
    /// The bonds of a body with these initial positions, in which i is bound to j where `bound(i, j)`. No particle is bound to itself.
    pub fn new(rest: Vec<DVec3>, bound: impl Fn(usize, usize) -> bool) -> Self {
        let relation = Relation::new(rest.len(), bound);
        let squares = relation.pairs().map(|(i, j, _)| (rest[j] - rest[i]).length_squared()).collect();
        Self { relation, rest, squares, stiffness: 1.0 }
    }

    /// Who is bound to whom.
    pub fn relation(&self) -> &Relation {
        &self.relation
    }

    /// The initial positions p⁰ that they keep the distances of.
    pub fn rest(&self) -> &[DVec3] {
        &self.rest
    }

    /// The squares of the initial distances, pair by pair.
    pub fn squares(&self) -> &[f64] {
        &self.squares
    }

    /// The factor of all bond forces; 1 as printed. A bond is about a spring of twice this stiffness.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Changes the factor of all bond forces.
    ///
    /// # Errors
    /// If it is negative or not finite; nothing is changed then.
    pub fn set_stiffness(&mut self, stiffness: f64) -> Result<(), BodyError> {
        self.stiffness = check(stiffness, Requirement::NonNegative, || "bonds.stiffness".into())?;
        Ok(())
    }
}

/// The collisions c of a body: which of its particles push each other apart where they overlap. All of them collide with the road.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Collisions {
    relation: Relation,
    stiffness: f64,
}

impl Collisions {
    /// The collisions of a body of `particles` particles, in which j pushes i where `pushed(i, j)`.
    pub fn new(particles: usize, pushed: impl Fn(usize, usize) -> bool) -> Self {
        Self { relation: Relation::new(particles, pushed), stiffness: 1.0 }
    }

    /// Who pushes whom.
    pub fn relation(&self) -> &Relation {
        &self.relation
    }

    /// The factor of all collision forces, those with the road included; 1 as printed.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Changes the factor of all collision forces.
    ///
    /// # Errors
    /// If it is negative or not finite; nothing is changed then.
    pub fn set_stiffness(&mut self, stiffness: f64) -> Result<(), BodyError> {
        self.stiffness = check(stiffness, Requirement::NonNegative, || "collisions.stiffness".into())?;
        Ok(())
    }
}
