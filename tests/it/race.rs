//! The race of methods: errors against the truth, ghosts, and one that blows up.

use bevy::{prelude::*, time::TimeUpdateStrategy};
use wriggle::{
    mechanics::integrators::Method,
    physics::{Clock, Frozen, PhysicsPlugin, Restart, Shown, Work},
    scenes::{self, Ghost, Runner, SceneBodies, ScenesPlugin},
};

/// The shipped race with this step, a frame lasting one tick.
fn race(dt: f64) -> App {
    let mut app = App::new();
    let scene = scenes::load("race").unwrap();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default(), ScenesPlugin::new(scene)));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.update();
    app.insert_resource(Clock::new(dt, 6.0).unwrap());
    app
}

fn run_until(app: &mut App, time: f64) {
    while app.world().resource::<Clock>().time() < time {
        app.update();
    }
}

/// The runner with this method.
fn runner(app: &App, method: Method) -> (Entity, Runner) {
    let bodies = &app.world().resource::<SceneBodies>().0;
    let body = *bodies.iter().find(|body| app.world().get::<Method>(**body) == Some(&method)).unwrap();
    (body, *app.world().get::<Runner>(body).unwrap())
}

#[test]
fn errors_of_the_runners_fall_with_their_order() {
    let worst = |dt: f64| {
        let mut app = race(dt);
        run_until(&mut app, 12.0);
        [Method::ExactFlow, Method::RungeKutta4, Method::Leapfrog, Method::SemiImplicitEuler]
            .map(|method| runner(&app, method).1.worst)
    };
    let (coarse, fine) = (worst(0.1), worst(0.025));
    assert_eq!(coarse[0], 0.0, "the truth is where it is");
    assert!(coarse[1] < coarse[2] && coarse[2] < coarse[3], "{coarse:?}");
    let order = libm::log2(coarse[3] / fine[3]) / 2.0;
    assert!((order - 1.0).abs() < 0.15, "semi-implicit Euler is of order {order}");
    assert!(fine[2] < 0.2 * coarse[2], "{fine:?} and {coarse:?}");
}

#[test]
fn each_runner_has_the_truth_for_a_ghost_in_its_lane() {
    let mut app = race(0.1);
    run_until(&mut app, 6.0);
    let (truth, _) = runner(&app, Method::ExactFlow);
    let shown = app.world().get::<Shown>(truth).unwrap().positions().to_vec();
    assert!(app.world().get::<Ghost>(truth).is_none());
    let (body, leapfrog) = runner(&app, Method::Leapfrog);
    let ghost = &app.world().get::<Ghost>(body).unwrap().0;
    assert_eq!(ghost.len(), 3);
    for (ghost, truth) in ghost.iter().zip(&shown) {
        assert_eq!(*ghost - *truth, leapfrog.offset.as_vec3());
    }
    assert_eq!(leapfrog.offset, bevy::math::DVec3::Z * 4.5);
    let work = app.world().get::<Work>(body).unwrap().force_evaluations;
    assert_eq!(work, app.world().resource::<Clock>().step(), "one evaluation a step");
}

#[test]
fn what_blows_up_leaves_and_the_others_go_on() {
    // Above explicit Euler's limit of 0.6, below that of Runge–Kutta 4.
    let mut app = race(1.2);
    run_until(&mut app, 150.0);
    let frozen = |app: &App, method| app.world().get::<Frozen>(runner(app, method).0).is_some();
    assert!(frozen(&app, Method::ExplicitEuler));
    for method in [Method::ExactFlow, Method::RungeKutta4, Method::ImplicitEuler, Method::ImplicitMidpoint] {
        assert!(!frozen(&app, method), "{method:?}");
        assert!(app.world().get::<Shown>(runner(&app, method).0).unwrap().positions()[0].x > 5.0, "{method:?}");
    }
    let left = runner(&app, Method::ExplicitEuler).1;
    app.world_mut().write_message(Restart);
    app.update();
    assert!(!frozen(&app, Method::ExplicitEuler));
    assert!(runner(&app, Method::ExplicitEuler).1.worst < left.worst, "a restart forgets the errors");
}

#[test]
fn a_saved_race_keeps_its_methods() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let mut app = race(0.1);
    let (body, _) = runner(&app, Method::StormerVerlet);
    app.world_mut().entity_mut(body).insert(Method::Xpbd);
    scenes::save(app.world_mut(), &path).unwrap();
    let saved = scenes::load(path.to_str().unwrap()).unwrap().file;
    let methods: Vec<_> = saved.creatures.iter().map(|placement| placement.method.unwrap_or(saved.method)).collect();
    assert_eq!(
        methods[..5],
        [Method::ExactFlow, Method::RungeKutta4, Method::ImplicitMidpoint, Method::Leapfrog, Method::Xpbd]
    );
    assert_eq!(saved.truth.as_deref(), Some("exact"));
}

#[test]
fn what_knows_no_method_cannot_race() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("bad.scene.ron");
    let creatures = "[(name: \"a\", creature: \"inchworm\"), (name: \"b\", creature: \"inchworm\")]";
    let text = format!("Scene(version: 1, title: \"Bad\", road: \"rough-road\", truth: \"a\", creatures: {creatures})");
    std::fs::write(&path, text.replace("truth: \"a\", ", "")).unwrap();
    scenes::load(path.to_str().unwrap()).unwrap();
    std::fs::write(&path, text).unwrap();
    let error = scenes::load(path.to_str().unwrap()).map(|_| ()).unwrap_err().to_string();
    assert!(
        error.contains("creatures[0]: \"a\" follows the six-matrix particle system") && error.contains("cannot race"),
        "{error}"
    );
}

#[test]
fn a_race_without_its_truth_is_refused() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("bad.scene.ron");
    let load = |truth: &str, other: &str| {
        let creatures =
            format!("[(name: \"a\", creature: \"garden-worm\"), (name: \"b\", creature: \"garden-worm\"{other})]");
        let text = format!("Scene(version: 1, title: \"Bad\", truth: \"{truth}\", creatures: {creatures})");
        std::fs::write(&path, text).unwrap();
        scenes::load(path.to_str().unwrap()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(load("a", ""), Ok(()));
    let error = load("c", "").unwrap_err();
    assert!(error.contains("truth: no creature is called \"c\"; give one of a, b"), "{error}");
    let error = load("a", ", heading: 30").unwrap_err();
    assert!(error.contains("creatures[1]: must have the heading"), "{error}");
}
