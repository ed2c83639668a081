//! Jelly: a block of masses on a cubic grid ("Mass-Spring-Damper model").

use bevy::{
    ecs::prelude::*,
    math::{DMat3, DVec3},
    prelude::ReflectComponent,
    reflect::Reflect,
};
use serde::{Deserialize, Deserializer, Serialize, de};

use super::{Body, FARTHEST, Look, MOST_PARTICLES, Pose, memory, numbers};
use crate::body::{BodyError, Lattice, Neighbours, Particle, Particles, Spring, Springs, check};

/// A block of masses at spacing 1, its middle above where it is put.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Jelly", deny_unknown_fields)]
pub struct JellyPlan {
    /// How many masses there are along x, y and z, each 1 or more.
    #[serde(deserialize_with = "size")]
    pub size: (u32, u32, u32),
    /// Which neighbours are joined by springs. Left out: none are, and each mass falls by itself.
    #[serde(default)]
    pub neighbours: NeighboursPlan,
    /// Mass of each particle, above zero. Left out: 1.
    #[serde(default = "one", deserialize_with = "numbers::positive")]
    pub mass: f64,
    /// How far it leans at the start: degrees about z, positive towards −x. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub tilt: f64,
    /// How it is turned before it leans. Left out: not at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// How high its lowest mass starts above where it is put, from zero to [`FARTHEST`]. Left out: 0.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub drop: f64,
}

/// The springs of a jelly, by how far the neighbours are that they join. What is left out is not joined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Neighbours", deny_unknown_fields)]
pub struct NeighboursPlan {
    /// At distance 1, along the edges of the cells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<SpringPlan>,
    /// At √2, across their faces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<SpringPlan>,
    /// At √3, across the cells themselves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cubes: Option<SpringPlan>,
}

/// What springs of a kind are like.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Spring", deny_unknown_fields)]
pub struct SpringPlan {
    /// Stiffness k, zero or more.
    #[serde(deserialize_with = "numbers::non_negative")]
    pub stiffness: f64,
    /// Damping D, zero or more. Left out: 0.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub damping: f64,
}

/// A turn about any axis.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The axis, of any length but zero.
    #[serde(deserialize_with = "axis")]
    pub axis: (f64, f64, f64),
    /// Degrees, right-handed about the axis.
    #[serde(deserialize_with = "numbers::finite")]
    pub angle: f64,
}

/// How a block on a grid starts: where, and how it leans. Parameters change it, which puts the block back to its start.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Attitude {
    size: [u32; 3],
    /// Degrees about z, after the rotation.
    tilt: f64,
    rotation: Option<Rotation>,
    drop: f64,
    /// Cosine and sine of the heading.
    direction: (f64, f64),
    at: DVec3,
}

impl NeighboursPlan {
    /// The springs between neighbours of a kind, if they are joined.
    pub fn of(&self, kind: Neighbours) -> Option<SpringPlan> {
        match kind {
            Neighbours::Edges => self.edges,
            Neighbours::Faces => self.faces,
            Neighbours::Cubes => self.cubes,
        }
    }

    /// The same springs between the neighbours of some kinds, none between others.
    pub fn alike(kinds: &[Neighbours], spring: SpringPlan) -> Self {
        let of = |kind| kinds.contains(&kind).then_some(spring);
        Self { edges: of(Neighbours::Edges), faces: of(Neighbours::Faces), cubes: of(Neighbours::Cubes) }
    }

    fn joined(&self) -> Vec<Neighbours> {
        Neighbours::ALL.into_iter().filter(|kind| self.of(*kind).is_some()).collect()
    }
}

impl JellyPlan {
    /// What a particle with springs to all its neighbours takes in memory while its scene is opened, in bytes (measured at 60³).
    pub const BYTES_A_PARTICLE: u64 = 1400;
    /// What of that one of its thirteen springs takes.
    const BYTES_A_SPRING: u64 = 84;

    /// How many particles it has.
    pub fn particles(&self) -> usize {
        let (x, y, z) = self.size;
        [x, y, z].into_iter().fold(1, |count: usize, along| count.saturating_mul(along as usize))
    }

    /// What it takes in memory while its scene is opened.
    fn bytes(&self) -> u64 {
        const NEIGHBOURS: u64 = 13;
        let (x, y, z) = self.size;
        let springs: u64 = self.neighbours.joined().iter().map(|kind| kind.springs([x, y, z])).sum();
        let alone = Self::BYTES_A_PARTICLE - NEIGHBOURS * Self::BYTES_A_SPRING;
        self.particles() as u64 * alone + springs * Self::BYTES_A_SPRING
    }

    /// Builds it, without what is not its own.
    pub(super) fn body(&self, pose: Pose) -> Result<Body, BodyError> {
        let inconsistent = |path: &str, problem: String| Err(BodyError::Inconsistent { path: path.into(), problem });
        if let Some(problem) = size_problem(self.size) {
            return inconsistent("size", problem);
        }
        if !(0.0..=FARTHEST).contains(&self.drop) {
            return inconsistent(
                "drop",
                format!("{:e} is not allowed; give a number from 0 to {FARTHEST:e}", self.drop),
            );
        }
        let (x, y, z) = self.size;
        let size = [x, y, z];
        for (kind, name) in Neighbours::ALL.into_iter().zip(["edges", "faces", "cubes"]) {
            if self.neighbours.of(kind).is_some() && kind.springs(size) == 0 {
                let problem = format!("a grid of {x} × {y} × {z} has no such neighbours; leave them out");
                return inconsistent(&format!("neighbours.{name}"), problem);
            }
        }
        if self.rotation.is_some_and(|rotation| DVec3::from(rotation.axis) == DVec3::ZERO) {
            return inconsistent("rotation.axis", NO_AXIS.into());
        }
        let bytes = self.bytes();
        if let Some(available) = memory::available().filter(|available| bytes > *available) {
            let problem = format!(
                "({x}, {y}, {z}) is {} particles, which would take {bytes} bytes ({:.1} GB) with their springs; {available} bytes ({:.1} GB) are available",
                self.particles(),
                bytes as f64 / 1e9,
                available as f64 / 1e9,
            );
            return inconsistent("size", problem);
        }
        let attitude = Attitude {
            size,
            tilt: check(self.tilt, crate::body::Requirement::Finite, || "tilt".into())?,
            rotation: self.rotation,
            drop: self.drop,
            direction: pose.direction(),
            at: pose.at,
        };
        let particle = |position| Particle { mass: self.mass, ..Particle::at(position) };
        let particles = Particles::new(attitude.positions().map(particle))?;
        let springs_of = |kind: Neighbours| {
            let plan = self.neighbours.of(kind);
            plan.into_iter().flat_map(move |SpringPlan { stiffness, damping }| {
                let spring = move |ends| Spring { ends, stiffness, damping, rest_length: kind.distance() };
                Lattice::ends_of(size, kind).map(spring)
            })
        };
        let springs = Springs::new(Neighbours::ALL.into_iter().flat_map(springs_of), &particles)?;
        let lattice = Lattice::new(size, &self.neighbours.joined(), &springs)?;
        Ok(Body {
            particles,
            springs,
            muscles: None,
            strand: None,
            waves: None,
            six: None,
            block: Some((lattice, attitude)),
            friction: None,
            coulomb: None,
            damping: None,
            tearing: None,
            look: Look::Plain,
        })
    }
}

impl Attitude {
    /// How far the block leans at its start, in degrees about z.
    pub fn tilt(&self) -> f64 {
        self.tilt
    }

    /// Lets it lean by another angle, in degrees.
    ///
    /// # Errors
    /// If the angle is not finite; nothing is changed then.
    pub fn set_tilt(&mut self, tilt: f64) -> Result<(), BodyError> {
        self.tilt = check(tilt, crate::body::Requirement::Finite, || "tilt".into())?;
        Ok(())
    }

    /// Where the particles start, in order: the block about its middle, turned, leant, headed, and lifted so that its lowest mass is where it drops from.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = DVec3> + use<> {
        let turn = self.turn();
        let [x, y, z] = self.size.map(|count| count as usize);
        let middle = 0.5 * (DVec3::new(x as f64, y as f64, z as f64) - DVec3::ONE);
        let about_middle =
            move |i: usize| turn * (DVec3::new((i % x) as f64, (i / x % y) as f64, (i / (x * y)) as f64) - middle);
        let corners = (0..8_u8).map(|corner| {
            let end = |bit: u8, count: usize| if corner >> bit & 1 == 1 { count - 1 } else { 0 };
            end(0, x) + x * (end(1, y) + y * end(2, z))
        });
        let lowest = corners.map(|corner| about_middle(corner).y).fold(f64::INFINITY, f64::min);
        let lift = self.at + DVec3::Y * (self.drop - lowest);
        (0..x * y * z).map(move |i| about_middle(i) + lift)
    }

    /// Puts a block back to its start, at rest.
    ///
    /// # Errors
    /// If it has not as many particles; nothing is changed then.
    pub fn place(&self, particles: &mut Particles) -> Result<(), BodyError> {
        let positions = self.positions();
        if positions.len() != particles.len() {
            let problem = format!("is that of a block of {} particles, not of {}", positions.len(), particles.len());
            return Err(BodyError::Inconsistent { path: "tilt".into(), problem });
        }
        let columns = particles.state_columns_mut();
        for (i, position) in positions.enumerate() {
            for axis in 0..3 {
                columns.0[axis][i] = position[axis];
                columns.1[axis][i] = 0.0;
            }
        }
        Ok(())
    }

    /// How the grid is turned at the start.
    fn turn(&self) -> DMat3 {
        let about = |axis: DVec3, degrees: f64| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let axis = unit(axis);
            let cross = DMat3::from_cols(
                DVec3::new(0.0, axis.z, -axis.y),
                DVec3::new(-axis.z, 0.0, axis.x),
                DVec3::new(axis.y, -axis.x, 0.0),
            );
            // Rodrigues: I + sin·[a] + (1 − cos)·[a]².
            DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
        };
        let (cos, sin) = self.direction;
        let heading = DMat3::from_cols(DVec3::new(cos, 0.0, sin), DVec3::Y, DVec3::new(-sin, 0.0, cos));
        let rotation = self.rotation.map_or(DMat3::IDENTITY, |turn| about(DVec3::from(turn.axis), turn.angle));
        heading * about(DVec3::Z, self.tilt) * rotation
    }
}

/// The vector of length 1 along an axis, however long or short that is.
fn unit(axis: DVec3) -> DVec3 {
    if axis.length_squared().is_normal() { axis.normalize() } else { (axis / axis.abs().max_element()).normalize() }
}

const NO_AXIS: &str = "(0, 0, 0) is not allowed; give an axis that has a direction";

fn one() -> f64 {
    1.0
}

/// What is wrong with the size of a grid.
fn size_problem((x, y, z): (u32, u32, u32)) -> Option<String> {
    if [x, y, z].contains(&0) {
        return Some(format!("({x}, {y}, {z}) is not allowed; give 1 or more along x, y and z"));
    }
    let particles = u128::from(x) * u128::from(y) * u128::from(z);
    let bytes = particles * u128::from(JellyPlan::BYTES_A_PARTICLE);
    (particles > MOST_PARTICLES as u128).then(|| {
        format!(
            "({x}, {y}, {z}) is {particles} particles, which would take {bytes} bytes ({:.1} GB) with all of their springs; a scene has at most \
             {MOST_PARTICLES} particles",
            bytes as f64 / 1e9
        )
    })
}

/// Reads the size of a grid for which there is memory.
fn size<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(u32, u32, u32), D::Error> {
    // Any number, so that a negative count or a part of one is told from a word.
    let (x, y, z) = <(f64, f64, f64)>::deserialize(deserializer)?;
    let whole = |count: f64| {
        let is_whole = (0.0..=f64::from(u32::MAX)).contains(&count) && count.trunc() == count;
        is_whole.then_some(count as u32)
    };
    match [x, y, z].map(whole) {
        [Some(x), Some(y), Some(z)] => match size_problem((x, y, z)) {
            None => Ok((x, y, z)),
            Some(problem) => Err(de::Error::custom(problem)),
        },
        _ => {
            let most = u32::MAX;
            Err(de::Error::custom(format_args!("({x}, {y}, {z}) is not allowed; give whole numbers from 1 to {most}")))
        }
    }
}

/// Reads an axis.
fn axis<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(f64, f64, f64), D::Error> {
    match numbers::vector(deserializer)? {
        (0.0, 0.0, 0.0) => Err(de::Error::custom(NO_AXIS)),
        axis => Ok(axis),
    }
}
