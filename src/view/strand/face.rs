//! The faces of strands: what sits on the round end of a head, shaped on the unit ball that looks along x.

use core::f32::consts::PI;

use bevy::prelude::*;

use super::{Grain, Surface};
use crate::view::clay::{Clay, tint};

/// The round end of a head as a ball: its middle, its half axes ahead, up and to the side, and where they point.
pub(super) fn head(surface: &Surface, grain: Grain) -> Option<Transform> {
    let width = grain.columns + 1;
    let rows = surface.positions.len() / width;
    let at = |row: usize, column: usize| surface.positions.get(row * width + column).map(|&at| Vec3::from(at));
    let rim = rows.checked_sub(1 + grain.cap)?;
    let middle = (0..grain.columns).filter_map(|column| at(rim, column)).sum::<Vec3>() / grain.columns as f32;
    let ahead = at(rows - 1, 0)? - middle;
    // The seam runs along the middle of the belly.
    let tall = at(rim, grain.columns / 2)? - at(rim, 0)?;
    let wide = at(rim, grain.columns / 4)?.distance(at(rim, 3 * grain.columns / 4)?);
    let forward = ahead.try_normalize()?;
    let up = tall.reject_from_normalized(forward).try_normalize()?;
    Some(Transform {
        translation: middle,
        rotation: Quat::from_mat3(&Mat3::from_cols(forward, up, forward.cross(up))),
        scale: Vec3::new(ahead.length(), 0.5 * tall.length(), 0.5 * wide),
    })
}

/// The closed mouth of a snake, from one corner of its jaw around the snout to the other, and its nostrils.
pub(super) fn snout() -> Mesh {
    let mut clay = Clay::default();
    let dark = tint(0x2a1a10);
    let mouth: Vec<Vec3> = (0..=24)
        .map(|i| {
            let t = i as f32 / 12.0 - 1.0;
            let (around, up): (f32, f32) = (t * 1.45, -0.2 + 0.12 * t * t);
            Vec3::new(around.cos() * up.cos(), up.sin(), around.sin() * up.cos())
        })
        .collect();
    clay.tube(&mouth, 6, |t| 0.014 + 0.026 * (PI * t).sin(), |_| dark);
    for side in [-1.0, 1.0] {
        let at = Vec3::new(0.84, 0.34, side * 0.4).normalize();
        clay.ball(Transform::from_translation(at * 0.98).with_scale(Vec3::splat(0.075)), 10, |_| dark);
    }
    clay.fire()
}

/// A forked tongue, out as far as it goes.
pub(super) fn tongue() -> Mesh {
    let mut clay = Clay::default();
    let red = tint(0xb3202c);
    let root = Vec3::new(0.8, -0.2, 0.0);
    let fork = Vec3::new(1.6, -0.26, 0.0);
    clay.tube(&[root, root.lerp(fork, 0.5), fork], 6, |_| 0.06, |_| red);
    for side in [-1.0, 1.0] {
        let tip = Vec3::new(2.1, -0.1, side * 0.34);
        clay.tube(&[fork, fork.lerp(tip, 0.5) - Vec3::Y * 0.04, tip], 6, |t| 0.055 - 0.045 * t, |_| red);
    }
    clay.fire()
}

/// How far out a tongue is at a time in seconds, from 0 to 1: every few seconds it flickers.
pub(super) fn flicker(time: f32) -> f32 {
    const EVERY: f32 = 2.6;
    const LASTS: f32 = 0.9;
    let t = time.rem_euclid(EVERY) / LASTS;
    // Out at time 0, where pictures are taken.
    if t < 1.0 { (0.5 + 0.5 * (2.0 * PI * 3.0 * t).cos()).max(0.15) * (1.0 - t * t) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::strand::Outline;

    #[test]
    fn the_ball_of_a_head_touches_the_end_of_its_skin() {
        let grain = Grain { rows: 4, columns: 16, cap: 4 };
        let corners = [(0.0, -0.5), (0.0, 0.5), (1.0, 0.5), (1.0, -0.5)];
        // Upright and straight along z, and turned.
        for turn in [Quat::IDENTITY, Quat::from_rotation_y(0.7), Quat::from_rotation_z(0.4)] {
            let section = |p: i32| corners.map(|(y, x)| turn * Vec3::new(-x, y, p as f32));
            let masses: Vec<_> = (0..=8).flat_map(section).collect();
            let mut surface = Surface::default();
            surface.cut(&masses, &Outline::SNAKE, grain);
            let head = head(&surface, grain).unwrap();
            let tip = Vec3::from(*surface.positions.last().unwrap());
            assert!((head * Vec3::X).distance(tip) < 1e-4, "{head:?}, {tip}");
            assert!((head.rotation * Vec3::X).distance(turn * Vec3::Z) < 1e-3);
            assert!((head.rotation * Vec3::Y).distance(turn * Vec3::Y) < 1e-3);
            // Its crown is the highest point of its last section's rim.
            let rim = surface.positions.len() - (1 + grain.cap) * (grain.columns + 1);
            let crown = Vec3::from(surface.positions[rim + grain.columns / 2]);
            assert!((head * Vec3::Y).distance(crown) < 0.02, "{head:?}, {crown}");
            // Its head is wider than it is high.
            assert!(head.scale.z > head.scale.y && head.scale.y > 0.1, "{}", head.scale);
        }
    }

    #[test]
    fn a_tongue_flickers_and_rests() {
        assert!(flicker(0.0) > 0.99);
        assert_eq!(flicker(2.0), 0.0);
        assert!((0..1000).map(|i| flicker(0.01 * i as f32)).all(|out| (0.0..=1.0).contains(&out)));
    }
}
