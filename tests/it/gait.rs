//! What the measures of a gait keep, and where there is no gait.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{ParticleId, Particles},
    mechanics::metrics::{Gait, SAMPLES_A_CYCLE},
    physics::body_parts,
};

use crate::{animal::Animal, support::stepping_app};

/// A snake that is moved by hand, stiff as it is at rest.
struct Carried {
    app: App,
    body: Entity,
    gait: Gait,
    start: Vec<DVec3>,
}

impl Carried {
    fn new() -> Self {
        let mut app = stepping_app(0.05, 1);
        let body = Animal::snake().spawn(app.world_mut());
        let parts = body_parts(app.world().entity(body)).unwrap();
        let (gait, start) = (Gait::new(&parts).unwrap(), parts.particles.positions().collect());
        Self { app, body, gait, start }
    }

    /// Moves it away from its start by a way that depends on the number of cycles, and looks at it at every sample from one number of cycles to another.
    fn carry(&mut self, from: usize, to: usize, way: impl Fn(f64) -> DVec3) {
        for sample in from * SAMPLES_A_CYCLE..to * SAMPLES_A_CYCLE {
            let cycles = sample as f64 / SAMPLES_A_CYCLE as f64;
            let mut particles = self.app.world_mut().get_mut::<Particles>(self.body).unwrap();
            for (i, start) in (0..).map(ParticleId).zip(&self.start) {
                let particle = particles.get(i).unwrap();
                particles.set(i, wriggle::body::Particle { position: start + way(cycles), ..particle }).unwrap();
            }
            let parts = body_parts(self.app.world().entity(self.body)).unwrap();
            self.gait.sample(&parts, cycles * self.gait.period(), 0.05);
        }
    }
}

#[test]
fn what_is_carried_ahead_follows_its_path_and_what_is_carried_aside_does_not() {
    for (way, error) in
        [(DVec3::X * 5.0, 0.0), (DVec3::Z * 3.0, 7.0), (DVec3::new(1.0, 0.0, 1.0), 7.0 * 0.5_f64.sqrt())]
    {
        let mut snake = Carried::new();
        snake.carry(0, 41, |cycles| way * cycles);
        let gait = snake.gait.measure().unwrap();
        // Sections 1 to 11 are 2 to 12 behind section 13, 7 on average.
        assert!((gait.path_error - error).abs() < 1e-9, "{way}: {}", gait.path_error);
        assert!((gait.distance - way.length()).abs() < 1e-9 && gait.cycles == 4, "{gait:?}");
    }
}

#[test]
fn what_a_gait_keeps_does_not_grow_with_time() {
    let mut snake = Carried::new();
    let round = |cycles: f64| DVec3::new(libm::sin(cycles), 0.0, libm::cos(cycles)) * 20.0;
    let mut kept = |from, to| {
        snake.carry(from, to, round);
        format!("{:?}", snake.gait).len() as f64
    };
    let (early, late) = (kept(0, 40), kept(40, 80));
    assert!(late < 1.05 * early, "{early} characters, then {late}");
}

#[test]
fn cycles_that_are_shorter_than_steps_have_no_gait() {
    for period in [0.0015, 1e-3, 1e-300] {
        let mut app = stepping_app(0.02, 1);
        let body = Animal::snake().with(|snake| snake.plan.waves[0].period = period).spawn(app.world_mut());
        let parts = body_parts(app.world().entity(body)).unwrap();
        let mut gait = Gait::new(&parts).unwrap();
        for step in 0..200 {
            gait.sample(&parts, 0.02 * f64::from(step), 0.02);
            assert_eq!(gait.measure(), None, "{period}");
        }
    }
}
