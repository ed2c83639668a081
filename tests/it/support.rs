//! Bodies and apps that the tests share.

use bevy::{ecs::schedule::SingleThreadedExecutor, math::DVec3, prelude::*, time::TimeUpdateStrategy};
use wriggle::{
    body::{Muscle, Muscles, Particle, ParticleId, Particles, SpineFriction, Spring, SpringId, Springs, Wave},
    mechanics::{Advance, BodyParts, Model, State, Timeline, integrators::Method},
    physics::{Clock, PhysicsPlugin},
};

/// The methods that step bodies in three dimensions: all but the exact flow.
pub fn in_space() -> impl Iterator<Item = Method> {
    Method::ALL.into_iter().filter(|method| *method != Method::ExactFlow)
}

/// A worm of three masses on the x axis, as numbers.
#[derive(Clone, Copy, Debug)]
pub struct Worm {
    pub stiffness: f64,
    pub damping: f64,
    pub amplitude: f64,
    pub period: f64,
    pub phase: f64,
    pub ramp: f64,
    pub ratchet: bool,
    pub drag: f64,
    pub method: Method,
}

impl Worm {
    /// The garden worm.
    pub const GARDEN: Self = Self {
        stiffness: 1.5,
        damping: 0.9,
        amplitude: 0.3,
        period: 6.0,
        phase: 0.25,
        ramp: 1.0,
        ratchet: true,
        drag: 0.5,
        method: Method::SemiImplicitEuler,
    };

    /// The worm whose motion is known to twelve digits.
    pub const EXACT: Self = Self { amplitude: 0.25, period: 2.0, ramp: 0.0, drag: 0.0, ..Self::GARDEN };

    pub fn body(&self) -> Body {
        let particles = Particles::new((0..3).map(|i| Particle::at(DVec3::X * f64::from(i)))).unwrap();
        let spring = |i| Spring {
            ends: [ParticleId(i), ParticleId(i + 1)],
            stiffness: self.stiffness,
            damping: self.damping,
            rest_length: 1.0,
        };
        let springs = Springs::new((0..2).map(spring), &particles).unwrap();
        let muscle = |i| Muscle {
            spring: SpringId(i),
            wave: Wave::Sine,
            amplitude: self.amplitude,
            period: self.period,
            phase: self.phase * f64::from(i),
            ramp: self.ramp,
        };
        let muscles = Muscles::new((0..2).map(muscle), &springs).unwrap();
        let friction = SpineFriction::new((0..3).map(ParticleId), &particles)
            .unwrap()
            .with_ratchet(self.ratchet)
            .with_drag(self.drag)
            .unwrap();
        Body { particles, springs, muscles, friction, method: self.method }
    }
}

/// The components of a body.
#[derive(Bundle, Clone)]
pub struct Body {
    pub particles: Particles,
    pub springs: Springs,
    pub muscles: Muscles,
    pub friction: SpineFriction,
    pub method: Method,
}

impl Body {
    pub fn parts(&self) -> BodyParts<'_> {
        BodyParts {
            muscles: Some(&self.muscles),
            friction: Some(&self.friction),
            ..BodyParts::new(&self.particles, &self.springs, self.method)
        }
    }

    /// The same body, shifted, and turned about y by an angle in radians.
    pub fn moved(mut self, by: DVec3, turn: f64) -> Self {
        let rotation = bevy::math::DQuat::from_rotation_y(turn);
        self.particles = Particles::new((0..self.particles.len()).map(|i| {
            let particle = self.particles.get(ParticleId(i as u32)).unwrap();
            Particle { position: rotation * particle.position + by, velocity: rotation * particle.velocity, ..particle }
        }))
        .unwrap();
        self
    }
}

/// Takes `steps` of `dt` with a body of `D` coordinates a particle, one by one from time 0, and shows it after each.
pub fn follow<const D: usize>(body: &BodyParts<'_>, dt: f64, steps: u64, mut see: impl FnMut(f64, BodyParts<'_>)) {
    let mut model = Model::<f64, D>::new(body, [], dt);
    let mut state = State::new(body.particles.len());
    state.set_lane(0, body.particles);
    let mut particles = body.particles.clone();
    let timeline = Timeline { dt, base_step: 0, base_time: 0.0 };
    for first in 0..steps {
        Advance { model: &mut model, state: &mut state, method: body.method, timeline, first, steps: 1 }.run();
        state.write_lane(0, &mut particles);
        see(timeline.time_at(first + 1), BodyParts { particles: &particles, ..*body });
    }
}

/// A body on the x axis.
pub struct Row {
    pub particles: Particles,
    pub springs: Springs,
    pub muscles: Muscles,
}

impl Row {
    pub fn new(particles: Particles, springs: Springs) -> Self {
        let muscles = Muscles::new([], &springs).unwrap();
        Self { particles, springs, muscles }
    }

    pub fn parts(&self, method: Method) -> BodyParts<'_> {
        BodyParts { muscles: Some(&self.muscles), ..BodyParts::new(&self.particles, &self.springs, method) }
    }

    /// Takes `steps` one by one, and shows the body after each.
    pub fn run(&self, method: Method, dt: f64, steps: u64, see: impl FnMut(f64, BodyParts<'_>)) {
        follow::<1>(&self.parts(method), dt, steps, see);
    }
}

/// A headless app whose every update is exactly one tick of `steps` steps of `dt`.
pub fn stepping_app(dt: f64, steps: u64) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::new(Update)));
    let mut clock = Clock::new(dt, 1.0).unwrap();
    clock.set_steps_per_tick(steps);
    app.insert_resource(clock);
    // Handing the few systems of a tick from thread to thread takes longer than most ticks here.
    for (_, schedule) in app.world_mut().resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
    app
}

/// A headless app with the physics in the fixed loop, a frame lasting exactly one tick.
pub fn ticking_app(dt: f64, time_scale: f64) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default()));
    app.insert_resource(Clock::new(dt, time_scale).unwrap());
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app
}

/// Updates until the clock has reached `time`.
pub fn run_until(app: &mut App, time: f64) {
    while app.world().resource::<Clock>().time() < time - 1e-9 {
        app.update();
    }
}

pub fn particles(app: &App, body: Entity) -> &Particles {
    app.world().get::<Particles>(body).unwrap()
}

pub fn center(app: &App, body: Entity) -> f64 {
    particles(app, body).center().x
}

/// The bits of all positions, then all velocities.
pub fn bits(particles: &Particles) -> Vec<u64> {
    let vectors = particles.positions().chain(particles.velocities());
    vectors.flat_map(|v| v.to_array()).map(f64::to_bits).collect()
}
