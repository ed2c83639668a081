//! What a spring update costs, through the plugin: `cargo bench --no-default-features`.
//!
//! Each row steps so many garden worms, muscles and friction included, by ticks of the garden's own clock (94 steps a tick). `elem` is one
//! spring update: the force on one spring in one evaluation. To compare with one core, run it on one: `taskset -c 0 cargo bench …`.

use std::{hint::black_box, time::Duration};

use bevy::prelude::*;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use wriggle::{
    creatures::{Creature, GardenWorm, Pose},
    mechanics::integrators::Method,
    physics::{Clock, Cost, PhysicsPlugin, Ticks},
};

const STEPS_A_TICK: u64 = 94;

/// An app of `count` garden worms, all a little different, that has settled for a few ticks.
fn worms(count: usize, method: Method) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::new(Ticks)));
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(STEPS_A_TICK);
    for i in 0..count {
        let pose = Pose { at: bevy::math::DVec3::Z * i as f64, heading: 0.0 };
        let worm = GardenWorm { damping: 0.9 + 0.2 * i as f64 / count as f64, ..GardenWorm::default() };
        match Creature::from(worm).body(pose) {
            Ok(body) => {
                let worm = app.world_mut().spawn(method);
                bevy::ecs::system::EntityCommand::apply(body, worm);
            }
            Err(error) => panic!("{error}"),
        }
    }
    for _ in 0..3 {
        app.world_mut().run_schedule(Ticks);
    }
    app
}

fn resident_bytes() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?.split_whitespace().nth(1)?.parse::<u64>().ok()?;
    Some(pages * 4096)
}

fn benchmarks(c: &mut Criterion) {
    let mut group = c.benchmark_group("tick");
    group.warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(3)).sample_size(20);
    for method in [Method::SemiImplicitEuler, Method::RungeKutta4] {
        for count in [1, 1_000, 10_000] {
            let before = resident_bytes();
            let mut app = worms(count, method);
            if let (Some(before), Some(after)) = (before, resident_bytes()) {
                println!("{count} worms take {:.1} MB", after.saturating_sub(before) as f64 / 1e6);
            }
            let cost = |app: &App| app.world().resource::<Cost>().spring_updates;
            let before = cost(&app);
            app.world_mut().run_schedule(Ticks);
            group.throughput(Throughput::Elements(cost(&app) - before));
            group.bench_function(BenchmarkId::new(method.name(), count), |b| {
                b.iter(|| black_box(&mut app).world_mut().run_schedule(Ticks))
            });
        }
    }
    let mut idle = worms(0, Method::SemiImplicitEuler);
    group.throughput(Throughput::Elements(1));
    group.bench_function("idle scene", |b| b.iter(|| black_box(&mut idle).world_mut().run_schedule(Ticks)));
    group.finish();
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
