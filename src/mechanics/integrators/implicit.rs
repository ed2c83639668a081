//! What implicit methods share: the velocity u with which a step ends, from one system of equations.
//!
//! M(u − v) = dt·F(t*, x*, v*) + R with x* = x₀ + a·dt·u and v* = v₀ + b·u; a method is its numbers. Newton's iteration solves it with the
//! Jacobian M + dt·(b·C + a·dt·K), where K leaves out the negative stiffness that a compressed spring has across its line, so that the
//! matrix is positive definite. The reactions R hold masses that the ratchet does not let slide back: 0 ≤ R ⟂ S·w ≥ 0 with w = u, or with the mean of
//! v and u, against which R does no work; an active set finds them.
//! Small bodies are solved by a sparse Cholesky factorisation whose pattern is analysed once, large ones by conjugate gradients.

mod linear;

use crate::mechanics::{
    Model, State,
    forces::direction,
    friction::{Frame, dot, subtract},
};

use linear::Linear;

/// Newton's iteration is given up after so many rounds.
const MOST_ROUNDS: usize = 60;
/// A residual this much smaller than what it is the difference of is rounding.
const TOLERANCE: f64 = 1e-13;
/// How much of a residual conjugate gradients leave where Newton's iteration takes the rest in its next round.
const LEFT: f64 = 1e-5;

/// Where a method evaluates the forces.
pub(super) struct Scheme {
    /// When, in steps.
    pub(super) at: f64,
    /// b: how much of u, the rest being v.
    pub(super) velocity: f64,
    /// How much of u is in the velocity w that the ratchet admits, the rest being v.
    pub(super) admitted: f64,
    /// How much of dt·v is in x*.
    pub(super) position_old: f64,
    /// a: how much of dt·u is in x*.
    pub(super) position_new: f64,
}

/// Scratch of the solution.
#[derive(Clone, Debug)]
pub(super) struct Implicit<const D: usize> {
    /// u, the velocity at the end of the step.
    velocity: Vec<[f64; D]>,
    stage: State<f64, D>,
    acceleration: Vec<[f64; D]>,
    /// M(u − v) − dt·F: the reactions, once solved.
    residual: Vec<[f64; D]>,
    /// The residual at u = v.
    base: Vec<[f64; D]>,
    change: Vec<[f64; D]>,
    image: Vec<[f64; D]>,
    /// Directions in which friction acts; as many as the spine has masses.
    frames: Vec<Frame<f64, D>>,
    stuck: Vec<bool>,
    /// The least S·u that the ratchet admits, of each mass of the spine.
    floor: Vec<f64>,
    linear: Option<Linear<D>>,
}

/// The iteration did not converge.
struct Diverged;

impl<const D: usize> Implicit<D> {
    pub(super) fn new(particles: usize) -> Self {
        let zeros = vec![[0.0; D]; particles];
        Self {
            velocity: zeros.clone(),
            stage: State::new(particles),
            acceleration: zeros.clone(),
            residual: zeros.clone(),
            base: zeros.clone(),
            change: zeros.clone(),
            image: zeros,
            frames: Vec::new(),
            stuck: Vec::new(),
            floor: Vec::new(),
            linear: None,
        }
    }

    /// Takes a step: u, then x⁺ = x + dt·((1 − b)v + b·u). What friction then takes from u is part of the way where R acts on u itself.
    pub(super) fn step(&mut self, scheme: &Scheme, model: &mut Model<f64, D>, state: &mut State<f64, D>, time: f64) {
        if self.solve(scheme, model, state, time).is_err() {
            model.refused = 1.0;
            return;
        }
        self.change.copy_from_slice(&self.velocity);
        model.finish_velocity(&state.position, &mut self.velocity);
        let ratchet_alone = model.stick.asks_in_stages() && model.coulomb.is_none();
        let way = if scheme.admitted < 1.0 && ratchet_alone { &self.change } else { &self.velocity };
        for ((x, v), u) in state.position.iter_mut().zip(&state.velocity).zip(way) {
            for axis in 0..D {
                x[axis] += model.dt * (v[axis] + scheme.velocity * (u[axis] - v[axis]));
            }
        }
        state.velocity.copy_from_slice(&self.velocity);
        model.apply_contact(state);
        model.note_lengths(state);
    }

    /// Solves for the velocity at the end of a step.
    fn solve(
        &mut self,
        scheme: &Scheme,
        model: &mut Model<f64, D>,
        state: &State<f64, D>,
        time: f64,
    ) -> Result<(), Diverged> {
        // What is evaluated on the way is no state of the body.
        let overstretched = model.overstretched;
        let solved = self.active_set(scheme, model, state, time);
        model.overstretched = overstretched;
        solved
    }

    fn active_set(
        &mut self,
        scheme: &Scheme,
        model: &mut Model<f64, D>,
        state: &State<f64, D>,
        time: f64,
    ) -> Result<(), Diverged> {
        self.begin(scheme, model, state);
        let ratchet = model.friction.is_some_and(|friction| friction.ratchet);
        self.velocity.copy_from_slice(&state.velocity);
        let scale = self.evaluate(scheme, model, state, time);
        self.base.copy_from_slice(&self.residual);
        for _ in 0..2 * self.frames.len() + 10 {
            self.newton(scheme, model, state, time, scale)?;
            let mut changed = false;
            for (i, (row, frame)) in model.spine.iter().zip(&self.frames).enumerate() {
                let mass = row.particle as usize;
                if !ratchet || frame.touches == 0.0 || model.inverse_mass[mass] == 0.0 {
                    continue;
                }
                let slack = 10.0 * TOLERANCE * scale;
                let wrong = if self.stuck[i] {
                    dot(self.residual[mass], frame.spine) * model.inverse_mass[mass] < -slack
                } else {
                    dot(self.velocity[mass], frame.spine) < self.floor[i] - slack
                };
                if wrong {
                    self.stuck[i] = !self.stuck[i];
                    changed = true;
                }
            }
            if !changed {
                return Ok(());
            }
        }
        // Rounding may leave a mass undecided; what is left is as small as that, and the ratchet takes it.
        Ok(())
    }

    /// Friction's directions in the middle of the step, and the masses that are taken to rest on because they rest now.
    fn begin(&mut self, scheme: &Scheme, model: &Model<f64, D>, state: &State<f64, D>) {
        self.frames.clear();
        self.stuck.clear();
        self.floor.clear();
        let (Some(friction), true) = (model.friction, model.stick.asks_in_stages()) else { return };
        for (middle, (x, v)) in self.stage.position.iter_mut().zip(state.position.iter().zip(&state.velocity)) {
            *middle = core::array::from_fn(|axis| x[axis] + 0.5 * model.dt * v[axis]);
        }
        self.frames.extend(model.spine.iter().map(|&row| model.frame(row, &self.stage.position)));
        self.floor.extend(model.spine.iter().zip(&self.frames).map(|(row, frame)| {
            (1.0 - 1.0 / scheme.admitted) * dot(state.velocity[row.particle as usize], frame.spine)
        }));
        self.stuck.extend(model.spine.iter().zip(&self.frames).map(|(row, frame)| {
            let speed = dot(state.velocity[row.particle as usize], frame.spine);
            friction.ratchet && frame.touches != 0.0 && speed <= 0.0
        }));
    }

    /// Newton's iteration with the present set of stuck masses.
    fn newton(
        &mut self,
        scheme: &Scheme,
        model: &mut Model<f64, D>,
        state: &State<f64, D>,
        time: f64,
        scale: f64,
    ) -> Result<(), Diverged> {
        // On an axis, and with positions that do not depend on u, the equations are linear; the first evaluation says everything.
        let affine = D == 1 || scheme.position_new == 0.0;
        self.linear.get_or_insert_with(|| Linear::new(model));
        self.velocity.copy_from_slice(&state.velocity);
        for (i, row) in model.spine.iter().enumerate().filter(|(i, _)| self.stuck.get(*i) == Some(&true)) {
            let (u, along) = (&mut self.velocity[row.particle as usize], self.frames[i].spine);
            subtract(u, along, dot(*u, along) - self.floor[i]);
        }
        let left = if affine { TOLERANCE } else { LEFT };
        let mut last = f64::INFINITY;
        for round in 0..MOST_ROUNDS {
            if round == 0 {
                self.place(scheme, model, state, Stage::Start);
                self.assemble(scheme, model);
                for ((change, u), v) in self.change.iter_mut().zip(&self.velocity).zip(&state.velocity) {
                    *change = core::array::from_fn(|axis| u[axis] - v[axis]);
                }
                self.residual.copy_from_slice(&self.base);
                self.add_image(model);
            } else if affine && round == 1 && self.same_sides(scheme, model, state) {
                return Ok(());
            } else {
                self.evaluate(scheme, model, state, time);
            }
            for (change, residual) in self.change.iter_mut().zip(&self.residual) {
                *change = residual.map(|r| -r);
            }
            project(model, &self.frames, &self.stuck, &mut self.change);
            let size = largest(model, &self.change);
            if !size.is_finite() {
                return Err(Diverged);
            }
            // Converged, or as near as rounding lets it come.
            let near = round > 3 && size >= 0.5 * last && size <= 1e3 * TOLERANCE * scale;
            if round > 0 && (size <= TOLERANCE * scale || near) {
                return Ok(());
            }
            last = size;
            if round > 0 {
                self.assemble(scheme, model);
            }
            let Some(linear) = &mut self.linear else { return Err(Diverged) };
            linear.solve(model, &self.frames, &self.stuck, &mut self.change, left)?;
            for (u, change) in self.velocity.iter_mut().zip(&self.change) {
                for axis in 0..D {
                    u[axis] += change[axis];
                }
            }
            self.add_image(model);
        }
        Err(Diverged)
    }

    fn assemble(&mut self, scheme: &Scheme, model: &Model<f64, D>) {
        if let Some(linear) = &mut self.linear {
            linear.assemble(scheme, model, &self.stage, &self.frames, &self.stuck);
        }
    }

    /// residual += matrix · change
    fn add_image(&mut self, model: &Model<f64, D>) {
        let Some(linear) = &self.linear else { return };
        linear.image(model, &self.change, &mut self.image);
        for (residual, image) in self.residual.iter_mut().zip(&self.image) {
            for axis in 0..D {
                residual[axis] += image[axis];
            }
        }
    }

    /// Puts the stage where the forces are evaluated, with the velocity of the start or with u.
    fn place(&mut self, scheme: &Scheme, model: &Model<f64, D>, state: &State<f64, D>, stage: Stage) {
        for (mass, &v) in state.velocity.iter().enumerate() {
            let u = match stage {
                Stage::Start => v,
                Stage::Now => self.velocity[mass],
            };
            for axis in 0..D {
                let moved = scheme.position_old * v[axis] + scheme.position_new * u[axis];
                self.stage.position[mass][axis] = state.position[mass][axis] + model.dt * moved;
                self.stage.velocity[mass][axis] = v[axis] + scheme.velocity * (u[axis] - v[axis]);
            }
        }
    }

    /// Whether every spring still points to the side to which it pointed when the matrix was set up.
    fn same_sides(&mut self, scheme: &Scheme, model: &Model<f64, D>, state: &State<f64, D>) -> bool {
        let sides = |stage: &State<f64, D>| -> Vec<bool> {
            let ends = model.springs.iter().map(|spring| spring.ends.map(|end| stage.position[end as usize][0]));
            ends.map(|[a, b]| a < b).collect()
        };
        let before = if D == 1 { sides(&self.stage) } else { Vec::new() };
        self.place(scheme, model, state, Stage::Now);
        D > 1 || before == sides(&self.stage)
    }

    /// M(u − v) − dt·F into the residual. Returns the scale of the velocities that it is a difference of.
    fn evaluate(&mut self, scheme: &Scheme, model: &mut Model<f64, D>, state: &State<f64, D>, time: f64) -> f64 {
        let dt = model.dt;
        self.place(scheme, model, state, Stage::Now);
        model.acceleration(time + scheme.at * dt, &self.stage.position, &self.stage.velocity, &mut self.acceleration);
        brake(model, &self.frames, &self.stage, &mut self.acceleration);
        let mut scale = f64::MIN_POSITIVE;
        for spring in &model.springs {
            let [a, b] = spring.ends.map(|end| end as usize);
            let lightest = model.inverse_mass[a].max(model.inverse_mass[b]);
            let length = direction(self.stage.position[a], self.stage.position[b]).0;
            let speed = largest_of(&self.stage.velocity[a]) + largest_of(&self.stage.velocity[b]);
            let force = spring.stiffness * (spring.rest_length + length) + spring.damping * speed;
            scale = scale.max(force * lightest * dt);
        }
        for (mass, (u, v)) in self.velocity.iter().zip(&state.velocity).enumerate() {
            let inverse_mass = model.inverse_mass[mass];
            scale = scale.max(largest_of(u)).max(largest_of(v));
            self.residual[mass] = core::array::from_fn(|axis| {
                let off = u[axis] - v[axis] - dt * self.acceleration[mass][axis];
                if inverse_mass > 0.0 { off / inverse_mass } else { 0.0 }
            });
        }
        scale
    }
}

/// With which velocity a stage is set up.
#[derive(Clone, Copy)]
enum Stage {
    Start,
    Now,
}

/// Adds drag, grip and isotropic friction to accelerations.
fn brake<const D: usize>(
    model: &Model<f64, D>,
    frames: &[Frame<f64, D>],
    stage: &State<f64, D>,
    acceleration: &mut [[f64; D]],
) {
    let Some(friction) = model.friction else { return };
    for (row, frame) in model.spine.iter().zip(frames) {
        let mass = row.particle as usize;
        let v = stage.velocity[mass];
        let sliding = dot(v, frame.forward).max(0.0);
        subtract(&mut acceleration[mass], frame.forward, sliding * friction.drag * frame.touches);
        let across = dot(v, frame.side) * model.grip_at(&friction, stage.position[mass]).rate;
        subtract(&mut acceleration[mass], frame.side, across * frame.touches);
        if friction.has_isotropic {
            let sliding = model.sliding(frame, v);
            subtract(&mut acceleration[mass], sliding, friction.isotropic.rate * frame.touches);
        }
    }
}

/// The masses that are stuck, with the directions of their friction.
fn stuck_masses<'a, const D: usize>(
    model: &'a Model<f64, D>,
    frames: &'a [Frame<f64, D>],
    stuck: &'a [bool],
) -> impl Iterator<Item = (usize, &'a Frame<f64, D>)> {
    let rows = model.spine.iter().zip(frames).zip(stuck);
    rows.filter(|(_, stuck)| **stuck).map(|((row, frame), _)| (row.particle as usize, frame))
}

/// Takes from a vector what stuck and pinned masses cannot follow.
fn project<const D: usize>(model: &Model<f64, D>, frames: &[Frame<f64, D>], stuck: &[bool], vector: &mut [[f64; D]]) {
    for (mass, frame) in stuck_masses(model, frames, stuck) {
        let v = &mut vector[mass];
        subtract(v, frame.spine, dot(*v, frame.spine));
    }
    for (v, &inverse_mass) in vector.iter_mut().zip(&model.inverse_mass) {
        if inverse_mass == 0.0 {
            *v = [0.0; D];
        }
    }
}

/// The largest velocity that a vector of impulses gives.
fn largest<const D: usize>(model: &Model<f64, D>, impulses: &[[f64; D]]) -> f64 {
    let each =
        impulses.iter().zip(&model.inverse_mass).flat_map(|(row, inverse_mass)| row.map(|p| (p * inverse_mass).abs()));
    // `f64::max` would lose a NaN.
    each.fold(0.0, |most, value| if value > most || value.is_nan() { value } else { most })
}

fn largest_of<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().fold(0.0, |most, value| value.abs().max(most))
}
