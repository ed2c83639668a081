//! Short grass where one looks: square patches, each of which goes to the next place that it fits when the view has left it behind.

use bevy::prelude::*;
use rand::{RngExt, rngs::SmallRng};

use super::{Place, TILE, green, height, is_sand, is_steep};
use crate::{
    body::Ground,
    view::{
        blade::{Size, blade},
        clay::{Clay, shade},
        quality::Quality,
    },
};

/// So many patches along each side of a tile.
const PATCHES: usize = 6;
/// Blades stand together in tufts of so many, no further apart than this.
const BLADES: usize = 4;
const APART: f32 = 0.13;
/// From where to where their height goes in a tuft of middling size: low enough not to hide who crawls there.
const HEIGHT: [f32; 2] = [0.16, 0.36];
/// Who is looked at from nearer than this is small, and so is the grass around.
const NEAR: f32 = 26.0;
/// Half of a blade's width.
const WIDTH: f32 = 0.045;

/// The patches of a tile around a place, each with its own middle.
pub(super) fn patches(ground: &Ground, place: Place, quality: Quality, random: &mut SmallRng) -> Vec<(Vec3, Clay)> {
    let side = TILE / PATCHES as f32;
    let part = (place.distance / NEAR).min(1.0);
    let corner = place.middle.with_y(0.0) - Vec3::new(0.5, 0.0, 0.5) * TILE;
    let all = (0..PATCHES * PATCHES).map(|i| {
        let own = corner + Vec3::new((i % PATCHES) as f32 + 0.5, 0.0, (i / PATCHES) as f32 + 0.5) * side;
        let mut clay = Clay::default();
        for _ in 0..quality.blades() / (BLADES * PATCHES * PATCHES) {
            let off = [(); 2].map(|()| random.random_range(-0.5..0.5) * side);
            let (x, z) = (own.x + off[0], own.z + off[1]);
            if is_sand(ground, x, z) || is_steep(ground, x, z) {
                continue;
            }
            let foot = Vec3::new(x, height(ground, x, z) - 0.03, z);
            let green = shade(green(x, z), random.random_range(0.8..1.3));
            let tall = random.random_range(0.7..1.3);
            for _ in 0..BLADES {
                let apart = Vec3::new(random.random_range(-1.0..1.0), 0.0, random.random_range(-1.0..1.0)) * APART;
                let height = part * tall * random.random_range(HEIGHT[0]..HEIGHT[1]);
                let size = Size { height, width: part.sqrt() * WIDTH * quality.blade_width().sqrt() };
                blade(&mut clay, foot + apart, size, green, random, quality);
            }
        }
        (own, clay)
    });
    all.collect()
}
