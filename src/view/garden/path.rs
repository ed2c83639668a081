//! The gravel path from the burrow to the door.

use bevy::prelude::*;
use rand::{RngExt, rngs::SmallRng};

use super::between;
use crate::{
    scenes::garden::{BURROW_MOUTH, DOOR},
    view::{
        clay::{Clay, Tint, blend, shade, tint},
        quality::Quality,
    },
};

const START: f32 = BURROW_MOUTH as f32 - 0.2;
const END: f32 = DOOR as f32;

/// Half the width of the path at x: it wavers a little and widens before the door.
fn half_width(x: f32) -> f32 {
    0.72 + 0.07 * (x * 1.7).sin() + 0.05 * (x * 4.1 + 1.0).sin() + 0.25 * ((x - 8.6) / 1.4).clamp(0.0, 1.0)
}

/// How far a spot is from the path's edge; negative on the path.
pub(super) fn distance(x: f32, z: f32) -> f32 {
    let beyond = (START - x).max(x - END).max(0.0);
    let aside = z.abs() - half_width(x.clamp(START, END));
    if beyond > 0.0 { beyond.max(aside) } else { aside }
}

/// A stone's colour: greys and sands.
pub(super) fn stone(random: &mut SmallRng) -> Tint {
    let sand = blend(tint(0xb9a98c), tint(0x9a948a), random.random());
    shade(sand, between(random, 0.75, 1.2))
}

/// Half a pebble or a boulder, lying at `at`.
pub(super) fn pebble(clay: &mut Clay, at: Vec3, size: Vec3, sides: usize, color: Tint, random: &mut SmallRng) {
    let turn = Quat::from_rotation_y(between(random, 0.0, 6.3)) * Quat::from_rotation_z(between(random, -0.15, 0.15));
    let place = Transform::from_translation(at).with_rotation(turn).with_scale(size);
    clay.ball(place, sides, |direction| shade(color, 0.72 + 0.28 * (direction.y * 0.5 + 0.5)));
}

/// The path.
pub(super) fn path(random: &mut SmallRng, quality: Quality) -> Clay {
    let mut clay = Clay::default();
    let (rows, columns) = (9, 140);
    clay.grid(rows, columns, |row, column| {
        let x = START + (END - START) * column as f32 / (columns - 1) as f32;
        let across = 1.0 - 2.0 * row as f32 / (rows - 1) as f32;
        let z = across * (half_width(x) + 0.06);
        let speckle = ((x * 37.0).sin() * (z * 53.0).cos() * 43758.5).fract().abs();
        let edge = across.abs().powi(6);
        let color = shade(blend(tint(0xc8b28a), tint(0x7d6a49), edge), 0.86 + 0.2 * speckle);
        (Vec3::new(x, 0.025 * (1.0 - edge), z), Vec3::Y, color)
    });
    for _ in 0..quality.pebbles() {
        let x = between(random, START, END);
        let z = between(random, -1.0, 1.0) * half_width(x);
        let size = between(random, 0.018, 0.05);
        let color = stone(random);
        pebble(&mut clay, Vec3::new(x, 0.02, z), Vec3::new(size * 1.3, size * 0.55, size), 6, color, random);
    }
    for side in [-1.0, 1.0] {
        let mut x = START + 0.35;
        while x < END - 0.2 {
            let length = between(random, 0.1, 0.2);
            let z = side * (half_width(x) + between(random, 0.02, 0.1));
            let size = Vec3::new(length, length * between(random, 0.5, 0.75), length * between(random, 0.6, 0.85));
            let color = stone(random);
            pebble(&mut clay, Vec3::new(x, 0.03, z), size, 8, color, random);
            x += length * between(random, 1.7, 2.6);
        }
    }
    clay
}
