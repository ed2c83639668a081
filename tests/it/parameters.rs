//! The registry of live parameters.

use bevy::prelude::*;
use wriggle::{
    body::{Gravity, Muscles, ParticleId, Particles, SpineFriction, SpringId, Springs, TravelingWaves},
    cli::Headless,
    mechanics::integrators::Method,
    physics::Clock,
    scenes::{
        self,
        parameters::{self, Kind, Parameter},
    },
};

/// A world with a shipped scene in it.
fn world(scene: &str) -> World {
    let mut world = World::new();
    scenes::open(&mut world, scenes::load(scene).unwrap()).unwrap();
    world
}

fn get(world: &mut World, path: &str) -> Parameter {
    parameters::list(world).into_iter().find(|parameter| parameter.path == path).expect(path)
}

fn component<C: Component + Clone>(world: &mut World) -> C {
    world.query::<&C>().single(world).unwrap().clone()
}

#[test]
fn every_listed_parameter_can_be_set_and_reads_back() {
    let mut world = world("garden");
    let all = parameters::list(&mut world);
    assert_eq!(all.len(), 32);
    for Parameter { path, value, range, unit, help, kind } in all {
        assert!(range.contains(&value), "{path}: {value} is outside of {range:?}");
        assert!(!unit.is_empty() && !help.is_empty(), "{path}");
        let other = if kind == Kind::Toggle { 1.0 - value } else { 0.5 * (range.start() + range.end()) + 0.001 };
        parameters::set(&mut world, &path, other).unwrap();
        assert_eq!(get(&mut world, &path).value, other, "{path}");
    }
}

#[test]
fn waves_are_set_live() {
    let mut world = world("sand");
    for Parameter { path, value, range, kind, .. } in parameters::list(&mut world) {
        let other = if kind == Kind::Toggle { 1.0 - value } else { 0.5 * (range.start() + range.end()) + 0.001 };
        parameters::set(&mut world, &path, other).unwrap();
        assert_eq!(get(&mut world, &path).value, other, "{path}");
    }
    for (path, value) in [
        ("snake.waves[1].amplitude", 0.15),
        ("snake.waves[1].lead", -0.25),
        ("snake.waves[0].period", 70.0),
        ("snake.gait.steering", -0.05),
        ("snake.gait.active", 1.0),
        ("snake.friction.isotropic", 0.5),
        ("snake.friction.brake", 0.25),
    ] {
        parameters::set(&mut world, path, value).unwrap();
    }
    let waves: TravelingWaves = component(&mut world);
    let (first, second) = (waves.get(0).unwrap(), waves.get(1).unwrap());
    assert_eq!((second.amplitude, second.lead, first.period), (0.15, -0.25, 70.0));
    assert_eq!((waves.steering(), waves.is_active()), (-0.05, true));
    let friction: SpineFriction = component(&mut world);
    assert_eq!((friction.isotropic(), friction.brake()), (0.5, 0.25));
}

#[test]
fn paths_reach_what_they_name() {
    let mut world = world("garden");
    for (path, value) in [
        ("worm.springs.stiffness", 2.0),
        ("worm.springs[1].stiffness", 3.0),
        ("worm.particles[2].mass", 4.0),
        ("worm.muscles[1].phase", -0.25),
        ("worm.friction.drag", 0.75),
        ("worm.friction.ratchet", 0.0),
        ("worm.gravity", 0.5),
        ("clock.dt", 0.001),
        ("clock.time_scale", 7.0),
    ] {
        parameters::set(&mut world, path, value).unwrap();
    }
    let springs: Springs = component(&mut world);
    assert_eq!([0, 1].map(|i| springs.get(SpringId(i)).unwrap().stiffness), [2.0, 3.0]);
    assert_eq!(component::<Particles>(&mut world).masses(), [1.0, 1.0, 4.0]);
    assert_eq!(component::<Muscles>(&mut world).get(1).unwrap().phase, -0.25);
    let friction: SpineFriction = component(&mut world);
    assert_eq!((friction.drag(), friction.ratchet()), (0.75, false));
    assert_eq!(component::<Gravity>(&mut world).acceleration(), 0.5);
    let clock = world.resource::<Clock>();
    assert_eq!((clock.dt(), clock.time_scale()), (0.001, Some(7.0)));
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut world = world("garden");
    let before = parameters::list(&mut world);
    for (path, value, words) in [
        ("worm.springs.stiffness", -1.0, "give a finite number, 0 or more"),
        ("worm.springs.stiffness", f64::NAN, "NaN is not allowed"),
        ("worm.springs[0].rest_length", 0.0, "give a finite number above 0"),
        ("worm.particles.mass", f64::INFINITY, "inf is not allowed"),
        ("worm.muscles.period", 0.0, "above 0"),
        ("worm.friction.ratchet", 0.5, "give 0 (off) or 1 (on)"),
        ("worm.gravity", -9.81, "0 or more"),
        ("clock.dt", 0.0, "above 0"),
        ("clock.time_scale", 1e6, "give a number from 0 to 1000"),
        ("clock.speed", 1.0, "`clock.dt` and `clock.time_scale`"),
        ("wurm.springs.stiffness", 1.0, "paths begin with `worm`, `clock`"),
        ("worm", 1.0, "paths begin with `worm`"),
        ("worm.springs", 1.0, "no parameter `worm.springs`"),
        ("worm.springs.", 1.0, "worm.springs.stiffness"),
        ("worm.spring.stiffness", 1.0, "did you mean worm.springs.stiffness"),
        ("worm.springs.colour", 1.0, "`worm` has worm.springs.stiffness"),
        ("worm.springs[2].stiffness", 1.0, "`worm` has 2 springs, counted from 0"),
        ("worm.springs[-1].stiffness", 1.0, "`-1` is no whole number"),
        ("worm.springs[0]stiffness", 1.0, "no parameter"),
        ("worm.friction[0].drag", 1.0, "give `worm.friction.drag`"),
    ] {
        let problem = parameters::set(&mut world, path, value).expect_err(path).to_string();
        assert!(problem.contains(words), "`{words}` is missing in: {problem}");
        assert!(problem.contains(path), "`{path}` is missing in: {problem}");
    }
    assert_eq!(parameters::list(&mut world), before);
}

#[test]
fn only_what_really_changes_is_marked_as_changed() {
    let mut world = world("garden");
    world.clear_trackers();
    let changed = |world: &mut World| {
        let mut bodies = world.query::<(Ref<Springs>, Ref<Muscles>, Ref<Particles>, Ref<SpineFriction>, Ref<Method>)>();
        let (springs, muscles, particles, friction, method) = bodies.single(world).unwrap();
        let changed = [
            springs.is_changed(),
            muscles.is_changed(),
            particles.is_changed(),
            friction.is_changed(),
            method.is_changed(),
        ];
        (changed, world.resource_ref::<Clock>().is_changed())
    };
    for Parameter { path, value, .. } in parameters::list(&mut world) {
        // All at once would make the two phases alike.
        if path != "worm.muscles.phase" {
            parameters::set(&mut world, &path, value).unwrap();
        }
    }
    parameters::set_method(&mut world, Method::RungeKutta2);
    assert_eq!(changed(&mut world), ([false; 5], false));
    assert!(world.query::<&Gravity>().single(&world).is_err(), "a body without gravity got some");

    parameters::set(&mut world, "worm.muscles[1].phase", 0.3).unwrap();
    assert_eq!(changed(&mut world), ([false, true, false, false, false], false));
    parameters::set_method(&mut world, Method::RungeKutta4);
    assert_eq!(changed(&mut world), ([false, true, false, false, true], false));
    assert_eq!(parameters::method(&mut world), Method::RungeKutta4);
}

#[test]
fn the_ends_of_no_slider_tear_the_garden_worm_out_of_its_pose() {
    let all = parameters::list(&mut world("garden"));
    for Parameter { path, range, .. } in all.into_iter().filter(|parameter| parameter.kind == Kind::Number) {
        for value in [*range.start(), *range.end()] {
            let mut run = Headless::new(scenes::load("garden").unwrap(), None).unwrap();
            parameters::set(run.world_mut(), &path, value).unwrap();
            let said = run.step(1);
            assert!(!run.has_frozen(), "{path} = {value}: {said:?}");
        }
    }
}

#[test]
fn bodies_are_listed_in_the_order_of_the_scene() {
    let mut world = world("four-worms");
    let names: Vec<_> = parameters::list(&mut world)
        .into_iter()
        .filter_map(|parameter| parameter.path.strip_suffix(".gravity").map(str::to_owned))
        .collect();
    assert_eq!(names, ["plain", "long-wave", "strong", "stiff"]);
    assert_eq!(get(&mut world, "strong.muscles.amplitude").value, 0.5);
    assert_eq!(get(&mut world, "plain.muscles.amplitude").value, 0.3);
    assert_eq!(
        world.query::<&Particles>().iter(&world).filter(|body| body.position(ParticleId(0)).unwrap().z == 3.0).count(),
        1
    );
}

#[test]
fn a_value_beyond_the_usual_range_widens_it() {
    let mut world = world("garden");
    parameters::set(&mut world, "worm.springs.stiffness", 250.0).unwrap();
    assert_eq!(get(&mut world, "worm.springs.stiffness").range, 0.0..=1000.0);
}
