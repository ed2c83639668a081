//! What a step costs with each method: `cargo bench --no-default-features --bench methods`.
//!
//! One step of a garden worm (3 masses, 2 springs), of a strand as large as a snake (60 masses, 258 springs) and of a block of 10³ masses with
//! springs to all neighbours. All methods take the same steps of half of Runge–Kutta 4's stability limit.

use std::{hint::black_box, time::Duration};

use bevy::math::{DVec3, U64Vec3};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use wriggle::{
    body::{Muscles, Particle, ParticleId, Particles, SpineFriction, Spring, Springs},
    creatures::{Creature, GardenWorm, Pose},
    mechanics::{Advance, BodyParts, Model, State, Timeline, integrators::Method},
};

/// The components of a body.
struct Body {
    name: &'static str,
    particles: Particles,
    springs: Springs,
    muscles: Option<Muscles>,
    friction: Option<SpineFriction>,
}

impl Body {
    fn parts(&self, method: Method) -> BodyParts<'_> {
        BodyParts {
            muscles: self.muscles.as_ref(),
            friction: self.friction.as_ref(),
            ..BodyParts::new(&self.particles, &self.springs, method)
        }
    }

    fn worm() -> Self {
        match Creature::from(GardenWorm::default()).body(Pose::default()) {
            Ok(body) => Self {
                name: "worm",
                particles: body.particles,
                springs: body.springs,
                muscles: body.muscles,
                friction: body.friction,
            },
            Err(error) => panic!("{error}"),
        }
    }

    /// Masses on a grid, and a spring between each two that are in the same cell and whose way `joined` accepts.
    fn lattice(name: &'static str, size: U64Vec3, joined: impl Fn(DVec3) -> bool) -> Self {
        let places: Vec<_> = (0..size.x * size.y * size.z)
            .map(|i| U64Vec3::new(i / (size.y * size.z), i / size.z % size.y, i % size.z).as_dvec3())
            .collect();
        // A wobble that is the same in every run.
        let wobble = |i: usize| DVec3::new((i * 7 % 11) as f64, (i * 5 % 13) as f64, (i * 3 % 7) as f64) / 100.0 - 0.05;
        let particle = |(i, &place): (usize, &DVec3)| Particle { velocity: wobble(i), ..Particle::at(place) };
        let ways = places.iter().enumerate().flat_map(|(i, a)| {
            places.iter().enumerate().skip(i + 1).map(move |(j, b)| (i as u32, j as u32, (b - a).abs()))
        });
        let springs = ways.filter(|(.., way)| way.max_element() == 1.0 && joined(*way)).map(|(a, b, way)| Spring {
            ends: [ParticleId(a), ParticleId(b)],
            stiffness: 1.0,
            damping: 0.3,
            rest_length: way.length(),
        });
        let built = Particles::new(places.iter().enumerate().map(particle)).and_then(|particles| {
            let springs = Springs::new(springs, &particles)?;
            Ok(Self { name, particles, springs, muscles: None, friction: None })
        });
        built.unwrap_or_else(|error| panic!("{error}"))
    }
}

fn benchmarks(c: &mut Criterion) {
    let bodies = [
        Body::worm(),
        // Without diagonals inside of its segments, as the animals are.
        Body::lattice("strand", U64Vec3::new(15, 2, 2), |way| way.element_sum() < 3.0),
        Body::lattice("block", U64Vec3::splat(10), |_| true),
    ];
    let mut group = c.benchmark_group("step");
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2)).sample_size(10);
    for body in &bodies {
        let dt = 0.5 * body.parts(Method::RungeKutta4).stability_limit(0.0);
        for method in Method::ALL {
            let parts = body.parts(method);
            let id = BenchmarkId::new(method.name(), body.name);
            match (parts.on_axis(), method) {
                (true, _) => group.bench_function(id, |b| steps::<1>(b, &parts, dt)),
                (false, Method::ExactFlow) => continue,
                (false, _) => group.bench_function(id, |b| steps::<3>(b, &parts, dt)),
            };
        }
    }
    group.finish();
}

/// Measures 16 steps at a time, always from the start, and reports one.
fn steps<const D: usize>(b: &mut criterion::Bencher<'_>, parts: &BodyParts<'_>, dt: f64) {
    const STEPS: u64 = 16;
    let mut model = Model::<f64, D>::new(parts, [], dt);
    let mut start = State::new(parts.particles.len());
    start.set_lane(0, parts.particles);
    let timeline = Timeline { dt, base_step: 0, base_time: 0.0 };
    b.iter_custom(|times| {
        let mut passed = Duration::ZERO;
        for _ in 0..times.div_ceil(STEPS) {
            let mut state = start.clone();
            let begin = std::time::Instant::now();
            let advance = Advance {
                model: &mut model,
                state: &mut state,
                method: parts.method,
                timeline,
                first: 0,
                steps: STEPS,
            };
            advance.run();
            passed += begin.elapsed();
            black_box(&state);
        }
        passed.mul_f64(times as f64 / (times.div_ceil(STEPS) * STEPS) as f64)
    });
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
