//! The surroundings of a scene without props: a chequered floor under an open sky.

use bevy::{camera::visibility::NoFrustumCulling, light::NotShadowCaster, prelude::*};

use super::{
    Decor,
    clay::{Clay, tint},
    garden::backdrop,
    paint::Paint,
    quality::Quality,
    travel::Travels,
};
use crate::scenes::SceneMember;

/// How far the floor reaches.
const REACH: i32 = 30;
/// The floor is a little lower than 0, so that balls at 0 are not cut in half.
const FLOOR: f32 = -0.13;

/// The edge of a tile below a road, which is larger than all else.
const LARGE: f32 = 4.0;

/// Spawns floor and sky; the floor below the lowest stone of a road where there is one.
pub(super) fn set_up(
    lowest: Option<f32>,
    quality: Quality,
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    paints: &mut Assets<Paint>,
) {
    let (edge, height) = lowest.map_or((1.0, FLOOR), |lowest| (LARGE, lowest.min(FLOOR + 1.5) - 1.5));
    let mut floor = Clay::default();
    for x in -REACH..REACH {
        for z in -REACH..REACH {
            let color = tint(if (x + z) % 2 == 0 { 0xb9c4ae } else { 0xaab8a0 });
            let corner = |dx: i32, dz: i32| Vec3::new((x + dx) as f32 * edge, height, (z + dz) as f32 * edge);
            floor.quad([corner(0, 1), corner(1, 1), corner(1, 0), corner(0, 0)], color);
        }
    }
    let floor_paint = paints.add(Paint::matte(quality.shadows()));
    commands.spawn((
        SceneMember,
        Decor,
        NotShadowCaster,
        // Two tiles on, it looks the same.
        Travels { every: 2.0 * edge, middle: Vec3::ZERO },
        Mesh3d(meshes.add(floor.fire())),
        MeshMaterial3d(floor_paint),
    ));
    let sky = (Mesh3d(meshes.add(backdrop::sky().fire())), MeshMaterial3d(paints.add(Paint::glowing())));
    commands.spawn((
        SceneMember,
        Decor,
        NotShadowCaster,
        NoFrustumCulling,
        Travels { every: 0.0, middle: Vec3::ZERO },
        sky,
    ));
}
