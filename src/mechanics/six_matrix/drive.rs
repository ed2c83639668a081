//! Beams, decisions and wheels: what a [`Drive`] sees and does.

use bevy::math::DVec3;

use crate::body::{Beams, Drive, Sense, Side, Table, Wheel};

use super::road::RoadSearch;

/// A beam: the whole line through its origin, both ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// o.
    pub origin: DVec3,
    /// r/‖r‖; zero where the axle points straight up, and then it hits nothing.
    pub direction: DVec3,
    /// How near to it a road particle is that it hits.
    pub reach: f64,
}

impl Beam {
    /// ‖q − (q·r/‖r‖)·r/‖r‖‖ with q = p − o.
    pub fn distance(&self, point: DVec3) -> f64 {
        let q = point - self.origin;
        (q - q.dot(self.direction) * self.direction).length()
    }

    /// Whether it hits a road particle.
    pub fn hits(&self, point: DVec3) -> bool {
        self.distance(point) < self.reach && self.direction != DVec3::ZERO
    }
}

/// What the beams of a drive see, and what is decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The beams in the order left front, left side, right front, right side.
    pub beams: [Beam; 4],
    /// Which of them hit the road.
    pub hits: [bool; 4],
    /// The goal directions of the left and the right wheels: 1 forwards, −1 backwards, 0 free.
    pub goals: (f64, f64),
}

impl Sight {
    /// The row of the table that was decided by, in the words of print.
    pub fn decision(&self) -> &'static str {
        match self.hits {
            [false, ..] | [_, _, false, _] => "left or right front beam",
            [_, false, _, false] => "both side beams",
            [_, false, ..] => "only left side beam",
            [.., false] => "only right side beam",
            _ => "none",
        }
    }
}

/// u/‖u‖, and zero for zero.
fn norm(u: DVec3) -> DVec3 {
    let length = u.length();
    if length > 0.0 { u / length } else { DVec3::ZERO }
}

/// The four beams from the left and the right end of an axle.
pub fn beams(beams: &Beams, [left, right]: [DVec3; 2]) -> [Beam; 4] {
    let &Beams { lift, front, side, down, out, reach } = beams;
    let a = right - left;
    let n = norm(a.cross(DVec3::new(0.0, lift, 0.0)));
    let planar = DVec3::new(out * n.x, n.y, out * n.z);
    let ahead = |factor: f64| DVec3::new(factor * n.x, down, factor * n.z);
    let beam = |origin, r| Beam { origin, direction: norm(r), reach };
    [
        beam(left, ahead(front).cross(a)),
        beam(left, ahead(side).cross(a + planar)),
        beam(right, ahead(front).cross(a)),
        beam(right, ahead(side).cross(a - planar)),
    ]
}

/// Looks at the road and decides.
pub fn look(drive: &Drive, position: &[DVec3], road: Option<&impl RoadSearch>) -> Sight {
    let beams = beams(&drive.beams, drive.eyes.map(|eye| position[eye.index()]));
    let hits = beams.map(|beam| road.is_some_and(|road| road.is_hit(&beam)));
    Sight { beams, hits, goals: decide(&drive.table, hits) }
}

/// Tries the rows of the table from the last one up.
fn decide(table: &Table, [left_front, left_side, right_front, right_side]: [bool; 4]) -> (f64, f64) {
    if !left_front || !right_front {
        table.front
    } else if !left_side && !right_side {
        table.both_sides
    } else if !right_side {
        table.right_side
    } else if !left_side {
        table.left_side
    } else {
        table.none
    }
}

/// Adds friction and steering to the reaction of every rim particle.
pub(super) fn add(
    drive: &Drive,
    position: &[DVec3],
    velocity: &[DVec3],
    touches: &[bool],
    road: Option<&impl RoadSearch>,
    reaction: &mut [DVec3],
) {
    let (left, right) = look(drive, position, road).goals;
    for wheel in &drive.wheels {
        let goal = match wheel.side {
            Side::Left => left,
            Side::Right => right,
        };
        let force = steering(drive, wheel, goal, position, velocity);
        let hub = position[wheel.hub.index()];
        let [from, to] = wheel.axis.map(|end| position[end.index()]);
        for id in &wheel.rim {
            let i = id.index();
            if touches[i] {
                reaction[i] -= drive.friction * velocity[i];
            }
            reaction[i] += force * norm((position[i] - hub).cross(to - from));
        }
    }
}

/// θ: the bounded control force of a wheel.
fn steering(drive: &Drive, wheel: &Wheel, goal: f64, position: &[DVec3], velocity: &[DVec3]) -> f64 {
    let mut momentum = drive.speed * goal;
    if goal != 0.0 {
        let hub = velocity[wheel.hub.index()];
        let speeds: f64 = wheel.rim.iter().map(|k| (hub - velocity[k.index()]).length()).sum();
        momentum += direction(drive.sense, wheel, position, velocity) / drive.mean * speeds;
    }
    momentum.min(drive.limit).max(-drive.limit)
}

/// ς: against which way the wheel turns at present.
fn direction(sense: Sense, wheel: &Wheel, position: &[DVec3], velocity: &[DVec3]) -> f64 {
    let height = |k: usize| position[wheel.rim[k].index()].y;
    let count = wheel.rim.len();
    // Of equal heights the first counts.
    let top = (1..count).fold(0, |best, k| if height(k) > height(best) { k } else { best });
    let bottom = (1..count).fold(0, |best, k| if height(k) < height(best) { k } else { best });
    let behind = |k: usize| -> f64 {
        let one = |condition: bool| if condition { 1.0 } else { 0.0 };
        let between = top < k && k < bottom;
        match sense {
            Sense::Restored | Sense::Reversed => {
                one(top > bottom) * (one(k > top) + one(k < bottom)) + one(top < bottom && between)
            }
            Sense::Printed => {
                (one(top > bottom && k > top) + one(top > bottom && k < bottom)) * one(top < bottom && between)
            }
            Sense::Implied => {
                (one(top <= bottom || k > top) + one(top <= bottom || k < bottom)) * one(top >= bottom || between)
            }
        }
    };
    let sum: f64 = (0..count).map(|k| (2.0 * behind(k) - 1.0) * velocity[wheel.rim[k].index()].y).sum();
    match (sum < 0.0, sense) {
        (true, Sense::Reversed) => -1.0,
        (false, Sense::Reversed) => 1.0,
        (true, _) => 1.0,
        (false, _) => -1.0,
    }
}
