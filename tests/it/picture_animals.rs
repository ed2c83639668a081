//! One picture of each scene with animals, looked at coarsely: they are where they should be, and nothing else is.

use bevy::{camera::Camera, prelude::*};
use wriggle::{
    physics::{Clock, PhysicsPlugin, Shown, Ticks},
    scenes::{self, ScenesPlugin},
    view::{Picture, Quality, SceneCamera, Shot},
};

use crate::picture::can_draw;

const SIZE: (u32, u32) = (320, 180);

/// A scene after a time, and the pixels at which its bodies are shown.
fn scene(name: &str, time: f64) -> (Shot, Vec<(String, Vec<Vec2>)>) {
    let file = scenes::load(name).expect("the scene is shipped");
    let mut shot = Shot::new(SIZE, Some(Quality::Low), |app| {
        app.add_plugins((PhysicsPlugin::new(Ticks), ScenesPlugin::new(file)));
    })
    .expect("there is an adapter");
    shot.update();
    let world = shot.world_mut();
    let mut clock = world.resource_mut::<Clock>();
    let steps = (time / clock.dt()).round() as u64;
    clock.set_steps_per_tick(steps);
    world.run_schedule(Ticks);
    shot.update();
    let world = shot.world_mut();
    let mut cameras = world.query_filtered::<(&Camera, &GlobalTransform), With<SceneCamera>>();
    let (camera, place) = cameras.single(world).map(|(camera, place)| (camera.clone(), *place)).expect("one camera");
    let mut bodies = world.query::<(&Name, &Shown)>();
    let project = |shown: &Shown| -> Vec<Vec2> {
        let inside = |at: &Vec2| at.cmpge(Vec2::splat(1.0)).all() && at.x < 319.0 && at.y < 179.0;
        // The masses of a strand are the corners of a box around its round skin, which is thin at the tail and lies on the ground there.
        let points: Vec<_> = match shown.positions() {
            masses if masses.len() >= 12 => masses
                .chunks(4)
                .map(|section| (section[0] + section[1]) * 0.4 + (section[2] + section[3]) * 0.1)
                .collect(),
            // The ball of a mass lies on the ground that the mass stands on.
            masses => masses.iter().map(|at| *at + 0.13 * Vec3::Y).collect(),
        };
        points.iter().filter_map(|&x| camera.world_to_viewport(&place, x).ok()).filter(inside).collect()
    };
    let bodies = bodies.iter(world).map(|(name, shown)| (name.to_string(), project(shown))).collect();
    (shot, bodies)
}

/// Whether two pictures differ at a pixel, visibly.
fn differ(a: &Picture, b: &Picture, at: Vec2) -> bool {
    let (x, y) = (at.x as u32, at.y as u32);
    a.pixel(x, y).iter().zip(b.pixel(x, y)).any(|(&a, b)| a.abs_diff(b) > 10)
}

#[test]
fn every_animal_is_seen_where_its_masses_are_and_nowhere_else() {
    if !can_draw() {
        return;
    }
    for name in ["meadow", "cliff", "sand", "standing-waves", "two-masses", "foot", "wall"] {
        let (mut shot, bodies) = scene(name, 4.2);
        let with = shot.picture().expect("the renderer gives a picture");
        if let Some(folder) = std::env::var_os("WRIGGLE_KEEP_PICTURES") {
            with.save(&std::path::Path::new(&folder).join(format!("{name}.png")))
                .expect("the folder can be written to");
        }
        let world = shot.world_mut();
        let all: Vec<_> = world.query_filtered::<Entity, With<Shown>>().iter(world).collect();
        all.into_iter().for_each(|body| world.entity_mut(body).despawn());
        let without = shot.picture().expect("the renderer gives a picture");
        for (body, points) in &bodies {
            assert!(points.len() >= 2, "{name}: {body} is in the picture");
            let seen = points.iter().filter(|&&at| differ(&with, &without, at)).count();
            let part = seen as f32 / points.len() as f32;
            assert!(part > 0.7, "{name}: {body} is seen at {part} of its masses");
        }
        let (mut beside, mut changed) = (0, 0);
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let at = Vec2::new(x as f32, y as f32);
                if differ(&with, &without, at) {
                    changed += 1;
                    let near = bodies.iter().flat_map(|(_, points)| points).any(|point| point.distance(at) < 24.0);
                    beside += u32::from(!near);
                }
            }
        }
        assert!(beside * 50 < changed, "{name}: {beside} of {changed} pixels that changed are far from any mass");
        // What is left is the ground, in the foreground: grass or sand under the sun, neither black nor empty.
        let ground = without.pixel(SIZE.0 / 4, SIZE.1 - 8).map(i32::from);
        assert!(ground[1] > 70 && ground[1] > ground[2] + 15, "{name}: the ground is {ground:?}");
    }
}

#[test]
fn animals_that_part_stay_in_the_picture() {
    if !can_draw() {
        return;
    }
    for name in ["standing-waves", "wall"] {
        let (mut shot, bodies) = scene(name, 700.0);
        for (body, points) in &bodies {
            let world = shot.world_mut();
            let mut shown = world.query::<(&Name, &Shown)>();
            let (_, shown) = shown.iter(world).find(|(name, _)| name.as_str() == body).expect("it is still there");
            let all = if shown.positions().len() >= 12 { shown.positions().len() / 4 } else { shown.positions().len() };
            assert_eq!(points.len(), all, "{name}: {body} is in the picture as a whole");
        }
    }
}
