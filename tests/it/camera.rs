//! The camera of a scene: what a drag and a wheel do to it, and that a panel keeps them for itself.

use core::f32::consts::FRAC_PI_2;

use bevy::{
    input::{
        ButtonState,
        mouse::{MouseButtonInput, MouseMotion, MouseScrollUnit, MouseWheel},
        touch::TouchPhase,
    },
    prelude::*,
};
use bevy_panorbit_camera::{ActiveCameraData, PanOrbitCamera};
use wriggle::{
    physics::{PhysicsPlugin, Ticks},
    scenes::{self, FIELD_OF_VIEW, ScenesPlugin},
    view::{PointerOnPanel, Quality, SceneCamera, Shot},
};

use crate::picture::can_draw;

const SIZE: Vec2 = Vec2::new(320.0, 180.0);

/// The garden, whose camera hears the pointer although there is no window.
fn garden() -> Shot {
    let scene = scenes::load("garden").expect("the garden is shipped");
    let mut shot = Shot::new((320, 180), Some(Quality::Low), |app| {
        app.add_plugins((PhysicsPlugin::new(Ticks), ScenesPlugin::new(scene)));
    })
    .expect("there is an adapter");
    shot.update();
    let world = shot.world_mut();
    let camera = world.query_filtered::<Entity, With<SceneCamera>>().single(world).expect("one camera");
    world.insert_resource(ActiveCameraData {
        entity: Some(camera),
        viewport_size: Some(SIZE),
        window_size: Some(SIZE),
        manual: true,
    });
    shot
}

/// Presses a button, moves the pointer so far with it and lets it go.
fn drag(shot: &mut Shot, button: MouseButton, way: Vec2) {
    let press = |state| MouseButtonInput { button, state, window: Entity::PLACEHOLDER };
    shot.world_mut().write_message(press(ButtonState::Pressed));
    shot.update();
    shot.world_mut().write_message(MouseMotion { delta: way });
    shot.update();
    shot.world_mut().write_message(press(ButtonState::Released));
    shot.update();
}

fn wheel(shot: &mut Shot, lines: f32) {
    let (unit, phase) = (MouseScrollUnit::Line, TouchPhase::Moved);
    shot.world_mut().write_message(MouseWheel { unit, x: 0.0, y: lines, window: Entity::PLACEHOLDER, phase });
    shot.update();
}

/// Where the camera is going: yaw, pitch, distance, and the point that it looks at.
fn aim(shot: &mut Shot) -> (f32, f32, f32, Vec3) {
    let world = shot.world_mut();
    let orbit = world.query::<&PanOrbitCamera>().single(world).expect("one camera");
    (orbit.target_yaw, orbit.target_pitch, orbit.target_radius, orbit.target_focus)
}

#[test]
fn a_drag_across_the_window_turns_the_camera_once_around() {
    if !can_draw() {
        return;
    }
    let mut shot = garden();
    let (yaw, pitch, radius, focus) = aim(&mut shot);
    drag(&mut shot, MouseButton::Left, Vec2::new(0.25 * SIZE.x, 0.0));
    let turned = aim(&mut shot);
    assert!(((turned.0 - yaw).abs() - FRAC_PI_2).abs() < 1e-4, "{yaw} to {}", turned.0);
    assert_eq!((turned.1, turned.2, turned.3), (pitch, radius, focus));
    // Down to the ground and no further, up to its zenith and not over it.
    for (way, most) in [(-10.0, 0.03), (10.0, 1.5)] {
        drag(&mut shot, MouseButton::Left, Vec2::new(0.0, way * SIZE.y));
        assert_eq!(aim(&mut shot).1, most);
    }
}

#[test]
fn what_is_panned_stays_under_the_pointer() {
    if !can_draw() {
        return;
    }
    let mut shot = garden();
    let (yaw, pitch, radius, focus) = aim(&mut shot);
    drag(&mut shot, MouseButton::Right, Vec2::new(0.0, 0.5 * SIZE.y));
    let (.., moved) = aim(&mut shot);
    assert_eq!((aim(&mut shot).0, aim(&mut shot).1, aim(&mut shot).2), (yaw, pitch, radius));
    // Half of the window shows half of what is seen at the distance of the focus; what lies above comes down with the pointer. The camera takes the angle for its
    // tangent, 5 % less.
    let up = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-pitch) * Vec3::Y;
    let way = up * radius * (0.5 * FIELD_OF_VIEW as f32).to_radians();
    assert!((moved - focus - way).length() < 1e-3 * way.length(), "{focus} to {moved}, {way} away");
}

#[test]
fn a_wheel_comes_nearer_and_not_into_the_ground() {
    if !can_draw() {
        return;
    }
    let mut shot = garden();
    let (yaw, pitch, radius, focus) = aim(&mut shot);
    wheel(&mut shot, 1.0);
    let nearer = aim(&mut shot);
    assert!(nearer.2 < 0.9 * radius && nearer.2 > 0.5 * radius, "{radius} to {}", nearer.2);
    assert_eq!((nearer.0, nearer.1, nearer.3), (yaw, pitch, focus));
    for (lines, most) in [(100.0, 1.5), (-100.0, 120.0)] {
        (0..5).for_each(|_| wheel(&mut shot, lines));
        assert_eq!(aim(&mut shot).2, most);
    }
}

#[test]
fn a_panel_keeps_the_pointer_for_itself() {
    if !can_draw() {
        return;
    }
    let mut shot = garden();
    let before = aim(&mut shot);
    shot.world_mut().resource_mut::<PointerOnPanel>().0 = true;
    drag(&mut shot, MouseButton::Left, 0.25 * SIZE);
    drag(&mut shot, MouseButton::Right, 0.25 * SIZE);
    wheel(&mut shot, 1.0);
    assert_eq!(aim(&mut shot), before);
    shot.world_mut().resource_mut::<PointerOnPanel>().0 = false;
    wheel(&mut shot, 1.0);
    assert_ne!(aim(&mut shot), before);
}
