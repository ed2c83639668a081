//! Saving a scene, switching scenes, and what stays when something is bad.

use std::{fs, path::Path};

use bevy::prelude::*;
use tempfile::TempDir;
use wriggle::{
    body::Particles,
    mechanics::integrators::Method,
    physics::{Clock, PhysicsPlugin},
    scenes::{self, CurrentScene, SceneBodies, SceneChange, SceneMember, SceneProblem, ScenesPlugin, parameters},
};

fn open(world: &mut World, scene: &Path) {
    scenes::open(world, scenes::load(scene.to_str().unwrap()).unwrap()).unwrap();
}

fn files(folder: &Path) -> Vec<String> {
    let mut all: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    all.sort();
    all
}

fn app(scene: &str) -> App {
    let mut app = App::new();
    let scene = scenes::load(scene).unwrap();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default(), ScenesPlugin::new(scene)));
    app.update();
    app
}

fn ask(app: &mut App, change: SceneChange) -> Option<String> {
    app.world_mut().write_message(change);
    app.update();
    app.world_mut().resource_mut::<Messages<SceneProblem>>().drain().last().map(|problem| problem.text)
}

#[test]
fn a_saved_scene_loads_with_the_same_parameters() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    for scene in ["garden", "four-worms", "raw-worm"] {
        let mut world = World::new();
        open(&mut world, Path::new(scene));
        let body = world.query::<&Name>().single(&world).map_or("stiff".into(), |name| name.to_string());
        for (field, value) in [
            ("springs.stiffness", 2.0 / 3.0),
            ("springs[1].damping", 1.25),
            ("muscles[0].period", 5.5),
            ("muscles.ramp", 0.0),
            ("friction.ratchet", 0.0),
            ("gravity", 0.125),
        ] {
            parameters::set(&mut world, &format!("{body}.{field}"), value).unwrap();
        }
        parameters::set(&mut world, "clock.dt", 0.00075).unwrap();
        parameters::set(&mut world, "clock.time_scale", 1.5).unwrap();
        parameters::set_method(&mut world, Method::RungeKutta4);
        let saved = parameters::list(&mut world);
        scenes::save(&mut world, &path).unwrap();

        let mut again = World::new();
        open(&mut again, &path);
        assert_eq!(parameters::list(&mut again), saved, "{scene}");
        assert_eq!(parameters::method(&mut again), Method::RungeKutta4);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("Scene("), "{text}");
        assert_eq!(text.matches("springs.stiffness\"").count(), 1, "one path for all springs: {text}");

        // Saved again without a change, it stays the same to the last letter.
        scenes::save(&mut again, &path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
    assert_eq!(files(folder.path()), ["mine.scene.ron"]);
}

#[test]
fn a_scene_saved_elsewhere_finds_its_creatures() {
    let (from, to) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    fs::write(from.path().join("own.creature.ron"), "Creature(version: 1, body: GardenWorm(stiffness: 7))").unwrap();
    let scene = "Scene(version: 1, title: \"Own\", creatures: [(name: \"worm\", creature: \"own\")])";
    fs::write(from.path().join("own.scene.ron"), scene).unwrap();
    let mut world = World::new();
    open(&mut world, &from.path().join("own.scene.ron"));
    let parameters = parameters::list(&mut world);
    scenes::save(&mut world, &to.path().join("copy.scene.ron")).unwrap();
    open(&mut world, &to.path().join("copy.scene.ron"));
    assert_eq!(parameters::list(&mut world), parameters);
}

#[test]
fn what_cannot_be_written_leaves_the_old_file_and_nothing_else() {
    let mut world = World::new();
    open(&mut world, Path::new("garden"));
    let folder = TempDir::new().unwrap();

    // The target is a folder.
    let target = folder.path().join("folder.scene.ron");
    fs::create_dir(&target).unwrap();
    fs::write(target.join("inside"), "old").unwrap();
    let problem = scenes::save(&mut world, &target).unwrap_err().to_string();
    assert!(problem.contains("folder.scene.ron: could not be written: it is a folder"), "{problem}");
    assert_eq!(files(folder.path()), ["folder.scene.ron"]);
    assert_eq!(fs::read_to_string(target.join("inside")).unwrap(), "old");

    // The folder is not there, or is a file.
    for bad in ["nowhere/mine.scene.ron", "folder.scene.ron/inside/mine.scene.ron"] {
        let problem = scenes::save(&mut world, &folder.path().join(bad)).unwrap_err().to_string();
        assert!(problem.contains("could not be written"), "{problem}");
    }
    assert_eq!(files(folder.path()), ["folder.scene.ron"]);
    assert_eq!(files(&target), ["inside"]);
}

/// Saves the garden over a file that says "old", in a process of its own, since the limits on files that a shell sets hold for all of one.
#[cfg(target_os = "linux")]
fn save_limited(limits: &str, path: &Path) -> std::process::Output {
    fs::write(path, "old").unwrap();
    let helper = "exec \"$0\" saving::helper_saves_the_garden --exact --ignored --nocapture";
    std::process::Command::new("sh")
        .args(["-c", &format!("{limits}; {helper}")])
        .arg(std::env::current_exe().unwrap())
        .env("WRIGGLE_TEST_SAVE_TO", path)
        .output()
        .unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_file_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let output = save_limited("ulimit -f 0; trap '' XFSZ", &path);
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("could not be written"), "{said}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(files(folder.path()), ["mine.scene.ron"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_crash_in_the_middle_of_writing_leaves_the_old_file() {
    use std::os::unix::process::ExitStatusExt;
    const SIGXFSZ: i32 = 25;
    // Who does not ignore its signal is killed at the first byte: sooner than it can clean up.
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let output = save_limited("ulimit -c 0; ulimit -f 0", &path);
    assert_eq!(output.status.signal(), Some(SIGXFSZ), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
}

#[test]
#[ignore = "run by the tests of a full disk and of a crash"]
fn helper_saves_the_garden() {
    let Some(path) = std::env::var_os("WRIGGLE_TEST_SAVE_TO") else { return };
    let mut world = World::new();
    open(&mut world, Path::new("garden"));
    if let Err(problem) = scenes::save(&mut world, Path::new(&path)) {
        panic!("{problem}");
    }
}

#[test]
fn without_a_scene_there_is_nothing_to_save() {
    let folder = TempDir::new().unwrap();
    let problem = scenes::save(&mut World::new(), &folder.path().join("x.scene.ron")).unwrap_err().to_string();
    assert!(problem.contains("no scene is open"), "{problem}");
    assert!(files(folder.path()).is_empty());
}

#[test]
fn another_scene_takes_the_place_of_the_last() {
    let mut app = app("garden");
    assert_eq!(app.world().resource::<CurrentScene>().file.title, "Garden");
    let guest = app.world_mut().spawn_empty().id();
    let member = app.world_mut().spawn(SceneMember).id();
    assert_eq!(ask(&mut app, SceneChange::Load("four-worms".into())), None);
    assert_eq!(app.world().resource::<SceneBodies>().0.len(), 4);
    assert_eq!(app.world_mut().query::<&Particles>().iter(app.world()).count(), 4);
    assert!(app.world().get_entity(guest).is_ok() && app.world().get_entity(member).is_err());
    assert_eq!(app.world().resource::<Clock>().time_scale(), Some(3.0));
}

#[test]
fn a_bad_file_keeps_the_last_good_scene() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let good = "Scene(version: 1, title: \"Mine\", creatures: [(name: \"worm\", creature: \"garden-worm\")])";
    fs::write(&path, good).unwrap();
    let mut app = app(path.to_str().unwrap());
    let bodies = app.world().resource::<SceneBodies>().0.clone();

    fs::write(&path, good.replace("creatures", "creature")).unwrap();
    let problem = ask(&mut app, SceneChange::Reload).unwrap();
    assert!(problem.contains("mine.scene.ron:1:"), "{problem}");
    let problem = ask(&mut app, SceneChange::Load("nowhere".into())).unwrap();
    assert!(problem.contains("no scene `nowhere`"), "{problem}");
    assert_eq!(app.world().resource::<CurrentScene>().file.title, "Mine");
    assert_eq!(app.world().resource::<SceneBodies>().0, bodies);
    assert!(bodies.iter().all(|&body| app.world().get::<Particles>(body).is_some()));

    fs::write(&path, good.replace("Mine", "Mended")).unwrap();
    assert_eq!(ask(&mut app, SceneChange::Reload), None);
    assert_eq!(app.world().resource::<CurrentScene>().file.title, "Mended");
}

#[cfg(feature = "window")]
#[test]
fn an_edited_file_is_loaded_again() {
    use std::time::{Duration, Instant};

    let folder = TempDir::new().unwrap();
    let (scene, worm) = (folder.path().join("mine.scene.ron"), folder.path().join("own.creature.ron"));
    fs::write(&scene, "Scene(version: 1, title: \"Mine\", creatures: [(name: \"worm\", creature: \"own\")])").unwrap();
    fs::write(&worm, "Creature(version: 1, body: GardenWorm())").unwrap();
    let mut app = app(scene.to_str().unwrap());
    app.add_plugins(scenes::WatchPlugin);
    let mut until = |done: &dyn Fn(&mut World) -> bool, what: &str| {
        let start = Instant::now();
        while !done(app.world_mut()) {
            assert!(start.elapsed() < Duration::from_secs(20), "{what}");
            std::thread::sleep(Duration::from_millis(20));
            app.update();
        }
    };
    let stiffness = |world: &mut World| {
        parameters::list(world).into_iter().find(|parameter| parameter.path == "worm.springs.stiffness").unwrap().value
    };
    // The watcher is set up in the background.
    let start = Instant::now();
    until(&|_| start.elapsed() > Duration::from_secs(1), "");
    fs::write(&worm, "Creature(version: 1, body: GardenWorm(stiffness: 7))").unwrap();
    until(&|world| stiffness(world) == 7.0, "an edited creature is not loaded again");
    // As editors do it: a new file takes the place of the old.
    fs::write(folder.path().join("new"), "Creature(version: 1, body: GardenWorm(stiffness: 8))").unwrap();
    fs::rename(folder.path().join("new"), &worm).unwrap();
    until(&|world| stiffness(world) == 8.0, "a replaced creature is not loaded again");
    fs::write(&scene, "Scene(version: 1, title: \"Bad\"").unwrap();
    until(&|world| !world.resource::<Messages<SceneProblem>>().is_empty(), "a bad file is not reported");
    assert_eq!(stiffness(app.world_mut()), 8.0);
}
