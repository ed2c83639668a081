//! Surroundings without end: the ground goes on under animals that crawl away, and what is far stays far.

use bevy::prelude::*;
use bevy_panorbit_camera::{PanOrbitCamera, PanOrbitCameraSystemSet};

use super::camera::{FollowWorm, SceneCamera};
use crate::{
    physics::Shown,
    scenes::{self, CurrentScene, FIELD_OF_VIEW, Props, SceneBodies},
};

/// Moves with what the camera looks at, so that its middle stays the nearest that it can.
#[derive(Clone, Component, Copy, Debug)]
pub(super) struct Travels {
    /// By whole multiples of this length, after which it looks the same; by any length where it is 0.
    pub every: f32,
    /// Where its middle is at home.
    pub middle: Vec3,
}

impl Travels {
    /// How far from home it is while the camera looks at `focus`.
    fn offset(self, focus: Vec3) -> Vec3 {
        let away = focus - self.middle;
        if self.every > 0.0 { (away / self.every).round() * self.every } else { away }
    }
}

/// No further away does the camera go by itself: animals that are further apart than it then sees are too small to be looked at together.
const FARTHEST: f32 = 100.0;

/// Where the animals of the scene were when the camera last went along.
#[derive(Clone, Copy)]
struct Seen {
    /// On average.
    middle: Vec3,
    /// From where the scene's camera would see them as large a part of the picture apart as at the start.
    distance: f32,
}

/// Where the animals of the scene are as a whole.
#[derive(Default, Resource)]
pub(super) struct Herd {
    /// Their middle at the start.
    middle_at_start: Vec3,
    /// How far apart they were at the start: the largest distance of one of them from the middle.
    reach_at_start: f32,
    seen: Option<Seen>,
}

impl Herd {
    /// How far the animals have gone over the ground since the start, and how far away the scene's camera would stand by now that stood so far away then.
    pub(super) fn since_start(&self, distance: f32) -> (Vec3, f32) {
        let Some(seen) = self.seen else { return (Vec3::ZERO, distance) };
        ((seen.middle - self.middle_at_start).with_y(0.0), seen.distance)
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Herd>().add_systems(PostUpdate, (go_along, travel).chain().before(PanOrbitCameraSystemSet));
}

/// Carries the camera along with the animals as a whole, and away from them as they part, wherever its user has turned it. In the garden and on roads,
/// which are one place, it stays.
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
        herd.seen = None;
    }
    let middle = |shown: &Shown| shown.positions().iter().sum::<Vec3>() / shown.positions().len().max(1) as f32;
    let middles: Vec<_> = bodies.0.iter().filter_map(|body| shown.get(*body).ok()).map(middle).collect();
    let has_road = scene.file.road.is_some() || scene.file.creatures.iter().any(|placement| placement.road.is_some());
    if middles.is_empty() || has_road || matches!(scene.file.props, Props::Garden { .. }) {
        return;
    }
    let now = middles.iter().sum::<Vec3>() / middles.len() as f32;
    let reach = middles.iter().map(|middle| middle.distance(now)).fold(0.0, f32::max);
    if herd.seen.is_none() {
        (herd.middle_at_start, herd.reach_at_start) = (now, reach);
    }
    let scenes::Camera::Orbit { distance, .. } = scene.file.camera;
    let distance = distance as f32;
    let seen = Seen { middle: now, distance: further(distance, reach - herd.reach_at_start) };
    let before = herd.seen.replace(seen).unwrap_or(seen);
    let moved = (now - before.middle).with_y(0.0);
    let wider = seen.distance / before.distance;
    if following.0 || (moved == Vec3::ZERO && wider == 1.0) {
        return;
    }
    for mut orbit in &mut cameras {
        orbit.focus += moved;
        orbit.target_focus += moved;
        orbit.radius = orbit.radius.map(|radius| radius * wider);
        orbit.target_radius *= wider;
        orbit.force_update = true;
    }
}

/// From how far away what is so much further apart than at `distance` fits into the picture, no further than [`FARTHEST`].
fn further(distance: f32, apart: f32) -> f32 {
    // Pictures are wider than high, and what parts towards the camera or away from it is foreshortened.
    const WIDE: f32 = 16.0 / 9.0;
    let per_length = ((0.5 * FIELD_OF_VIEW as f32).to_radians().tan() * WIDE).recip();
    (distance + apart.max(0.0) * per_length).min(FARTHEST.max(distance))
}

fn travel(cameras: Query<&PanOrbitCamera, With<SceneCamera>>, mut things: Query<(&Travels, &mut Transform)>) {
    let Some(orbit) = cameras.iter().next() else { return };
    for (travels, mut transform) in &mut things {
        let there = travels.offset(orbit.focus).with_y(transform.translation.y);
        if transform.translation != there {
            transform.translation = there;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_of_a_tile_are_always_all_around_what_is_looked_at() {
        let (every, side) = (96.0, 16.0);
        let corners = (0..36).map(|i| Vec3::new((i % 6) as f32, 0.0, (i / 6) as f32));
        let middles: Vec<_> = corners.map(|corner| (corner + Vec3::new(0.5, 0.0, 0.5)) * side - 48.0).collect();
        for focus in [Vec3::ZERO, Vec3::new(7.0, 2.0, -300.5), Vec3::new(1e4, 0.0, 49.0)] {
            let mut taken: Vec<_> = middles
                .iter()
                .map(|&middle| {
                    let there = middle + Travels { every, middle }.offset(focus);
                    let off = there - focus;
                    assert!(
                        off.x.abs() <= 0.5 * every && off.z.abs() <= 0.5 * every,
                        "{middle} at {there} for {focus}"
                    );
                    // A tile further on all looks the same.
                    assert_eq!(((there - middle) / every).fract().with_y(0.0), Vec3::ZERO);
                    ((there.x / side).floor() as i32, (there.z / side).floor() as i32)
                })
                .collect();
            taken.sort_unstable();
            taken.dedup();
            assert_eq!(taken.len(), middles.len(), "two patches in one place for {focus}");
        }
    }
}
