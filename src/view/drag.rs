//! The mouse as a hand: pressed on a body, it drags the nearest particle.

use bevy::{ecs::system::SystemParam, prelude::*, window::PrimaryWindow};

use super::camera::{PointerOnPanel, SceneCamera};
use crate::{
    body::{ParticleId, Particles, Pull, Springs},
    physics::{Frozen, Shown},
};

/// How far from a particle the pointer may be to take it: as a part of how far away it is, and in rest lengths of its body's springs; of a body without springs in
/// radii of its particles, which are 1 by the six-matrix model. So the whole of a skin can be taken, the middle of a face between four masses, too.
const REACH: (f32, f32) = (0.012, 0.75);

/// The body that is dragged, where its particle was taken, and how far its true place is from where it is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Resource)]
pub(super) struct Held(pub(super) Option<(Entity, Vec3, Vec3)>);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Held>().add_systems(Update, (take, drag, show).chain().in_set(Dragging));
}

/// Where what is dragged is taken, moved and let go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, SystemSet)]
pub(super) struct Dragging;

/// The pointer, and what it points through.
#[derive(SystemParam)]
struct Pointer<'w, 's> {
    windows: Query<'w, 's, &'static Window, With<PrimaryWindow>>,
    cameras: Query<'w, 's, (&'static Camera, &'static GlobalTransform), With<SceneCamera>>,
}

impl Pointer<'_, '_> {
    /// The ray through the pointer, and where the camera looks.
    fn ray(&self) -> Option<(Ray3d, Dir3)> {
        let at = self.windows.iter().next().and_then(Window::cursor_position)?;
        let (camera, place) = self.cameras.iter().next()?;
        Some((camera.viewport_to_world(place, at).ok()?, place.forward()))
    }
}

/// Takes the particle under the pointer, of any body that moves. The particles of a road are no body.
fn take(
    buttons: Res<ButtonInput<MouseButton>>,
    on_panel: Res<PointerOnPanel>,
    pointer: Pointer,
    bodies: Query<(Entity, &Shown, &Particles, Option<&Springs>), Without<Frozen>>,
    mut held: ResMut<Held>,
    mut commands: Commands,
) {
    if !buttons.just_pressed(MouseButton::Left) || on_panel.0 {
        return;
    }
    let Some((ray, _)) = pointer.ray() else { return };
    let all = bodies.iter().filter_map(|(body, shown, particles, springs)| {
        let shortest = springs.and_then(|springs| springs.iter().map(|spring| spring.rest_length).reduce(f64::min));
        let (i, along) = under(ray, shown.positions(), shortest.unwrap_or(1.0) as f32)?;
        Some((along, body, i, shown.positions()[i], particles.position(ParticleId(i as u32))?))
    });
    let Some((_, body, i, shown, at)) = all.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
    held.0 = Some((body, shown, at.as_vec3() - shown));
    commands.entity(body).insert(Pull { particle: ParticleId(i as u32), target: at });
}

/// The particle of a body that a ray meets first, and how far along: of those within reach, the nearest to where the ray comes to the first of them.
fn under(ray: Ray3d, positions: &[Vec3], rest_length: f32) -> Option<(usize, f32)> {
    let near = positions.iter().enumerate().filter_map(|(i, &at)| {
        let along = (at - ray.origin).dot(*ray.direction);
        let beside = at.distance(ray.origin + *ray.direction * along);
        (along > 0.0 && beside < REACH.0 * along + REACH.1 * rest_length).then_some((i, along, beside))
    });
    let near: Vec<_> = near.collect();
    let first = near.iter().map(|near| near.1).reduce(f32::min)?;
    let distance = |(_, along, beside): &(usize, f32, f32)| (along - first).hypot(*beside);
    near.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|(i, along, _)| (i, along))
}

/// Moves what pulls with the pointer, in the plane across the view in which the particle was taken, and lets go with the button.
fn drag(
    buttons: Res<ButtonInput<MouseButton>>,
    pointer: Pointer,
    mut held: ResMut<Held>,
    mut pulls: Query<&mut Pull>,
    mut commands: Commands,
) {
    let Some((body, taken, offset)) = held.0 else { return };
    let Ok(mut pull) = pulls.get_mut(body) else {
        // Just taken, or gone with its scene.
        if !buttons.just_pressed(MouseButton::Left) {
            held.0 = None;
        }
        return;
    };
    if !buttons.pressed(MouseButton::Left) {
        held.0 = None;
        commands.entity(body).remove::<Pull>();
        return;
    }
    let Some((ray, forward)) = pointer.ray() else { return };
    if let Some(along) = ray.intersect_plane(taken, InfinitePlane3d { normal: forward }) {
        pull.target = (ray.get_point(along) + offset).as_dvec3();
    }
}

/// Draws the force as a line.
fn show(held: Res<Held>, pulls: Query<(&Pull, &Shown)>, mut lines: Gizmos) {
    const STRING: Srgba = Srgba::new(1.0, 0.95, 0.6, 1.0);
    let Some((body, _, offset)) = held.0 else { return };
    let Ok((pull, shown)) = pulls.get(body) else { return };
    let Some(&at) = shown.positions().get(pull.particle.index()) else { return };
    lines.arrow(at, pull.target.as_vec3() - offset, STRING);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_particle_under_the_pointer_is_the_nearest_that_it_meets() {
        let ray = Ray3d { origin: Vec3::new(0.0, 0.0, 20.0), direction: Dir3::NEG_Z };
        // Behind another, beside, a little off, and behind the camera.
        let positions = [Vec3::ZERO, Vec3::X * 3.0, Vec3::new(0.1, 0.2, 5.0), Vec3::new(0.3, 0.0, 5.1), Vec3::Z * 30.0];
        assert_eq!(under(ray, &positions, 1.0).map(|(i, _)| i), Some(2));
        assert_eq!(under(ray, &positions[..1], 1.0).map(|(i, _)| i), Some(0));
        assert_eq!(under(ray, &positions[1..2], 1.0), None);
    }

    #[test]
    fn every_place_of_a_face_takes_the_mass_of_it_that_is_nearest() {
        // Three masses each way; the face towards the eye is at z = 2.
        let grid = |i: usize| Vec3::new((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32);
        let positions: Vec<_> = (0..27).map(grid).collect();
        for (x, y) in [(0.5, 0.5), (1.0, 1.0), (1.45, 0.52), (0.02, 1.9), (1.5, 1.5)] {
            let ray = Ray3d { origin: Vec3::new(x, y, 12.0), direction: Dir3::NEG_Z };
            let taken = grid(under(ray, &positions, 1.0).unwrap().0);
            assert!(taken.z == 2.0 && (taken - Vec3::new(x, y, 2.0)).abs().max_element() <= 0.5, "{taken} at {x}, {y}");
        }
    }
}
