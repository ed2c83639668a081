//! What a spring of a block of jelly costs: `taskset -c 0 cargo bench --no-default-features --bench jelly`.
//!
//! Each row steps a block with springs to all neighbours that lies on the ground, by damped Verlet as its scene does, contact and gravity
//! included; `elem` is one spring update, and `fastest` the shortest of many short runs, for machines that others use, too. `bare` is the same arithmetic on a few arrays that stay in the first cache: the practical limit of the processor. Rows of
//! `damped` have damping in their springs, too.
//!
//! `JELLY_THREADS=2 cargo bench --no-default-features --bench jelly` measures nothing but how much faster two threads are than one that steps the same block: both in turns, so
//! that what else the machine does befalls both.

use std::{
    hint::black_box,
    time::{Duration, Instant},
};

use bevy::{
    prelude::*,
    tasks::{ComputeTaskPool, TaskPoolBuilder},
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use wriggle::{
    body::{Gravity, Ground, MassDamping, Neighbours},
    creatures::{Body, Creature, JellyPlan, NeighboursPlan, Pose, SpringPlan},
    mechanics::{Advance, BodyParts, Lanes, Model, Real, State, Timeline, integrators::Method},
    physics::{Clock, PhysicsPlugin, Ticks},
    scenes,
};

const DT: f64 = 0.1;

fn block(size: u32, damping: f64) -> Body {
    let spring = SpringPlan { stiffness: 1.0, damping };
    let plan = JellyPlan {
        size: (size, size, size),
        neighbours: NeighboursPlan::alike(&Neighbours::ALL, spring),
        mass: 1.0,
        tilt: 0.0,
        rotation: None,
        drop: 0.0,
    };
    match Creature::from(plan).body(Pose::default()) {
        Ok(body) => body,
        Err(error) => panic!("{error}"),
    }
}

fn parts(body: &Body) -> BodyParts<'_> {
    BodyParts {
        lattice: body.block.map(|(lattice, _)| lattice),
        gravity: Gravity::new(0.001).ok(),
        ground: Some(&Ground::Flat),
        mass_damping: MassDamping::per_step(0.01).ok(),
        ..BodyParts::new(&body.particles, &body.springs, Method::DampedVerlet)
    }
}

fn resident_bytes() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?.split_whitespace().nth(1)?.parse::<u64>().ok()?;
    Some(pages * 4096)
}

/// From the start of a page: where arrays lie to each other decides how fast a processor stores to one and loads from another.
#[repr(C, align(4096))]
struct Arrays {
    ends: [[[f64; 8]; 13]; 13],
    sums: [[[f64; 8]; 13]; 6],
}

/// The processor's limit: the arithmetic of a spring on 104 of them, in arrays that stay in the first cache.
struct Bare<'a> {
    ends: &'a [[[f64; 8]; 13]; 13],
    sums: &'a mut [[[f64; 8]; 13]; 6],
    damping: f64,
}

impl pulp::NullaryFnOnce for Bare<'_> {
    type Output = Lanes<8>;

    #[inline(always)]
    fn call(self) -> Lanes<8> {
        if self.damping > 0.0 { self.run::<true>() } else { self.run::<false>() }
    }
}

impl Bare<'_> {
    #[inline(always)]
    fn run<const DAMPED: bool>(self) -> Lanes<8> {
        type Eight = Lanes<8>;
        let Self { ends: e, sums, damping } = self;
        let (zero, one) = (Eight::splat(0.0), Eight::splat(1.0));
        let mut too_long = zero;
        for i in 0..13 {
            let apart = |k: usize| Eight::from(e[3 + k][i]) - Eight::from(e[k][i]);
            let (x, y, z) = (apart(0), apart(1), apart(2));
            let square = x * x + y * y + z * z;
            let mask = Eight::from(e[12][i]);
            too_long = (square * mask).if_below(Eight::splat(100.0), too_long, one);
            let length = square.sqrt();
            let inverse = zero.if_below(length, one / length, zero);
            let mut pull = one - inverse;
            if DAMPED {
                let apart = |k: usize| Eight::from(e[9 + k][i]) - Eight::from(e[6 + k][i]);
                let speed = apart(0) * x + apart(1) * y + apart(2) * z;
                pull += Eight::splat(damping) * speed * inverse * inverse;
            }
            let pull = pull * mask;
            for (k, force) in [x * pull, y * pull, z * pull].into_iter().enumerate() {
                sums[k][i] = (Eight::from(sums[k][i]) + force).into();
                sums[3 + k][i] = (Eight::from(sums[3 + k][i]) - force).into();
            }
        }
        too_long
    }
}

fn bare(c: &mut Criterion) {
    let mut group = c.benchmark_group("bare");
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1)).sample_size(40);
    group.throughput(Throughput::Elements(104));
    let mut arrays = Box::new(Arrays { ends: [[[0.0; 8]; 13]; 13], sums: [[[0.0; 8]; 13]; 6] });
    let Arrays { ends, sums } = &mut *arrays;
    for (k, column) in ends.iter_mut().enumerate() {
        for (i, value) in column.as_flattened_mut().iter_mut().enumerate() {
            *value = if k == 12 { 1.0 } else { k as f64 + 0.01 * (i % 7) as f64 };
        }
    }
    for (name, damping) in [("stiff", 0.0), ("damped", 0.1)] {
        let mut round =
            || pulp::Arch::new().dispatch(Bare { ends: black_box(&*ends), sums: black_box(&mut *sums), damping });
        group.bench_function(name, |b| b.iter(&mut round));
        let fastest = (0..20_000).map(|_| {
            let start = Instant::now();
            (0..100).for_each(|_| _ = black_box(round()));
            start.elapsed().as_secs_f64()
        });
        let fastest = fastest.fold(f64::INFINITY, f64::min);
        println!("fastest: {:.0} million spring updates a second", 100.0 * 104.0 / fastest / 1e6);
    }
    group.finish();
}

/// Several steps at once, as a tick takes them.
const AT_ONCE: u64 = 6;

/// A block on its way.
struct Run {
    model: Model<f64, 3>,
    state: State<f64, 3>,
    method: Method,
    first: u64,
}

impl Run {
    fn new(parts: &BodyParts<'_>) -> Self {
        let mut state = State::new(parts.particles.len());
        state.set_lane(0, parts.particles);
        Self { model: Model::new(parts, [], DT), state, method: parts.method, first: 0 }
    }

    fn steps(&mut self, steps: u64) {
        let Self { model, state, method, first } = self;
        let timeline = Timeline { dt: DT, base_step: 0, base_time: 0.0 };
        Advance { model, state, method: *method, timeline, first: *first, steps }.run();
        *first += steps;
    }

    /// The seconds that steps take.
    fn timed(&mut self) -> f64 {
        let start = Instant::now();
        self.steps(AT_ONCE);
        start.elapsed().as_secs_f64()
    }
}

/// How much faster some threads step a block than one does.
fn cores(threads: usize) {
    /// So often both are timed.
    const TURNS: usize = 400;
    // Smaller blocks are not shared.
    let sizes = [30, 60];
    let bodies = sizes.map(|size| block(size, 0.0));
    // A block that is made before there are threads goes on by itself.
    let alone = bodies.each_ref().map(|body| Run::new(&parts(body)));
    ComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(threads).build());
    for ((size, body), mut alone) in sizes.into_iter().zip(&bodies).zip(alone) {
        let mut shared = Run::new(&parts(body));
        let mut seconds: Vec<_> = (0..TURNS).map(|_| [alone.timed(), shared.timed()]).collect();
        let fastest = [0, 1].map(|i| seconds.iter().map(|pair| pair[i]).fold(f64::INFINITY, f64::min));
        seconds.sort_by(|a, b| (a[0] / a[1]).total_cmp(&(b[0] / b[1])));
        let median = seconds[TURNS / 2][0] / seconds[TURNS / 2][1];
        let rate = |seconds: f64| (AT_ONCE * body.springs.len() as u64) as f64 / seconds / 1e6;
        println!(
            "{size}³: {threads} threads are {:.2} times as fast as one, fastest of {TURNS} turns (median of the turns {median:.2}): {:.0} and {:.0} \
             million spring updates a second",
            fastest[0] / fastest[1],
            rate(fastest[1]),
            rate(fastest[0]),
        );
        black_box((&alone.state, &shared.state));
    }
}

fn blocks(c: &mut Criterion) {
    ComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
    let mut group = c.benchmark_group("step");
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2)).sample_size(20);
    for (name, damping, sizes) in [("stiff", 0.0, &[8, 10, 20, 30, 60, 100][..]), ("damped", 0.1, &[10, 30])] {
        for &size in sizes {
            let before = resident_bytes();
            let body = block(size, damping);
            let parts = parts(&body);
            let mut run = Run::new(&parts);
            let springs = parts.springs.len() as u64;
            run.steps(1);
            if let (Some(before), Some(after)) = (before, resident_bytes()) {
                let bytes = after.saturating_sub(before) as f64 / f64::from(size * size * size);
                println!("{size}³: {springs} springs, {bytes:.0} bytes a particle");
            }
            group.throughput(Throughput::Elements(AT_ONCE * springs));
            group.bench_function(BenchmarkId::new(name, size), |b| b.iter(|| run.steps(AT_ONCE)));
            // What the machine can do while nobody else wants it.
            let fastest = (0..200_000_000 / (AT_ONCE * springs)).map(|_| run.timed()).fold(f64::INFINITY, f64::min);
            println!("fastest: {:.0} million spring updates a second", (AT_ONCE * springs) as f64 / fastest / 1e6);
            black_box(&run.state);
        }
    }
    group.finish();
}

/// A tick of the scene at its own setting.
fn tick(c: &mut Criterion) {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::new(Ticks)));
    if let Err(error) = scenes::load("jelly").and_then(|scene| scenes::open(app.world_mut(), scene)) {
        panic!("{error}");
    }
    // 40 units of time a second in 64 ticks are 2.6 steps of 0.24.
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(3);
    let mut group = c.benchmark_group("tick");
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2)).sample_size(40);
    group.bench_function("jelly 8³, 3 steps", |b| b.iter(|| black_box(&mut app).world_mut().run_schedule(Ticks)));
    group.finish();
}

criterion_group!(benches, bare, blocks, tick);

fn main() {
    match std::env::var("JELLY_THREADS").ok().and_then(|text| text.parse().ok()) {
        Some(threads) if threads > 1 => cores(threads),
        _ => {
            benches();
            Criterion::default().configure_from_args().final_summary();
        }
    }
}
