//! Methods whose work depends on the body step the bodies of a group one after the other, each on its own copy of its lane.

use core::marker::PhantomData;

use crate::mechanics::{Model, Real, State};

use super::Integrator;

/// One method for each lane.
#[derive(Clone, Debug)]
pub struct LaneByLane<I, R, const D: usize> {
    lanes: Vec<(Model<f64, D>, State<f64, D>, I)>,
    group: PhantomData<R>,
}

impl<I: Integrator<f64, D>, R: Real, const D: usize> Integrator<R, D> for LaneByLane<I, R, D> {
    fn new(_: usize) -> Self {
        Self { lanes: Vec::new(), group: PhantomData }
    }

    fn step(&mut self, model: &mut Model<R, D>, state: &mut State<R, D>, time: f64) {
        let particles = state.position.len();
        if self.lanes.is_empty() {
            let lane = |lane| (model.lane(lane), State::new(particles), I::new(particles));
            self.lanes = (0..R::LANES).map(lane).collect();
        }
        for (lane, (own, body, method)) in self.lanes.iter_mut().enumerate() {
            if own.refused != 0.0 {
                continue;
            }
            for i in 0..particles {
                body.position[i] = state.position[i].map(|x| x.lane(lane));
                body.velocity[i] = state.velocity[i].map(|v| v.lane(lane));
            }
            own.begin_step(body);
            method.step(own, body, time);
            for i in 0..particles {
                for axis in 0..D {
                    state.position[i][axis].set_lane(lane, body.position[i][axis]);
                    state.velocity[i][axis].set_lane(lane, body.velocity[i][axis]);
                }
            }
            model.overstretched.set_lane(lane, own.overstretched);
            model.refused.set_lane(lane, own.refused);
            model.evaluations.set_lane(lane, own.evaluations);
        }
    }
}
