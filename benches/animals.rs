//! What a step of Miller's animals costs, through the plugin: `cargo bench --no-default-features --bench animals`.
//!
//! Each row steps so many of one animal, with their waves, contact and friction, by ticks of as many steps as its scene shows in a 64th of a
//! second. `elem` is one spring update: the force on one spring in one evaluation. To compare with one core, run it on one:
//! `taskset -c 0 cargo bench …`.

use std::{hint::black_box, time::Duration};

use bevy::{ecs::system::EntityCommand, math::DVec3, prelude::*};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use wriggle::{
    body::Gravity,
    creatures::{
        Pose,
        library::{self, CREATURE},
    },
    physics::{Clock, Cost, PhysicsPlugin, Ticks},
};

/// An animal, its step, and how much simulated time a second shows.
const ANIMALS: [(&str, f64, f64); 4] =
    [("worm", 0.05, 6.0), ("snake", 0.035, 25.0), ("sidewinder", 0.035, 25.0), ("caterpillar", 0.1, 13.0)];

/// An app of `count` animals side by side that has gone for a while.
fn animals(name: &str, count: usize, dt: f64, steps: u64) -> App {
    let creature = match library::find(CREATURE, name, None).and_then(|source| library::read_creature(&source)) {
        Ok(creature) => creature,
        Err(error) => panic!("{error}"),
    };
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::new(Ticks)));
    let mut clock = app.world_mut().resource_mut::<Clock>();
    if let Err(error) = clock.set_dt(dt) {
        panic!("{error}");
    }
    clock.set_steps_per_tick(steps);
    for i in 0..count {
        let pose = Pose { at: DVec3::Z * (20 * i) as f64, heading: 0.0 };
        let gravity = creature.gravity.and_then(|gravity| Gravity::new(gravity).ok());
        match (creature.body(pose), gravity, creature.ground.clone()) {
            (Ok(body), Some(gravity), Some(ground)) => body.apply(app.world_mut().spawn((gravity, ground))),
            (Err(error), ..) => panic!("{error}"),
            _ => panic!("{name} has no ground"),
        }
    }
    for _ in 0..200 {
        app.world_mut().run_schedule(Ticks);
    }
    app
}

fn benchmarks(c: &mut Criterion) {
    let mut group = c.benchmark_group("tick");
    group.warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(3)).sample_size(20);
    for (name, dt, time_scale) in ANIMALS {
        let steps = (time_scale / 64.0 / dt).round().max(1.0) as u64;
        for count in [1, 100] {
            let mut app = animals(name, count, dt, steps);
            let cost = |app: &App| app.world().resource::<Cost>().spring_updates;
            let before = cost(&app);
            app.world_mut().run_schedule(Ticks);
            group.throughput(Throughput::Elements(cost(&app) - before));
            group.bench_function(BenchmarkId::new(name, count), |b| {
                b.iter(|| black_box(&mut app).world_mut().run_schedule(Ticks))
            });
        }
    }
    group.finish();
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
