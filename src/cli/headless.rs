//! A scene without a renderer, stepped by hand.

use std::{collections::HashSet, io::Write};

use bevy::{
    app::{TaskPoolOptions, TaskPoolPlugin, TaskPoolThreadAssignmentPolicy},
    ecs::message::Messages,
    prelude::*,
};

use super::{CliError, Outcome};
use crate::{
    body::{Muscles, Particles, TravelingWaves},
    creatures::FileError,
    physics::{BodyFrozen, BodyInverted, Clock, Cost, Frozen, PhysicsPlugin, Plan, Ticks, WavesCut, cut_waves},
    scenes::{self, LoadedScene, SceneBodies, garden},
};

/// An app without a renderer that holds one scene and steps when it is told to.
pub struct Headless {
    app: App,
    warned: bool,
    /// Bodies whose waves are cut as their files have them: that was said when they were read.
    cut: HashSet<Entity>,
}

impl Headless {
    /// Opens `scene` in a pool of `threads`, or of as many as there are cores. Bevy's pools are global: only the first app of a
    /// process can choose.
    ///
    /// # Errors
    /// As [`scenes::open`].
    pub fn new(scene: LoadedScene, threads: Option<usize>) -> Result<Self, FileError> {
        let mut app = App::new();
        let threads = threads.unwrap_or_else(bevy::tasks::available_parallelism);
        let task_pool_options = pools_of(threads);
        app.add_plugins(MinimalPlugins.set(TaskPoolPlugin { task_pool_options }));
        app.add_plugins(PhysicsPlugin::new(Ticks));
        app.finish();
        app.cleanup();
        scenes::open(app.world_mut(), scene)?;
        let mut run = Self { app, warned: false, cut: HashSet::new() };
        run.cut = run.bodies().map(|(_, body, _)| body).filter(is_cut).map(|body| body.id()).collect();
        Ok(run)
    }

    /// The world.
    pub fn world(&self) -> &World {
        self.app.world()
    }

    /// The world, to change parameters.
    pub fn world_mut(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// The clock's step and time.
    pub fn clock(&self) -> &Clock {
        self.world().resource::<Clock>()
    }

    /// What the run has cost so far.
    pub fn cost(&self) -> Cost {
        *self.world().resource::<Cost>()
    }

    /// The bodies with their names, in the order of the scene.
    pub fn bodies(&self) -> impl Iterator<Item = (&str, EntityRef<'_>, &Particles)> + Clone {
        self.world().resource::<SceneBodies>().0.iter().filter_map(|&body| {
            let entity = self.world().get_entity(body).ok()?;
            Some((entity.get::<Name>()?.as_str(), entity, entity.get::<Particles>()?))
        })
    }

    /// Whether a body is frozen.
    pub fn has_frozen(&self) -> bool {
        self.bodies().any(|(_, body, _)| body.contains::<Frozen>())
    }

    /// Takes exactly `steps`, and gives back what has to be said about them.
    pub fn step(&mut self, steps: u64) -> Vec<String> {
        self.world_mut().resource_mut::<Clock>().set_steps_per_tick(steps);
        self.world_mut().run_schedule(Ticks);
        let mut said = self.unstable();
        said.extend(self.world_mut().resource_mut::<Messages<BodyFrozen>>().drain().map(|frozen| frozen.text));
        let cut: Vec<_> = self.world_mut().resource_mut::<Messages<WavesCut>>().drain().collect();
        let cut = cut.into_iter().filter(|cut| !self.cut.remove(&cut.body)).map(|cut| cut.text);
        said.extend(cut.map(|text| format!("warning: {text}")));
        let inverted = &mut self.world_mut().resource_mut::<Messages<BodyInverted>>();
        said.extend(inverted.drain().map(|inverted| format!("warning: {}", inverted.text)));
        said
    }

    /// Warns once of a dt above the stability limit.
    fn unstable(&mut self) -> Vec<String> {
        if core::mem::replace(&mut self.warned, true) {
            return Vec::new();
        }
        let dt = self.clock().dt();
        let bodies = self.bodies();
        let plans = bodies.filter_map(|(name, body, _)| Some((name, body.get::<Plan>()?)));
        plans
            .filter(|(_, plan)| dt > plan.stability_limit())
            .map(|(name, plan)| {
                format!("warning: dt {dt} is above {}, the stability limit of `{name}`", plan.limit_text())
            })
            .collect()
    }
}

fn is_cut(body: &EntityRef<'_>) -> bool {
    cut_waves(body.get::<Muscles>(), body.get::<TravelingWaves>()).next().is_some()
}

/// Pools for a computation on `threads`: bodies are stepped in the compute pool, the others stay as small as they can be.
fn pools_of(threads: usize) -> TaskPoolOptions {
    let policy = |threads| TaskPoolThreadAssignmentPolicy {
        min_threads: threads,
        max_threads: threads,
        percent: 1.0,
        on_thread_spawn: None,
        on_thread_destroy: None,
    };
    TaskPoolOptions {
        min_total_threads: threads,
        max_total_threads: threads,
        io: policy(1),
        async_compute: policy(1),
        compute: policy(threads),
    }
}

/// What `wriggle` does where nothing can be drawn: says in one line what is missing, and runs the garden for one minute of the worm's
/// time with its progress along the path.
///
/// # Errors
/// If the garden's file is bad or standard output cannot be written.
pub fn headless_garden(missing: &str) -> Result<Outcome, CliError> {
    /// One minute, printed in tenths.
    const MINUTE: f64 = 60.0;
    const LINES: u32 = 10;
    eprintln!("{missing}; running the garden without a picture (`wriggle run --help` has more)");
    let mut run = Headless::new(scenes::load("garden")?, None)?;
    let steps_a_line = (MINUTE / f64::from(LINES) / run.clock().dt()).round() as u64;
    let mut out = std::io::stdout().lock();
    let mut say = |run: &Headless| {
        for (name, _, particles) in run.bodies() {
            let head = particles.positions().map(|position| position.x).fold(f64::NEG_INFINITY, f64::max);
            let left = garden::DOOR - head;
            let place =
                if left > 0.0 { format!("{left:.2} before its door") } else { format!("{:.2} behind its door", -left) };
            writeln!(out, "t = {:4.1}  {name} is at {head:5.2} on the path, {place}", run.clock().time())
                .map_err(CliError::stdout)?;
        }
        Ok::<_, CliError>(())
    };
    say(&run)?;
    for _ in 0..LINES {
        for said in run.step(steps_a_line) {
            eprintln!("{said}");
        }
        say(&run)?;
    }
    Ok(if run.has_frozen() { Outcome::Frozen } else { Outcome::Done })
}
