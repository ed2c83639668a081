//! A creature file that is opened without a scene: it is seen as a whole, and as fast as it wants to be watched.

use bevy::math::{DQuat, DVec3};
use wriggle::{
    body::Particles,
    scenes::{self, Camera, FIELD_OF_VIEW, SceneBodies},
};

#[test]
fn all_of_a_creature_is_in_the_picture_when_it_is_opened_alone() {
    for name in ["garden-worm", "snake", "caterpillar", "two-mass-worm", "jelly-all"] {
        let loaded = scenes::load_creature(name).unwrap();
        let Camera::Orbit { target, distance, pitch, yaw } = loaded.file.camera;
        let mut world = bevy::prelude::World::new();
        scenes::open(&mut world, loaded).unwrap();
        let body = world.resource::<SceneBodies>().0[0];
        let turn = DQuat::from_rotation_y(yaw.to_radians()) * DQuat::from_rotation_x(-pitch.to_radians());
        let eye = DVec3::from(target) + turn * DVec3::Z * distance;
        let (mut widest, half) = (0.0_f64, libm::tan(0.5 * FIELD_OF_VIEW.to_radians()));
        for at in world.get::<Particles>(body).unwrap().positions() {
            // As the camera sees it: x to the right, y up, looking along −z.
            let seen = turn.inverse() * (at - eye);
            assert!(seen.z < 0.0, "{name}: a mass is behind the camera");
            widest = widest.max((seen.x / -seen.z).abs().max((seen.y / -seen.z).abs()) / half);
        }
        // All of it is inside of the picture's height, and fills a part of it that one can look at.
        assert!((0.15..1.0).contains(&widest), "{name}: its edge is at {widest} of the picture's half");
    }
}

#[test]
fn a_cycle_of_a_creature_alone_takes_some_seconds() {
    for (name, period) in [("garden-worm", 6.0), ("snake", 60.0), ("sidewinder", 80.0), ("caterpillar", 40.0)] {
        let scale = scenes::load_creature(name).unwrap().file.clock.time_scale;
        assert!((1.5..5.0).contains(&(period / scale)), "{name}: a cycle takes {} s", period / scale);
    }
    assert_eq!(scenes::load_creature("jelly-all").unwrap().file.clock.time_scale, 1.0, "what has no cycle");
}
