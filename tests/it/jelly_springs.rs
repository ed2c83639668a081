//! Springs of a block by the neighbours that they join, set while it runs.

use std::fs;

use bevy::prelude::*;
use wriggle::{
    body::{Lattice, Neighbours, SpringId, Springs},
    physics::{Clock, Plan, body_parts},
    scenes::{self, SceneBodies, parameters},
};

use crate::support::{bits, particles, stepping_app};

fn world(scene: &str) -> World {
    let mut world = World::new();
    scenes::open(&mut world, scenes::load(scene).unwrap()).unwrap();
    world
}

/// The fields of a body's block.
fn fields(world: &mut World, body: &str) -> Vec<String> {
    let start = format!("{body}.block.");
    let paths = parameters::list(world).into_iter().map(|parameter| parameter.path);
    paths.filter_map(|path| path.strip_prefix(&start).map(str::to_owned)).collect()
}

/// Stiffness and damping of the springs of each kind, which are all alike.
fn kinds(world: &World, body: Entity) -> Vec<(f64, f64)> {
    let (lattice, springs) = (world.get::<Lattice>(body).unwrap(), world.get::<Springs>(body).unwrap());
    let kinds = Neighbours::ALL.into_iter().filter(|kind| lattice.joins(*kind));
    kinds
        .map(|kind| springs.uniform(lattice.range(kind)).map(|spring| (spring.stiffness, spring.damping)).unwrap())
        .collect()
}

#[test]
fn only_the_neighbours_that_a_block_joins_are_offered() {
    let mut world = world("jelly-lab");
    let of = |kinds: &[&str]| {
        let all = kinds
            .iter()
            .flat_map(|kind| ["stiffness", "damping", "rest_length"].map(|field| format!("{kind}.{field}")));
        core::iter::once("tilt".to_owned()).chain(all).collect::<Vec<_>>()
    };
    assert_eq!(fields(&mut world, "edges"), of(&["edges"]));
    assert_eq!(fields(&mut world, "faces"), of(&["edges", "faces"]));
    assert_eq!(fields(&mut world, "cubes"), of(&["edges", "cubes"]));
    assert_eq!(fields(&mut world, "all"), of(&["edges", "faces", "cubes"]));
    for (path, value, words) in [
        ("faces.block.cubes.stiffness", 1.0, "`faces` has "),
        ("faces.block.cubes.stiffness", 1.0, "faces.block.faces.stiffness"),
        ("faces.block.faces.stiffness", -1.0, "give a finite number, 0 or more"),
        ("faces.block.faces.damping", f64::NAN, "NaN is not allowed"),
        ("faces.block[0].faces.damping", 1.0, "give `faces.block.faces.damping`"),
    ] {
        let before = parameters::list(&mut world);
        let problem = parameters::set(&mut world, path, value).expect_err(path).to_string();
        assert!(problem.contains(words) || problem.contains("did you mean"), "{problem}");
        assert_eq!(parameters::list(&mut world), before);
    }
    let mut garden = self::world("garden");
    assert!(parameters::list(&mut garden).iter().all(|parameter| !parameter.path.contains(".block.")));
}

#[test]
fn springs_of_a_kind_are_set_while_the_block_runs() {
    let mut app = stepping_app(0.1, 10);
    scenes::open(app.world_mut(), scenes::load("jelly-lab").unwrap()).unwrap();
    app.update();
    app.update();
    let [_, faces, _, all] = app.world().resource::<SceneBodies>().0[..] else { panic!("four blocks") };
    let limit = |app: &App, body| app.world().get::<Plan>(body).unwrap().stability_limit();
    let before = [faces, all].map(|body| limit(&app, body));
    for (path, value) in [
        ("all.block.edges.stiffness", 2.0),
        ("all.block.edges.damping", 0.25),
        ("all.block.faces.stiffness", 4.0),
        ("all.block.cubes.damping", 0.5),
    ] {
        parameters::set(app.world_mut(), path, value).unwrap();
        let parameter = parameters::list(app.world_mut()).into_iter().find(|parameter| parameter.path == path).unwrap();
        assert!(parameter.value == value && parameter.range.contains(&value) && !parameter.help.is_empty());
    }
    assert_eq!(kinds(app.world(), all), [(2.0, 0.25), (4.0, 0.0), (1.0, 0.5)]);
    assert_eq!(kinds(app.world(), faces), [(1.0, 0.0), (1.0, 0.0)]);
    assert!(body_parts(app.world().entity(all)).unwrap().is_regular());
    app.update();
    // The largest stable step is that of the springs as they are now, and of no other body.
    assert_eq!(limit(&app, faces), before[0]);
    let now = limit(&app, all);
    assert!(now < 0.7 * before[1], "{now} of {}", before[1]);
    assert!((now - body_parts(app.world().entity(all)).unwrap().stability_limit(0.0)).abs() < 0.02 * now);
}

#[test]
fn a_block_moves_by_the_springs_that_are_set() {
    let run = |stiffness: Option<f64>| {
        let mut app = stepping_app(0.1, 100);
        scenes::open(app.world_mut(), scenes::load("jelly").unwrap()).unwrap();
        app.world_mut().resource_mut::<Clock>().set_steps_per_tick(500);
        app.update();
        let block = app.world().resource::<SceneBodies>().0[0];
        let name = app.world().get::<Name>(block).unwrap().to_string();
        if let Some(stiffness) = stiffness {
            parameters::set(app.world_mut(), &format!("{name}.block.edges.stiffness"), stiffness).unwrap();
        }
        (0..3).for_each(|_| app.update());
        bits(particles(&app, block))
    };
    let as_it_is = run(None);
    assert!(run(Some(1.0)) == as_it_is);
    assert!(run(Some(0.2)) != as_it_is);
}

#[test]
fn springs_of_a_kind_are_saved_by_one_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let saved = |changes: &[(&str, f64)]| {
        let mut before = world("jelly-lab");
        for (path, value) in changes {
            parameters::set(&mut before, path, *value).unwrap();
        }
        scenes::save(&mut before, &path).unwrap();
        let mut again = World::new();
        scenes::open(&mut again, scenes::load(path.to_str().unwrap()).unwrap()).unwrap();
        let springs = |world: &World| {
            let bodies = &world.resource::<SceneBodies>().0;
            bodies.iter().map(|&body| world.get::<Springs>(body).unwrap().clone()).collect::<Vec<_>>()
        };
        assert_eq!(springs(&again), springs(&before), "{changes:?}");
        assert_eq!(parameters::list(&mut again), parameters::list(&mut before), "{changes:?}");
        let set = scenes::load(path.to_str().unwrap()).unwrap().file.set;
        set.into_iter().filter(|(path, _)| !path.ends_with("tilt")).collect::<Vec<_>>()
    };
    let told = |all: &[(&str, f64)]| all.iter().map(|&(path, value)| (path.to_owned(), value)).collect::<Vec<_>>();
    let two = [("all.block.cubes.damping", 0.5), ("all.block.faces.stiffness", 2.0)];
    assert_eq!(saved(&two), told(&two));
    // What is of all springs is one path, too, and what is of one spring stands beside its kind.
    assert_eq!(saved(&[("edges.block.edges.stiffness", 2.0)]), told(&[("edges.springs.stiffness", 2.0)]));
    assert_eq!(
        saved(&[("all.springs.stiffness", 3.0), ("all.block.edges.stiffness", 2.0)]),
        told(&[
            ("all.block.cubes.stiffness", 3.0),
            ("all.block.edges.stiffness", 2.0),
            ("all.block.faces.stiffness", 3.0)
        ])
    );
    let longer = [("edges.block.edges.rest_length", 1.25)];
    assert_eq!(saved(&longer), told(&longer));
    let mixed = [("faces.block.edges.stiffness", 2.0), ("faces.springs[400].stiffness", 3.0)];
    assert_eq!(saved(&mixed), told(&mixed));
}

#[test]
fn what_a_file_sets_of_a_kind_holds_against_what_it_sets_of_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.scene.ron");
    fs::write(
        &path,
        "Scene(version: 1, title: \"Mine\", ground: Flat, creatures: [(name: \"b\", creature: \"jelly-all\")],
           set: {\"b.springs.stiffness\": 3, \"b.block.faces.stiffness\": 2, \"b.springs[0].stiffness\": 4})",
    )
    .unwrap();
    let world = world(path.to_str().unwrap());
    let body = world.resource::<SceneBodies>().0[0];
    let lattice = world.get::<Lattice>(body).unwrap();
    let springs = world.get::<Springs>(body).unwrap();
    let stiffness = |i: usize| springs.get(SpringId(i as u32)).unwrap().stiffness;
    let starts = Neighbours::ALL.map(|kind| stiffness(lattice.range(kind).start));
    assert_eq!((starts, stiffness(1)), ([4.0, 2.0, 3.0], 3.0));
}

#[test]
fn no_rest_length_is_that_of_all_springs_of_a_block() {
    let mut world = world("jelly-lab");
    let body = world.resource::<SceneBodies>().0[3];
    let before = world.get::<Springs>(body).unwrap().clone();
    // Neighbours at √2 and √3 would be drawn to 1, and the block crumpled.
    let problem = parameters::set(&mut world, "all.springs.rest_length", 1.0).unwrap_err().to_string();
    for kind in ["edges", "faces", "cubes"] {
        assert!(problem.contains(&format!("`all.block.{kind}.rest_length`")), "{problem}");
    }
    assert_eq!(*world.get::<Springs>(body).unwrap(), before);
    let listed = parameters::list(&mut world);
    assert!(listed.iter().all(|parameter| !parameter.path.contains(".springs") || !parameter.path.ends_with("length")));
    let value = |path: &str| listed.iter().find(|parameter| parameter.path == path).unwrap().value;
    assert_eq!(value("all.block.edges.rest_length"), 1.0);
    assert_eq!(value("all.block.faces.rest_length"), core::f64::consts::SQRT_2);
    parameters::set(&mut world, "all.block.faces.rest_length", 1.5).unwrap();
    let springs = world.get::<Springs>(body).unwrap();
    let lattice = world.get::<Lattice>(body).unwrap();
    let lengths =
        Neighbours::ALL.map(|kind| springs.uniform(lattice.range(kind)).map(|spring| spring.rest_length).unwrap());
    assert_eq!(lengths, [1.0, 1.5, 3.0_f64.sqrt()]);
    // One spring can still be set by itself.
    parameters::set(&mut world, "all.springs[0].rest_length", 1.25).unwrap();
    assert_eq!(world.get::<Springs>(body).unwrap().get(SpringId(0)).unwrap().rest_length, 1.25);
}
