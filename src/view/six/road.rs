//! A road of stones.

use bevy::prelude::*;

use crate::{
    mechanics::six_matrix::Road,
    scenes::{CurrentScene, SceneMember},
    view::{
        Decor,
        clay::{Clay, blend, shade, tint},
        paint::Paint,
        quality::Quality,
    },
};

/// Roads of more stones than this are drawn with as many of them, evenly picked.
const MOST: usize = 40_000;
/// Up to so many stones are round.
const ROUND: usize = 6_000;

/// Laying the roads of a scene, once the surroundings of the last one are cleared away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, SystemSet)]
pub(in crate::view) struct Lay;

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, lay.in_set(Lay).run_if(resource_exists_and_changed::<CurrentScene>));
}

/// The height of the lowest stone of any road; nothing where there is none.
pub(in crate::view) fn lowest<'a>(roads: impl Iterator<Item = &'a Road>) -> Option<f32> {
    roads.flat_map(Road::points).map(|stone| stone.y as f32).reduce(f32::min)
}

/// Lays each road of the scene once.
fn lay(
    roads: Query<&Road>,
    quality: Res<Quality>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut paints: ResMut<Assets<Paint>>,
) {
    let mut laid: Vec<&Road> = Vec::new();
    for road in &roads {
        if road.points().is_empty() || laid.contains(&road) {
            continue;
        }
        laid.push(road);
        let paint = paints.add(Paint::matte(quality.shadows()));
        commands.spawn((SceneMember, Decor, Mesh3d(meshes.add(stones(road, *quality))), MeshMaterial3d(paint)));
    }
}

/// All stones in one mesh: unit balls, a little worn, in the greys of a cobbled way.
fn stones(road: &Road, quality: Quality) -> Mesh {
    let points = road.points();
    let every = points.len().div_ceil(MOST);
    let sides = match (points.len() <= ROUND, quality) {
        (false, _) => 4,
        (true, Quality::Low) => 8,
        (true, Quality::High) => 12,
    };
    let mut clay = Clay::default();
    for (i, stone) in points.iter().enumerate().step_by(every) {
        // As good as random, and the same every time.
        let mixed = (i as u32).wrapping_mul(2_654_435_761) >> 8;
        let part = |shift: u32| ((mixed >> shift) & 0xff) as f32 / 255.0;
        let color = shade(blend(tint(0x8d8a80), tint(0xb7ab94), part(0)), 0.75 + 0.35 * part(8));
        let turn = Quat::from_rotation_y(core::f32::consts::TAU * part(16));
        let size = Vec3::new(0.92 + 0.08 * part(4), 0.94, 0.92 + 0.08 * part(12));
        let place = Transform::from_translation(stone.as_vec3()).with_rotation(turn).with_scale(size);
        clay.ball(place, sides, |direction| shade(color, 0.7 + 0.3 * direction.y.max(-0.5)));
    }
    clay.fire()
}
