//! Forces: driven springs and gravity.

use crate::body::{LEAST_REST_FRACTION, Muscles, SpringId, Springs, Wave};

use super::{
    BodyParts, Model, Real, State,
    model::MuscleRow,
    wave::{sin_cycles, square_cycles},
};

/// How much a muscle drives its spring at `time`: ρ·amplitude·wave(cycles − phase).
#[inline(always)]
fn drive<R: Real>(muscle: &MuscleRow<R>, time: f64) -> R {
    let cycles = muscle.epoch_cycles + (R::splat(time) - muscle.epoch_time) * muscle.frequency;
    let ramp = cycles.if_below(muscle.ramp, cycles * muscle.ramp_rate, R::splat(1.0));
    let at = cycles - muscle.phase;
    let wave = match muscle.wave {
        Wave::Sine => sin_cycles(at),
        Wave::Square => square_cycles(at),
    };
    ramp * muscle.amplitude * wave
}

/// A rest length L driven by `drive`: L(1 + drive), and no less than [`LEAST_REST_FRACTION`] of L.
#[inline(always)]
fn driven<R: Real>(rest_length: R, drive: R) -> R {
    let least = R::splat(LEAST_REST_FRACTION);
    let factor = R::splat(1.0) + drive;
    rest_length * factor.if_below(least, least, factor)
}

impl<R: Real, const D: usize> Model<R, D> {
    /// Drives all rest lengths to `time`. Those of a strand also depend on where it is.
    #[inline(always)]
    pub(super) fn drive_muscles(&mut self, time: f64, position: &[[R; D]]) {
        if self.strand.is_some() {
            self.drive_strand(time, position);
        } else {
            for (rest, spring) in self.rest.iter_mut().zip(&self.springs) {
                *rest = spring.rest_length;
            }
        }
        for muscle in &self.muscles {
            let rest = &mut self.rest[muscle.spring as usize];
            *rest = driven(*rest, drive(muscle, time));
        }
    }

    /// Acceleration of every particle at `time`: [`forces`](Self::forces), and damping in proportion to mass.
    #[inline(always)]
    pub fn acceleration(&mut self, time: f64, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        self.forces(time, position, velocity, acceleration);
        let Some(damping) = self.damping else { return };
        let zero = R::splat(0.0);
        for ((row, v), &inverse_mass) in acceleration.iter_mut().zip(velocity).zip(&self.inverse_mass) {
            let rate = zero.if_below(inverse_mass, damping.rate, zero);
            for axis in 0..D {
                row[axis] -= rate * v[axis];
            }
        }
    }

    /// What springs and gravity accelerate every particle with at `time`: springs f = k(L − l) − D·dl/dt along the line of their ends, rest lengths driven to that
    /// time, and gravity. A spring of no length has no direction and pulls nowhere.
    #[inline(always)]
    pub fn forces(&mut self, time: f64, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        self.own_forces(time, position, velocity, acceleration);
        if let Some((particle, pull)) = self.pull(position, velocity) {
            for (a, pull) in acceleration[particle].iter_mut().zip(pull) {
                *a += pull;
            }
        }
    }

    /// The same without the pull of a hand.
    #[inline(always)]
    fn own_forces(&mut self, time: f64, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let zero = R::splat(0.0);
        self.evaluations += R::splat(1.0);
        if self.lattice.is_some() {
            self.lattice_forces(position, velocity, acceleration);
            return;
        }
        self.drive_muscles(time, position);
        if self.strand.is_some() {
            self.strand_forces(position, velocity, acceleration);
            return;
        }
        for row in acceleration.iter_mut() {
            *row = [zero; D];
        }
        for (spring, &rest) in self.springs.iter().zip(&self.rest) {
            let [a, b] = [spring.ends[0] as usize, spring.ends[1] as usize];
            let (length, along) = direction(position[a], position[b]);
            self.overstretched = length.if_below(spring.longest, self.overstretched, R::splat(1.0));
            let mut speed = zero;
            for axis in 0..D {
                speed += (velocity[b][axis] - velocity[a][axis]) * along[axis];
            }
            let force = spring.stiffness * (rest - length) - spring.damping * speed;
            for axis in 0..D {
                let force = force * along[axis];
                acceleration[a][axis] -= force * self.inverse_mass[a];
                acceleration[b][axis] += force * self.inverse_mass[b];
            }
        }
        if let (Some(gravity), true) = (self.gravity, D == 3) {
            for (row, &inverse_mass) in acceleration.iter_mut().zip(&self.inverse_mass) {
                row[1] -= zero.if_below(inverse_mass, gravity, zero);
            }
        }
    }
}

/// The distance from `from` to `to` and the unit vector that points there; no vector where there is no distance.
#[inline(always)]
pub(super) fn direction<R: Real, const D: usize>(from: [R; D], to: [R; D]) -> (R, [R; D]) {
    let zero = R::splat(0.0);
    let mut difference = [zero; D];
    for axis in 0..D {
        difference[axis] = to[axis] - from[axis];
    }
    if D == 1 {
        // On an axis the direction is a sign, exactly.
        let d = difference[0];
        let one = R::splat(1.0);
        return (d.abs(), [d.if_below(zero, -one, zero.if_below(d, one, zero)); D]);
    }
    let mut square = zero;
    for d in difference {
        square += d * d;
    }
    let length = square.sqrt();
    let inverse = zero.if_below(length, R::splat(1.0) / length, zero);
    (length, difference.map(|d| d * inverse))
}

/// The rest length of a spring at `time`, as its muscle drives it; without a muscle, its own. Zero where there is no such spring.
pub fn rest_length(springs: &Springs, muscles: Option<&Muscles>, spring: SpringId, time: f64) -> f64 {
    let rest = springs.get(spring).map_or(0.0, |spring| spring.rest_length);
    muscles
        .into_iter()
        .flat_map(|muscles| muscles.iter().zip(muscles.epochs()))
        .find(|(muscle, _)| muscle.spring == spring)
        .map_or(rest, |(muscle, &epoch)| driven(rest, drive(&MuscleRow::of(muscle, epoch), time)))
}

/// The rest lengths of all springs of a body at `time`, as its muscles and waves drive them where it is.
pub fn rest_lengths(body: &BodyParts<'_>, time: f64) -> Vec<f64> {
    if body.muscles.is_none() && body.strand.is_none() {
        return body.springs.iter().map(|spring| spring.rest_length).collect();
    }
    // Rest lengths do not depend on the step.
    let mut model = Model::<f64, 3>::new(body, [], 1.0);
    let mut state = State::new(body.particles.len());
    state.set_lane(0, body.particles);
    model.drive_muscles(time, &state.position);
    model.rest
}
