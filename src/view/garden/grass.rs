//! Real blades of grass, in a few meshes.

use bevy::{platform::collections::HashMap, prelude::*};
use rand::{RngExt, rngs::SmallRng};

use super::{FIELD, MIDDLE, between, burrow, house, lawn, path};
use crate::view::{
    clay::{Clay, blend, shade, swaying, tint},
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
        blade(patches.entry(patch).or_default(), at, size, random, quality);
    }
    let mut patches: Vec<_> = patches.into_iter().collect();
    patches.sort_unstable_by_key(|(patch, _)| *patch);
    patches.into_iter().map(|(_, clay)| clay).collect()
}

struct Size {
    height: f32,
    width: f32,
}

/// One blade: a bent strip that ends in a point.
fn blade(clay: &mut Clay, at: Vec2, size: Size, random: &mut SmallRng, quality: Quality) {
    let turn = Vec2::from_angle(between(random, 0.0, core::f32::consts::TAU));
    let (across, lean) = (Vec3::new(turn.x, 0.0, turn.y), Vec3::new(-turn.y, 0.0, turn.x));
    let bend = between(random, 0.1, 0.75) * size.height;
    let root = Vec3::new(at.x, lawn::height(at.x, at.y) - 0.02, at.y);
    let dry = random.random::<f32>().powi(4) * 0.55;
    let light = shaded(root + Vec3::Y * 0.1, quality) * between(random, 0.82, 1.18);
    let fresh = shade(blend(lawn::green(at.x, at.y), tint(0xd9c25a), dry), light);
    let normal = (Vec3::Y + lean * 0.35).normalize();
    let segments = quality.blade_segments();
    let mut below = None;
    for i in 0..=segments {
        let t = i as f32 / segments as f32;
        let spine = root + Vec3::Y * (size.height * t * (1.0 - 0.15 * t)) + lean * (bend * t * t);
        let color = swaying(shade(fresh, 0.5 + 0.75 * t), size.height * 0.3 * t * t);
        let half = across * (size.width * (1.0 - 0.6 * t));
        if i == segments {
            let tip = clay.vertex(spine, normal, color);
            if let Some((left, right)) = below {
                clay.triangle(left, right, tip);
            }
        } else {
            let (left, right) = (clay.vertex(spine - half, normal, color), clay.vertex(spine + half, normal, color));
            if let Some((l, r)) = below {
                clay.triangle(l, r, right);
                clay.triangle(l, right, left);
            }
            below = Some((left, right));
        }
    }
}
