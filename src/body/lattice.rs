//! Which springs of a block of jelly join which masses.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};
use core::ops::Range;
use serde::{Deserialize, Serialize};

use super::{BodyError, ParticleId, SpringId, Springs};

/// Neighbours on a cubic grid, by their distance in spacings ("Mass-Spring-Damper model", questions 2 and 4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect, Serialize, Deserialize)]
pub enum Neighbours {
    /// At 1, along the edges of the cells.
    Edges,
    /// At √2, across their faces.
    Faces,
    /// At √3, across the cells themselves.
    Cubes,
}

/// The ways from a mass to those neighbours that come after it, nearest first. The other half of the neighbours has this mass as one of theirs.
const WAYS: [[i32; 3]; 13] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 1, 0],
    [-1, 1, 0],
    [1, 0, 1],
    [-1, 0, 1],
    [0, 1, 1],
    [0, -1, 1],
    [1, 1, 1],
    [-1, 1, 1],
    [1, -1, 1],
    [-1, -1, 1],
];

impl Neighbours {
    /// All of them, nearest first.
    pub const ALL: [Self; 3] = [Self::Edges, Self::Faces, Self::Cubes];

    /// How far they are, in spacings: 1, √2 or √3.
    pub fn distance(self) -> f64 {
        match self {
            Self::Edges => 1.0,
            Self::Faces => core::f64::consts::SQRT_2,
            Self::Cubes => 3.0_f64.sqrt(),
        }
    }

    /// The ways to them, in cells along x, y and z.
    pub fn ways(self) -> &'static [[i32; 3]] {
        match self {
            Self::Edges => &WAYS[..3],
            Self::Faces => &WAYS[3..9],
            Self::Cubes => &WAYS[9..],
        }
    }

    /// How many springs join such neighbours in a grid.
    pub fn springs(self, size: [u32; 3]) -> u64 {
        self.ways().iter().map(|way| places(size, *way)).fold(0, u64::saturating_add)
    }
}

/// How many masses of a grid have another at the end of a way.
fn places(size: [u32; 3], way: [i32; 3]) -> u64 {
    let along = size.iter().zip(way).map(|(&size, step)| u64::from(size.saturating_sub(step.unsigned_abs())));
    along.fold(1, u64::saturating_mul)
}

/// A block of masses on a cubic grid, with springs between neighbours: the mass-spring-damper lattice.
///
/// The mass at (x, y, z) of the grid is particle x + n_x(y + n_y z). Springs come kind by kind, nearest first; within a kind way by way as
/// [`Neighbours::ways`] has them; and of each way in the order of the masses at which it begins. Where a spring ends follows from where it begins, so nothing needs
/// to look it up.
#[derive(Clone, Component, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
#[reflect(Component)]
pub struct Lattice {
    size: [u32; 3],
    /// Whether neighbours of each kind are joined, nearest first.
    joined: [bool; 3],
}

impl Lattice {
    /// The lattice of a body that has these springs.
    ///
    /// # Errors
    /// If a count is zero, or the springs are not those of such a lattice.
    pub fn new(size: [u32; 3], joined: &[Neighbours], springs: &Springs) -> Result<Self, BodyError> {
        let [x, y, z] = size;
        let particles = x.checked_mul(y).and_then(|layer| layer.checked_mul(z));
        if particles.is_none_or(|particles| particles == 0) {
            return Err(BodyError::Inconsistent {
                path: "size".into(),
                problem: format!(
                    "({x}, {y}, {z}) is not allowed; a grid has 1 mass or more each way, and fewer than 2³²"
                ),
            });
        }
        let lattice = Self { size, joined: Neighbours::ALL.map(|kind| joined.contains(&kind)) };
        let wrong = lattice.ends().zip(springs.ends()).position(|(ends, given)| ends != *given);
        match wrong {
            None if lattice.springs() == springs.len() => Ok(lattice),
            None => Err(BodyError::Inconsistent {
                path: "springs".into(),
                problem: format!("are {} springs; a grid of {x} × {y} × {z} has {}", springs.len(), lattice.springs()),
            }),
            Some(spring) => Err(BodyError::Inconsistent {
                path: format!("springs[{spring}].ends"),
                problem: format!("does not join the particles that it joins in a grid of {x} × {y} × {z}"),
            }),
        }
    }

    /// The ends of all springs of a grid between neighbours of a kind, in order.
    pub fn ends_of(size: [u32; 3], kind: Neighbours) -> impl Iterator<Item = [ParticleId; 2]> {
        Self { size, joined: [true; 3] }.ends_between(kind)
    }

    fn ends(self) -> impl Iterator<Item = [ParticleId; 2]> {
        let kinds = Neighbours::ALL.into_iter().filter(move |kind| self.joins(*kind));
        kinds.flat_map(move |kind| self.ends_between(kind))
    }

    /// The ends of the springs that join neighbours of a kind, in order, whether it has them or not.
    pub fn ends_between(self, kind: Neighbours) -> impl Iterator<Item = [ParticleId; 2]> {
        kind.ways().iter().flat_map(move |&way| self.ends_along(way))
    }

    /// The ends of the springs along one way.
    fn ends_along(self, way: [i32; 3]) -> impl Iterator<Item = [ParticleId; 2]> {
        let offset = self.offset(way);
        // The first of the masses that have such a neighbour, and the one after the last.
        let bound = move |axis: usize| {
            let (size, step) = (self.size[axis], way[axis].unsigned_abs().min(self.size[axis]));
            if way[axis] < 0 { step..size } else { 0..size - step }
        };
        bound(2).flat_map(move |z| {
            bound(1).flat_map(move |y| {
                bound(0).map(move |x| {
                    let from = self.particle([x, y, z]);
                    [from, ParticleId((i64::from(from.0) + offset) as u32)]
                })
            })
        })
    }

    /// How many masses there are along x, y and z.
    pub fn size(self) -> [usize; 3] {
        self.size.map(|count| count as usize)
    }

    /// Whether neighbours of a kind are joined.
    pub fn joins(self, kind: Neighbours) -> bool {
        self.joined[kind as usize]
    }

    /// How many particles it has.
    pub fn particles(self) -> usize {
        self.size().iter().product()
    }

    /// How many springs it has.
    pub fn springs(self) -> usize {
        self.range(Neighbours::Cubes).end
    }

    /// The springs that join neighbours of a kind, by their numbers; none where they are not joined.
    pub fn range(self, kind: Neighbours) -> Range<usize> {
        let count = |kind: Neighbours| if self.joins(kind) { kind.springs(self.size) as usize } else { 0 };
        let start = Neighbours::ALL.into_iter().take(kind as usize).map(count).sum();
        start..start + count(kind)
    }

    /// The kind of neighbours that a spring joins.
    pub fn kind(self, spring: SpringId) -> Neighbours {
        let holds = |kind: &Neighbours| self.range(*kind).contains(&spring.index());
        Neighbours::ALL.into_iter().find(holds).unwrap_or(Neighbours::Cubes)
    }

    /// The particle at a place of the grid.
    pub fn particle(self, [x, y, z]: [u32; 3]) -> ParticleId {
        ParticleId(x + self.size[0] * (y + self.size[1] * z))
    }

    /// By how much the number of a neighbour along a way is larger.
    pub fn offset(self, way: [i32; 3]) -> i64 {
        let [x, y, z] = way.map(i64::from);
        x + i64::from(self.size[0]) * (y + i64::from(self.size[1]) * z)
    }
}
