//! Real blades of grass, in a few meshes.

use bevy::{platform::collections::HashMap, prelude::*};
use rand::{RngExt, rngs::SmallRng};

use super::{FIELD, MIDDLE, between, burrow, house, lawn, path};
use crate::view::{
    blade::{Size, blade},
    clay::{Clay, shade},
    light::shaded,
    quality::Quality,
};

/// The side of the square of lawn whose blades share a mesh, so that blades out of sight cost nothing.
const PATCH: f32 = 12.0;

/// The blades of the whole field, patch by patch.
pub(super) fn patches(random: &mut SmallRng, quality: Quality) -> Vec<Clay> {
    let mut patches = HashMap::<(i32, i32), Clay>::default();
    for _ in 0..quality.blades() {
        // Dense where one looks, thin in the distance, and wider there.
        let out = 0.4 + (FIELD - 20.0) * random.random::<f32>().powf(1.7);
        let around = between(random, 0.0, core::f32::consts::TAU);
        let at = MIDDLE + Vec2::new(around.cos() * 1.35, around.sin()) * out;
        let near_path = path::distance(at.x, at.y);
        if near_path < 0.02 || house::covers(at.x, at.y) || burrow::covers(at.x, at.y) {
            continue;
        }
        let patch = ((at.x / PATCH).floor() as i32, (at.y / PATCH).floor() as i32);
        let tall = 1.0 - 0.55 * (1.0 - near_path / 0.8).clamp(0.0, 1.0);
        let size = Size {
            height: between(random, 0.16, 0.38) * tall * (1.0 + out * 0.012),
            width: (0.016 + out * 0.0011) * quality.blade_width(),
        };
        let root = Vec3::new(at.x, lawn::height(at.x, at.y) - 0.02, at.y);
        let green = shade(lawn::green(at.x, at.y), shaded(root + Vec3::Y * 0.1, quality));
        blade(patches.entry(patch).or_default(), root, size, green, random, quality);
    }
    let mut patches: Vec<_> = patches.into_iter().collect();
    patches.sort_unstable_by_key(|(patch, _)| *patch);
    patches.into_iter().map(|(_, clay)| clay).collect()
}
