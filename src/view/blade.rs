//! A blade of grass.

use core::f32::consts::TAU;

use bevy::prelude::*;
use rand::{RngExt, rngs::SmallRng};

use super::{
    clay::{Clay, Tint, blend, shade, swaying, tint},
    quality::Quality,
};

/// How large a blade is.
pub(super) struct Size {
    pub height: f32,
    /// Half of the width at its root.
    pub width: f32,
}

/// A bent strip that ends in a point; some are dry.
pub(super) fn blade(clay: &mut Clay, root: Vec3, size: Size, green: Tint, random: &mut SmallRng, quality: Quality) {
    let turn = Vec2::from_angle(random.random_range(0.0..TAU));
    let (across, lean) = (Vec3::new(turn.x, 0.0, turn.y), Vec3::new(-turn.y, 0.0, turn.x));
    let bend = random.random_range(0.1..0.75) * size.height;
    let dry = random.random::<f32>().powi(4) * 0.55;
    let fresh = shade(blend(green, tint(0xd9c25a), dry), random.random_range(0.82..1.18));
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
