//! A step of the model of motion.

use bevy::math::DVec3;

use crate::body::{Bonds, Collisions, Columns, Particles, Pull, Rule, Rules};

use super::{
    bonds, contacts,
    hand::Hand,
    road::{Road, RoadSearch},
    rules::{self, Old},
};

/// Components of one body, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct SixParts<'a> {
    /// Its positions and velocities.
    pub particles: &'a Particles,
    /// Its damping and memory.
    pub columns: &'a Columns,
    /// Its bonds.
    pub bonds: &'a Bonds,
    /// Its collisions.
    pub collisions: &'a Collisions,
    /// What it does of itself.
    pub rules: &'a Rules,
    /// The road that it moves on, if any.
    pub road: Option<&'a Road>,
    /// The hand that pulls at it, if any. The [dense form](super::Dense) knows none.
    pub pull: Option<Pull>,
}

impl SixParts<'_> {
    /// The first thing that is wrong with the components as a whole, if any: they can be put together by hand that were not made for each other.
    pub fn misfit(&self) -> Option<String> {
        let particles = self.particles.len();
        let made =
            |what: &str| Some(format!("its {what} were made for another body; this one has {particles} particles"));
        if self.columns.len() != particles {
            return made("columns");
        }
        if self.bonds.relation().particles() != particles {
            return made("bonds");
        }
        if self.collisions.relation().particles() != particles {
            return made("collisions");
        }
        if !self.rules.fit(particles) {
            return made("rules");
        }
        None
    }

    /// Which of its legs grip, in the order of its rules.
    pub fn grips(&self) -> impl Iterator<Item = (crate::body::ParticleId, bool)> + '_ {
        let memory = self.columns.memory();
        self.rules.iter().filter_map(move |rule| match rule {
            Rule::Leg(leg) => Some((leg.particle, !rules::is_free(leg, memory))),
            _ => None,
        })
    }
}

/// p, v and m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SixState {
    /// Positions.
    pub position: Vec<DVec3>,
    /// Velocities.
    pub velocity: Vec<DVec3>,
    /// Memory.
    pub memory: Vec<DVec3>,
}

impl SixState {
    /// The state of a body.
    pub fn of(body: &SixParts<'_>) -> Self {
        Self {
            position: body.particles.positions().collect(),
            velocity: body.particles.velocities().collect(),
            memory: body.columns.memory().to_vec(),
        }
    }

    /// Writes it to a body of as many particles.
    pub(crate) fn write(&self, particles: &mut Particles, columns: &mut Columns) {
        let (positions, velocities) = particles.state_columns_mut();
        for (rows, columns) in [(&self.position, positions), (&self.velocity, velocities)] {
            for (i, row) in rows.iter().enumerate() {
                for (axis, value) in row.to_array().into_iter().enumerate() {
                    columns[axis][i] = value;
                }
            }
        }
        columns.memory_mut().copy_from_slice(&self.memory);
    }

    /// The mean of the positions.
    pub fn center(&self) -> DVec3 {
        self.position.iter().sum::<DVec3>() / self.position.len().max(1) as f64
    }
}

/// What has burst.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Burst {
    /// The particle that is not finite, or the faster end of the bond.
    pub particle: usize,
    /// The bond that is too long, if it is that.
    pub bond: Option<usize>,
}

/// Takes steps with a body, and holds the scratch for them.
#[derive(Clone, Debug)]
pub struct Stepper {
    now: SixState,
    /// The state before; from step to step they change places.
    next: SixState,
    bond: Vec<DVec3>,
    contact: Vec<DVec3>,
    reaction: Vec<DVec3>,
    touches: Vec<bool>,
}

impl Stepper {
    /// Begins with the present state of a body whose components [fit](SixParts::misfit) each other.
    pub fn new(body: &SixParts<'_>) -> Self {
        let (now, count) = (SixState::of(body), body.particles.len());
        let zeros = vec![DVec3::ZERO; count];
        Self {
            next: now.clone(),
            now,
            bond: zeros.clone(),
            contact: zeros.clone(),
            reaction: zeros,
            touches: vec![false; count],
        }
    }

    /// Moves every particle from where it is.
    #[must_use]
    pub fn moved(mut self, by: impl Fn(usize) -> DVec3) -> Self {
        self.now.position.iter_mut().enumerate().for_each(|(i, x)| *x += by(i));
        self
    }

    /// The state that has been reached.
    pub fn state(&self) -> &SixState {
        &self.now
    }

    /// Which particles touched the road before the last step.
    pub fn touches(&self) -> &[bool] {
        &self.touches
    }

    /// Takes one step of `dt` on the road of the body, from [`state`](Self::state). Where what it leads to has [burst](Burst), the state stays what it was.
    ///
    /// # Errors
    /// If a particle would not be finite, or a bond would be longer than ten times its initial length.
    pub fn step(&mut self, body: &SixParts<'_>, dt: f64) -> Result<(), Burst> {
        self.step_on(body, body.road, dt)
    }

    /// As [`step`](Self::step), with the road searched in another way.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn step_on(&mut self, body: &SixParts<'_>, road: Option<&impl RoadSearch>, dt: f64) -> Result<(), Burst> {
        let Self { now, next, bond, contact, reaction, touches } = self;
        bonds::add(body.bonds, &now.position, bond);
        contacts::add(body.collisions, road, &now.position, contact, touches);
        let old = Old { position: &now.position, velocity: &now.velocity, memory: &now.memory, touches };
        rules::apply(body.rules, &old, road, reaction, &mut next.memory);
        let hand = Hand::of(body, dt);
        let mut finite = true;
        for (i, &damping) in body.columns.damping().iter().enumerate() {
            let mut velocity = damping * now.velocity[i] + bond[i] + contact[i] + reaction[i];
            if let Some(hand) = hand.filter(|hand| hand.particle == i) {
                velocity += hand.pull(now.position[i], velocity);
            }
            let position = now.position[i] + dt * velocity;
            finite &= velocity.is_finite() & position.is_finite();
            (next.velocity[i], next.position[i]) = (velocity, position);
        }
        if !finite || !bonds::are_whole(body.bonds, &next.position) {
            return Err(self.burst(body.bonds));
        }
        core::mem::swap(&mut self.now, &mut self.next);
        Ok(())
    }

    fn burst(&self, all: &Bonds) -> Burst {
        let SixState { position, velocity, .. } = &self.next;
        let finite = |i: usize| position[i].is_finite() && velocity[i].is_finite();
        if let Some(particle) = (0..position.len()).find(|&i| !finite(i)) {
            return Burst { particle, bond: None };
        }
        match bonds::burst(all, position) {
            Some((bond, [a, b])) => {
                let faster = if velocity[b].length_squared() > velocity[a].length_squared() { b } else { a };
                Burst { particle: faster, bond: Some(bond) }
            }
            None => Burst { particle: 0, bond: None },
        }
    }
}
