//! The camera: orbit, pan, zoom, and following the worm.

use bevy::{camera::SubCameraView, light::cluster::ClusterConfig, prelude::*, render::view::NoIndirectDrawing};
use bevy_panorbit_camera::{PanOrbitCamera, PanOrbitCameraPlugin, PanOrbitCameraSystemSet, TrackpadBehavior};

use super::{
    drag::Held, half::HalfResolution, help::typing, offscreen::OffscreenTarget, quality::Quality, steering::Selected,
    travel::Herd,
};
use crate::{
    creatures::Look,
    physics::Shown,
    scenes::{Camera as Place, CurrentScene, FIELD_OF_VIEW, SceneBodies},
};

/// Where the camera is kept still while the pointer is used by a panel, in [`PostUpdate`]. Whoever draws panels writes [`PointerOnPanel`] before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, SystemSet)]
pub struct LeaveToPanel;

/// Whether the pointer is used by a panel: while true, it does not move the camera. Written by whoever draws panels, before [`LeaveToPanel`]: a wheel that
/// turns in the frame in which the pointer comes onto a panel is the panel's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Resource)]
#[reflect(Resource)]
pub struct PointerOnPanel(pub bool);

/// How wide a strip a panel covers at the left of the window, in logical pixels; 0 for none. The scene's middle is that of what stays free.
/// Written by whoever draws panels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Resource)]
#[reflect(Resource)]
pub struct CoveredLeft(pub f32);

/// The camera that shows the scene.
#[derive(Clone, Component, Copy, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct SceneCamera;

/// Whether the camera follows the selected animal, or the first body of a scene without any; key `C`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Resource)]
#[reflect(Resource)]
pub struct FollowWorm(pub bool);

/// How near the camera comes when it begins to follow.
const NEAR: f32 = 6.5;
/// How quickly the camera follows: the part of the way it makes in a second is 1 − e^−this.
const QUICKNESS: f32 = 3.5;

pub(super) fn plugin(app: &mut App) {
    app.add_plugins(PanOrbitCameraPlugin)
        .init_resource::<PointerOnPanel>()
        .init_resource::<CoveredLeft>()
        .init_resource::<FollowWorm>()
        .add_systems(Startup, spawn)
        .add_systems(
            Update,
            (take_place.run_if(resource_exists_and_changed::<CurrentScene>), toggle.run_if(not(typing))).chain(),
        )
        .add_systems(
            PostUpdate,
            (leave_to_panel.in_set(LeaveToPanel), follow, make_room).chain().before(PanOrbitCameraSystemSet),
        );
}

fn spawn(quality: Res<Quality>, target: Option<Res<OffscreenTarget>>, mut commands: Commands) {
    let mut camera = commands.spawn((
        SceneCamera,
        Camera3d::default(),
        quality.msaa(),
        bevy::core_pipeline::tonemapping::Tonemapping::None,
        Projection::from(PerspectiveProjection {
            fov: (FIELD_OF_VIEW as f32).to_radians(),
            near: 0.1,
            far: 400.0,
            ..default()
        }),
        PanOrbitCamera {
            pitch_lower_limit: Some(0.03),
            pitch_upper_limit: Some(1.5),
            zoom_lower_limit: 1.5,
            zoom_upper_limit: Some(120.0),
            orbit_smoothness: 0.25,
            zoom_smoothness: 0.25,
            trackpad_behavior: TrackpadBehavior::blender_default(),
            use_real_time: true,
            ..default()
        },
    ));
    if *quality == Quality::Low {
        // What a GPU sorts and culls for us costs a software renderer more than it saves.
        camera.insert((NoIndirectDrawing, ClusterConfig::Single));
    }
    match target {
        Some(target) => _ = camera.insert(target.0.clone()),
        // A picture is worth its full resolution; a window must keep moving.
        None if *quality == Quality::Low => _ = camera.insert(HalfResolution),
        None => {}
    }
}

/// Where a scene wants the camera: the point that it looks at, yaw and pitch in radians, and its distance.
fn place(scene: &CurrentScene) -> (Vec3, f32, f32, f32) {
    let Place::Orbit { target: (x, y, z), distance, pitch, yaw } = scene.file.camera;
    let target = Vec3::new(x as f32, y as f32, z as f32);
    (target, yaw.to_radians() as f32, pitch.to_radians() as f32, distance as f32)
}

/// Goes where the scene wants it, at once.
fn take_place(scene: Res<CurrentScene>, mut cameras: Query<(&mut PanOrbitCamera, &mut Transform), With<SceneCamera>>) {
    let (focus, yaw, pitch, radius) = place(&scene);
    for (mut orbit, mut transform) in &mut cameras {
        (orbit.focus, orbit.target_focus) = (focus, focus);
        (orbit.yaw, orbit.target_yaw) = (Some(yaw), yaw);
        (orbit.pitch, orbit.target_pitch) = (Some(pitch), pitch);
        (orbit.radius, orbit.target_radius) = (Some(radius), radius);
        orbit.force_update = true;
        let turn = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-pitch);
        *transform = Transform::from_translation(focus + turn * Vec3::Z * radius).with_rotation(turn);
    }
}

fn toggle(
    keys: Res<ButtonInput<KeyCode>>,
    scene: Option<Res<CurrentScene>>,
    herd: Res<Herd>,
    mut following: ResMut<FollowWorm>,
    mut cameras: Query<&mut PanOrbitCamera, With<SceneCamera>>,
) {
    if !keys.just_pressed(KeyCode::KeyC) {
        return;
    }
    following.0 = !following.0;
    for mut orbit in &mut cameras {
        if following.0 {
            orbit.target_radius = orbit.target_radius.min(NEAR);
        } else if let Some(scene) = &scene {
            let (focus, _, _, radius) = place(scene);
            // Where the scene would have it, had it gone along all the while.
            let (moved, wider) = herd.since_start(radius);
            (orbit.target_focus, orbit.target_radius) = (focus + moved, wider);
        }
    }
}

fn leave_to_panel(
    on_panel: Res<PointerOnPanel>,
    held: Option<Res<Held>>,
    mut cameras: Query<&mut PanOrbitCamera, With<SceneCamera>>,
) {
    let drags = held.is_some_and(|held| held.0.is_some());
    for mut orbit in &mut cameras {
        orbit.enabled = !on_panel.0 && !drags;
    }
}

/// Moves the picture beside a panel. What is culled on the side of the panel lies behind it.
fn make_room(covered: Res<CoveredLeft>, mut cameras: Query<&mut Camera, With<SceneCamera>>) {
    for mut camera in &mut cameras {
        let view =
            camera.logical_target_size().map(Vec2::as_uvec2).filter(|size| covered.0 > 0.0 && size.min_element() > 0);
        let view = view.map(|size| SubCameraView {
            full_size: size,
            offset: Vec2::new(-0.5 * covered.0.min(size.x as f32), 0.0),
            size,
        });
        if camera.sub_camera_view != view {
            camera.sub_camera_view = view;
        }
    }
}

/// Draws the camera's focus towards the middle of the selected animal, or of the first body where no animal is led.
fn follow(
    time: Res<Time<Real>>,
    following: Res<FollowWorm>,
    selected: Option<Res<Selected>>,
    scene: Option<Res<SceneBodies>>,
    bodies: Query<&Shown, With<Look>>,
    mut cameras: Query<&mut PanOrbitCamera, With<SceneCamera>>,
) {
    let led = selected.and_then(|selected| bodies.get(selected.0?).ok());
    // As the scene lists them: queries go by what components a body has just now.
    let first = || scene.iter().flat_map(|scene| &scene.0).find_map(|body| bodies.get(*body).ok());
    let Some(shown) = led.or_else(first).filter(|_| following.0) else { return };
    let count = shown.positions().len().max(1) as f32;
    let middle = shown.positions().iter().sum::<Vec3>() / count + Vec3::Y * 0.4;
    let part = 1.0 - (-QUICKNESS * time.delta_secs()).exp();
    for mut orbit in &mut cameras {
        orbit.target_focus = orbit.target_focus.lerp(middle, part);
        orbit.force_update = true;
    }
}
