//! A mechanical skin: tyres and spokes coloured by what their wheel is told to do, axles, and beams by whether they hit.

use bevy::{math::DVec3, prelude::*};

use crate::{
    body::{Drive, Rule, Rules, Side},
    mechanics::six_matrix::{Beam, Road, look},
    view::clay::{Clay, Tint, shade, tint},
};

/// The radius of a tyre's tube: a rim particle's, less what stones take of it.
const TYRE: f32 = 0.8;
/// How far beams are drawn.
const REACH: f32 = 16.0;

/// The colour of a goal direction: forwards, backwards, free.
fn goal_color(goal: f64) -> Tint {
    match goal {
        goal if goal > 0.0 => tint(0x3fa34d),
        goal if goal < 0.0 => tint(0xd0342c),
        _ => tint(0xe9c46a),
    }
}

/// Shapes wheels, axles and beams.
pub(super) fn shape(clay: &mut Clay, at: &[Vec3], rules: &Rules, road: Option<&Road>, sides: usize) {
    let mut rims = vec![false; at.len()];
    for rule in rules.iter() {
        let Rule::Drive(drive) = rule else { continue };
        if drive.eyes.iter().any(|eye| eye.index() >= at.len()) {
            continue;
        }
        // Where it is shown is between two steps; what it sees there is shown with it.
        let position: Vec<DVec3> = at.iter().map(|x| x.as_dvec3()).collect();
        let sight = look(drive, &position, road);
        for (beam, hit) in sight.beams.iter().zip(sight.hits) {
            ray(clay, beam, hit, road, sides);
        }
        wheels(clay, drive, sight.goals, at, sides);
        for wheel in &drive.wheels {
            wheel.rim.iter().for_each(|id| rims[id.index()] = true);
        }
    }
    rods(clay, at, &rims, sides);
}

fn wheels(clay: &mut Clay, drive: &Drive, goals: (f64, f64), at: &[Vec3], sides: usize) {
    for wheel in &drive.wheels {
        let rim: Vec<_> = wheel.rim.iter().filter_map(|id| at.get(id.index()).copied()).collect();
        if rim.len() < 3 {
            continue;
        }
        let middle = rim.iter().sum::<Vec3>() / rim.len() as f32;
        let color = goal_color(if wheel.side == Side::Left { goals.0 } else { goals.1 });
        // Round once more to where it begins.
        let around: Vec<_> = rim.iter().chain(&rim[..1]).copied().collect();
        let tread = |t: f32| shade(tint(0x33302d), if (t * 40.0) as i32 % 2 == 0 { 1.25 } else { 0.75 });
        clay.tube(&around, sides, |_| TYRE, tread);
        for spoke in rim.iter().step_by((rim.len() / 5).max(1)) {
            clay.tube(&[middle, 0.5 * (middle + *spoke), *spoke], 8, |_| 0.16, |_| tint(0xb8bcc2));
        }
        let hub = Transform::from_translation(middle).with_scale(Vec3::splat(0.75));
        clay.ball(hub, sides, |direction| shade(color, 0.85 + 0.2 * direction.y));
    }
}

/// Rods through what is no rim: a new one begins where the next particle is far.
fn rods(clay: &mut Clay, at: &[Vec3], rims: &[bool], sides: usize) {
    let rest: Vec<_> = at.iter().zip(rims).filter(|(_, rim)| !**rim).map(|(x, _)| *x).collect();
    for rod in rest.chunk_by(|a, b| a.distance(*b) < 2.0) {
        if rod.len() > 1 {
            clay.tube(
                rod,
                sides,
                |_| 0.42,
                |t| shade(tint(0x5f7f9f), if (t * 20.0) as i32 % 2 == 0 { 1.0 } else { 0.9 }),
            );
        }
        for end in [rod.first(), rod.last()].into_iter().flatten() {
            clay.ball(Transform::from_translation(*end).with_scale(Vec3::splat(0.5)), sides, |_| tint(0x4c6680));
        }
    }
}

/// A beam from its origin downwards: green to the nearest stone that it hits, red into the void.
fn ray(clay: &mut Clay, beam: &Beam, hit: bool, road: Option<&Road>, sides: usize) {
    let down = if beam.direction.y > 0.0 { -beam.direction } else { beam.direction };
    let stones = road.map_or(&[][..], Road::points).iter();
    let depths = stones.filter(|stone| hit && beam.hits(**stone)).map(|stone| (*stone - beam.origin).dot(down));
    let depth = depths.filter(|depth| *depth > 0.0).fold(f64::from(REACH), f64::min) as f32;
    let (from, along) = (beam.origin.as_vec3(), down.as_vec3());
    if along == Vec3::ZERO {
        return;
    }
    let color = if hit { tint(0x46e06a) } else { tint(0xff3b30) };
    let end = from + along * depth;
    clay.tube(&[from, 0.5 * (from + end), end], sides.min(8), |_| 0.09, |_| color);
    if hit {
        clay.ball(Transform::from_translation(end).with_scale(Vec3::splat(0.28)), sides, |_| color);
    }
}
