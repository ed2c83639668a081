//! What the panel shows and sets of bodies that are no worms: animals, blocks, and several at once.

use bevy::{camera::RenderTargetInfo, math::DVec3, prelude::*};
use bevy_egui::egui;
use wriggle::{
    body::{ParticleId, Pull},
    creatures::library,
    panel::{
        self, Settings,
        blocks::{self, BlockLabel},
        bridge,
        traces::observe,
    },
    physics::{PhysicsPlugin, Shown, Steer, body_parts},
    scenes::{self, ScenesPlugin, parameters},
    view::{SceneCamera, Selected, skin_color},
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

#[test]
fn the_body_that_is_taken_in_hand_is_shown() {
    let mut app = App::new();
    app.init_resource::<Settings>().init_resource::<bridge::Known>();
    for scene in ["jelly-lab", "rough-road"] {
        scenes::open(app.world_mut(), scenes::load(scene).unwrap()).unwrap();
        let bodies = app.world().resource::<scenes::SceneBodies>().0.clone();
        bridge::read(app.world_mut());
        let shown = |app: &App| app.world().resource::<Settings>().body().unwrap().entity;
        assert_eq!(shown(&app), bodies[0]);
        app.world_mut().entity_mut(bodies[1]).insert(Pull { particle: ParticleId(0), target: DVec3::ZERO });
        bridge::read(app.world_mut());
        assert_eq!(shown(&app), bodies[1], "{scene}");
        let settings = app.world().resource::<Settings>();
        let own = format!("{}.", settings.body().unwrap().name);
        assert!(settings.parameters.iter().any(|setting| setting.path.starts_with(&own)), "{scene}");
        // While it is held another one can be chosen in the panel; what is let go stays shown.
        app.world_mut().resource_mut::<Settings>().selected = 0;
        bridge::read(app.world_mut());
        assert_eq!(shown(&app), bodies[0], "{scene}");
        app.world_mut().entity_mut(bodies[1]).remove::<Pull>();
        bridge::read(app.world_mut());
        assert_eq!(shown(&app), bodies[0], "{scene}");
    }
}

/// A camera that looks along −z at the middle of the blocks, 100 pixels for a length at the plane of the middle.
fn camera() -> (SceneCamera, Camera, GlobalTransform) {
    let mut camera = Camera::default();
    camera.computed.target_info = Some(RenderTargetInfo { physical_size: UVec2::new(4000, 2000), scale_factor: 1.0 });
    camera.computed.clip_from_view = Mat4::orthographic_rh(-20.0, 20.0, -10.0, 10.0, 100.0, 0.0);
    (SceneCamera, camera, GlobalTransform::from_xyz(0.0, 0.0, 50.0))
}

#[test]
fn blocks_side_by_side_have_their_names_above_them() {
    let mut app = App::new();
    let scene = scenes::load("jelly-lab").unwrap();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default(), ScenesPlugin::new(scene)));
    app.init_resource::<Settings>().init_resource::<bridge::Known>();
    app.update();
    bridge::read(app.world_mut());
    let labels = |app: &App| app.world().resource::<Settings>().blocks.clone();
    assert!(labels(&app).iter().all(|label| label.place.is_none()), "without a camera nothing is in sight");
    app.world_mut().spawn(camera());
    bridge::read(app.world_mut());
    let names: Vec<_> = labels(&app).into_iter().map(|label| label.name).collect();
    assert_eq!(names, ["edges", "faces", "cubes", "all"]);
    for (label, body) in labels(&app).iter().zip(&app.world().resource::<scenes::SceneBodies>().0) {
        assert_eq!(label.color, skin_color(*app.world().get(*body).unwrap()), "{}", label.name);
        let shown = app.world().get::<Shown>(*body).unwrap().positions();
        let middle = shown.iter().map(|at| at.x).sum::<f32>() / shown.len() as f32;
        let top = shown.iter().map(|at| at.y).fold(0.0, f32::max);
        // Pixels go to the right and down.
        let (x, y) = label.place.unwrap();
        assert!((x - (2000.0 + 100.0 * middle)).abs() < 0.1, "{label:?}, its middle at {middle}");
        let above = (1000.0 - y) / 100.0 - top;
        assert!((0.5..1.5).contains(&above), "{} is {above} above its block", label.name);
    }
    // Which of them a single block is, nobody asks.
    scenes::open(app.world_mut(), scenes::load("jelly").unwrap()).unwrap();
    bridge::read(app.world_mut());
    assert_eq!(labels(&app), []);
}

#[test]
fn the_name_of_a_block_is_written_where_it_is_in_sight() {
    let block = |name: &str, place| BlockLabel { name: name.into(), color: 0x35a86b, place };
    let blocks = [block("faces", Some((400.0, 300.0))), block("all", None)];
    let context = egui::Context::default();
    let mut output = context.run_ui(egui::RawInput::default(), |ui| blocks::labels(ui.ctx(), &blocks));
    output.textures_delta.clear();
    let (mut texts, mut frames) = (Vec::new(), Vec::new());
    for clipped in output.shapes {
        match clipped.shape {
            egui::Shape::Text(text) => texts.push((text.galley.text().to_owned(), text.visual_bounding_rect())),
            egui::Shape::Rect(rect) => frames.push((rect.rect, rect.stroke.color)),
            _ => {}
        }
    }
    let ([(text, field)], [(frame, color)]) = (&texts[..], &frames[..]) else { panic!("{texts:?} {frames:?}") };
    assert_eq!((text.as_str(), *color), ("faces", egui::Color32::from_rgb(0x35, 0xa8, 0x6b)));
    assert!(frame.contains_rect(*field) && (frame.center().x - 400.0).abs() < 1.0 && frame.top() < 300.0, "{frame}");
}
