//! The classic fourth-order Runge–Kutta method, with the friction rule inside its stages.
//!
//! Each stage first takes from its velocity what friction does not admit, evaluates the forces with that velocity, and then takes from the
//! acceleration what friction does not admit. Order 4 while no mass sticks or slips; about 2, and erratic, across such events, because
//! they are not located. Four evaluations a step.

use crate::mechanics::{
    Model, Real, State,
    stability::{Damping, StabilityBound},
};

use super::Integrator;

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct RungeKutta4<R, const D: usize> {
    /// Where the current stage stands.
    stage: State<R, D>,
    /// Acceleration of the current stage.
    acceleration: Vec<[R; D]>,
    /// Weighted sum of the stages' velocities and accelerations.
    sum: State<R, D>,
}

/// When a stage is evaluated, in steps, and its weight in the sum.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

impl<R: Real, const D: usize> Integrator<R, D> for RungeKutta4<R, D> {
    fn new(particles: usize) -> Self {
        Self {
            stage: State::new(particles),
            acceleration: vec![[R::splat(0.0); D]; particles],
            sum: State::new(particles),
        }
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let zero = R::splat(0.0);
        let particles = state.position.len();
        for i in 0..particles {
            (self.sum.position[i], self.sum.velocity[i]) = ([zero; D], [zero; D]);
        }
        for (stage, &(at, weight)) in STAGES.iter().enumerate() {
            // The stage starts from the state, moved along by the slopes of the stage before.
            let reach = R::splat(at * model.dt);
            for i in 0..particles {
                for axis in 0..D {
                    let (x, v) = if stage == 0 {
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
                time + at * model.dt,
                &self.stage.position,
                &self.stage.velocity,
                &mut self.acceleration,
            );
            model.admit_acceleration(&self.stage.position, &self.stage.velocity, &mut self.acceleration);
            let weight = R::splat(weight);
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
        model.admit_velocity(&state.position, &mut state.velocity);
        model.apply_contact(state);
    }
}

/// The smallest |z| in the left half-plane at which |1 + z + z²/2 + z³/6 + z⁴/24| = 1 (at a damping ratio near ½), rounded down.
const STABLE_RADIUS: f64 = 2.615;

/// A mode e^(μt) is stable while |μ|·dt is within the method's region of stability, and thus surely within its [`STABLE_RADIUS`].
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    let stiffness = bound.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max);
    let damping = bound.rates.iter().map(|rates| rates.damping).fold(0.0, f64::max);
    let frequency = stiffness.sqrt();
    let fastest = match bound.damping {
        // Every mode has γ = βκ, and |μ| grows with κ: the stiffest mode is the fastest.
        Damping::Proportional if bound.friction == 0.0 => {
            let overdamped = 0.25 * damping * damping - stiffness;
            if overdamped > 0.0 { 0.5 * damping + overdamped.sqrt() } else { frequency }
        }
        // Over all modes within the bounds: √κ if it oscillates, at most γ if not.
        _ => frequency.max(damping + bound.friction),
    };
    if fastest > 0.0 { STABLE_RADIUS / fastest } else { f64::INFINITY }
}
