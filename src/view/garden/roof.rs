//! The roof of the worm's house: scalloped tiles, and a chimney of bricks.

use core::f32::consts::PI;

use bevy::prelude::*;
use rand::rngs::SmallRng;

use super::{
    between,
    house::{BACK, EAVES, FRONT, RIDGE, SIDE},
};
use crate::view::clay::{Clay, Tint, blend, shade, tint};

/// How far the roof stands out over the walls.
const OVERHANG: f32 = 0.38;

/// Two slopes of scalloped tiles over a slab.
pub(super) fn roof(clay: &mut Clay, random: &mut SmallRng) {
    let (from, to) = (FRONT - OVERHANG, BACK + OVERHANG);
    let half = SIDE + OVERHANG;
    let drop = (RIDGE - EAVES) / SIDE * half;
    for side in [-1.0, 1.0] {
        let slope = Vec3::new(0.0, -drop, side * half);
        let (length, down) = (slope.length(), slope.normalize());
        let out = if side > 0.0 { Vec3::X.cross(down) * -1.0 } else { Vec3::X.cross(down) };
        let out = if out.y < 0.0 { -out } else { out };
        let ridge = Vec3::new((from + to) * 0.5, RIDGE, 0.0);
        let turn = Quat::from_mat3(&Mat3::from_cols(Vec3::X, out, Vec3::X.cross(out)));
        let slab = Transform::from_translation(ridge + down * (length * 0.5) - out * 0.05)
            .with_rotation(turn)
            .with_scale(Vec3::new(to - from, 0.12, length));
        clay.block(slab, tint(0x6e4630));
        let (rows, tiles) = (11, 20);
        let (depth, width) = (length / rows as f32, (to - from) / tiles as f32);
        for row in 0..rows {
            for tile in 0..=tiles {
                let offset = if row % 2 == 0 { 0.0 } else { 0.5 };
                let x = from + (tile as f32 + offset) * width;
                if x > to - width * 0.4 || x < from + width * 0.1 {
                    continue;
                }
                let color =
                    shade(blend(tint(0xb4512f), tint(0xd0744a), between(random, 0.0, 1.0)), between(random, 0.85, 1.1));
                let start = ridge.with_x(x) + down * (depth * row as f32 - 0.02);
                roof_tile(clay, start, down, out, Vec2::new(width * 0.97, depth * 1.25), color);
            }
        }
    }
    let top: Vec<Vec3> =
        (0..=12).map(|i| Vec3::new(from - 0.04 + (to - from + 0.08) * i as f32 / 12.0, RIDGE + 0.02, 0.0)).collect();
    clay.tube(&top, 8, |t| 0.11 + 0.018 * ((t * 12.0 * PI).cos()).abs(), |_| tint(0xa9492a));
    for x in [from, to] {
        for side in [-1.0, 1.0] {
            let ends = [Vec3::new(x, RIDGE - 0.04, 0.0), Vec3::new(x, RIDGE - drop - 0.04, side * half)];
            let along = ends[1] - ends[0];
            let place = Transform::from_translation((ends[0] + ends[1]) * 0.5)
                .with_rotation(Quat::from_rotation_arc(Vec3::Y, along.normalize()))
                .with_scale(Vec3::new(0.08, along.length(), 0.2));
            clay.block(place, tint(0x8a5a36));
        }
    }
}

/// One tile: a gently arched shingle with a rounded end, lifted at its lower edge.
fn roof_tile(clay: &mut Clay, start: Vec3, down: Vec3, out: Vec3, size: Vec2, color: Tint) {
    let across = out.cross(down);
    let columns = 5;
    clay.grid(3, columns, |row, column| {
        let u = column as f32 / (columns - 1) as f32 * 2.0 - 1.0;
        let v = row as f32 * 0.5;
        let round = if row == 2 { 1.0 - 0.22 * u * u } else { v };
        let along = if row == 2 { round } else { v * 1.3 };
        let at = start - across * (u * size.x * 0.5)
            + down * (size.y * along)
            + out * (0.02 + 0.045 * v + 0.03 * (1.0 - u * u));
        let normal = (out - across * (u * 0.35)).normalize();
        (at, normal, shade(color, if row == 2 { 1.08 } else { 0.72 + 0.3 * v }))
    });
}

/// The chimney, of bricks.
pub(super) fn chimney(clay: &mut Clay, random: &mut SmallRng) {
    let at = Vec3::new(13.3, 0.0, 0.85);
    clay.cuboid(at + Vec3::new(-0.25, 2.4, -0.25), at + Vec3::new(0.25, 4.3, 0.25), tint(0x8f5b45));
    let mut y = 2.75;
    while y < 4.25 {
        for face in 0..4 {
            let turn = Quat::from_rotation_y(face as f32 * PI * 0.5);
            for i in 0..2 {
                let along = -0.125 + 0.25 * i as f32 + if (y * 10.0) as i32 % 2 == 0 { 0.04 } else { -0.04 };
                let place = Transform::from_translation(at + turn * Vec3::new(along, y, 0.245))
                    .with_rotation(turn)
                    .with_scale(Vec3::new(0.2, 0.1, 0.04));
                clay.block(place, shade(tint(0xa9644a), between(random, 0.8, 1.15)));
            }
        }
        y += 0.15;
    }
    clay.cuboid(at + Vec3::new(-0.33, 4.26, -0.33), at + Vec3::new(0.33, 4.4, 0.33), tint(0x9c8f80));
    clay.lathe(
        Transform::from_translation(at + Vec3::Y * 4.4),
        &[(0.15, 0.0), (0.12, 0.28), (0.15, 0.3), (0.09, 0.3)],
        12,
        |_, _| tint(0xb5643c),
    );
}
