//! XPBD: extended position-based dynamics with small steps, each step one substep with one pass over the springs.
//!
//! x* = x + dt·(v + dt·g); then for each spring in turn, with C = l − L(t+dt): Δλ = −(dt²k·C + dt·D·∇C·(x − xₙ)) / (1 + (dt²k + dt·D)·w),
//! w = Σ1/m, x += ∇C·Δλ/m; v⁺ = (x − xₙ)/dt. Order 1; one evaluation (pass) a step. No step makes it unstable, but one pass does not solve stiff bodies:
//! their low modes slow down. Sources: M. Macklin, M. Müller, N. Chentanez, "XPBD" (2016), with its damping; M. Macklin et al., "Small
//! steps in physics simulation" (2019).

use crate::mechanics::{Model, Real, State, forces::direction};

use super::{About, Integrator};

pub(super) const ABOUT: About = About {
    name: "Xpbd",
    summary: "order 1, one pass over the springs a step; never explodes, soft where springs are stiff",
    order: 1,
    evaluations: Some(1),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct Xpbd<R, const D: usize> {
    /// Where the step began.
    start: Vec<[R; D]>,
}

impl<R: Real, const D: usize> Integrator<R, D> for Xpbd<R, D> {
    fn new(particles: usize) -> Self {
        Self { start: vec![[R::splat(0.0); D]; particles] }
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let (zero, one, dt) = (R::splat(0.0), R::splat(1.0), R::splat(model.dt));
        self.start.copy_from_slice(&state.position);
        let kept = one - model.damping.map_or(zero, |damping| damping.loss);
        if let Some((particle, pull)) = model.pull(&state.position, &state.velocity) {
            for (v, pull) in state.velocity[particle].iter_mut().zip(pull) {
                *v += pull * dt;
            }
        }
        for ((x, v), &inverse_mass) in state.position.iter_mut().zip(&mut state.velocity).zip(&model.inverse_mass) {
            if let (Some(gravity), true) = (model.gravity, D == 3) {
                v[1] -= zero.if_below(inverse_mass, gravity * dt, zero);
            }
            for axis in 0..D {
                x[axis] += v[axis] * kept * dt;
            }
        }
        model.drive_muscles(time + model.dt, &state.position);
        model.evaluations += one;
        for (spring, &rest) in model.springs.iter().zip(&model.rest) {
            let [a, b] = [spring.ends[0] as usize, spring.ends[1] as usize];
            let (length, along) = direction(state.position[a], state.position[b]);
            model.overstretched = length.if_below(spring.longest, model.overstretched, one);
            let mut lengthened = zero;
            for (axis, along) in along.into_iter().enumerate() {
                let (moved_a, moved_b) =
                    (state.position[a][axis] - self.start[a][axis], state.position[b][axis] - self.start[b][axis]);
                lengthened += (moved_b - moved_a) * along;
            }
            let (stiff, damp) = (spring.stiffness * dt * dt, spring.damping * dt);
            let weight = model.inverse_mass[a] + model.inverse_mass[b];
            let multiplier = -(stiff * (length - rest) + damp * lengthened) / (one + (stiff + damp) * weight);
            for (axis, along) in along.into_iter().enumerate() {
                let push = along * multiplier;
                state.position[a][axis] -= push * model.inverse_mass[a];
                state.position[b][axis] += push * model.inverse_mass[b];
            }
        }
        let per_time = one / dt;
        for ((x, v), start) in state.position.iter_mut().zip(&mut state.velocity).zip(&self.start) {
            for axis in 0..D {
                v[axis] = (x[axis] - start[axis]) * per_time;
            }
        }
        // Friction takes from the way what it takes from the velocity.
        model.apply_friction(&self.start, &mut state.velocity);
        for ((x, v), start) in state.position.iter_mut().zip(&state.velocity).zip(&self.start) {
            for axis in 0..D {
                x[axis] = start[axis] + v[axis] * dt;
            }
        }
        model.apply_contact(state);
    }
}
