//! What explicit Runge–Kutta methods share: stages that each start from the state, moved along by the slopes of the stage before.
//!
//! Each stage first takes from its velocity what friction does not admit, evaluates the forces with that velocity, and then takes from the
//! acceleration what friction does not admit.

use crate::mechanics::{Model, Real, State};

/// A stage of a method: when it is evaluated, in steps, and its weight in the sum.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    pub(super) at: f64,
    pub(super) weight: f64,
}

/// Scratch of a method in stages.
#[derive(Clone, Debug)]
pub(super) struct Stages<R, const D: usize> {
    /// Where the current stage stands.
    stage: State<R, D>,
    /// Acceleration of the current stage.
    acceleration: Vec<[R; D]>,
    /// Weighted sum of the stages' velocities and accelerations.
    sum: State<R, D>,
}

impl<R: Real, const D: usize> Stages<R, D> {
    pub(super) fn new(particles: usize) -> Self {
        Self {
            stage: State::new(particles),
            acceleration: vec![[R::splat(0.0); D]; particles],
            sum: State::new(particles),
        }
    }

    #[inline(always)]
    pub(super) fn step(&mut self, stages: &[Stage], model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let zero = R::splat(0.0);
        let particles = state.position.len();
        for i in 0..particles {
            (self.sum.position[i], self.sum.velocity[i]) = ([zero; D], [zero; D]);
        }
        for (index, stage) in stages.iter().enumerate() {
            let reach = R::splat(stage.at * model.dt);
            for i in 0..particles {
                for axis in 0..D {
                    let (x, v) = if index == 0 {
                        (state.position[i][axis], state.velocity[i][axis])
                    } else {
                        (
                            state.position[i][axis] + self.stage.velocity[i][axis] * reach,
                            state.velocity[i][axis] + self.acceleration[i][axis] * reach,
                        )
                    };
                    self.stage.position[i][axis] = x;
                    self.stage.velocity[i][axis] = v;
                }
            }
            model.admit_velocity(&self.stage.position, &mut self.stage.velocity);
            model.acceleration(
                time + stage.at * model.dt,
                &self.stage.position,
                &self.stage.velocity,
                &mut self.acceleration,
            );
            model.admit_acceleration(&self.stage.position, &self.stage.velocity, &mut self.acceleration);
            let weight = R::splat(stage.weight);
            for i in 0..particles {
                for axis in 0..D {
                    self.sum.position[i][axis] += self.stage.velocity[i][axis] * weight;
                    self.sum.velocity[i][axis] += self.acceleration[i][axis] * weight;
                }
            }
        }
        let dt = R::splat(model.dt);
        for i in 0..particles {
            for axis in 0..D {
                state.position[i][axis] += self.sum.position[i][axis] * dt;
                state.velocity[i][axis] += self.sum.velocity[i][axis] * dt;
            }
        }
        model.stop_held(&self.stage.position, &self.stage.velocity, &self.acceleration, &mut state.velocity);
        model.finish_velocity(&state.position, &mut state.velocity);
        model.apply_contact(state);
    }
}
