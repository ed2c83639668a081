//! What the six-matrix particle system costs: `cargo bench --no-default-features --bench six_matrix`.
//!
//! `step` is one step of one creature on Rough Road with every search: all pairs in dense matrices, a scan of the whole road, and the grid. `million` is the
//! same on the grid of a strip of a million road particles. `hundreds` is a step through the plugin of a hundred of each creature on one road, on all
//! cores; times 64 it should stay below a second for ticks of as many steps as the scene shows.

use std::{hint::black_box, time::Duration};

use bevy::{ecs::system::EntityCommand, prelude::*};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use wriggle::{
    body::{BodyError, Particle, Particles},
    creatures::{Composed, Creature, Inchworm, RoadForm, Roller, Rough, SixBody, Strip},
    mechanics::six_matrix::{Dense, Road, Scan, SixParts, Stepper},
    physics::{Clock, PhysicsPlugin, Ticks},
};

const DT: f64 = 0.01;

struct Six {
    particles: Particles,
    six: SixBody,
    road: Road,
}

impl Six {
    /// A creature on a road, some way from its start.
    fn new(creature: &Composed, form: &RoadForm, road: &Road) -> Result<Self, BodyError> {
        let Some(pose) = creature.pose_on(road, form.station(6.0), 0.0, 0.0) else { panic!("no road is below it") };
        let body = Creature::from(creature.clone()).body(pose)?;
        let Some(six) = body.six else { panic!("a composed creature has six matrices") };
        let particles = Particles::new(body.particles.positions().map(Particle::at))?;
        Ok(Self { particles, six, road: road.clone() })
    }

    fn parts(&self) -> SixParts<'_> {
        let SixBody { columns, bonds, collisions, rules } = &self.six;
        SixParts { particles: &self.particles, columns, bonds, collisions, rules, road: Some(&self.road), pull: None }
    }
}

fn creatures() -> [(&'static str, Composed); 2] {
    [("inchworm", Inchworm::default().composed()), ("roller", Roller::default().composed())]
}

fn good<T>(result: Result<T, BodyError>) -> T {
    match result {
        Ok(value) => value,
        Err(error) => panic!("{error}"),
    }
}

/// So many steps from the start, again and again: a creature that walks off its road costs less.
const STRETCH: usize = 200;

fn stretches(c: &mut Criterion, group: &str, form: &RoadForm, with_dense: bool) {
    let road = good(form.build());
    let mut group = c.benchmark_group(group);
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2)).sample_size(10);
    group.throughput(criterion::Throughput::Elements(STRETCH as u64));
    for (name, creature) in creatures() {
        let six = good(Six::new(&creature, form, &road));
        let parts = six.parts();
        let run = |step: &dyn Fn(&mut Stepper) -> bool| {
            let mut stepper = Stepper::new(&parts);
            (0..STRETCH).all(|_| step(&mut stepper))
        };
        group.bench_function(BenchmarkId::new("grid", name), |b| {
            b.iter(|| black_box(run(&|stepper| stepper.step(&parts, DT).is_ok())))
        });
        if !with_dense {
            continue;
        }
        let scan = Scan(road.points());
        group.bench_function(BenchmarkId::new("scan", name), |b| {
            b.iter(|| black_box(run(&|stepper| stepper.step_on(&parts, Some(&scan), DT).is_ok())))
        });
        group.throughput(criterion::Throughput::Elements(1));
        let mut dense = Dense::new(&parts);
        group.bench_function(BenchmarkId::new("dense", name), |b| b.iter(|| black_box(&mut dense).step(&parts, DT)));
        group.throughput(criterion::Throughput::Elements(STRETCH as u64));
    }
    group.finish();
}

/// A hundred of each on one road, side by side in the same places: bodies do not touch each other.
fn hundreds() -> App {
    let form = RoadForm::Rough(Rough::default());
    let road = good(form.build());
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::new(Ticks)));
    app.finish();
    app.cleanup();
    let mut clock = app.world_mut().resource_mut::<Clock>();
    good(clock.set_dt(DT));
    clock.set_steps_per_tick(1);
    for (_, creature) in creatures() {
        for i in 0..100 {
            let station = form.station(3.0 + 0.05 * f64::from(i));
            let Some(pose) = creature.pose_on(&road, station, 0.0, 0.0) else { panic!("no road is below it") };
            let body = good(Creature::from(creature.clone()).body(pose));
            body.apply(app.world_mut().spawn(road.clone()));
        }
    }
    app
}

fn benchmarks(c: &mut Criterion) {
    stretches(c, "step", &RoadForm::Rough(Rough::default()), true);
    let million = Strip { rows: 10_000, columns: 100, spacing: 1.5, at: (0.0, 0.0, 0.0), heading: 0.0, bump: 0.0 };
    stretches(c, "million", &RoadForm::Strip(million), false);
    let mut group = c.benchmark_group("hundreds");
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(3)).sample_size(10);
    let mut app = hundreds();
    group.bench_function("step", |b| b.iter(|| black_box(&mut app).world_mut().run_schedule(Ticks)));
    group.finish();
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
