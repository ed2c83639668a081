//! What blooms: the two flower pots, the window boxes, the flowers in the grass, and a few mushrooms.

use core::f32::consts::{PI, TAU};

use bevy::prelude::*;
use rand::{RngExt, rngs::SmallRng};

use super::{MIDDLE, between, burrow, house, lawn, path};
use crate::view::{
    clay::{Clay, Tint, blend, shade, swaying, tint},
    quality::Quality,
};

/// Where the two pots stand, and how large they are.
pub(crate) const POTS: [(Vec3, f32); 2] = [(Vec3::new(9.15, 0.0, -1.75), 1.0), (Vec3::new(4.1, 0.0, -1.65), 0.86)];

const PETALS: [u32; 5] = [0xf4517a, 0xffd23f, 0xf7f3ff, 0x9a5be0, 0xff7a3c];

/// The pots, without what grows in them.
pub(super) fn pots() -> Clay {
    let mut clay = Clay::default();
    for (at, size) in POTS {
        let place = Transform::from_translation(at).with_scale(Vec3::splat(size));
        let profile = [
            (0.0, 0.01),
            (0.32, 0.01),
            (0.35, 0.05),
            (0.47, 0.6),
            (0.55, 0.6),
            (0.57, 0.64),
            (0.57, 0.76),
            (0.54, 0.8),
            (0.48, 0.78),
            (0.46, 0.68),
        ];
        clay.lathe(place, &profile, 28, |part, _| {
            let light = [0.6, 0.65, 0.75, 0.85, 0.8, 1.05, 1.08, 1.1, 0.8, 0.4][part];
            shade(tint(0xc96a3f), light)
        });
        clay.lathe(place, &[(0.47, 0.7), (0.0, 0.74)], 20, |_, _| tint(0x4a3222));
        clay.lathe(place, &[(0.56, 0.0), (0.6, 0.07), (0.52, 0.07)], 28, |_, _| tint(0xb05a34));
    }
    clay
}

/// What grows in the pots.
pub(super) fn bouquets(random: &mut SmallRng) -> Clay {
    let mut clay = Clay::default();
    for (pot, (at, size)) in POTS.into_iter().enumerate() {
        let soil = at + Vec3::Y * (0.7 * size);
        for i in 0..26 {
            let around = i as f32 * 2.4;
            let foot = soil + Vec3::new(around.cos(), 0.0, around.sin()) * between(random, 0.1, 0.42) * size;
            leaf(&mut clay, foot, around, between(random, 0.28, 0.5) * size, random);
        }
        for i in 0..11 {
            let around = i as f32 * 2.4 + pot as f32;
            let spread = 0.42 * ((i as f32 + 0.4) / 11.0).sqrt();
            let foot = soil + Vec3::new(around.cos(), 0.0, around.sin()) * spread * 0.6 * size;
            let tall = (between(random, 0.62, 0.85) - spread * 0.55) * size;
            let top = foot + Vec3::new(around.cos() * spread * 1.15, tall, around.sin() * spread * 1.15);
            let petals = tint(PETALS[(i + pot * 2) % if pot == 0 { 4 } else { 5 }]);
            flower(&mut clay, foot, top, 0.17 * size, petals, random);
        }
    }
    clay
}

/// A box of small flowers under a window, `at` its upper middle.
pub(super) fn window_box(clay: &mut Clay, at: Vec3, random: &mut SmallRng) {
    clay.block(Transform::from_translation(at - Vec3::Y * 0.09).with_scale(Vec3::new(0.86, 0.2, 0.24)), tint(0x8a5a36));
    for i in 0..9 {
        let x = -0.38 + 0.095 * i as f32;
        let top = at + Vec3::new(x, between(random, 0.06, 0.16), between(random, -0.05, 0.14));
        let leaves = Transform::from_translation(top - Vec3::Y * 0.07).with_scale(Vec3::splat(0.085));
        clay.ball(leaves, 7, |direction| shade(tint(0x4c8a34), 0.8 + 0.3 * direction.y));
        let bloom = Transform::from_translation(top).with_scale(Vec3::new(0.055, 0.045, 0.055));
        let color = tint(PETALS[[0, 2, 1][i % 3]]);
        clay.ball(bloom, 7, |_| color);
    }
}

/// A pointed leaf that bends outwards.
fn leaf(clay: &mut Clay, foot: Vec3, around: f32, length: f32, random: &mut SmallRng) {
    let out = Vec3::new(around.cos(), 0.0, around.sin());
    let across = Vec3::new(-out.z, 0.0, out.x);
    let color = shade(blend(tint(0x3f7d2c), tint(0x7fb545), random.random()), between(random, 0.9, 1.1));
    let rise = between(random, 0.35, 1.0);
    let steps = 6;
    clay.grid(steps + 1, 3, |row, column| {
        let t = row as f32 / steps as f32;
        let u = column as f32 - 1.0;
        let spine = foot + out * (length * t) + Vec3::Y * (length * (1.6 * rise * t - (0.5 + rise) * t * t));
        let half = length * 0.2 * (PI * t.powf(0.75)).sin().max(0.0);
        let at = spine + across * (half * u) + Vec3::Y * (half * 0.35 * u.abs());
        let normal = (Vec3::Y - out * 0.3 + across * (0.3 * u)).normalize();
        (at, normal, swaying(shade(color, if column == 1 { 0.85 } else { 1.05 }), 0.03 * t))
    });
}

/// A flower on a bent stem.
fn flower(clay: &mut Clay, foot: Vec3, top: Vec3, size: f32, petals: Tint, random: &mut SmallRng) {
    let green = tint(0x5a9a3a);
    let reach = 0.06 * (top.y - foot.y);
    let stem: Vec<Vec3> = (0..=5)
        .map(|i| {
            let t = i as f32 / 5.0;
            foot.lerp(top, t) + Vec3::Y * (0.12 * (top.y - foot.y) * (PI * t).sin())
        })
        .collect();
    clay.tube(&stem, 5, |t| size * (0.1 - 0.03 * t), |t| swaying(green, reach * t * t));
    let lean = ((top - foot).normalize() + Vec3::new(0.0, 0.25, 0.5)).normalize();
    let place = Transform::from_translation(top)
        .with_rotation(Quat::from_rotation_arc(Vec3::Y, lean) * Quat::from_rotation_y(between(random, 0.0, TAU)));
    let count = 7;
    for i in 0..count {
        let around = TAU * i as f32 / count as f32;
        let turn = Quat::from_rotation_y(around);
        let petal = Transform::from_translation(turn * Vec3::new(size * 0.62, size * 0.06, 0.0))
            .with_rotation(turn * Quat::from_rotation_z(0.28))
            .with_scale(Vec3::new(size * 0.52, size * 0.1, size * 0.32));
        clay.ball(place * petal, 8, |direction| swaying(shade(petals, 0.86 + 0.14 * direction.x), reach));
    }
    let heart = if petals[2] < 0.2 && petals[0] > 0.8 { tint(0x8a4a1c) } else { tint(0xffc62e) };
    let middle =
        place * Transform::from_xyz(0.0, size * 0.12, 0.0).with_scale(Vec3::new(size * 0.3, size * 0.2, size * 0.3));
    clay.ball(middle, 8, |_| swaying(heart, reach));
}

/// Daisies, poppies and bluebells in the grass.
pub(super) fn meadow(random: &mut SmallRng, quality: Quality) -> Clay {
    let mut clay = Clay::default();
    for _ in 0..quality.meadow_flowers() {
        let out = 1.2 + 20.0 * random.random::<f32>().powf(1.2);
        let around = between(random, 0.0, TAU);
        let at = MIDDLE + Vec2::new(around.cos() * 1.35, around.sin()) * out;
        if path::distance(at.x, at.y) < 0.3 || house::covers(at.x, at.y) || burrow::covers(at.x, at.y) {
            continue;
        }
        let foot = Vec3::new(at.x, lawn::height(at.x, at.y), at.y);
        let top =
            foot + Vec3::new(between(random, -0.06, 0.06), between(random, 0.26, 0.44), between(random, -0.06, 0.06));
        let petals = tint([0xfdfbf2, 0xfdfbf2, 0xffdf4d, 0xe8483b, 0x7f8cf0][random.random_range(0..5)]);
        small_flower(&mut clay, foot, top, between(random, 0.06, 0.1), petals);
    }
    clay
}

/// A flower seen from afar: a stem, a ring of flat petals, a heart.
fn small_flower(clay: &mut Clay, foot: Vec3, top: Vec3, size: f32, petals: Tint) {
    let reach = 0.07;
    let stem = swaying(tint(0x5a9a3a), reach);
    let [a, b, c] = [(foot - Vec3::X * 0.012, 0.0), (foot + Vec3::X * 0.012, 0.0), (top, reach)]
        .map(|(at, reach)| clay.vertex(at, Vec3::Y, swaying(stem, reach)));
    clay.triangle(a, b, c);
    let tilt = Quat::from_rotation_x(0.45);
    let middle = clay.vertex(top + Vec3::Y * (size * 0.3), Vec3::Y, swaying(shade(petals, 0.8), reach));
    let count = 10;
    let ring: Vec<u32> = (0..=count)
        .map(|i| {
            let around = TAU * i as f32 / count as f32;
            let out = if i % 2 == 0 { 1.15 } else { 0.72 };
            let at = top + tilt * Vec3::new(around.cos() * size * out, 0.0, -around.sin() * size * out);
            clay.vertex(at, Vec3::Y, swaying(petals, reach))
        })
        .collect();
    for pair in ring.windows(2) {
        clay.triangle(middle, pair[0], pair[1]);
    }
    let heart: Vec<u32> = (0..6)
        .map(|i| {
            let around = -TAU * i as f32 / 6.0;
            let at = top + tilt * Vec3::new(around.cos() * size * 0.36, size * 0.33, around.sin() * size * 0.36);
            clay.vertex(at, Vec3::Y, swaying(tint(0xf6b81f), reach))
        })
        .collect();
    for pair in heart[1..].windows(2) {
        clay.triangle(heart[0], pair[0], pair[1]);
    }
}

/// Three families of mushrooms.
pub(super) fn mushrooms(random: &mut SmallRng) -> Clay {
    let mut clay = Clay::default();
    for (at, count) in [(Vec2::new(1.4, -1.75), 4), (Vec2::new(7.0, 1.5), 3), (Vec2::new(-1.4, 1.75), 4)] {
        for i in 0..count {
            let around = TAU * i as f32 / count as f32 + at.x;
            let size = between(random, 0.16, 0.34);
            let foot = at + Vec2::from_angle(around) * between(random, 0.14, 0.3);
            let place = Transform::from_xyz(foot.x, 0.0, foot.y)
                .with_rotation(Quat::from_rotation_z(between(random, -0.16, 0.16)))
                .with_scale(Vec3::splat(size));
            clay.lathe(place, &[(0.26, 0.0), (0.2, 0.5), (0.22, 1.0)], 12, |_, _| tint(0xf3e8d2));
            let cap: Vec<(f32, f32)> = (0..=8)
                .map(|i| {
                    let turn = PI * 0.5 * i as f32 / 8.0;
                    (0.72 * turn.cos(), 0.9 + 0.62 * turn.sin())
                })
                .collect();
            clay.lathe(place, &[(0.2, 0.98), (0.72, 0.9)], 16, |_, _| tint(0xcdb69a));
            clay.lathe(place, &cap, 18, |_, _| tint(0xd8392b));
            for (round, up) in
                [(0.3, 0.9), (1.5, 0.55), (2.7, 0.75), (3.9, 0.5), (5.1, 0.8), (0.9, 0.3), (2.1, 0.25), (4.5, 0.3)]
            {
                let (round, up): (f32, f32) = (round, up * PI * 0.5);
                let spot =
                    Vec3::new(0.72 * up.cos() * round.cos(), 0.9 + 0.62 * up.sin(), 0.72 * up.cos() * round.sin());
                let place = place * Transform::from_translation(spot).with_scale(Vec3::splat(0.085));
                clay.ball(place, 6, |_| tint(0xfff6e6));
            }
        }
    }
    clay
}
