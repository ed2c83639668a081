//! An organic skin: a tube with segments, a face, and legs that show whether they grip.

use bevy::prelude::*;

use crate::{
    body::{Columns, Free, Leg, Rule, Rules},
    view::clay::{Clay, Tint, blend, shade, tint},
};

/// The radius of the body.
const RADIUS: f32 = 0.72;
/// How many segments it shows.
const SEGMENTS: f32 = 15.0;

/// Shapes it through all particles that are no legs, in their order, the first in front.
pub(super) fn shape(clay: &mut Clay, at: &[Vec3], rules: &Rules, columns: &Columns, sides: usize) {
    let legs: Vec<&Leg> =
        rules.iter().filter_map(|rule| if let Rule::Leg(leg) = rule { Some(leg) } else { None }).collect();
    let is_leg = |i: usize| legs.iter().any(|leg| leg.particle.index() == i);
    let spine: Vec<_> = at.iter().enumerate().filter(|(i, _)| !is_leg(*i)).map(|(_, x)| *x).collect();
    let phase = |i: usize| columns.memory().get(i).map_or(0.0, |memory| memory.x);
    // Warm while the muscle contracts, cool while it relaxes.
    let contracts = phase(0) > 0.0;
    let skin = if contracts { [tint(0xd98a3d), tint(0xf0b66a)] } else { [tint(0x7fa546), tint(0xb9d27a)] };
    if spine.len() > 2 {
        body(clay, &spine, skin, sides);
    }
    for leg in legs {
        let i = leg.particle.index();
        let Some(&foot) = at.get(i) else { continue };
        let count = phase(leg.clock.index());
        let free = match leg.free {
            Free::Contracting => 0.0 <= count,
            Free::Relaxing => count < 0.0,
        };
        let hip = nearest(&spine, foot).unwrap_or(foot + Vec3::Y);
        limb(clay, hip, foot, free, sides);
    }
}

fn nearest(spine: &[Vec3], to: Vec3) -> Option<Vec3> {
    spine.iter().copied().min_by(|a, b| a.distance_squared(to).total_cmp(&b.distance_squared(to)))
}

/// The tube with round ends, ringed, with two eyes in front.
fn body(clay: &mut Clay, spine: &[Vec3], [dark, light]: [Tint; 2], sides: usize) {
    let last = spine.len() - 1;
    let out = |end: usize, other: usize| (spine[end] - spine[other]).normalize_or(Vec3::Z);
    let (front, back) = (out(0, 2.min(last)), out(last, last - 2));
    let mut points = vec![spine[0] + front * RADIUS];
    points.extend([0.9, 0.65, 0.3].map(|part| spine[0] + front * RADIUS * part));
    points.extend(spine);
    points.extend([0.3, 0.65, 0.9, 1.0].map(|part| spine[last] + back * RADIUS * part));
    let caps = 4.0 / (points.len() - 1) as f32;
    let girth = |t: f32| {
        let from_end = t.min(1.0 - t) / caps;
        let round = if from_end < 1.0 { (1.0 - (1.0 - from_end).powi(2)).max(0.0).sqrt() } else { 1.0 };
        let ring = (t * SEGMENTS * core::f32::consts::TAU).cos();
        RADIUS * round * (0.94 + 0.06 * ring) * (1.0 - 0.18 * t) + 0.01
    };
    let color = |t: f32| {
        let ring = (t * SEGMENTS * core::f32::consts::TAU).cos() * 0.5 + 0.5;
        if t < 1.4 * caps { shade(dark, 0.8) } else { blend(dark, light, ring.powf(0.6)) }
    };
    clay.tube(&points, sides, girth, color);
    let side = front.cross(Vec3::Y).normalize_or(Vec3::X);
    let up = side.cross(front);
    for left in [-1.0, 1.0] {
        let place = spine[0] + (front * 0.62 + up * 0.42 + side * left * 0.34) * RADIUS;
        let eye = Transform::from_translation(place).with_scale(Vec3::splat(0.19 * RADIUS));
        clay.ball(eye, sides, |direction| if direction.dot(front) > 0.55 { tint(0x14110e) } else { tint(0xfaf6ea) });
    }
}

/// A stump with a foot: dark red and flat where it grips, pale and round where it is free.
fn limb(clay: &mut Clay, hip: Vec3, foot: Vec3, free: bool, sides: usize) {
    let color = if free { tint(0xe8e0c8) } else { tint(0xa3231c) };
    let place = Transform::from_translation(foot - Vec3::Y * 0.25);
    let flat = if free { Vec3::splat(0.55) } else { Vec3::new(0.95, 0.4, 0.95) };
    clay.ball(place.with_scale(flat), sides, |direction| shade(color, 0.85 + 0.2 * direction.y));
    if hip.distance(foot) > 0.1 {
        clay.tube(&[hip, 0.5 * (hip + foot), foot - Vec3::Y * 0.2], sides, |_| 0.34, |_| shade(color, 0.8));
    }
}
