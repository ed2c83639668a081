//! What a frame shows: positions between two ticks, followers, laps.

use bevy::{math::DVec3, prelude::*, time::TimeUpdateStrategy};
use core::time::Duration;
use wriggle::{
    body::{Particle, ParticleId, Particles, Springs},
    physics::{Clock, FollowParticle, PhysicsPlugin, Shown, ShownLap},
    scenes::{self, SceneBodies, ScenesPlugin, garden},
};

use crate::support::ticking_app;

/// A mass that moves one length a second of real time, in an app whose frames last `frame` seconds.
fn moving(frame: f64) -> (App, Entity) {
    let mut app = ticking_app(0.001, 1.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(frame)));
    let particle = Particle { velocity: DVec3::X, ..Particle::at(DVec3::Y) };
    let body = app.world_mut().spawn((Particles::new([particle]).unwrap(), Springs::default())).id();
    (app, body)
}

#[test]
fn followers_move_evenly_between_ticks() {
    // 200 frames a second on 64 ticks a second: without interpolation, two frames of three would stand still.
    let (mut app, body) = moving(0.005);
    let follower = app.world_mut().spawn(FollowParticle { body, particle: ParticleId(0) }).id();
    for _ in 0..50 {
        app.update();
    }
    let at = |app: &App| app.world().get::<Transform>(follower).unwrap().translation;
    let mut last = at(&app);
    for _ in 0..100 {
        app.update();
        let now = at(&app);
        let moved = now.x - last.x;
        // Ticks are a whole number of steps of 0.001, so a tick may be one step short.
        assert!((moved - 0.005).abs() < 0.0008, "moved {moved} in a frame of 0.005");
        assert_eq!((now.y, now.z), (1.0, 0.0));
        last = now;
    }
}

#[test]
fn followers_are_drawn_where_they_are_whatever_schedule_the_physics_has() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, PhysicsPlugin::new(Update)));
    let particle = Particle { velocity: DVec3::X, ..Particle::at(DVec3::Y) };
    let body = app.world_mut().spawn((Particles::new([particle]).unwrap(), Springs::default())).id();
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(5);
    let follower = app.world_mut().spawn(FollowParticle { body, particle: ParticleId(0) }).id();
    for _ in 0..20 {
        app.update();
        let moved = app.world().get::<Particles>(body).unwrap().center().as_vec3();
        assert_eq!(app.world().get::<GlobalTransform>(follower).unwrap().translation(), moved);
    }
}

#[test]
fn what_is_shown_moves_on_through_ticks_without_steps() {
    // Steps of 0.2 at three units a second: a tick in four or five takes one, and a frame is less than a tick.
    let (mut app, body) = moving(0.005);
    app.insert_resource(Clock::new(0.2, 3.0).unwrap());
    for _ in 0..100 {
        app.update();
    }
    let at = |app: &App| f64::from(app.world().get::<Shown>(body).unwrap().positions()[0].x);
    let mut last = at(&app);
    for _ in 0..200 {
        app.update();
        let now = at(&app);
        assert!((now - last - 0.015).abs() < 1e-5, "moved {} in a frame of 0.015", now - last);
        last = now;
    }
    let time = app.world().resource::<Clock>().time();
    assert!(last <= time + 1e-6 && last >= time - 0.25, "{last} at {time}");
}

#[test]
fn what_is_shown_is_at_most_a_tick_behind() {
    let (mut app, body) = moving(0.011);
    for _ in 0..30 {
        app.update();
        let shown = app.world().get::<Shown>(body).unwrap().positions()[0].x;
        let now = app.world().resource::<Clock>().time() as f32;
        assert!(shown <= now + 1e-6 && shown >= now - 1.0 / 64.0 - 1e-6, "{shown} at {now}");
    }
}

#[test]
fn a_lap_moves_what_is_shown_and_not_the_body() {
    let (mut app, body) = moving(0.02);
    let lap = ShownLap { end: 0.5, length: 2.0 };
    app.world_mut().entity_mut(body).insert(lap);
    for _ in 0..300 {
        app.update();
        let shown = app.world().get::<Shown>(body).unwrap().positions()[0].x;
        assert!((-1.6..0.51).contains(&shown), "shown at {shown}");
    }
    assert!(app.world().get::<Particles>(body).unwrap().center().x > 5.0);
    assert_eq!([0.0, 0.49, 0.5, 2.49, 2.5, 4.6].map(|x| lap.offset(x)), [0.0, 0.0, 2.0, 2.0, 4.0, 6.0]);
}

#[test]
fn the_garden_worm_goes_in_at_its_door_and_comes_out_of_its_burrow_again_and_again() {
    /// How far the inside of the house and the tunnel of the burrow reach.
    const INSIDE: [f32; 2] = [-5.0, 14.5];
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default(), ScenesPlugin::new(scenes::load("garden").unwrap())));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.update();
    let worm = app.world().resource::<SceneBodies>().0[0];
    let ends = |app: &App| {
        let places = app.world().get::<Shown>(worm).unwrap().positions().iter().map(|at| at.x);
        places.fold([f32::INFINITY, f32::NEG_INFINITY], |[tail, head], x| [tail.min(x), head.max(x)])
    };
    let (mut laps, mut before, mut left, mut arrived) = (0, ends(&app), false, false);
    // Three times the length of the path and more.
    for _ in 0..8000 {
        app.update();
        let [tail, head] = ends(&app);
        if head < before[1] - 5.0 {
            // It was all in its house, and is all in its burrow, out of sight both times.
            assert!(before[0] > garden::DOOR as f32 && before[1] < INSIDE[1], "behind the door at {before:?}");
            assert!(head < garden::BURROW_MOUTH as f32 && tail > INSIDE[0], "in the burrow at {tail} to {head}");
            assert!(laps == 0 || left && arrived, "it came all the way");
            (laps, left, arrived) = (laps + 1, false, false);
        } else {
            assert!((head - before[1]).abs() < 0.1, "from {} to {head} in a tick", before[1]);
        }
        left |= tail > garden::BURROW_MOUTH as f32 && head < garden::DOOR as f32;
        arrived |= tail < garden::DOOR as f32 && head > garden::DOOR as f32;
        before = [tail, head];
    }
    assert!(laps >= 3, "{laps} laps");
    let way = app.world().get::<Particles>(worm).unwrap().center().x;
    assert!(way > garden::LAP.end + 2.0 * garden::LAP.length, "the body itself goes straight on: {way}");
}
