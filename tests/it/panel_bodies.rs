//! What the panel shows and sets of bodies that are no worms: animals, blocks, and several at once.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    creatures::library,
    panel::{self, Settings, bridge, traces::observe},
    physics::{Steer, body_parts},
    scenes::{self, parameters},
    view::Selected,
};

/// The world of a shipped scene.
fn opened(scene: &str) -> World {
    let mut world = World::new();
    scenes::open(&mut world, scenes::load(scene).unwrap()).unwrap();
    world
}

fn body_named(world: &mut World, wanted: &str) -> Entity {
    let mut bodies = world.query::<(Entity, &Name)>();
    bodies.iter(world).find(|(_, name)| name.as_str() == wanted).unwrap().0
}

#[test]
fn rest_lengths_are_those_that_waves_drive() {
    let mut world = opened("meadow");
    let snake = body_named(&mut world, "snake");
    let parts = body_parts(world.entity(snake)).unwrap();
    let early = observe(&parts, DVec3::ZERO, 0.0);
    let late = observe(&parts, DVec3::ZERO, 500.0);
    let driven = early.springs.iter().zip(&late.springs).filter(|(a, b)| (a.2 - b.2).abs() > 1e-3).count();
    assert!(driven >= 4, "{:?} and {:?}", early.springs, late.springs);
    assert!(early.block.is_none());
}

#[test]
fn a_block_is_seen_with_its_shape_and_energy() {
    let world = opened("jelly-lab");
    let body = world.resource::<scenes::SceneBodies>().0[0];
    let parts = body_parts(world.entity(body)).unwrap();
    let seen = observe(&parts, DVec3::ZERO, 0.0).block.unwrap();
    assert!(seen.shape.shape_error < 1e-7 && seen.shape.inverted == 0, "{seen:?}");
    assert!((seen.shape.volume.unwrap() - 1.0).abs() < 1e-12);
    // At rest and unstretched it has the energy of its height alone.
    let gravity = parts.gravity.unwrap().acceleration();
    let height = parts.particles.positions().zip(parts.particles.masses()).map(|(x, m)| m * gravity * x.y).sum::<f64>();
    assert!(height > 0.1 && (seen.energy / height - 1.0).abs() < 1e-9, "{} of {height}", seen.energy);
}

#[test]
fn every_parameter_of_every_scene_belongs_to_a_body_of_the_panel() {
    for scene in library::list(library::SCENE).into_keys() {
        let mut world = opened(&scene);
        let mut names = world.query::<&Name>();
        let names: Vec<String> = names.iter(&world).map(ToString::to_string).collect();
        for parameter in parameters::list(&mut world) {
            let owner = panel::Path::parse(&parameter.path).owner;
            assert!(owner == "clock" || names.iter().any(|name| name == owner), "{scene}: {}", parameter.path);
        }
    }
}

#[test]
fn bodies_that_are_set_together_get_the_same_value() {
    let mut app = App::new();
    app.init_resource::<Settings>().init_resource::<bridge::Known>();
    scenes::open(app.world_mut(), scenes::load("jelly-lab").unwrap()).unwrap();
    bridge::read(app.world_mut());
    let mut settings = app.world_mut().resource_mut::<Settings>();
    assert!(settings.together, "blocks side by side");
    let own = format!("{}.block.tilt", settings.body().unwrap().name);
    settings.request(&own, 15.0);
    bridge::apply(app.world_mut());
    let tilts = |world: &mut World| {
        let all = parameters::list(world).into_iter().filter(|parameter| parameter.path.ends_with(".block.tilt"));
        all.map(|parameter| parameter.value).collect::<Vec<_>>()
    };
    assert_eq!(tilts(app.world_mut()), [15.0; 4]);
    let mut settings = app.world_mut().resource_mut::<Settings>();
    settings.together = false;
    settings.request(&own, 30.0);
    bridge::apply(app.world_mut());
    assert_eq!(tilts(app.world_mut()).into_iter().filter(|tilt| *tilt == 30.0).count(), 1);
}

#[test]
fn the_animal_that_is_led_and_the_body_that_is_shown_are_one() {
    let mut app = App::new();
    app.init_resource::<Settings>().init_resource::<bridge::Known>();
    scenes::open(app.world_mut(), scenes::load("meadow").unwrap()).unwrap();
    let bodies = app.world().resource::<scenes::SceneBodies>().0.clone();
    for body in &bodies {
        app.world_mut().entity_mut(*body).insert(Steer::default());
    }
    app.insert_resource(Selected(Some(bodies[2])));
    bridge::read(app.world_mut());
    let shown = |app: &App| app.world().resource::<Settings>().body().unwrap().entity;
    let listed: Vec<_> = app.world().resource::<Settings>().bodies.iter().map(|body| body.entity).collect();
    assert_eq!(listed, bodies, "in the order of the scene");
    assert_eq!(shown(&app), bodies[2]);
    // Another one is led, by Tab or the mouse.
    app.insert_resource(Selected(Some(bodies[1])));
    bridge::read(app.world_mut());
    assert_eq!(shown(&app), bodies[1]);
    // Another one is chosen in the panel.
    app.world_mut().resource_mut::<Settings>().selected = 3;
    bridge::read(app.world_mut());
    assert_eq!((shown(&app), app.world().resource::<Selected>().0), (bodies[3], Some(bodies[3])));
    // What belongs to nobody changes nothing.
    bridge::read(app.world_mut());
    assert_eq!((shown(&app), app.world().resource::<Selected>().0), (bodies[3], Some(bodies[3])));
}
