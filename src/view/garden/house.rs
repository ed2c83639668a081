//! The worm's house: a cottage with a tiled roof, and a round-topped door that the worm crawls through.

use core::f32::consts::PI;

use bevy::prelude::*;
use rand::rngs::SmallRng;

use super::{between, flowers, path, roof};
use crate::{
    scenes::garden::DOOR,
    view::clay::{Clay, shade, tint},
};

pub(super) const FRONT: f32 = DOOR as f32;
pub(super) const BACK: f32 = 14.5;
/// Half the house's width.
pub(super) const SIDE: f32 = 1.9;
pub(super) const EAVES: f32 = 1.95;
pub(super) const RIDGE: f32 = 3.75;
const DOOR_HALF_WIDTH: f32 = 0.66;
/// Where the door's arch begins; its top is half a width higher.
const DOOR_SPRING: f32 = 0.86;
const WALL: f32 = 0.24;

const PLASTER: u32 = 0xf2e3c4;
const TIMBER: u32 = 0x6b4428;

/// Whether the house stands on a spot, so that no grass grows there.
pub(super) fn covers(x: f32, z: f32) -> bool {
    x > FRONT - 0.1 && x < BACK + 0.05 && z.abs() < SIDE + 0.05
}

/// The height of the gable at z.
fn gable(z: f32) -> f32 {
    RIDGE - 0.1 - (RIDGE - EAVES) * z.abs() / SIDE
}

/// The height of the door's opening at z, or zero beside it.
fn opening(z: f32) -> f32 {
    if z.abs() >= DOOR_HALF_WIDTH { 0.0 } else { DOOR_SPRING + (DOOR_HALF_WIDTH.powi(2) - z * z).sqrt() }
}

/// Everything but the window panes.
pub(super) fn house(random: &mut SmallRng) -> Clay {
    let mut clay = Clay::default();
    walls(&mut clay);
    timber(&mut clay);
    door(&mut clay, random);
    roof::roof(&mut clay, random);
    roof::chimney(&mut clay, random);
    for x in [11.25, 13.25] {
        window(&mut clay, x);
        flowers::window_box(&mut clay, Vec3::new(x, 0.78, SIDE + 0.16), random);
    }
    foundation(&mut clay, random);
    clay
}

fn walls(clay: &mut Clay) {
    let plaster = |y: f32| shade(tint(PLASTER), 0.74 + 0.26 * (y / 0.9).min(1.0));
    // The front, in upright strips around the door; the same outline inside out is what one sees of the wall's thickness.
    let edge = |i: usize| -SIDE + 2.0 * SIDE * i as f32 / 80.0;
    for i in 0..80 {
        let (l, r) = (edge(i), edge(i + 1));
        let middle = (l + r) * 0.5;
        let (low_l, low_r) = if middle.abs() < DOOR_HALF_WIDTH { (opening(l), opening(r)) } else { (0.0, 0.0) };
        let face = |z: f32, y: f32| Vec3::new(FRONT, y, z);
        for (y0l, y0r, y1l, y1r) in
            [(low_l, low_r, low_l.max(0.9), low_r.max(0.9)), (low_l.max(0.9), low_r.max(0.9), gable(l), gable(r))]
        {
            let [a, b, c, d] =
                [(l, y0l), (r, y0r), (r, y1r), (l, y1l)].map(|(z, y)| clay.vertex(face(z, y), Vec3::NEG_X, plaster(y)));
            clay.triangle(a, b, c);
            clay.triangle(a, c, d);
        }
        clay.quad(
            [
                Vec3::new(BACK, 0.0, r),
                Vec3::new(BACK, 0.0, l),
                Vec3::new(BACK, gable(l), l),
                Vec3::new(BACK, gable(r), r),
            ],
            plaster(2.0),
        );
    }
    for (side, ends) in [(SIDE, [FRONT, BACK]), (-SIDE, [BACK, FRONT])] {
        clay.grid(4, 2, |row, column| {
            let y = [0.0, 0.5, 0.9, EAVES][row];
            (Vec3::new(ends[column], y, side), Vec3::Z * side.signum(), plaster(y))
        });
    }
    // The jamb of the door and, behind it, the dark of the hall: the worm crawls into it and is gone.
    let steps = 24;
    let arch = |i: usize| {
        let t = i as f32 / steps as f32;
        if t < 0.25 {
            (-DOOR_HALF_WIDTH, DOOR_SPRING * t / 0.25)
        } else if t > 0.75 {
            (DOOR_HALF_WIDTH, DOOR_SPRING * (1.0 - t) / 0.25)
        } else {
            let turn = PI * (1.0 - (t - 0.25) / 0.5);
            (DOOR_HALF_WIDTH * turn.cos(), DOOR_SPRING + DOOR_HALF_WIDTH * turn.sin())
        }
    };
    let depths = [(0.0, 0.5), (WALL, 0.12), (WALL + 0.3, 0.012), (WALL + 0.7, 0.004)];
    clay.grid(depths.len(), steps + 1, |row, column| {
        let ((z, y), (deep, light)) = (arch(steps - column), depths[row]);
        let inward = Vec3::new(0.0, 0.6 - y, -z).normalize_or(Vec3::Y);
        (Vec3::new(FRONT + deep, y, z), inward, shade(tint(PLASTER), light))
    });
    let dark = [0.004, 0.003, 0.003, 0.0];
    let wall = FRONT + WALL + 0.7;
    clay.quad(
        [Vec3::new(wall, 0.0, -1.0), Vec3::new(wall, 0.0, 1.0), Vec3::new(wall, 2.0, 1.0), Vec3::new(wall, 2.0, -1.0)],
        dark,
    );
    clay.grid(depths.len(), 2, |row, column| {
        let z = if column == 0 { -DOOR_HALF_WIDTH } else { DOOR_HALF_WIDTH };
        (Vec3::new(FRONT + depths[row].0, 0.03, z), Vec3::Y, shade(tint(0x8a7a62), depths[row].1))
    });
}

/// The beams on the plaster.
fn timber(clay: &mut Clay) {
    let wood = tint(TIMBER);
    let mut beam = |from: Vec3, to: Vec3, thick: f32| {
        let along = to - from;
        let turn = Quat::from_rotation_arc(Vec3::Y, along.normalize());
        let place = Transform::from_translation((from + to) * 0.5).with_rotation(turn).with_scale(Vec3::new(
            thick,
            along.length(),
            thick,
        ));
        clay.block(place, wood);
    };
    let x = FRONT - 0.01;
    beam(Vec3::new(x, EAVES - 0.02, -SIDE), Vec3::new(x, EAVES - 0.02, SIDE), 0.13);
    beam(Vec3::new(x, EAVES, 0.62), Vec3::new(x, gable(0.62), 0.62), 0.1);
    beam(Vec3::new(x, EAVES, -0.62), Vec3::new(x, gable(0.62), -0.62), 0.1);
    for z in [-SIDE, SIDE] {
        for x in [FRONT, BACK] {
            beam(Vec3::new(x, 0.0, z), Vec3::new(x, EAVES - 0.02, z), 0.17);
        }
        beam(Vec3::new(12.25, 0.0, z), Vec3::new(12.25, EAVES, z), 0.1);
        beam(Vec3::new(FRONT, EAVES - 0.06, z), Vec3::new(BACK, EAVES - 0.06, z), 0.13);
        beam(Vec3::new(FRONT, 0.42, z), Vec3::new(BACK, 0.42, z), 0.09);
    }
}

/// The door's frame, its leaf standing open against the wall, a lamp, and a round window in the gable.
fn door(clay: &mut Clay, random: &mut SmallRng) {
    let mut frame: Vec<Vec3> = (0..=20)
        .map(|i| {
            let turn = PI * i as f32 / 20.0;
            Vec3::new(
                FRONT - 0.03,
                DOOR_SPRING + (DOOR_HALF_WIDTH + 0.06) * turn.sin(),
                (DOOR_HALF_WIDTH + 0.06) * turn.cos(),
            )
        })
        .collect();
    frame.insert(0, Vec3::new(FRONT - 0.03, 0.0, DOOR_HALF_WIDTH + 0.06));
    frame.push(Vec3::new(FRONT - 0.03, 0.0, -DOOR_HALF_WIDTH - 0.06));
    clay.tube(&frame, 8, |_| 0.09, |_| tint(0x7d4f2c));

    // The leaf is hinged on the side away from the viewer and stands open.
    let hinge =
        Transform::from_xyz(FRONT - 0.06, 0.04, -DOOR_HALF_WIDTH - 0.02).with_rotation(Quat::from_rotation_y(-0.5));
    let planks = 6;
    for i in 0..planks {
        let width = 2.0 * DOOR_HALF_WIDTH / planks as f32;
        let z = -width * (i as f32 + 0.5);
        let tall = opening(z + DOOR_HALF_WIDTH).max(0.9) - 0.04;
        let color = shade(tint(0x2f7f79), between(random, 0.88, 1.12));
        let place = Transform::from_xyz(0.0, tall * 0.5, z).with_scale(Vec3::new(0.07, tall, width * 0.95));
        clay.block(hinge * place, color);
    }
    for y in [0.3, 0.95] {
        let place = Transform::from_xyz(-0.045, y, -DOOR_HALF_WIDTH).with_scale(Vec3::new(
            0.03,
            0.07,
            2.0 * DOOR_HALF_WIDTH - 0.12,
        ));
        clay.block(hinge * place, tint(0x3a3230));
    }
    clay.ball(hinge * Transform::from_xyz(-0.08, 0.62, -1.16).with_scale(Vec3::splat(0.055)), 10, |_| tint(0xe0b04a));

    let ring: Vec<Vec3> = (0..=24)
        .map(|i| {
            let turn = 2.0 * PI * i as f32 / 24.0;
            Vec3::new(FRONT - 0.03, 2.62 + 0.33 * turn.sin(), 0.33 * turn.cos())
        })
        .collect();
    clay.tube(&ring, 8, |_| 0.06, |_| tint(TIMBER));
    for (tall, wide) in [(0.6, 0.045), (0.045, 0.6)] {
        clay.block(Transform::from_xyz(FRONT - 0.045, 2.62, 0.0).with_scale(Vec3::new(0.04, tall, wide)), tint(TIMBER));
    }

    let lamp = Vec3::new(FRONT - 0.2, 1.62, 1.02);
    clay.tube(
        &[Vec3::new(FRONT, 1.86, 1.02), Vec3::new(FRONT - 0.14, 1.9, 1.02), lamp + Vec3::Y * 0.14],
        6,
        |_| 0.018,
        |_| tint(0x2c2a2a),
    );
    clay.ball(Transform::from_translation(lamp).with_scale(Vec3::new(0.075, 0.1, 0.075)), 10, |_| {
        [1.6, 1.1, 0.45, 0.0]
    });
    clay.lathe(Transform::from_translation(lamp), &[(0.1, 0.08), (0.015, 0.17)], 8, |_, _| tint(0x2c2a2a));
    clay.lathe(Transform::from_translation(lamp), &[(0.0, -0.13), (0.07, -0.1), (0.07, -0.07)], 8, |_, _| {
        tint(0x2c2a2a)
    });

    clay.ball(Transform::from_xyz(FRONT - 0.28, 0.0, 0.0).with_scale(Vec3::new(0.42, 0.05, 0.95)), 20, |_| {
        tint(0xa79f92)
    });
}

/// A window on the side that one sees, with a frame, a cross and two shutters.
fn window(clay: &mut Clay, x: f32) {
    let (z, y) = (SIDE, 1.2);
    let white = tint(0xfaf3e2);
    for (at, size) in [
        (Vec3::new(x, y + 0.36, z), Vec3::new(0.82, 0.08, 0.12)),
        (Vec3::new(x, y - 0.36, z), Vec3::new(0.9, 0.09, 0.2)),
        (Vec3::new(x - 0.38, y, z), Vec3::new(0.08, 0.72, 0.12)),
        (Vec3::new(x + 0.38, y, z), Vec3::new(0.08, 0.72, 0.12)),
        (Vec3::new(x, y, z), Vec3::new(0.045, 0.7, 0.09)),
        (Vec3::new(x, y, z), Vec3::new(0.72, 0.045, 0.09)),
    ] {
        clay.block(Transform::from_translation(at).with_scale(size), white);
    }
    for side in [-1.0, 1.0] {
        let middle = Vec3::new(x + side * 0.6, y, z + 0.04);
        clay.block(Transform::from_translation(middle).with_scale(Vec3::new(0.34, 0.76, 0.05)), tint(0x2f7f79));
        for i in 0..5 {
            let slat = middle + Vec3::new(0.0, -0.26 + 0.13 * i as f32, 0.03);
            clay.block(
                Transform::from_translation(slat)
                    .with_rotation(Quat::from_rotation_x(0.4))
                    .with_scale(Vec3::new(0.26, 0.07, 0.03)),
                tint(0x3d968e),
            );
        }
    }
}

fn foundation(clay: &mut Clay, random: &mut SmallRng) {
    let mut along = |from: Vec3, to: Vec3| {
        let length = from.distance(to);
        let mut done = 0.1;
        while done < length {
            let size = between(random, 0.14, 0.24);
            let at = from.lerp(to, done / length) + Vec3::Y * between(random, 0.02, 0.1);
            let color = path::stone(random);
            path::pebble(clay, at, Vec3::new(size, size * 0.75, size * 0.6), 9, shade(color, 0.9), random);
            done += size * 1.35;
        }
    };
    for side in [SIDE, -SIDE] {
        along(Vec3::new(FRONT, 0.0, side), Vec3::new(BACK, 0.0, side));
        along(Vec3::new(FRONT, 0.0, side), Vec3::new(FRONT, 0.0, side.signum() * (DOOR_HALF_WIDTH + 0.12)));
    }
}

/// The panes of the windows.
pub(super) fn panes() -> Clay {
    let mut clay = Clay::default();
    for x in [11.25, 13.25] {
        let (z, color) = (SIDE + 0.012, tint(0x35566b));
        let corners =
            [(-0.36, -0.34), (0.36, -0.34), (0.36, 0.34), (-0.36, 0.34)].map(|(dx, dy)| Vec3::new(x + dx, 1.2 + dy, z));
        clay.quad(corners, color);
        let glow = [
            Vec3::new(x - 0.3, 1.42, z + 0.004),
            Vec3::new(x - 0.1, 1.42, z + 0.004),
            Vec3::new(x + 0.06, 1.54, z + 0.004),
            Vec3::new(x - 0.16, 1.54, z + 0.004),
        ];
        clay.quad(glow, tint(0x8fb4c4));
    }
    clay.lathe(
        Transform::from_xyz(FRONT - 0.012, 2.62, 0.0).with_rotation(Quat::from_rotation_z(PI * 0.5)),
        &[(0.33, 0.0), (0.0, 0.001)],
        24,
        |_, _| tint(0x3b5f74),
    );
    clay
}
