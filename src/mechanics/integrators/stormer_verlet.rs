//! Störmer–Verlet, as drift, kick, drift.
//!
//! x½ = x + dt/2·v, v⁺ = v + dt·F(t + dt/2, x½, v)/m, x⁺ = x½ + dt/2·v⁺. The middles obey the project's equation (1.3),
//! x(t+dt) = 2x(t) − x(t−dt) + a(t)·dt², and position and velocity stand on their own between steps. One evaluation a step; order 2, and
//! symplectic, without damping; order 1 with it, because damping sees the velocity of the step before. Stable up to ω·dt = 2(√(1+ζ²) − ζ), 2
//! without damping. Sources: C. Størmer (1907); L. Verlet, Phys. Rev. 159 (1967) 98; "Mass-Spring-Damper model", (1.3).

use crate::mechanics::{Model, Real, State, lattice::KickDrift, stability::StabilityBound};

use super::{About, Integrator, semi_implicit_euler};

pub(super) const ABOUT: About = About {
    name: "StormerVerlet",
    summary: "order 2 (1 with damping), one force evaluation a step; energy stays within bounds",
    order: 2,
    evaluations: Some(1),
};

/// Scratch of the method.
#[derive(Clone, Debug)]
pub struct StormerVerlet<R, const D: usize> {
    /// Positions in the middle of the step.
    middle: Vec<[R; D]>,
    acceleration: Vec<[R; D]>,
}

impl<R: Real, const D: usize> Integrator<R, D> for StormerVerlet<R, D> {
    fn new(particles: usize) -> Self {
        let zeros = vec![[R::splat(0.0); D]; particles];
        Self { middle: zeros.clone(), acceleration: zeros }
    }

    #[inline(always)]
    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let (dt, half) = (R::splat(model.dt), R::splat(0.5 * model.dt));
        for ((middle, x), v) in self.middle.iter_mut().zip(&state.position).zip(&state.velocity) {
            for axis in 0..D {
                middle[axis] = x[axis] + v[axis] * half;
            }
        }
        model.acceleration(time + 0.5 * model.dt, &self.middle, &state.velocity, &mut self.acceleration);
        model.admit_acceleration(&self.middle, &state.velocity, &mut self.acceleration);
        for (v, a) in state.velocity.iter_mut().zip(&self.acceleration) {
            for axis in 0..D {
                v[axis] += a[axis] * dt;
            }
        }
        model.finish_velocity(&self.middle, &mut state.velocity);
        for ((x, middle), v) in state.position.iter_mut().zip(&self.middle).zip(&state.velocity) {
            for axis in 0..D {
                x[axis] = middle[axis] + v[axis] * half;
            }
        }
        model.apply_contact(state);
    }
}

/// The step as a drift, a kick and a drift.
pub(super) fn kick_drift<R: Real, const D: usize>(model: &Model<R, D>) -> KickDrift {
    let rate = model.damping.map_or(0.0, |damping| damping.rate.lane(0));
    KickDrift { dt: model.dt, before: 0.5 * model.dt, after: 0.5 * model.dt, rate, kept: 1.0 }
}

/// In the middles the method is semi-implicit Euler.
pub(super) fn stability_limit(bound: &StabilityBound) -> f64 {
    semi_implicit_euler::limit_with(bound, bound.mass_damping + bound.friction)
}
