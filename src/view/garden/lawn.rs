//! The ground under the grass, and what grows on which spot of it.

use bevy::prelude::*;

use super::{FIELD, MIDDLE};
use crate::view::{
    clay::{Clay, Tint, blend, shade, tint},
    light::shaded,
    quality::Quality,
};

/// The height of the ground at a spot: flat where the worm crawls, rolling further out.
pub(super) fn height(x: f32, z: f32) -> f32 {
    let far = ((Vec2::new(x, z) - MIDDLE).length() - 12.0).max(0.0);
    let roll = (x * 0.16 + 1.0).sin() * (z * 0.13).cos() + 0.5 * (x * 0.07 - z * 0.11).sin();
    roll * (far * 0.06).min(1.0)
}

/// The colour of the lawn at a spot, in broad patches.
pub(super) fn green(x: f32, z: f32) -> Tint {
    let patch = (x * 0.55 + (z * 0.4).sin() * 1.3).sin() * (z * 0.5 + (x * 0.35).cos()).cos() * 0.5 + 0.5;
    blend(tint(0x467a30), tint(0x6f9c3e), patch)
}

/// The bare ground, finer where the worm crawls.
pub(super) fn lawn(quality: Quality) -> Clay {
    let mut clay = Clay::default();
    let (rings, spokes) = if quality == Quality::Low { (60, 96) } else { (110, 160) };
    clay.grid(spokes + 1, rings, |spoke, ring| {
        let around = -core::f32::consts::TAU * spoke as f32 / spokes as f32;
        let out = FIELD * 1.6 * (ring as f32 / (rings - 1) as f32).powf(2.2);
        let (x, z) = (MIDDLE.x + out * around.cos(), MIDDLE.y + out * around.sin());
        let e = 0.1;
        let normal = Vec3::new(height(x - e, z) - height(x + e, z), 2.0 * e, height(x, z - e) - height(x, z + e));
        let color = shade(green(x, z), 0.62 * shaded(Vec3::new(x, 0.02, z), quality));
        (Vec3::new(x, height(x, z) - 0.02, z), normal.normalize(), color)
    });
    clay
}
