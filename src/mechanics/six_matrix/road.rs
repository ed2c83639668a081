//! A road: particles that never move.

use std::sync::Arc;

use bevy::{
    ecs::prelude::*,
    math::DVec3,
    prelude::ReflectComponent,
    reflect::{Reflect, TypePath},
};

use crate::body::{BodyError, Requirement, check};

use super::{
    drive::Beam,
    grid::{Grid, TOUCH},
};

/// The road that a body moves on: unit balls that never move. Cheap to share between bodies. A body without it, or with one of no particles, touches nothing, its
/// legs are drawn nowhere and its beams miss.
#[derive(Clone, Component, Reflect)]
#[reflect(Component)]
pub struct Road(Arc<RoadParticles>);

#[derive(TypePath)]
struct RoadParticles {
    points: Vec<DVec3>,
    line: Vec<DVec3>,
    grid: Grid,
}

/// What the rules ask of a road. Of equal answers the particle of lowest number counts.
pub trait RoadSearch {
    /// Calls `touched` with every road particle nearer than 2, in rising order.
    fn touching(&self, point: DVec3, touched: impl FnMut(DVec3));
    /// The road particle nearest to a point; nothing where there is no road.
    fn nearest(&self, point: DVec3) -> Option<DVec3>;
    /// Whether a beam hits any road particle.
    fn is_hit(&self, beam: &Beam) -> bool;
}

impl Road {
    /// The road of these particles, with the line along its middle, from its start to its end.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn new(points: Vec<DVec3>, line: Vec<DVec3>) -> Result<Self, BodyError> {
        for (what, list) in [("points", &points), ("line", &line)] {
            for (i, value) in list.iter().enumerate().flat_map(|(i, point)| point.to_array().map(|x| (i, x))) {
                check(value, Requirement::Finite, || format!("road.{what}[{i}]"))?;
            }
        }
        let grid = Grid::new(&points);
        Ok(Self(Arc::new(RoadParticles { points, line, grid })))
    }

    /// Its particles.
    pub fn points(&self) -> &[DVec3] {
        &self.0.points
    }

    /// The line along its middle.
    pub fn line(&self) -> &[DVec3] {
        &self.0.line
    }

    /// How many bytes of memory its particles and their grid take: in proportion to how many there are.
    pub fn bytes(&self) -> usize {
        (self.0.points.capacity() + self.0.line.capacity()) * size_of::<DVec3>() + self.0.grid.bytes()
    }

    /// How far along its middle a point is, seen from above: the way along the line to where it passes the point most closely. 0 without a line.
    pub fn way(&self, point: DVec3) -> f64 {
        let flat = |point: DVec3| bevy::math::DVec2::new(point.x, point.z);
        let (point, mut way, mut nearest, mut found) = (flat(point), 0.0, f64::INFINITY, 0.0);
        for ends in self.0.line.windows(2) {
            let [from, to] = [flat(ends[0]), flat(ends[1])];
            let along = to - from;
            let length = along.length();
            let part = if length > 0.0 { ((point - from).dot(along) / (length * length)).clamp(0.0, 1.0) } else { 0.0 };
            let distance = (from + part * along).distance_squared(point);
            if distance < nearest {
                (nearest, found) = (distance, way + part * length);
            }
            way += length;
        }
        found
    }

    /// The height of its lowest particle; infinite without any.
    pub fn lowest(&self) -> f64 {
        self.points().iter().map(|point| point.y).fold(f64::INFINITY, f64::min)
    }

    /// How long its middle is, seen from above.
    pub fn length(&self) -> f64 {
        self.0.line.windows(2).map(|ends| (ends[1] - ends[0]).with_y(0.0).length()).sum()
    }
}

impl core::fmt::Debug for Road {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Road({} particles)", self.points().len())
    }
}

impl PartialEq for Road {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || (self.points() == other.points() && self.line() == other.line())
    }
}

impl RoadSearch for Road {
    #[inline]
    fn touching(&self, point: DVec3, mut touched: impl FnMut(DVec3)) {
        for &i in self.0.grid.near(point) {
            let there = self.0.points[i as usize];
            if touches(point, there) {
                touched(there);
            }
        }
    }

    fn nearest(&self, point: DVec3) -> Option<DVec3> {
        let (mut best, mut found) = (f64::INFINITY, None);
        for block in self.0.grid.blocks() {
            // Rounding may put the box of what is as near a little further away.
            if block.distance_squared(point) > best * (1.0 + 1e-12) {
                continue;
            }
            for &i in self.0.grid.members(block) {
                let square = (self.0.points[i as usize] - point).length_squared();
                if square < best || (square == best && found.is_some_and(|found| i < found)) {
                    (best, found) = (square, Some(i));
                }
            }
        }
        found.map(|i| self.0.points[i as usize])
    }

    fn is_hit(&self, beam: &Beam) -> bool {
        let grid = &self.0.grid;
        grid.blocks().iter().any(|block| {
            let (middle, radius) = block.ball();
            beam.distance(middle) < (beam.reach + radius) * (1.0 + 1e-9)
                && grid.members(block).iter().any(|&i| beam.hits(self.0.points[i as usize]))
        })
    }
}

/// A road that is searched from end to end every time, for tests and comparison.
#[derive(Clone, Copy, Debug)]
pub struct Scan<'a>(pub &'a [DVec3]);

impl RoadSearch for Scan<'_> {
    fn touching(&self, point: DVec3, mut touched: impl FnMut(DVec3)) {
        self.0.iter().filter(|there| touches(point, **there)).for_each(|there| touched(*there));
    }

    fn nearest(&self, point: DVec3) -> Option<DVec3> {
        let mut best = f64::INFINITY;
        let mut found = None;
        for &there in self.0 {
            let square = (there - point).length_squared();
            if square < best {
                (best, found) = (square, Some(there));
            }
        }
        found
    }

    fn is_hit(&self, beam: &Beam) -> bool {
        self.0.iter().any(|there| beam.hits(*there))
    }
}

/// Whether two unit balls overlap.
#[inline]
pub(super) fn touches(a: DVec3, b: DVec3) -> bool {
    (b - a).length_squared() < TOUCH * TOUCH
}
