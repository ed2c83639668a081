//! What closes the view: sky, clouds, hills, trees and a fence.

use core::f32::consts::TAU;

use bevy::prelude::*;
use rand::{RngExt, rngs::SmallRng};

use super::{MIDDLE, between, lawn};
use crate::view::{
    clay::{Clay, Tint, blend, shade, tint},
    quality::Quality,
};

/// The dome of the sky, from haze at the horizon to blue overhead.
pub(in crate::view) fn sky() -> Clay {
    let mut clay = Clay::default();
    let (rows, columns) = (24, 49);
    let bands = [(0.0, 0xd9ecf2), (0.06, 0xbfe2f2), (0.2, 0x8fcdf0), (0.5, 0x55aae6), (1.0, 0x2f7fcf)]
        .map(|(up, code)| (up, tint(code)));
    clay.grid(rows, columns, |row, column| {
        let up: f32 = -0.15 + 1.15 * (row as f32 / (rows - 1) as f32).powf(1.4);
        let flat = (1.0 - up * up).max(0.0).sqrt();
        let around = -TAU * column as f32 / (columns - 1) as f32;
        let direction = Vec3::new(flat * around.cos(), up, -flat * around.sin());
        let band = bands.windows(2).find(|pair| up <= pair[1].0).unwrap_or(&bands[3..]);
        let color = blend(band[0].1, band[1].1, ((up - band[0].0) / (band[1].0 - band[0].0)).clamp(0.0, 1.0));
        // Already through the eyes' curve once: shown brighter to come out as chosen.
        (Vec3::new(MIDDLE.x, 0.0, 0.0) + direction * 180.0, -direction, shade(color, 0.95))
    });
    clay
}

/// Heaps of soft balls with flat feet, behind the hills.
pub(in crate::view) fn clouds(random: &mut SmallRng, quality: Quality) -> Clay {
    let mut clay = Clay::default();
    for i in 0..13 {
        let around = TAU * (i as f32 + between(random, -0.3, 0.3)) / 13.0;
        let (out, up) = (
            between(random, 142.0, 162.0),
            if i % 3 == 0 { between(random, 40.0, 65.0) } else { between(random, 17.0, 33.0) },
        );
        let at = Vec3::new(around.cos() * out, up, around.sin() * out);
        let across = Vec3::new(-around.sin(), 0.0, around.cos());
        let size = between(random, 3.6, 6.2);
        for puff in 0..9 {
            let t = puff as f32 / 8.0 * 2.0 - 1.0;
            let big = size * (1.15 - 0.75 * t * t) * between(random, 0.75, 1.1);
            let place = at + across * (t * size * 3.1) + Vec3::Y * between(random, 0.0, big * 0.35);
            let flat = Transform::from_translation(place).with_scale(Vec3::new(big, big * 0.72, big));
            clay.ball(flat, quality.roundness(), |direction| shade(tint(0xfbfcff), 0.86 + 0.2 * direction.y));
        }
    }
    clay
}

/// Two rows of hills, the further the paler, with so many trees on each.
pub(in crate::view) fn hills(random: &mut SmallRng, quality: Quality, trees: usize) -> Clay {
    let mut clay = Clay::default();
    for (count, out, low, high, code) in [(15, 126.0, 8.0, 14.0, 0x6f9a6a_u32), (13, 96.0, 4.0, 8.0, 0x6fa54a)] {
        for i in 0..count {
            let around = TAU * (i as f32 + between(random, -0.3, 0.3)) / count as f32;
            let foot = Vec3::new(MIDDLE.x + around.cos() * out, -0.5, around.sin() * out);
            let hill = Hill { foot, radius: between(random, 30.0, 44.0), height: between(random, low, high) };
            let color = shade(tint(code), between(random, 0.85, 1.1));
            hill.heap(&mut clay, quality.roundness() + 6, color);
            for _ in 0..trees {
                let (turn, part) = (between(random, 0.0, TAU), between(random, 0.1, 0.6));
                let foot = hill.at(Vec2::from_angle(turn) * part).0 - Vec3::Y * 0.1;
                tree(&mut clay, foot, between(random, 1.2, 2.2), quality.roundness() / 2, random);
            }
        }
    }
    clay
}

/// A round hill that goes over into the plain: (1 − ρ²)² of its height at the part ρ of its radius.
struct Hill {
    foot: Vec3,
    radius: f32,
    height: f32,
}

impl Hill {
    /// A spot of its surface, in parts of its radius from its middle, and the normal there.
    fn at(&self, spot: Vec2) -> (Vec3, Vec3) {
        let rest = (1.0 - spot.length_squared()).max(0.0);
        let up = self.height * rest * rest;
        let fall = 4.0 * self.height * rest / self.radius;
        (
            self.foot + Vec3::new(self.radius * spot.x, up, self.radius * spot.y),
            Vec3::new(fall * spot.x, 1.0, fall * spot.y).normalize(),
        )
    }

    fn heap(&self, clay: &mut Clay, sides: usize, color: Tint) {
        let (spokes, rings) = (2 * sides, sides);
        clay.grid(spokes + 1, rings, |spoke, ring| {
            let turn = Vec2::from_angle(-TAU * spoke as f32 / spokes as f32);
            let (place, normal) = self.at(turn * (ring as f32 / (rings - 1) as f32));
            (place, normal, shade(color, 0.8 + 0.2 * (place.y - self.foot.y) / self.height))
        });
    }
}

/// How many trees stand around the garden, and into how many meshes they go, so that those behind the viewer cost nothing.
const TREES: usize = 46;
const SECTORS: usize = 8;

/// Round trees all around the garden.
pub(super) fn trees(random: &mut SmallRng, quality: Quality) -> Vec<Clay> {
    let mut sectors: Vec<_> = (0..SECTORS).map(|_| Clay::default()).collect();
    for i in 0..TREES {
        let around = TAU * (i as f32 + between(random, -0.45, 0.45)) / TREES as f32;
        // In front of the camera's usual place it stays open.
        let front = around.sin().max(0.0);
        let out = between(random, 21.0, 44.0) + 16.0 * front;
        let (x, z) = (MIDDLE.x + around.cos() * out, around.sin() * out);
        tree(
            &mut sectors[i * SECTORS / TREES],
            Vec3::new(x, lawn::height(x, z) - 0.1, z),
            between(random, 0.8, 1.45),
            quality.roundness(),
            random,
        );
    }
    // Three old friends that frame the house.
    for (x, z, size) in [(17.2, -4.2, 1.15), (-7.6, -6.2, 1.0), (1.2, -9.6, 0.85)] {
        tree(
            &mut sectors[SECTORS * 3 / 4],
            Vec3::new(x, lawn::height(x, z) - 0.05, z),
            size,
            quality.roundness() + 4,
            random,
        );
    }
    sectors
}

fn tree(clay: &mut Clay, foot: Vec3, size: f32, sides: usize, random: &mut SmallRng) {
    let top = foot + Vec3::Y * (2.6 * size);
    let bark = tint(0x6f4c30);
    clay.tube(
        &[foot, foot.lerp(top, 0.3), top],
        9,
        |t| size * (0.32 - 0.2 * t) * (1.0 + 0.5 * (1.0 - t).powi(6)),
        |t| shade(bark, 0.7 + 0.4 * t),
    );
    let leaves = blend(tint(0x3f7a2e), tint(0x84ac3a), random.random());
    for i in 0..7 {
        let around = TAU * i as f32 / 6.0 + foot.x;
        let (out, up) = if i == 6 { (0.0, 1.25) } else { (0.95, between(random, 0.0, 0.7)) };
        let at = top + Vec3::new(around.cos() * out, up, around.sin() * out) * size;
        let big = size * between(random, 0.9, 1.3);
        let place = Transform::from_translation(at).with_scale(Vec3::new(big, big * 0.86, big));
        crown(clay, place, sides, leaves);
    }
}

/// One round of a tree's crown: lumpy, darker below.
fn crown(clay: &mut Clay, place: Transform, sides: usize, leaves: Tint) {
    clay.ball(place, sides, |direction| {
        let lumps = (direction.x * 9.0).sin() * (direction.y * 8.0 + 1.0).sin() * (direction.z * 9.0 + 2.0).sin();
        shade(leaves, 0.8 + 0.26 * direction.y + 0.2 * lumps)
    });
}

/// A picket fence around the back of the garden.
pub(super) fn fence(random: &mut SmallRng) -> Clay {
    let mut clay = Clay::default();
    let corners = [Vec2::new(-7.5, 1.0), Vec2::new(-7.5, -4.6), Vec2::new(17.0, -4.6), Vec2::new(17.0, 1.0)];
    for side in corners.windows(2) {
        let (from, to) = (side[0], side[1]);
        let length = from.distance(to);
        let along = (to - from) / length;
        let turn = Quat::from_rotation_y(-along.to_angle());
        let count = (length / 0.34) as usize;
        for i in 0..=count {
            let at = from + along * (0.34 * i as f32);
            let ground = lawn::height(at.x, at.y);
            let tall = 0.82 + between(random, -0.03, 0.03);
            let color = shade(tint(0xf4efe4), between(random, 0.88, 1.0));
            let lean = Quat::from_rotation_x(between(random, -0.03, 0.03));
            let place = Transform::from_xyz(at.x, ground + tall * 0.5, at.y).with_rotation(turn * lean);
            clay.block(place.with_scale(Vec3::new(0.15, tall, 0.045)), color);
            let tip = place
                * Transform::from_xyz(0.0, tall * 0.5, 0.0)
                    .with_rotation(Quat::from_rotation_z(TAU / 8.0))
                    .with_scale(Vec3::new(0.106, 0.106, 0.044));
            clay.block(tip, color);
        }
        let middle = (from + to) * 0.5;
        for y in [0.28, 0.62] {
            let ground = lawn::height(middle.x, middle.y);
            let place = Transform::from_xyz(middle.x, ground + y, middle.y).with_rotation(turn);
            let behind = place * Transform::from_xyz(0.0, 0.0, -0.04);
            clay.block(behind.with_scale(Vec3::new(length, 0.09, 0.04)), tint(0xe8e2d4));
        }
    }
    clay
}
