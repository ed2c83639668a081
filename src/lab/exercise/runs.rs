//! The runs that the answers are made of.

use std::time::Instant;

use bevy::math::DVec3;
use faer::{Mat, Side};

use super::ExerciseOptions;
use crate::{
    body::{BodyError, Gravity, Ground, MassDamping, Neighbours, Particle, ParticleId},
    creatures::{Body, Creature, JellyPlan, NeighboursPlan, Pose, Rotation, SpringPlan},
    mechanics::{Advance, BodyParts, Model, State, Timeline, integrators::Method, metrics::BlockShape},
};

/// The kinds of blocks that the exercise asks for, with names.
pub(super) const KINDS: [(&str, &[Neighbours]); 4] = [
    ("1", &[Neighbours::Edges]),
    ("1, √2", &[Neighbours::Edges, Neighbours::Faces]),
    ("1, √3", &[Neighbours::Edges, Neighbours::Cubes]),
    ("1, √2, √3", &Neighbours::ALL),
];

/// How blocks start, with names.
pub(super) const ATTITUDES: [(&str, f64, Option<Rotation>); 4] = [
    ("upright", 0.0, None),
    ("tilted by 1°", 1.0, None),
    ("tilted by 20°", 20.0, None),
    ("turned by 50° about (1, 2, 3)", 0.0, Some(TURNED)),
];

/// An attitude in which no spring is along an axis.
pub(super) const TURNED: Rotation = Rotation { axis: (1.0, 2.0, 3.0), angle: 50.0 };

/// The template's gravity, and from how high it drops the block.
pub(super) const GRAVITY: f64 = 0.001;
pub(super) const DROP: f64 = 2.0;

/// A block that is stepped by itself, with k = m = 1.
pub(super) struct Block {
    pub(super) body: Body,
    method: Method,
    dt: f64,
    falls: bool,
    damping: Option<MassDamping>,
    step: u64,
    /// Whether it has exploded.
    pub(super) exploded: bool,
}

/// A cube of `count` masses each way.
pub(super) fn cube(count: u32, kinds: &[Neighbours]) -> JellyPlan {
    JellyPlan {
        size: (count, count, count),
        neighbours: NeighboursPlan::alike(kinds, SpringPlan { stiffness: 1.0, damping: 0.0 }),
        mass: 1.0,
        tilt: 0.0,
        rotation: None,
        drop: 0.0,
    }
}

impl Block {
    pub(super) fn new(plan: JellyPlan, method: Method, dt: f64) -> Result<Self, BodyError> {
        let body = Creature::from(plan).body(Pose::default())?;
        Ok(Self { body, method, dt, falls: false, damping: None, step: 0, exploded: false })
    }

    /// Lets it fall onto the floor.
    pub(super) fn falling(self) -> Self {
        Self { falls: true, ..self }
    }

    /// Damps it in proportion to mass.
    pub(super) fn damped(self, damping: MassDamping) -> Self {
        Self { damping: Some(damping), ..self }
    }

    /// Lets its masses tremble a little, each its own way; its layers as a whole where nothing holds it against shear.
    fn trembling(mut self, speed: f64) -> Result<Self, BodyError> {
        let one_axis = self
            .body
            .block
            .is_some_and(|(lattice, _)| !lattice.joins(Neighbours::Faces) && !lattice.joins(Neighbours::Cubes));
        let ways = if one_axis { DVec3::Y } else { DVec3::ONE };
        for i in 0..self.body.particles.len() as u32 {
            let layer = self.body.particles.position(ParticleId(i)).map_or(0, |place| place.y.round() as u32);
            let seed = if one_axis { layer } else { i };
            let wobble = |prime: u32, modulus: u32| f64::from(seed * prime % modulus) / f64::from(modulus) - 0.5;
            let velocity = DVec3::new(wobble(7, 11), wobble(5, 13), wobble(3, 17)) * ways * speed;
            if let Some(particle) = self.body.particles.get(ParticleId(i)) {
                self.body.particles.set(ParticleId(i), Particle { velocity, ..particle })?;
            }
        }
        Ok(self)
    }

    pub(super) fn parts(&self) -> BodyParts<'_> {
        BodyParts {
            lattice: self.body.block.map(|(lattice, _)| lattice),
            gravity: Gravity::new(GRAVITY).ok().filter(|_| self.falls),
            ground: self.falls.then_some(&Ground::Flat),
            mass_damping: self.damping,
            ..BodyParts::new(&self.body.particles, &self.body.springs, self.method)
        }
    }

    pub(super) fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// Takes so many steps. Gives back how many seconds they took.
    pub(super) fn take(&mut self, steps: u64) -> f64 {
        let parts = self.parts();
        let mut model = Model::<f64, 3>::new(&parts, [], self.dt);
        let mut state = State::new(parts.particles.len());
        state.set_lane(0, parts.particles);
        let timeline = Timeline { dt: self.dt, base_step: 0, base_time: 0.0 };
        let (method, first) = (self.method, self.step);
        let start = Instant::now();
        Advance { model: &mut model, state: &mut state, method, timeline, first, steps }.run();
        let seconds = start.elapsed().as_secs_f64();
        model.note(&state);
        self.exploded |= model.has_exploded(0);
        state.write_lane(0, &mut self.body.particles);
        self.step += steps;
        seconds
    }

    pub(super) fn take_until(&mut self, time: f64) {
        let steps = (time / self.dt).round() as u64;
        self.take(steps.saturating_sub(self.step));
    }

    /// Where a mass is and how fast it falls; nothing where there is no such mass.
    pub(super) fn fall(&self, mass: ParticleId) -> Option<(f64, f64)> {
        self.body.particles.get(mass).map(|particle| (particle.position.y, -particle.velocity.y))
    }

    /// Follows it, and measures it so many times.
    pub(super) fn follow(&mut self, time: f64, samples: u32, measure: impl Fn(&Self) -> f64) -> Vec<(f64, f64)> {
        let mut places = vec![(self.time(), measure(self))];
        let start = self.time();
        for i in 1..=samples {
            self.take_until(start + time * f64::from(i) / f64::from(samples));
            places.push((self.time(), measure(self)));
        }
        places
    }

    pub(super) fn shape(&self) -> Option<BlockShape> {
        self.body.block.and_then(|(lattice, _)| BlockShape::measure(&self.body.particles, lattice))
    }

    pub(super) fn height(&self) -> f64 {
        self.shape().map_or(0.0, |shape| shape.height)
    }

    pub(super) fn center(&self) -> f64 {
        self.body.particles.center().y
    }

    /// Whether a spring is longer than four rest lengths, or of no length that is a number.
    fn bursts(&self) -> bool {
        let place = |id: ParticleId| self.body.particles.position(id).unwrap_or(DVec3::NAN);
        self.exploded
            || self.body.springs.iter().any(|spring| {
                let length = place(spring.ends[0]).distance(place(spring.ends[1]));
                length.is_nan() || length > 4.0 * spring.rest_length
            })
    }
}

/// Whether a free block that trembles stays whole for as many steps, and for 400 units of time if these are 3000.
fn is_stable(
    plan: &JellyPlan,
    method: Method,
    damping: Option<MassDamping>,
    dt: f64,
    trial: u32,
) -> Result<bool, BodyError> {
    let steps = u64::from(trial).max((f64::from(trial) * 400.0 / 3000.0 / dt) as u64);
    let block = Block { damping, ..Block::new(plan.clone(), method, dt)? };
    let mut block = block.trembling(1e-3)?;
    for _ in 0..20 {
        block.take(steps.div_ceil(20));
        if block.bursts() {
            return Ok(false);
        }
    }
    Ok(true)
}

/// A largest stable step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    pub(super) dt: f64,
    /// Whether a step just above it was found unstable; if not, none was, up to this one.
    pub(super) found: bool,
}

impl Limit {
    /// It as text.
    pub(super) fn text(self, digits: usize) -> String {
        format!("{}{:.digits$}", if self.found { "" } else { "> " }, self.dt)
    }
}

/// The largest stable step, by halving an interval, which is widened until its ends are a stable and an unstable step.
pub(super) fn largest_step(
    plan: &JellyPlan,
    method: Method,
    damping: Option<MassDamping>,
    [mut low, mut high]: [f64; 2],
    options: &ExerciseOptions,
) -> Result<Limit, BodyError> {
    /// No further than this times the interval's end.
    const WIDEST: f64 = 4.0;
    const WIDER: f64 = 1.25;
    let stable = |dt: f64| is_stable(plan, method, damping, dt, options.trial);
    let most = WIDEST * high;
    while stable(high)? {
        if high > most {
            return Ok(Limit { dt: high, found: false });
        }
        (low, high) = (high, WIDER * high);
    }
    // A step of 0 is stable.
    while low > 0.0 && !stable(low)? {
        (low, high) = (low / WIDER, low);
    }
    for _ in 0..options.halvings {
        let middle = 0.5 * (low + high);
        if stable(middle)? { low = middle } else { high = middle }
    }
    Ok(Limit { dt: low, found: true })
}

/// The eigenvalues of the stiffness of a block at rest with k = m = 1, in rising order; none where they cannot be found.
pub(super) fn spectrum(body: &Body) -> Vec<f64> {
    stiffness(body).self_adjoint_eigenvalues(Side::Lower).unwrap_or_default()
}

/// Below this, an eigenvalue of the stiffness is none.
pub(super) const NO_STIFFNESS: f64 = 1e-10;

/// The motions that no spring of a block at rest resists, each a vector of length 1 across the others: those of a rigid body, and mechanisms.
pub(super) fn free_motions(body: &Body) -> Vec<Vec<f64>> {
    let Ok(found) = stiffness(body).self_adjoint_eigen(Side::Lower) else { return Vec::new() };
    let values = found.S().column_vector();
    let free = (0..values.nrows()).filter(|&i| values[i].abs() < NO_STIFFNESS);
    free.map(|i| found.U().col(i).iter().copied().collect()).collect()
}

/// What of a vector is along others, which are of length 1 and across each other.
pub(super) fn along(vector: &[f64], others: &[Vec<f64>]) -> Vec<f64> {
    let mut sum = vec![0.0; vector.len()];
    for other in others {
        let part: f64 = vector.iter().zip(other).map(|(a, b)| a * b).sum();
        sum.iter_mut().zip(other).for_each(|(sum, value)| *sum += part * value);
    }
    sum
}

/// The stiffness matrix of a block at rest.
fn stiffness(body: &Body) -> Mat<f64> {
    let count = 3 * body.particles.len();
    let mut matrix = Mat::<f64>::zeros(count, count);
    for spring in body.springs.iter() {
        let [Some(from), Some(to)] = spring.ends.map(|end| body.particles.position(end)) else { continue };
        let along = (to - from).normalize().to_array();
        for (p, a) in spring.ends.into_iter().enumerate() {
            for (q, b) in spring.ends.into_iter().enumerate() {
                let sign = if p == q { 1.0 } else { -1.0 };
                for i in 0..3 {
                    for j in 0..3 {
                        matrix[(3 * a.index() + i, 3 * b.index() + j)] += sign * spring.stiffness * along[i] * along[j];
                    }
                }
            }
        }
    }
    matrix
}
