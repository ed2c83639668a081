//! The sun, and the shadows that are baked where a shadow map would cost too much.

use bevy::{
    light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap},
    prelude::*,
};

use super::quality::Quality;
use crate::scenes::SceneMember;

/// Towards the sun: it stands behind the viewer's left shoulder, so that shadows fall to the right and back.
pub(super) const SUN: Vec3 = Vec3::new(-0.5, 0.76, 0.46);

/// Spawns the sun of a scene.
pub(super) fn shine(quality: Quality, commands: &mut Commands) {
    commands.insert_resource(DirectionalLightShadowMap { size: 4096 });
    commands.spawn((
        SceneMember,
        super::Decor,
        DirectionalLight { shadow_maps_enabled: quality.shadows(), ..default() },
        CascadeShadowConfigBuilder {
            num_cascades: 3,
            first_cascade_far_bound: 9.0,
            maximum_distance: 60.0,
            ..default()
        }
        .build(),
        Transform::from_translation(SUN).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

/// The garden's large things as round ones, centre and radius: burrow, pots, and the crowns of the near trees.
const ROUND: [(Vec3, f32); 8] = [
    (Vec3::new(-2.4, 0.3, 0.0), 1.2),
    (Vec3::new(-4.0, 0.2, 0.0), 1.15),
    (Vec3::new(9.15, 0.4, -1.75), 0.5),
    (Vec3::new(9.15, 1.25, -1.75), 0.45),
    (Vec3::new(4.1, 0.35, -1.65), 0.43),
    (Vec3::new(4.1, 1.05, -1.65), 0.4),
    (Vec3::new(17.2, 3.9, -4.2), 2.1),
    (Vec3::new(-7.6, 3.3, -6.2), 1.8),
];

/// How much of the light reaches a spot of the ground, 1 in the open; always 1 where a shadow map does this work.
pub(super) fn shaded(spot: Vec3, quality: Quality) -> f32 {
    if quality.shadows() || (spot.x - 5.0).abs() > 22.0 || spot.z.abs() > 18.0 {
        return 1.0;
    }
    let spread = [(0.0, 0.0), (0.07, 0.0), (-0.07, 0.0), (0.0, 0.07), (0.0, -0.07)];
    let open = spread.iter().filter(|(x, z)| !hidden(spot, SUN + Vec3::new(*x, 0.0, *z))).count();
    0.5 + 0.5 * open as f32 / spread.len() as f32
}

/// Whether something stands between a spot and the sun.
fn hidden(spot: Vec3, to_sun: Vec3) -> bool {
    let round = |(center, radius): &(Vec3, f32)| {
        let along = (center - spot).dot(to_sun) / to_sun.length_squared();
        along > 0.0 && (spot + to_sun * along).distance_squared(*center) < radius * radius
    };
    ROUND.iter().any(round) || behind_house(spot, to_sun)
}

/// The house as a prism: where the ray is inside of every face at once, it is hidden.
fn behind_house(spot: Vec3, to_sun: Vec3) -> bool {
    let slope = Vec2::new(1.0, 0.95);
    let faces = [
        (Vec3::X, 14.75),
        (Vec3::NEG_X, -9.75),
        (Vec3::Z, 2.05),
        (Vec3::NEG_Z, 2.05),
        (Vec3::new(0.0, slope.x, slope.y), 3.8),
        (Vec3::new(0.0, slope.x, -slope.y), 3.8),
    ];
    let (mut enter, mut leave) = (0.0_f32, f32::INFINITY);
    for (out, limit) in faces {
        let (speed, room) = (out.dot(to_sun), limit - out.dot(spot));
        if speed.abs() < 1e-6 {
            if room < 0.0 {
                return false;
            }
        } else if speed > 0.0 {
            leave = leave.min(room / speed);
        } else {
            enter = enter.max(room / speed);
        }
    }
    enter < leave
}
