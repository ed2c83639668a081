//! The player's hand: which animal is selected, where it is led with the arrow keys or a click on the ground, and marks that show both.

use bevy::{ecs::system::SystemParam, math::DVec2, prelude::*, window::PrimaryWindow};
use bevy_egui::{EguiContexts, EguiPostUpdateSet, egui::Key};

use super::{
    camera::{PointerOnPanel, SceneCamera},
    drag::{Dragging, Held},
    help::typing,
};
use crate::{
    body::Ground,
    mechanics::ground_distance,
    physics::{Shown, Steer},
    scenes::{CurrentScene, SceneBodies},
};

/// The animal that is led by the player; key Tab takes the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Resource)]
#[reflect(Resource)]
pub struct Selected(pub Option<Entity>);

/// A press and release of the button that moves the pointer further than this, in logical pixels, is a drag and no click.
const CLICK: f32 = 4.0;
/// How far away a click is still on the ground.
const REACH: f64 = 300.0;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Selected>()
        .add_systems(Update, (select, lead.run_if(not(typing)), point).chain().after(Dragging))
        .add_systems(Update, mark.after(point))
        .add_systems(PostUpdate, keep_keys.after(EguiPostUpdateSet::EndPass).before(EguiPostUpdateSet::ProcessOutput));
}

/// Takes from a panel the focus that Tab has given it while there are animals that Tab chooses: all keys would go to its buttons from then on. Who goes
/// from field to field with Tab keeps it.
fn keep_keys(selected: Res<Selected>, mut in_field: Local<bool>, mut contexts: EguiContexts) {
    let Ok(context) = contexts.ctx_mut() else { return };
    let was_in_field = core::mem::replace(&mut *in_field, context.text_edit_focused());
    // What egui heard, which is also Tab again and again while it is held.
    let tab = context.input(|input| input.key_pressed(Key::Tab));
    if selected.0.is_some() && tab && !was_in_field {
        context.memory_mut(|memory| {
            if let Some(id) = memory.focused() {
                memory.surrender_focus(id);
            }
        });
    }
}

/// Takes the first animal of a scene, the next one at Tab, and one that is pressed on.
fn select(
    keys: Res<ButtonInput<KeyCode>>,
    held: Res<Held>,
    bodies: Option<Res<SceneBodies>>,
    animals: Query<(), With<Steer>>,
    mut selected: ResMut<Selected>,
) {
    let Some(bodies) = bodies else { return };
    let led: Vec<_> = bodies.0.iter().copied().filter(|body| animals.contains(*body)).collect();
    let at = led.iter().position(|body| Some(*body) == selected.0);
    let pressed = held.0.map(|(body, ..)| body).filter(|body| held.is_changed() && led.contains(body));
    let next = match at {
        _ if pressed.is_some() => pressed,
        Some(at) if keys.just_pressed(KeyCode::Tab) => led.get((at + 1) % led.len()).copied(),
        Some(_) => return,
        None => led.first().copied(),
    };
    if selected.0 != next {
        selected.0 = next;
    }
}

/// Left and right turn it while they are held; up lets it go on, down stops it.
fn lead(keys: Res<ButtonInput<KeyCode>>, selected: Res<Selected>, mut animals: Query<&mut Steer>) {
    const TURNS: [KeyCode; 2] = [KeyCode::ArrowLeft, KeyCode::ArrowRight];
    let Some(mut steer) = selected.0.and_then(|body| animals.get_mut(body).ok()) else { return };
    if keys.any_just_pressed(TURNS) || keys.any_just_released(TURNS) {
        let held = |key| f64::from(u8::from(keys.pressed(key)));
        let side = held(KeyCode::ArrowRight) - held(KeyCode::ArrowLeft);
        if let Err(error) = steer.turn(side) {
            warn!("{error}");
        }
    }
    if keys.just_pressed(KeyCode::ArrowDown) {
        steer.stop();
    }
    if keys.just_pressed(KeyCode::ArrowUp) {
        steer.go();
    }
}

/// The pointer, and what it points through.
#[derive(SystemParam)]
struct Pointer<'w, 's> {
    buttons: Res<'w, ButtonInput<MouseButton>>,
    on_panel: Res<'w, PointerOnPanel>,
    held: Res<'w, Held>,
    windows: Query<'w, 's, &'static Window, With<PrimaryWindow>>,
    cameras: Query<'w, 's, (&'static Camera, &'static GlobalTransform), With<SceneCamera>>,
    pressed: Local<'s, Option<Vec2>>,
}

impl Pointer<'_, '_> {
    /// The ray through a click that ends now.
    fn click(&mut self) -> Option<Ray3d> {
        let at = self.windows.iter().next().and_then(Window::cursor_position)?;
        if self.buttons.just_pressed(MouseButton::Left) {
            // What is pressed on a body drags it.
            *self.pressed = (!self.on_panel.0 && self.held.0.is_none()).then_some(at);
        }
        if !self.buttons.just_released(MouseButton::Left) {
            return None;
        }
        self.pressed.take().filter(|from| from.distance(at) <= CLICK)?;
        let (camera, place) = self.cameras.iter().next()?;
        camera.viewport_to_world(place, at).ok()
    }
}

/// Sends it where the ground is clicked.
fn point(
    mut pointer: Pointer,
    scene: Option<Res<CurrentScene>>,
    selected: Res<Selected>,
    mut animals: Query<&mut Steer>,
) {
    let Some(ray) = pointer.click() else { return };
    let Some(mut steer) = selected.0.and_then(|body| animals.get_mut(body).ok()) else { return };
    let Some(ground) = scene.as_ref().and_then(|scene| scene.file.ground.as_ref()) else { return };
    if let Some(spot) = hit(ground, ray)
        && let Err(error) = steer.go_to(DVec2::new(f64::from(spot.x), f64::from(spot.z)))
    {
        warn!("{error}");
    }
}

/// Where a ray meets the ground, by steps of the distance that is free in any direction.
fn hit(ground: &Ground, ray: Ray3d) -> Option<Vec3> {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut along = 0.0;
    for _ in 0..256 {
        let at = origin + direction * along;
        let (free, _) = ground_distance(ground, at);
        if free < 1e-3 {
            return Some(at.as_vec3());
        }
        // The distance of a hill is known to first order only.
        along += 0.9 * free;
        if along > REACH {
            return None;
        }
    }
    None
}

/// A ring around the selected animal, and a mark where it goes.
fn mark(
    selected: Res<Selected>,
    animals: Query<(&Shown, &Steer, Option<&Ground>)>,
    bodies: Option<Res<SceneBodies>>,
    mut lines: Gizmos,
) {
    const GOLD: Srgba = Srgba::new(1.0, 0.84, 0.3, 1.0);
    const STOPPED: Srgba = Srgba::new(0.95, 0.45, 0.35, 1.0);
    let Some((shown, steer, ground)) = selected.0.and_then(|body| animals.get(body).ok()) else { return };
    let height = |x: f32, z: f32, from: f32| -> f32 {
        let down = Ray3d { origin: Vec3::new(x, from + 5.0, z), direction: Dir3::NEG_Y };
        ground.and_then(|ground| hit(ground, down)).map_or(0.0, |at| at.y)
    };
    // One animal alone needs no mark.
    if bodies.is_some_and(|bodies| bodies.0.len() > 1)
        && let Some(head) = shown.positions().last_chunk::<4>()
    {
        let at = head.iter().sum::<Vec3>() / 4.0;
        let color = if steer.is_stopped() { STOPPED } else { GOLD };
        let ring = Isometry3d::new(
            Vec3::new(at.x, height(at.x, at.z, at.y) + 0.05, at.z),
            Quat::from_rotation_arc(Vec3::Z, Vec3::Y),
        );
        lines.circle(ring, 0.95, color).resolution(32);
    }
    if let Some(target) = steer.target().filter(|_| !steer.has_arrived()) {
        let (x, z) = (target.x as f32, target.y as f32);
        let at = Vec3::new(x, height(x, z, 10.0) + 0.05, z);
        let flat = Quat::from_rotation_arc(Vec3::Z, Vec3::Y);
        for radius in [0.25, 0.6] {
            lines.circle(Isometry3d::new(at, flat), radius, GOLD).resolution(32);
        }
        lines.arrow(at + Vec3::Y * 1.8, at + Vec3::Y * 0.1, GOLD);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::body::{Surface, Terrain};

    #[test]
    fn a_click_is_where_the_ray_meets_the_ground() {
        let ray = |to: Vec3| {
            let origin = Vec3::new(-3.0, 12.0, 20.0);
            Ray3d { origin, direction: Dir3::new(to - origin).unwrap() }
        };
        for spot in [Vec3::ZERO, Vec3::new(14.0, 0.0, -30.0)] {
            assert!(hit(&Ground::Flat, ray(spot)).unwrap().distance(spot) < 0.05);
        }
        assert_eq!(hit(&Ground::Flat, ray(Vec3::new(0.0, 30.0, -40.0))), None, "the sky is no ground");
        let hill = Surface::Hill { center: (0.0, 0.0), radius: 8.0, height: 3.0 };
        let ground = Ground::Terrain(Arc::new(Terrain::new([hill]).unwrap()));
        let at = hit(&ground, ray(Vec3::new(0.0, 3.0, 0.0))).unwrap();
        assert!(ground_distance(&ground, at.as_dvec3()).0.abs() < 2e-3 && at.y > 2.0, "{at}");
    }
}
