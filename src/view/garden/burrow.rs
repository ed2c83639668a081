//! The little mound of earth out of which the worm comes.

use core::f32::consts::TAU;

use bevy::prelude::*;
use rand::rngs::SmallRng;

use super::{between, path};
use crate::{
    scenes::garden::BURROW_MOUTH,
    view::clay::{Clay, blend, shade, swaying, tint},
};

const MOUTH: f32 = BURROW_MOUTH as f32;
const BACK: f32 = -5.9;
/// The radius of the tunnel, wide enough for the worm at its thickest.
const TUNNEL: f32 = 0.6;
/// How high above the ground the middle of the tunnel is.
const AXIS: f32 = 0.42;

/// The mound's outer radius at x.
fn radius(x: f32) -> f32 {
    let t = ((x - BACK) / (MOUTH - BACK)).clamp(0.0, 1.0);
    let rise = (t * 1.5).min(1.0);
    (1.0 - (1.0 - rise).powi(2)).sqrt() * 1.28 - 0.32 * ((t - 0.72) / 0.28).clamp(0.0, 1.0).powi(2)
}

/// Whether the mound stands on a spot, so that no grass grows there.
pub(super) fn covers(x: f32, z: f32) -> bool {
    x > BACK && x < MOUTH && z.abs() < radius(x) * 0.93
}

/// The mound with its mouth, its rim of stones and the tufts on its back.
pub(super) fn burrow(random: &mut SmallRng) -> Clay {
    let mut clay = Clay::default();
    let (earth, moss) = (tint(0x7a5534), tint(0x6d8a35));
    let (rows, columns) = (26, 41);
    let bump =
        |x: f32, around: f32| 1.0 + 0.05 * (around * 5.0 + x * 2.0).sin() + 0.035 * (around * 9.0 - x * 4.3).sin();
    let surface = |x: f32, around: f32| {
        let out = radius(x) * bump(x, around);
        Vec3::new(x, AXIS * ((x - BACK) * 0.8).clamp(0.0, 1.0) + out * around.sin() * 0.86, out * around.cos())
    };
    clay.grid(rows, columns, |row, column| {
        let x = BACK + (MOUTH - BACK) * (row as f32 / (rows - 1) as f32).powf(0.8);
        let around = -TAU * (column as f32 / (columns - 1) as f32);
        let (e, at) = (0.02, surface(x, around));
        let normal = (surface(x, around + e) - surface(x, around - e))
            .cross(surface((x + e).min(MOUTH), around) - surface((x - e).max(BACK), around))
            .normalize_or(Vec3::NEG_X);
        let normal = if normal.dot(Vec3::new(0.0, around.sin(), around.cos())) < 0.0 { -normal } else { normal };
        let mossy = (normal.y * 1.6 - 0.45).clamp(0.0, 1.0) * (0.65 + 0.35 * (x * 6.0 + around * 7.0).sin());
        let color = shade(blend(earth, moss, mossy), 0.75 + 0.3 * (at.y / 1.4).clamp(0.0, 1.0));
        (at, normal, color)
    });
    // The front: a ring of bare earth around the mouth, then the tunnel, ever darker.
    let rings = [
        (MOUTH, radius(MOUTH), 0.7),
        (MOUTH + 0.06, TUNNEL * 1.22, 0.75),
        (MOUTH - 0.05, TUNNEL, 0.42),
        (MOUTH - 0.6, TUNNEL * 0.96, 0.05),
        (MOUTH - 1.2, 0.0, 0.008),
    ];
    clay.grid(rings.len(), columns, |row, column| {
        let (x, out, light) = rings[row];
        let around = -TAU * (column as f32 / (columns - 1) as f32);
        let flat = if row == 0 { 0.86 * bump(MOUTH, around) } else { 1.0 };
        let wide = if row == 0 { bump(MOUTH, around) } else { 1.0 };
        let at = Vec3::new(x, AXIS + out * around.sin() * flat, out * around.cos() * wide);
        let inward = Vec3::new(0.0, -around.sin(), -around.cos());
        let normal = if row < 2 { Vec3::X } else { (inward + Vec3::X * 0.3).normalize() };
        (at, normal, shade(earth, light))
    });
    for i in 0..15 {
        let around = -0.25 + (core::f32::consts::PI + 0.5) * i as f32 / 14.0;
        let size = between(random, 0.12, 0.19);
        let at = Vec3::new(MOUTH + 0.03, AXIS + around.sin() * (TUNNEL + 0.17), around.cos() * (TUNNEL + 0.17));
        let color = path::stone(random);
        path::pebble(&mut clay, at, Vec3::new(size, size * 0.85, size), 9, color, random);
    }
    for _ in 0..240 {
        let (x, around) = (between(random, BACK + 0.5, MOUTH - 0.1), between(random, 0.35, 2.8));
        tuft(&mut clay, surface(x, around) - Vec3::Y * 0.03, random);
    }
    clay
}

/// Three short blades of grass, drawn from both sides.
fn tuft(clay: &mut Clay, root: Vec3, random: &mut SmallRng) {
    let color = shade(blend(tint(0x55902f), tint(0x9cbf45), between(random, 0.0, 1.0)), between(random, 0.8, 1.1));
    for _ in 0..3 {
        let turn = Vec2::from_angle(between(random, 0.0, TAU));
        let across = Vec3::new(turn.x, 0.0, turn.y) * 0.022;
        let lean = Vec3::new(-turn.y, 0.0, turn.x) * between(random, 0.03, 0.12);
        let tip = root + Vec3::Y * between(random, 0.12, 0.26) + lean;
        let [a, b] = [root - across, root + across].map(|foot| clay.vertex(foot, Vec3::Y, shade(color, 0.6)));
        let c = clay.vertex(tip, Vec3::Y, swaying(shade(color, 1.15), 0.05));
        clay.triangle(a, b, c);
        clay.triangle(b, a, c);
    }
}
