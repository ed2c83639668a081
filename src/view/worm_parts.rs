//! The shapes that a garden worm's skin is put together from.

use core::f32::consts::{PI, TAU};

use bevy::prelude::*;

use super::clay::{Clay, blend, tint};

const SKIN: u32 = 0xf0848c;
const BELLY: u32 = 0xffc9b0;
const RING: u32 = 0xff6a00;

/// The unit ball with a pale belly.
pub(super) fn body() -> Mesh {
    let mut clay = Clay::default();
    let along_x = Transform::from_rotation(Quat::from_rotation_z(-PI * 0.5));
    clay.ball(along_x, 36, |direction| {
        let up = -direction.x;
        blend(tint(BELLY), tint(SKIN), (up * 1.4 + 0.85).clamp(0.0, 1.0))
    });
    clay.fire()
}

/// A torus about x of radius 1.
pub(super) fn ring() -> Mesh {
    let mut clay = Clay::default();
    let circle: Vec<Vec3> = (0..=36)
        .map(|i| {
            let turn = TAU * i as f32 / 36.0;
            Vec3::new(0.0, turn.cos(), turn.sin())
        })
        .collect();
    clay.tube(&circle, 10, |_| 0.12, |_| tint(RING));
    clay.fire()
}

/// An eye that looks along x: white, pupil, two highlights.
pub(super) fn eye() -> Mesh {
    let mut clay = Clay::default();
    clay.ball(Transform::default(), 20, |_| tint(0xffffff));
    let mut spot = |direction: Vec3, out: f32, size: Vec3, color: u32| {
        let turn = Quat::from_rotation_arc(Vec3::X, direction.normalize());
        let at = Transform::from_translation(turn * Vec3::X * out).with_rotation(turn).with_scale(size);
        let color = if color == 0xffffff { [3.0, 3.0, 3.0, 0.0] } else { tint(color) };
        clay.ball(at, 14, |_| color);
    };
    spot(Vec3::new(1.0, 0.05, 0.0), 0.74, Vec3::new(0.36, 0.66, 0.6), 0x5b3a1e);
    spot(Vec3::new(1.0, 0.05, 0.0), 0.84, Vec3::new(0.3, 0.5, 0.45), 0x140d0a);
    spot(Vec3::new(1.0, 0.3, 0.24), 1.08, Vec3::new(0.09, 0.16, 0.16), 0xffffff);
    spot(Vec3::new(1.0, -0.16, -0.2), 1.08, Vec3::new(0.06, 0.09, 0.09), 0xffffff);
    clay.fire()
}

/// A wide smile with dimples, and rosy cheeks, on the unit ball.
pub(super) fn mouth() -> Mesh {
    let mut clay = Clay::default();
    let smile: Vec<Vec3> = (0..=20)
        .map(|i| {
            let t = i as f32 / 10.0 - 1.0;
            let (around, up): (f32, f32) = (t * 0.95, -0.3 + 0.34 * t * t);
            Vec3::new(around.cos() * up.cos(), up.sin(), around.sin() * up.cos())
        })
        .collect();
    clay.tube(&smile, 7, |t| 0.03 + 0.028 * (PI * t).sin(), |_| tint(0x7a2230));
    for end in [smile[0], smile[20]] {
        clay.ball(Transform::from_translation(end).with_scale(Vec3::splat(0.055)), 8, |_| tint(0x7a2230));
    }
    for side in [-1.0, 1.0] {
        let direction = Vec3::new(0.52, 0.02, side * 0.85).normalize();
        let turn = Quat::from_rotation_arc(Vec3::X, direction);
        let cheek =
            Transform::from_translation(direction * 0.975).with_rotation(turn).with_scale(Vec3::new(0.05, 0.17, 0.2));
        clay.ball(cheek, 14, |_| tint(0xf76a7c));
    }
    clay.fire()
}

/// A feeler that stands up along y.
pub(super) fn feeler() -> Mesh {
    let mut clay = Clay::default();
    let stalk: Vec<Vec3> = (0..=6)
        .map(|i| {
            let t = i as f32 / 6.0;
            Vec3::new(0.3 * t * t, -0.1 + 0.75 * t, 0.0)
        })
        .collect();
    clay.tube(&stalk, 7, |t| 0.07 - 0.025 * t, |_| tint(SKIN));
    clay.ball(Transform::from_translation(stalk[6]).with_scale(Vec3::splat(0.13)), 12, |_| tint(RING));
    clay.fire()
}

/// A flat soft spot of shade.
pub(super) fn blot() -> Mesh {
    let mut clay = Clay::default();
    clay.grid(25, 5, |spoke, ring| {
        let around = -TAU * spoke as f32 / 24.0;
        let out = ring as f32 / 4.0;
        let alpha = 0.62 * (1.0 - out * out).powi(2);
        (Vec3::new(around.cos() * out, 0.0, around.sin() * out), Vec3::Y, [0.03, 0.025, 0.01, alpha])
    });
    clay.fire()
}
