//! Surroundings without end: the ground goes on under animals that crawl away, and what is far stays far.

use bevy::prelude::*;
use bevy_panorbit_camera::{PanOrbitCamera, PanOrbitCameraSystemSet};

use super::camera::{FollowWorm, SceneCamera};
use crate::{
    physics::Shown,
    scenes::{CurrentScene, Props, SceneBodies},
};

/// Moves with what the camera looks at, by whole multiples of a length after which it looks the same; at any place where that is 0.
#[derive(Clone, Component, Copy, Debug)]
pub(super) struct Travels(pub f32);

/// Where the animals of the scene were on average when the camera last went along.
#[derive(Default, Resource)]
struct Herd(Option<Vec3>);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Herd>().add_systems(PostUpdate, (go_along, travel).chain().before(PanOrbitCameraSystemSet));
}

/// Carries the camera along with the animals as a whole, wherever its user has turned it. In the garden and on roads, which are one place, it stays.
fn go_along(
    scene: Option<Res<CurrentScene>>,
    bodies: Option<Res<SceneBodies>>,
    shown: Query<&Shown>,
    following: Res<FollowWorm>,
    mut herd: ResMut<Herd>,
    mut cameras: Query<&mut PanOrbitCamera, With<SceneCamera>>,
) {
    let (Some(scene), Some(bodies)) = (scene, bodies) else { return };
    if scene.is_changed() {
        herd.0 = None;
    }
    let middle = |shown: &Shown| shown.positions().iter().sum::<Vec3>() / shown.positions().len().max(1) as f32;
    let middles: Vec<_> = bodies.0.iter().filter_map(|body| shown.get(*body).ok()).map(middle).collect();
    let has_road = scene.file.road.is_some() || scene.file.creatures.iter().any(|placement| placement.road.is_some());
    if middles.is_empty() || has_road || matches!(scene.file.props, Props::Garden { .. }) {
        return;
    }
    let now = middles.iter().sum::<Vec3>() / middles.len() as f32;
    let moved = herd.0.map_or(Vec3::ZERO, |before| now - before).with_y(0.0);
    herd.0 = Some(now);
    if following.0 || moved == Vec3::ZERO {
        return;
    }
    for mut orbit in &mut cameras {
        orbit.focus += moved;
        orbit.target_focus += moved;
        orbit.force_update = true;
    }
}

fn travel(cameras: Query<&PanOrbitCamera, With<SceneCamera>>, mut things: Query<(&Travels, &mut Transform)>) {
    let Some(orbit) = cameras.iter().next() else { return };
    for (&Travels(length), mut transform) in &mut things {
        let there = if length > 0.0 { (orbit.focus / length).round() * length } else { orbit.focus };
        let there = there.with_y(transform.translation.y);
        if transform.translation != there {
            transform.translation = there;
        }
    }
}
