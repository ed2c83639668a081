//! Bodies of the six-matrix particle system in the house: clock, watch, restart, hash, parameters, files and scenes.

use std::fs;

use bevy::prelude::*;
use tempfile::TempDir;
use wriggle::{
    body::{Columns, Rules},
    creatures::{Composed, Creature, Inchworm, Pose, Roller},
    mechanics::six_matrix::{Road, RoadSearch, Stepper, look},
    physics::{BodyFrozen, Clock, Frozen, Plan, Restart, Trail, six_parts},
    scenes::{self, SceneBodies, parameters},
};

use crate::{
    cli::json,
    support::{bits, particles, stepping_app},
};

/// A shipped scene, every update so many of its steps.
pub fn open(scene: &str, steps: u64) -> (App, Vec<Entity>) {
    let mut app = stepping_app(1.0, 1);
    scenes::open(app.world_mut(), scenes::load(scene).unwrap()).unwrap();
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(steps);
    let bodies = app.world().resource::<SceneBodies>().0.clone();
    (app, bodies)
}

pub fn state(app: &App, bodies: &[Entity]) -> Vec<Vec<u64>> {
    bodies.iter().map(|body| bits(particles(app, *body))).collect()
}

#[test]
fn ticks_neighbours_and_restarts_change_no_bits() {
    let (mut app, bodies) = open("flat-strip", 600);
    app.update();
    let expected = state(&app, &bodies);
    let trail = |app: &App| app.world().get::<Trail>(bodies[1]).unwrap().clone();
    let way = trail(&app);
    assert_eq!(way.points().len(), 60);
    app.world_mut().write_message(Restart);
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(0);
    app.update();
    assert_eq!(app.world().resource::<Clock>().step(), 0);
    assert_ne!(state(&app, &bodies), expected);
    while app.world().resource::<Clock>().step() < 600 {
        let left = 600 - app.world().resource::<Clock>().step();
        app.world_mut().resource_mut::<Clock>().set_steps_per_tick(left.min(7));
        app.update();
    }
    assert_eq!(app.world().resource::<Clock>().step(), 600);
    assert_eq!(state(&app, &bodies), expected, "after a restart, seven steps a tick");
    assert_eq!(trail(&app), way);
    let text = fs::read_to_string("assets/scenes/flat-strip.scene.ron").unwrap();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("alone.scene.ron");
    for (i, creature) in ["inchworm", "roller"].into_iter().enumerate() {
        let alone = |line: &&str| !line.contains("(name: ") || line.contains(&format!("name: \"{creature}\""));
        let lines: Vec<_> = text.lines().filter(alone).collect();
        // The line that ends the list may be gone.
        fs::write(&path, lines.join("\n").replace(")],", "),").replace("  camera:", "  ], camera:")).unwrap();
        let (mut alone, body) = open(path.to_str().unwrap(), 600);
        alone.update();
        assert_eq!(state(&alone, &body), [expected[i].clone()], "{creature} alone");
    }
}

#[test]
fn what_bursts_is_frozen_in_its_last_good_state_and_its_neighbour_goes_on() {
    let (mut calm, bodies) = open("flat-strip", 300);
    calm.update();
    let expected = state(&calm, &bodies)[0].clone();
    let frozen = |steps: u64| {
        let (mut app, bodies) = open("flat-strip", steps);
        parameters::set(app.world_mut(), "roller.bonds.stiffness", 12.0).unwrap();
        let mut said = Vec::new();
        while app.world().resource::<Clock>().step() < 300 {
            app.update();
            said.extend(app.world_mut().resource_mut::<Messages<BodyFrozen>>().drain().map(|frozen| frozen.text));
        }
        let frozen = app.world().get::<Frozen>(bodies[1]).unwrap().clone();
        assert!(app.world().get::<Frozen>(bodies[0]).is_none());
        assert_eq!(said.len(), 1);
        for part in [
            "roller",
            &format!("particle {}", frozen.particle.0),
            &format!("step {}", frozen.step),
            "0.01",
            "ten times",
        ] {
            assert!(said[0].contains(part), "{} does not name {part}", said[0]);
        }
        // Every bond is whole where it froze, and is not a step later.
        let parts = six_parts(app.world().entity(bodies[1])).unwrap();
        let positions: Vec<_> = parts.particles.positions().collect();
        for ((i, j, _), square) in parts.bonds.relation().pairs().zip(parts.bonds.squares()) {
            let length = positions[i].distance(positions[j]);
            assert!(length <= 10.0 * square.sqrt(), "bond of {i} and {j} is {length} long");
        }
        let burst = Stepper::new(&parts).step(&parts, 0.01).unwrap_err();
        assert_eq!(burst.particle, frozen.particle.index());
        (frozen, state(&app, &bodies))
    };
    let (first, states) = frozen(300);
    assert_eq!(states[0], expected, "the neighbour goes on as if nothing had been");
    let (second, again) = frozen(1);
    assert_eq!((first, states), (second, again), "whatever the ticks");
}

#[test]
fn a_restart_takes_back_what_was_remembered() {
    let (mut app, bodies) = open("inchworm", 300);
    let memory = |app: &App| app.world().get::<Columns>(bodies[0]).unwrap().memory().to_vec();
    let start = memory(&app);
    app.update();
    assert_eq!(memory(&app)[0].x, 300.0);
    app.world_mut().write_message(Restart);
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(0);
    app.update();
    assert_eq!(memory(&app), start);
}

#[test]
fn legs_take_turns() {
    let (mut app, bodies) = open("inchworm", 1);
    for (steps, expected) in
        [(0, [true, false]), (999, [true, false]), (2, [false, true]), (998, [false, true]), (3, [true, false])]
    {
        app.world_mut().resource_mut::<Clock>().set_steps_per_tick(steps);
        app.update();
        let parts = six_parts(app.world().entity(bodies[0])).unwrap();
        let grips: Vec<_> = parts.grips().map(|(_, grips)| grips).collect();
        assert_eq!(grips, expected, "at step {}", app.world().resource::<Clock>().step());
    }
}

#[test]
fn every_constant_is_a_parameter() {
    for (scene, count) in [("inchworm", 62), ("roller", 79)] {
        let (mut app, bodies) = open(scene, 1);
        let all = parameters::list(app.world_mut());
        assert_eq!(all.iter().filter(|parameter| parameter.path.contains("].damping")).count(), count);
        for hidden in ["mass", "gravity", "springs"] {
            assert!(!all.iter().any(|parameter| parameter.path.contains(hidden)), "{hidden}");
        }
        let mut before = all.clone();
        for parameter in all.iter().filter(|parameter| !parameter.path.starts_with("clock")) {
            let other = 0.5 * (parameter.range.start() + parameter.range.end()) + 0.001;
            parameters::set(app.world_mut(), &parameter.path, other).unwrap();
            let now = parameters::list(app.world_mut());
            let at = now.iter().position(|now| now.path == parameter.path).unwrap();
            assert_eq!(now[at].value, other, "{}", parameter.path);
            // Nothing else has changed. All of a kind are shown by the value of the first.
            let kind = |path: &str| path.split(['[', ']']).step_by(2).collect::<String>();
            for (now, before) in now.iter().zip(&before) {
                let same = now.value == before.value || kind(&now.path) == kind(&parameter.path);
                assert!(same, "{} changed {}", parameter.path, now.path);
            }
            before = now;
        }
        app.update();
        assert!(app.world().get::<Rules>(bodies[0]).is_some());
    }
    let (mut app, _) = open("roller", 1);
    parameters::set(app.world_mut(), "roller.drive.friction", 0.5).unwrap();
    for (path, value, part) in [
        ("roller.drive.limit", 0.0, "above 0"),
        ("roller.bonds.stiffness", -1.0, "0 or more"),
        ("roller.drive.frictoin", 0.1, "roller.drive.friction"),
        ("roller.legs.seek", 0.1, "has"),
    ] {
        let error = parameters::set(app.world_mut(), path, value).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn a_written_out_creature_moves_like_its_kind() {
    for kind in [Creature::from(Inchworm::default()), Creature::from(Roller::default())] {
        let composed = kind.body.composed().unwrap().into_owned();
        let text = ron::ser::to_string(&composed).unwrap();
        let read: Composed = ron::from_str(&text).unwrap();
        assert_eq!(read, composed);
        let bodies = [kind, Creature::from(read)].map(|creature| creature.body(Pose::default()).unwrap());
        assert_eq!((&bodies[0].particles, &bodies[0].six), (&bodies[1].particles, &bodies[1].six));
    }
}

#[test]
fn creatures_of_no_document_get_on() {
    let (mut app, bodies) = open("ramp", 2000);
    let start: Vec<_> = bodies.iter().map(|body| particles(&app, *body).center()).collect();
    app.update();
    for (body, start) in bodies.iter().zip(start) {
        assert!(app.world().get::<Frozen>(*body).is_none());
        let (road, now) = (app.world().get::<Road>(*body).unwrap(), particles(&app, *body).center());
        let near = road.nearest(now).unwrap().distance(now);
        assert!(road.way(now) > road.way(start) + 1.0 && near < 6.0, "from {start} to {now}, {near} from the road");
    }
}

#[test]
fn scenes_open_at_their_moments() {
    for (scene, row) in [("roller-left-beam", "only left side beam"), ("roller-right-beam", "only right side beam")] {
        let (mut app, bodies) = open(scene, 0);
        let steps = scenes::load(scene).unwrap().file.clock.opening_steps();
        app.world_mut().resource_mut::<Clock>().leap(steps);
        app.update();
        app.update();
        assert_eq!(app.world().resource::<Clock>().step(), steps);
        let parts = six_parts(app.world().entity(bodies[0])).unwrap();
        let positions: Vec<_> = parts.particles.positions().collect();
        let mut sights = parts.rules.iter().filter_map(|rule| match rule {
            wriggle::body::Rule::Drive(drive) => Some(look(drive, &positions, parts.road)),
            _ => None,
        });
        assert_eq!(sights.next().unwrap().decision(), row);
    }
    let worm = |scene: &str| {
        let steps = scenes::load(scene).unwrap().file.clock.opening_steps();
        let (mut app, bodies) = open(scene, steps);
        app.update();
        let x: Vec<_> = particles(&app, bodies[0]).positions().collect();
        x[60].distance(x[61])
    };
    assert!((worm("inchworm-contracted") - 11.01).abs() < 0.01 && (worm("inchworm-relaxed") - 16.06).abs() < 0.01);
}

#[test]
fn an_app_opens_a_moment_and_stands_still_there() {
    let mut app = App::new();
    let scene = scenes::load("roller-left-beam").unwrap();
    app.add_plugins((MinimalPlugins, wriggle::physics::PhysicsPlugin::default(), scenes::ScenesPlugin::new(scene)));
    app.insert_resource(bevy::time::TimeUpdateStrategy::FixedTimesteps(1));
    for _ in 0..5 {
        app.update();
    }
    assert_eq!(app.world().resource::<Clock>().step(), 260);
    assert!(app.world().resource::<Time<Virtual>>().is_paused());
    app.world_mut().write_message(scenes::SceneChange::Load("garden".into()));
    for _ in 0..5 {
        app.update();
    }
    assert!(app.world().resource::<Clock>().step() > 0 && !app.world().resource::<Time<Virtual>>().is_paused());
}

#[test]
fn threads_change_no_bits() {
    let run = |threads: &str| json(&["run", "rough-road", "--for", "6", "--threads", threads]);
    let [one, two, eight] = ["1", "2", "8"].map(run);
    assert_eq!((&one["hash"], &one["hash"]), (&two["hash"], &eight["hash"]));
    // A step evaluates the forces of each of both bodies once.
    assert_eq!((one["steps"].as_u64(), one["force_evaluations"].as_u64()), (Some(600), Some(1200)));
}

#[test]
fn the_limit_of_the_bonds_is_planned_with() {
    let (mut app, bodies) = open("flat-strip", 1);
    app.update();
    for (body, limit) in bodies.iter().zip([0.0951, 0.0270]) {
        let found = app.world().get::<Plan>(*body).unwrap().stability_limit();
        assert!((found / limit - 1.0).abs() < 0.02, "{found}, expected {limit}");
    }
}

#[test]
fn components_of_another_body_freeze_it() {
    let misfit = |with_columns: bool| {
        let (mut app, bodies) = open("flat-strip", 1);
        let other = app.world().get::<Rules>(bodies[1]).unwrap().clone();
        let mut body = app.world_mut().entity_mut(bodies[0]);
        body.insert(other);
        if with_columns {
            body.insert(Columns::default());
        }
        app.update();
        assert!(app.world().get::<Frozen>(bodies[1]).is_none());
        app.world().get::<Frozen>(bodies[0]).unwrap().reason.clone()
    };
    let said = misfit(false);
    assert!(said.contains("its rules were made for another body; this one has 62 particles"), "{said}");
    let said = misfit(true);
    assert!(said.contains("its columns were made for another body"), "{said}");
}

/// What is said about a creature file.
fn said(body: &str) -> String {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("bad.creature.ron");
    fs::write(&path, format!("Creature(version: 1, body: {body})")).unwrap();
    scenes::load(path.to_str().unwrap()).unwrap_err().to_string()
}

#[test]
fn bad_files_are_told_what_would_be_right() {
    let groups = r#"groups: [(name: "rim", shape: Ring(count: 2, center: (0, 0, 0), radius: 1, angle: 0.5)),
        (name: "axle", shape: Row(count: 2, from: (0, 0, 0), step: (1, 0, 0)))]"#;
    let wheel = |wheel: &str| {
        format!(r#"Composed({groups}, rules: [WheelDrive(left: ("axle", 0), right: ("axle", 1), wheels: [{wheel}])])"#)
    };
    for (body, parts) in [
        (
            wheel(r#"(rim: "rim", hub: ("axle", 0), from: ("axle", 0), to: ("axle", 1), side: Left)"#),
            ["rules[0].wheels[0].rim", "has 2 particles; a wheel has three or more"],
        ),
        (
            wheel(r#"(rim: "tyre", hub: ("axle", 0), from: ("axle", 0), to: ("axle", 1), side: Left)"#),
            ["rules[0].wheels[0].rim", "there is no group `tyre`; there are `axle`, `rim`"],
        ),
        (
            wheel(r#"(rim: "rim", hub: ("axle", 7), from: ("axle", 0), to: ("axle", 1), side: Left)"#),
            ["rules[0].wheels[0].hub", "there is no particle 7 in `axle`; it has 2"],
        ),
        (
            format!(r#"Composed({groups}, bonds: [(of: ["rim"], with: ["hub"])])"#),
            ["bonds[0].with", "there is no group `hub`"],
        ),
        (
            format!(
                r#"Composed({groups}, rules: [Muscle(counting: ["rim"], on: ("axle", 0, 2), from: ("axle", 0), to: ("axle", 1), strength: 1)])"#
            ),
            ["rules[0].on", "does not count"],
        ),
        ("Roller(table: (left_side: (0, 2)))".into(), ["table.left_side", "(0, 2) is not allowed"]),
        ("Inchworm(half: 0)".into(), ["half", "above 0"]),
        (
            r#"Composed(groups: [(name: "a", shape: Points([(0, 0, 0)])), (name: "a", shape: Points([(3, 0, 0)]))])"#
                .into(),
            ["groups[1].name", "give each a name of its own"],
        ),
        ("Composed(groups: [])".into(), ["particles", "at least one particle"]),
    ] {
        let said = said(&body);
        assert!(parts.iter().all(|part| said.contains(part)), "{body}\n{said}");
    }
}

#[test]
fn a_saved_scene_keeps_its_roads_and_places() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let (mut app, _) = open("rough-road", 1);
    parameters::set(app.world_mut(), "roller.drive.friction", 0.3).unwrap();
    scenes::save(app.world_mut(), &path).unwrap();
    let again = scenes::load(path.to_str().unwrap()).unwrap();
    let (old, new) = (scenes::load("rough-road").unwrap().file, again.file.clone());
    assert_eq!((old.road, old.creatures), (new.road, new.creatures));
    let mut other = World::new();
    scenes::open(&mut other, again).unwrap();
    assert_eq!(parameters::list(&mut other), parameters::list(app.world_mut()));
}
