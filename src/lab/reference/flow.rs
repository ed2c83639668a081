//! A body as a system of differential equations that are smooth as long as no mass starts or stops to slide.
//!
//! Per mass of the spine v' = F + R with 0 ≤ R ⟂ S·v ≥ 0. With s = S·v, s' = S·a + S'·v, where S turns with the neighbours on the spine:
//! S' = (1 − SSᵀ)(v_next − v_previous)/|x_next − x_previous|. A mass that is held has s' = 0, so R = −(S·F + S'·v), and it is let go when that would be
//! negative. R acts on its own mass alone and S' depends on velocities alone, so the masses do not ask each other.

use core::cell::RefCell;

use crate::{
    body::{SpineFriction, Springs},
    lab::ProblemBody,
    mechanics::{
        BodyParts, Model,
        integrators::{Method, StickRule},
    },
};

/// What friction does to a mass of the spine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// It slides forward, against drag.
    Forward,
    /// The ratchet holds it.
    Held,
    /// It slides back, which only a spine without a ratchet lets it.
    Back,
}

/// A mass of the spine and its neighbours there; at the ends one of them is the mass itself.
#[derive(Clone, Copy, Debug)]
struct Node {
    particle: usize,
    previous: usize,
    next: usize,
}

/// Rates of friction.
#[derive(Clone, Copy, Debug)]
struct Friction {
    ratchet: bool,
    drag: f64,
    grip: f64,
}

/// A body as a system of differential equations: a state is all positions, then all velocities, `D` coordinates each.
pub(super) struct Flow<'a, const D: usize> {
    springs: &'a Springs,
    model: RefCell<(Model<f64, D>, Vec<[f64; D]>)>,
    particles: usize,
    nodes: Vec<Node>,
    friction: Option<Friction>,
}

/// The system while the modes are what they are, between two kinks of the muscles.
pub(super) struct Piece<'a, const D: usize> {
    pub(super) flow: &'a Flow<'a, D>,
    pub(super) modes: &'a [Mode],
    /// Forces are evaluated at times in between only: where a square wave switches, its value depends on the side.
    pub(super) window: [f64; 2],
}

impl<'a, const D: usize> Flow<'a, D> {
    pub(super) fn new(body: &'a ProblemBody) -> Self {
        let parts = body.parts(Method::default(), StickRule::default());
        // Rates do not depend on the step, and friction is here.
        let model = Model::new(&BodyParts { friction: None, ..parts }, [], 1.0);
        let spine = parts.friction.map_or(&[][..], SpineFriction::spine);
        let node = |i: usize| Node {
            particle: spine[i].index(),
            previous: spine[i.saturating_sub(1)].index(),
            next: spine[(i + 1).min(spine.len() - 1)].index(),
        };
        let particles = parts.particles.len();
        Self {
            springs: parts.springs,
            model: RefCell::new((model, vec![[0.0; D]; particles])),
            particles,
            nodes: (0..spine.len()).map(node).collect(),
            friction: parts.friction.map(|friction| Friction {
                ratchet: friction.ratchet(),
                drag: friction.drag(),
                grip: friction.grip(),
            }),
        }
    }

    /// Whether any mass can start or stop to slide.
    pub(super) fn has_events(&self) -> bool {
        self.friction.is_some_and(|friction| friction.ratchet || friction.drag > 0.0)
    }

    pub(super) fn is_ratchet(&self) -> bool {
        self.friction.is_some_and(|friction| friction.ratchet)
    }

    pub(super) fn particle(&self, node: usize) -> usize {
        self.nodes[node].particle
    }

    fn rows<'y>(&self, y: &'y [f64]) -> (&'y [[f64; D]], &'y [[f64; D]]) {
        let (position, velocity) = y.split_at(self.particles * D);
        (position.as_chunks().0, velocity.as_chunks().0)
    }

    /// S and S' of a mass of the spine.
    fn spine(&self, node: Node, position: &[[f64; D]], velocity: &[[f64; D]]) -> ([f64; D], [f64; D]) {
        let along = minus(position[node.next], position[node.previous]);
        let length = dot(along, along).sqrt();
        if length == 0.0 {
            return ([0.0; D], [0.0; D]);
        }
        let spine = along.map(|value| value / length);
        let turn = if D == 1 {
            [0.0; D]
        } else {
            let apart = minus(velocity[node.next], velocity[node.previous]).map(|value| value / length);
            plus(apart, spine, -dot(spine, apart))
        };
        (spine, turn)
    }

    /// The first spring that has come to no length since `before`, or turned round on its axis: there the forces are not smooth.
    pub(super) fn collapsed(&self, before: &[f64], now: &[f64]) -> Option<usize> {
        let ends = |y| self.rows(y).0;
        let (before, now) = (ends(before), ends(now));
        self.springs.ends().iter().position(|ends| {
            let [a, b] = ends.map(|end| end.index());
            let (then, now) = (minus(before[b], before[a]), minus(now[b], now[a]));
            let collapsed = dot(now, now) == 0.0;
            collapsed || (D == 1 && dot(then, now) < 0.0)
        })
    }

    /// The modes that the masses of the spine are in from the start; what the ratchet does not admit of their velocities is taken away. What is at rest
    /// goes with the push on it, and where that is `nothing`, with what it is a `moment` later.
    pub(super) fn settle(&self, window: [f64; 2], y: &mut [f64], nothing: f64, moment: f64) -> Vec<Mode> {
        let Some(friction) = self.friction else { return Vec::new() };
        let mut modes = vec![Mode::Forward; self.nodes.len()];
        for (i, mode) in modes.iter_mut().enumerate() {
            let sliding = self.sliding(i, y);
            *mode = match (friction.ratchet, sliding > 0.0) {
                (_, true) => Mode::Forward,
                (true, false) => Mode::Held,
                (false, false) => Mode::Back,
            };
            if *mode == Mode::Held {
                self.stop(i, y);
            }
        }
        let held = modes.clone();
        let piece = Piece { flow: self, modes: &held, window };
        let mut derivative = vec![0.0; y.len()];
        piece.derivative(0.0, y, &mut derivative);
        let later: Vec<_> = y.iter().zip(&derivative).map(|(y, slope)| y + moment * slope).collect();
        for (i, mode) in modes.iter_mut().enumerate() {
            if *mode == Mode::Held || (*mode == Mode::Back && self.sliding(i, y) == 0.0) {
                let push = piece.push(i, 0.0, y);
                let push = if push.abs() > nothing { push } else { piece.push(i, moment, &later) };
                if push > 0.0 {
                    *mode = Mode::Forward;
                }
            }
        }
        modes
    }

    /// s = S·v.
    fn sliding(&self, node: usize, y: &[f64]) -> f64 {
        let (position, velocity) = self.rows(y);
        let node = self.nodes[node];
        dot(self.spine(node, position, velocity).0, velocity[node.particle])
    }

    /// Takes from a mass its velocity along the spine.
    pub(super) fn stop(&self, node: usize, y: &mut [f64]) {
        let (position, velocity) = self.rows(y);
        let node = self.nodes[node];
        let (spine, _) = self.spine(node, position, velocity);
        let v = velocity[node.particle];
        let rest = plus(v, spine, -dot(spine, v));
        let at = (self.particles + node.particle) * D;
        y[at..at + D].copy_from_slice(&rest);
    }
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
    fn push(&self, index: usize, time: f64, y: &[f64]) -> f64 {
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

fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}

fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    core::array::from_fn(|axis| a[axis] - b[axis])
}

/// a + factor·b
fn plus<const D: usize>(a: [f64; D], b: [f64; D], factor: f64) -> [f64; D] {
    core::array::from_fn(|axis| a[axis] + factor * b[axis])
}
