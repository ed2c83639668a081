//! The system of differential equations between two events.

use super::flow::{Flow, Mode, dot, plus};

/// The system while the modes are what they are, between two kinks of the muscles.
pub(super) struct Piece<'a, const D: usize> {
    pub(super) flow: &'a Flow<'a, D>,
    pub(super) modes: &'a [Mode],
    /// Forces are evaluated at times in between only: where a square wave switches, its value depends on the side.
    pub(super) window: [f64; 2],
}

impl<const D: usize> Piece<'_, D> {
    /// The derivative of the state.
    pub(super) fn derivative(&self, time: f64, y: &[f64], derivative: &mut [f64]) {
        let flow = self.flow;
        let (position, velocity) = flow.rows(y);
        let (first, second) = derivative.split_at_mut(flow.particles * D);
        first.copy_from_slice(velocity.as_flattened());
        let (model, acceleration) = &mut *flow.model.borrow_mut();
        model.acceleration(time.clamp(self.window[0], self.window[1]), position, velocity, acceleration);
        second.copy_from_slice(acceleration.as_flattened());
        let acceleration = second.as_chunks_mut::<D>().0;
        for (i, &node) in flow.nodes.iter().enumerate() {
            let held = self.modes[i] == Mode::Held;
            let push = self.resist(i, position, velocity, &mut acceleration[node.particle]);
            if held {
                let (spine, _) = flow.spine(node, position, velocity);
                acceleration[node.particle] = plus(acceleration[node.particle], spine, -push);
            }
        }
    }

    /// Adds drag and grip to the acceleration of a mass, and gives what s' is then.
    fn resist(&self, index: usize, position: &[[f64; D]], velocity: &[[f64; D]], acceleration: &mut [f64; D]) -> f64 {
        let (flow, node) = (self.flow, self.flow.nodes[index]);
        let (spine, turn) = flow.spine(node, position, velocity);
        let v = velocity[node.particle];
        if let Some(friction) = flow.friction {
            if self.modes[index] == Mode::Forward {
                *acceleration = plus(*acceleration, spine, -friction.drag * dot(spine, v));
            }
            if D == 3 {
                let mut side = [0.0; D];
                (side[0], side[2]) = (spine[2], -spine[0]);
                let length = dot(side, side).sqrt();
                if length > 0.0 {
                    let side = side.map(|value| value / length);
                    *acceleration = plus(*acceleration, side, -friction.grip * dot(side, v));
                }
            }
        }
        dot(spine, *acceleration) + dot(turn, v)
    }

    /// What s' of a mass is, or would be if nothing held it.
    pub(super) fn push(&self, index: usize, time: f64, y: &[f64]) -> f64 {
        let flow = self.flow;
        let (position, velocity) = flow.rows(y);
        let (model, acceleration) = &mut *flow.model.borrow_mut();
        model.acceleration(time.clamp(self.window[0], self.window[1]), position, velocity, acceleration);
        let mut row = acceleration[flow.nodes[index].particle];
        self.resist(index, position, velocity, &mut row)
    }

    /// For every mass of the spine, how far it is from changing its mode; below zero where it must.
    pub(super) fn gaps(&self, time: f64, y: &[f64], gaps: &mut Vec<f64>) {
        let flow = self.flow;
        let (position, velocity) = flow.rows(y);
        let (model, acceleration) = &mut *flow.model.borrow_mut();
        model.acceleration(time.clamp(self.window[0], self.window[1]), position, velocity, acceleration);
        gaps.clear();
        gaps.extend(flow.nodes.iter().enumerate().map(|(i, &node)| match self.modes[i] {
            Mode::Held => {
                let mut row = acceleration[node.particle];
                -self.resist(i, position, velocity, &mut row)
            }
            Mode::Forward => flow.sliding(i, y),
            Mode::Back => -flow.sliding(i, y),
        }));
    }
}
