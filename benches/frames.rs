//! How many frames a second are drawn: `cargo bench --bench frames`.
//!
//! Each row draws a scene at 1920 × 1080 in high quality without a window, one frame after the other, with the steps of physics that a 60th of a second shows in
//! between. `elem` is a frame. What draws is printed first; without a graphics adapter nothing is measured.
//!
//! Rows of `small` draw the same at 64 × 36, where pixels cost next to nothing: what is left is the processor's own share of a frame, and with a renderer that has no GPU
//! the vertices, too.

use std::{error::Error, fmt::Write, fs, time::Duration};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use wriggle::{
    physics::{Clock, PhysicsPlugin, Ticks},
    scenes::{self, LoadedScene, ScenesPlugin},
    view::{Quality, Shot, adapter},
};

/// The frames a second that are wanted.
const WANTED: f64 = 60.0;

/// A hundred snakes in ten rows.
fn snakes() -> String {
    let mut creatures = String::new();
    for i in 0..100 {
        let (x, z) = (24 * (i % 10), 6 * (i / 10));
        // Writing to a string does not fail.
        let _ = write!(creatures, "(name: \"snake{i}\", creature: \"snake\", at: ({x}, 0, {z})),");
    }
    format!(
        "Scene(version: 1, title: \"Snakes\", gravity: 0.01, ground: Flat, creatures: [{creatures}],
            camera: Orbit(target: (120, 0, 27), distance: 150, pitch: 35, yaw: 0),
            clock: (dt: 0.035, time_scale: 25), method: StormerVerlet)"
    )
}

/// A block of 20³ masses with all neighbours.
const BLOCK: &str = "Creature(version: 1,
    body: Jelly(size: (20, 20, 20),
        neighbours: (edges: (stiffness: 1), faces: (stiffness: 1), cubes: (stiffness: 1)), tilt: 20, drop: 2),
    damping: Rate(0.1005), ground: Flat, gravity: 0.001)";

const JELLY: &str = "Scene(version: 1, title: \"Jelly\", gravity: 0.001, ground: Flat,
    creatures: [(name: \"jelly\", creature: \"block\")], camera: Orbit(target: (0, 10, 0), distance: 52, pitch: 14, yaw: 25),
    clock: (dt: 0.24, time_scale: 40), method: StormerVerlet)";

/// The scenes, and what they are called.
fn all() -> Result<Vec<(&'static str, LoadedScene)>, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("block.creature.ron"), BLOCK)?;
    let own = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text)?;
        Ok::<_, Box<dyn Error>>(scenes::load(&path.to_string_lossy())?)
    };
    Ok(vec![
        ("garden", scenes::load("garden")?),
        ("meadow", scenes::load("meadow")?),
        ("a hundred snakes", own("snakes.scene.ron", &snakes())?),
        ("jelly of 20³", own("jelly.scene.ron", JELLY)?),
    ])
}

/// The scene, drawn for the first time.
fn shown(scene: LoadedScene, size: (u32, u32)) -> Result<Shot, Box<dyn Error>> {
    let mut shot = Shot::new(size, Some(Quality::High), |app| {
        app.add_plugins((PhysicsPlugin::new(Ticks), ScenesPlugin::new(scene)));
    })?;
    // The first frame opens the scene, others build pipelines.
    for _ in 0..5 {
        shot.update();
    }
    let mut clock = shot.world_mut().resource_mut::<Clock>();
    let steps = clock.time_scale().unwrap_or(1.0) / WANTED / clock.dt();
    clock.set_steps_per_tick(steps.round().max(1.0) as u64);
    Ok(shot)
}

fn benchmarks(c: &mut Criterion) {
    match adapter() {
        Ok(summary) => println!("drawn by {summary:?}"),
        Err(error) => {
            println!("nothing is measured: {error}");
            return;
        }
    }
    for (group, size) in [("frame", (1920, 1080)), ("small", (64, 36))] {
        let scenes = all().unwrap_or_else(|error| panic!("{error}"));
        let mut group = c.benchmark_group(group);
        group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5)).sample_size(10);
        group.throughput(Throughput::Elements(1));
        for (name, scene) in scenes {
            let mut shot = None;
            group.bench_function(name, |b| {
                // Only what is asked for is opened.
                let shot = shot.get_or_insert_with(|| {
                    shown(scene.clone(), size).unwrap_or_else(|error| panic!("{name}: {error}"))
                });
                b.iter(|| {
                    shot.world_mut().run_schedule(Ticks);
                    shot.update();
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
