//! Miller's animals as tests run them.

use bevy::{ecs::system::EntityCommand, prelude::*};
use wriggle::{
    body::{Gravity, Ground, Particles, Strand},
    creatures::{
        Creature, Friction, Plan, Pose, StrandPlan,
        library::{self, CREATURE},
    },
    mechanics::{
        integrators::Method,
        metrics::{Gait, GaitMetrics, SAMPLES_A_CYCLE},
    },
    physics::{Clock, body_parts},
};

use crate::support::stepping_app;

/// An animal of the shipped files with what it stands on.
#[derive(Clone)]
pub struct Animal {
    pub plan: StrandPlan,
    pub friction: Friction,
    pub gravity: f64,
    pub ground: Option<Ground>,
    pub pose: Pose,
    pub method: Method,
    pub dt: f64,
}

impl Animal {
    pub fn shipped(name: &str, dt: f64) -> Self {
        let creature = library::read_creature(&library::find(CREATURE, name, None).unwrap()).unwrap();
        let Plan::Strand(plan) = creature.body else { panic!("{name} is a strand") };
        Self {
            plan,
            friction: creature.friction.unwrap(),
            gravity: creature.gravity.unwrap(),
            ground: creature.ground,
            pose: Pose::default(),
            method: Method::SemiImplicitEuler,
            dt,
        }
    }

    pub fn worm() -> Self {
        Self::shipped("worm", 0.03)
    }

    pub fn snake() -> Self {
        Self::shipped("snake", 0.05)
    }

    pub fn sidewinder() -> Self {
        Self::shipped("sidewinder", 0.05)
    }

    pub fn caterpillar() -> Self {
        Self::shipped("caterpillar", 0.1)
    }

    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// The slowest wave's period.
    pub fn period(&self) -> f64 {
        self.plan.waves.iter().map(|wave| wave.period).fold(0.0, f64::max)
    }

    pub fn spawn(&self, world: &mut World) -> Entity {
        let mut creature = Creature::from(self.plan.clone());
        creature.friction = Some(self.friction);
        let body = creature.body(self.pose).unwrap();
        let mut entity = world.spawn(self.method);
        if self.gravity > 0.0 {
            entity.insert(Gravity::new(self.gravity).unwrap());
        }
        if let Some(ground) = &self.ground {
            entity.insert(ground.clone());
        }
        let id = entity.id();
        body.apply(entity);
        id
    }

    /// An app with the animal alone whose every update is as much as two samples of its gait are apart.
    pub fn app(&self) -> (App, Entity) {
        let steps = (self.period() / SAMPLES_A_CYCLE as f64 / self.dt).round().max(1.0) as u64;
        let mut app = stepping_app(self.dt, steps);
        let body = self.spawn(app.world_mut());
        (app, body)
    }

    /// Runs it alone for so many cycles.
    pub fn run(&self, cycles: usize) -> Ran {
        let (mut app, body) = self.app();
        let mut ran = Ran::start(&mut app, body);
        ran.go_on(&mut app, cycles);
        ran
    }
}

/// A run of an animal.
pub struct Ran {
    pub body: Entity,
    pub gait: Gait,
}

impl Ran {
    pub fn start(app: &mut App, body: Entity) -> Self {
        app.world_mut().run_schedule(PreUpdate);
        let gait = Gait::new(&body_parts(app.world().entity(body)).unwrap()).unwrap();
        Self { body, gait }
    }

    fn look(&mut self, app: &App, see: &mut impl FnMut(&Particles)) {
        let clock = app.world().resource::<Clock>();
        let parts = body_parts(app.world().entity(self.body)).unwrap();
        self.gait.sample(&parts, clock.time(), clock.dt());
        see(parts.particles);
    }

    pub fn go_on(&mut self, app: &mut App, cycles: usize) {
        self.go_on_seeing(app, cycles, |_| {});
    }

    /// Goes on for so many cycles, and shows its particles at every sample.
    pub fn go_on_seeing(&mut self, app: &mut App, cycles: usize, mut see: impl FnMut(&Particles)) {
        self.look(app, &mut see);
        let end = app.world().resource::<Clock>().time() + cycles as f64 * self.gait.period();
        while app.world().resource::<Clock>().time() < end - 1e-9 {
            app.update();
            self.look(app, &mut see);
        }
    }

    pub fn metrics(&self) -> GaitMetrics {
        self.gait.measure().unwrap()
    }
}

/// The lattice of a body.
pub fn strand(app: &App, body: Entity) -> Strand {
    *app.world().get::<Strand>(body).unwrap()
}
