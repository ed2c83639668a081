//! Roads along points of one's own.

use core::f64::consts::TAU;

use bevy::math::DVec3;
use serde::{Deserialize, Serialize};

use super::Station;
use crate::{
    body::{BodyError, Requirement, check},
    creatures::numbers,
};

/// A road along points. At each of them it bends at once; the rows fan out there, so that its outer side has no gap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Course {
    /// The points of its middle, two or more.
    pub points: Vec<(f64, f64, f64)>,
    /// Its width, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub width: f64,
    /// From row to row, and from particle to particle in a row, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub spacing: f64,
    /// How many particles stand in a ring as wide as the road, as on Rough Road, in place of each row. Left out: none, a row goes straight across.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ring: Option<u32>,
}

/// Where a course bends.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// How far along its points.
    way: f64,
    /// The point, and the direction in which the course comes there.
    station: Station,
    /// By how much it turns to the right, in radians.
    turn: f64,
}

impl Course {
    /// How many rows it has, and how many particles in each.
    pub(super) fn counts(&self) -> Result<(usize, usize), BodyError> {
        for (i, &(x, y, z)) in self.points.iter().enumerate() {
            for value in [x, y, z] {
                check(value, Requirement::Finite, || format!("form.points[{i}]"))?;
            }
        }
        let length: f64 = self.pieces().map(|[from, to]| from.distance(to)).sum();
        if self.points.len() < 2 || length == 0.0 {
            let problem = "lead nowhere; give two or more that are apart".into();
            return Err(BodyError::Inconsistent { path: "form.points".into(), problem });
        }
        let across = || (self.width / self.spacing).round().max(0.0) as usize + 1;
        Ok(((length / self.spacing).ceil() as usize, self.ring.map_or_else(across, |ring| ring as usize)))
    }

    fn pieces(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        self.points.windows(2).map(|ends| [DVec3::from(ends[0]), DVec3::from(ends[1])])
    }

    /// So far along its points; beyond its end straight on.
    pub(super) fn station(&self, way: f64) -> Station {
        let (mut left, mut place) = (way, Station { middle: DVec3::ZERO, ahead: DVec3::X });
        for [from, to] in self.pieces() {
            let length = from.distance(to);
            if length == 0.0 {
                continue;
            }
            let ahead = (to - from).with_y(0.0).normalize_or(place.ahead);
            place = Station { middle: from + (to - from) * (left / length), ahead };
            if left <= length {
                break;
            }
            left -= length;
        }
        place
    }

    /// A particle of a ring.
    pub(super) fn on_ring(&self, row: usize, each: usize, column: usize) -> DVec3 {
        let (sin, cos) = libm::sincos(TAU * column as f64 / each as f64);
        self.station(row as f64 * self.spacing).middle + 0.5 * self.width * DVec3::new(cos, 0.0, sin)
    }

    /// What closes the outer sides of its corners: between two rows with a corner between them each column goes on along the one piece, around the corner and
    /// along the other, in steps of about the spacing. Rings leave no gap.
    pub(super) fn corners(&self, rows: usize, each: usize) -> impl Iterator<Item = DVec3> + '_ {
        let bends = if self.ring.is_none() { self.bends() } else { Vec::new() };
        let row = |corner: &Corner| (corner.way / self.spacing) as usize;
        let between: Vec<_> = bends.chunk_by(|a, b| row(a) == row(b)).map(<[_]>::to_vec).collect();
        // Behind the last row nothing is to be joined to.
        let between = between.into_iter().filter(move |bends| row(&bends[0]) + 1 < rows);
        between.flat_map(move |bends| {
            let from = row(&bends[0]) as f64 * self.spacing;
            (0..each).flat_map(move |column| {
                let aside = self.spacing * (column as f64 - 0.5 * (each as f64 - 1.0));
                let length = self.spacing + bends.iter().map(|bend| bend.arc(aside)).sum::<f64>();
                let steps = (length / self.spacing).round().max(1.0) as usize;
                let bends = bends.clone();
                (1..steps).map(move |i| self.around(&bends, from, aside, length * i as f64 / steps as f64))
            })
        })
    }

    /// All of its corners in order.
    fn bends(&self) -> Vec<Corner> {
        let (mut bends, mut way, mut before) = (Vec::new(), 0.0, None);
        for [from, to] in self.pieces() {
            // Straight up it goes on in no other direction.
            let ahead = (to - from).with_y(0.0).try_normalize().or(before);
            if let (Some(before), Some(ahead)) = (before, ahead)
                && before != ahead
            {
                let station = Station { middle: from, ahead: before };
                let turn = libm::atan2(ahead.dot(station.right()), ahead.dot(before));
                bends.push(Corner { way, station, turn });
            }
            before = ahead;
            way += from.distance(to);
        }
        bends
    }

    /// The place to which `left` leads, beside the middle by `aside`, from `way` on and around these corners.
    fn around(&self, bends: &[Corner], mut way: f64, aside: f64, mut left: f64) -> DVec3 {
        for bend in bends {
            if left <= bend.way - way {
                break;
            }
            left -= bend.way - way;
            way = bend.way;
            let arc = bend.arc(aside);
            if left <= arc {
                return bend.beside(aside, bend.turn * (left / arc));
            }
            left -= arc;
        }
        let place = self.station(way + left);
        place.middle + aside * place.right()
    }
}

impl Corner {
    /// How long the way around it is, so far to the right of the middle; 0 on its inner side.
    fn arc(&self, aside: f64) -> f64 {
        (-aside * self.turn).max(0.0)
    }

    /// So far to the right of its point, once the course has turned by this much.
    fn beside(&self, aside: f64, turn: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(turn);
        self.station.middle + aside * (cos * self.station.right() - sin * self.station.ahead)
    }
}
