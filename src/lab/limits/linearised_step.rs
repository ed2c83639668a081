//! A method's step near a pose, linearised by taking it from disturbed poses.

use crate::mechanics::{Advance, BodyParts, Model, State, Timeline, linear::Linear};

/// How large disturbances are, in the shortest rest length: on an axis, where springs are linear, and in space.
const DISTURBANCE: [f64; 2] = [1e-3, 1e-5];

/// The step of `dt` near a body's present pose, without friction, contact and gravity and with its muscles at rest, as a linear map of disturbances:
/// first where each coordinate is, weighted by √m, then how fast, in [`Linear::time`].
#[derive(Debug)]
pub(super) struct LinearisedStep<'a, const D: usize> {
    body: BodyParts<'a>,
    linear: &'a Linear,
    timeline: Timeline,
    model: Model<f64, D>,
    pose: State<f64, D>,
    size: f64,
    time: f64,
}

impl<'a, const D: usize> LinearisedStep<'a, D> {
    pub(super) fn new(body: &BodyParts<'a>, linear: &'a Linear, dt: f64) -> Self {
        let body = body.bare();
        let rest = body.springs.iter().map(|spring| spring.rest_length).fold(f64::INFINITY, f64::min);
        let mut pose = State::new(body.particles.len());
        pose.set_lane(0, body.particles);
        Self {
            model: Model::new(&body, [], dt),
            body,
            linear,
            timeline: Timeline { dt, base_step: 0, base_time: 0.0 },
            pose,
            size: if rest.is_finite() { rest } else { 1.0 } * DISTURBANCE[usize::from(D == 3)],
            time: linear.time(dt),
        }
    }

    /// What a disturbance becomes, by the difference of two steps from either side of the pose. Nothing where the method cannot step the body.
    pub(super) fn take(&mut self, disturbance: &[f64]) -> Option<Vec<f64>> {
        let linear = self.linear;
        let count = linear.coordinates.len();
        let (positions, velocities) = disturbance.split_at(count);
        let moved = linear.coordinates.iter().zip(positions.iter().zip(velocities));
        let largest = moved.map(|(at, (x, v))| at.weight * x.abs().max(v.abs())).fold(0.0, f64::max);
        if largest == 0.0 {
            return Some(disturbance.to_vec());
        }
        let amount = self.size / largest;
        let ahead = self.step_from(positions, velocities, amount)?;
        let behind = self.step_from(positions, velocities, -amount)?;
        let apart = |of: &dyn Fn(&State<f64, D>, usize, usize) -> f64| -> Vec<f64> {
            let coordinates = linear.coordinates.iter();
            let between = coordinates.map(|at| {
                let difference = of(&ahead, at.particle, at.axis) - of(&behind, at.particle, at.axis);
                difference / (2.0 * amount * at.weight)
            });
            between.collect()
        };
        let mut all = apart(&|state, particle, axis| state.position[particle][axis]);
        all.extend(apart(&|state, particle, axis| state.velocity[particle][axis] * self.time));
        Some(all)
    }

    fn step_from(&mut self, positions: &[f64], velocities: &[f64], amount: f64) -> Option<State<f64, D>> {
        let mut state = self.pose.clone();
        for (at, (x, v)) in self.linear.coordinates.iter().zip(positions.iter().zip(velocities)) {
            state.position[at.particle][at.axis] += amount * at.weight * x;
            state.velocity[at.particle][at.axis] += amount * at.weight * v / self.time;
        }
        let Self { model, timeline, body, .. } = self;
        let step = Advance { model, state: &mut state, method: body.method, timeline: *timeline, first: 0, steps: 1 };
        step.run();
        (!self.model.has_refused(0)).then_some(state)
    }
}
