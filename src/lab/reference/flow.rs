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

use super::piece::Piece;

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
pub(super) struct Node {
    pub(super) particle: usize,
    previous: usize,
    next: usize,
}

/// Rates of friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Friction {
    ratchet: bool,
    pub(super) drag: f64,
    pub(super) grip: f64,
}

/// A body as a system of differential equations: a state is all positions, then all velocities, `D` coordinates each.
pub(super) struct Flow<'a, const D: usize> {
    pub(super) springs: &'a Springs,
    pub(super) model: RefCell<(Model<f64, D>, Vec<[f64; D]>)>,
    pub(super) particles: usize,
    pub(super) nodes: Vec<Node>,
    pub(super) friction: Option<Friction>,
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

    pub(super) fn rows<'y>(&self, y: &'y [f64]) -> (&'y [[f64; D]], &'y [[f64; D]]) {
        let (position, velocity) = y.split_at(self.particles * D);
        (position.as_chunks().0, velocity.as_chunks().0)
    }

    /// S and S' of a mass of the spine.
    pub(super) fn spine(&self, node: Node, position: &[[f64; D]], velocity: &[[f64; D]]) -> ([f64; D], [f64; D]) {
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
    pub(super) fn sliding(&self, node: usize, y: &[f64]) -> f64 {
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

pub(super) fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}

pub(super) fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    core::array::from_fn(|axis| a[axis] - b[axis])
}

/// a + factor·b
pub(super) fn plus<const D: usize>(a: [f64; D], b: [f64; D], factor: f64) -> [f64; D] {
    core::array::from_fn(|axis| a[axis] + factor * b[axis])
}
