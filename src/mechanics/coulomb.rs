//! Coulomb friction with exact stick.
//!
//! In a step of dt a sliding mass loses at most μN·dt of its speed and stops exactly at zero: the velocity with which it would go on, u, is replaced by the v
//! that solves v = u − dt·N·(μ_s v_s, μ_q v_q)/|v|, and by 0 where u is within the cone. That is Moreau's time stepping (J. J. Moreau, CISM
//! Courses 302 (1988) 1), closed form along a line. Methods in stages take the same friction as a force: where a mass slides, against it;
//! where it rests, the pull within the cone is held and the rest accelerates it. What friction has brought to a stop within a step stays at rest until its
//! end, so that no stage makes friction push a mass backwards.

use crate::body::{CoulombFriction, ParticleId};

use super::{
    BodyParts, Model, Real,
    forces::direction,
    friction::{Frame, dot, subtract},
    model::SpineRow,
};

/// One particle with the decelerations μN that friction gives it.
#[derive(Clone, Copy, Debug)]
struct CoulombRow<R> {
    at: SpineRow,
    forward: R,
    backward: R,
    sideways: R,
}

/// How a particle slid when the step began.
#[derive(Clone, Copy, Debug)]
struct Begun<R> {
    /// Its sliding velocity, forward and across.
    sliding: [R; 2],
    /// 1 once a stage has found it at rest since, else 0.
    stopped: R,
}

/// Coulomb friction as steps work on it.
#[derive(Clone, Debug)]
pub(super) struct Coulomb<R, const D: usize> {
    rows: Vec<CoulombRow<R>>,
    /// How each row began the step.
    begun: Vec<Begun<R>>,
    /// Whether no stage of the present step has asked yet.
    fresh: bool,
}

impl<R: Real, const D: usize> Coulomb<R, D> {
    /// The rows of `friction` without numbers, for a body of as many particles.
    pub(super) fn idle(friction: &CoulombFriction, particles: usize) -> Self {
        let zero = R::splat(0.0);
        let row = |at| CoulombRow { at, forward: zero, backward: zero, sideways: zero };
        let rows: Vec<_> = match friction.spine() {
            [] => {
                let alone = |i| row(SpineRow { particle: i, previous: i, next: i });
                (0..particles as u32).map(alone).collect()
            }
            spine => SpineRow::along(spine).map(row).collect(),
        };
        let begun = Begun { sliding: [zero; 2], stopped: zero };
        Self { begun: vec![begun; rows.len()], rows, fresh: true }
    }

    /// The friction of the body in one lane.
    pub(super) fn lane(&self, lane: usize) -> Coulomb<f64, D> {
        let row = |row: &CoulombRow<R>| CoulombRow {
            at: row.at,
            forward: row.forward.lane(lane),
            backward: row.backward.lane(lane),
            sideways: row.sideways.lane(lane),
        };
        let begun = |begun: &Begun<R>| Begun {
            sliding: begun.sliding.map(|value| value.lane(lane)),
            stopped: begun.stopped.lane(lane),
        };
        Coulomb {
            rows: self.rows.iter().map(row).collect(),
            begun: self.begun.iter().map(begun).collect(),
            fresh: self.fresh,
        }
    }

    /// Puts the numbers of `body` into a lane.
    pub(super) fn set_lane(&mut self, lane: usize, body: &BodyParts<'_>) {
        let Some(friction) = body.coulomb else { return };
        let gravity = body.gravity.map_or(CoulombFriction::STANDARD_LOAD, |gravity| gravity.acceleration());
        let load = friction.load().unwrap_or(gravity);
        for row in &mut self.rows {
            let coefficients = friction.coefficients(ParticleId(row.at.particle));
            row.forward.set_lane(lane, load * coefficients.forward);
            row.backward.set_lane(lane, load * coefficients.backward);
            row.sideways.set_lane(lane, load * coefficients.sideways);
        }
    }
}

impl<R: Real> CoulombRow<R> {
    /// What friction can take of a speed in `time`, along `u` and across.
    #[inline(always)]
    fn reach<const D: usize>(&self, frame: &Frame<R, D>, u: [R; 2], time: R) -> [R; 2] {
        let along = u[0].if_below(R::splat(0.0), self.backward, self.forward);
        [along * frame.touches * time, self.sideways * frame.touches * time]
    }
}

impl<R: Real, const D: usize> Model<R, D> {
    #[inline(always)]
    fn coulomb_frame(&self, row: SpineRow, position: &[[R; D]]) -> Frame<R, D> {
        let mut along = [R::splat(0.0); D];
        if row.previous == row.next {
            along[0] = R::splat(1.0);
        } else {
            along = direction(position[row.previous as usize], position[row.next as usize]).1;
        }
        self.frame_along(row.particle, along, position)
    }

    /// Lets Coulomb friction act on all velocities for a whole step.
    #[inline(always)]
    pub(super) fn apply_coulomb(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        let Some(coulomb) = &self.coulomb else { return };
        let dt = R::splat(self.dt);
        for row in &coulomb.rows {
            let frame = self.coulomb_frame(row.at, position);
            let v = &mut velocity[row.at.particle as usize];
            let u = sliding(&frame, *v);
            replace(&frame, v, u, slowed::<R, D>(u, row.reach(&frame, u, dt)));
        }
    }

    /// Lets Coulomb friction act on the velocities with which a step ends: only the stop, where its stages have had the force.
    #[inline(always)]
    pub(super) fn finish_coulomb(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        let Some(coulomb) = &mut self.coulomb else { return };
        let staged = self.stick.asks_in_stages() && !core::mem::replace(&mut coulomb.fresh, true);
        if staged {
            self.stop_coulomb(position, velocity);
        } else {
            self.apply_coulomb(position, velocity);
        }
    }

    /// Stops in a stage what friction has brought to rest in this step.
    #[inline(always)]
    pub(super) fn admit_coulomb_velocity(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        if self.coulomb.as_ref().is_some_and(|coulomb| !coulomb.fresh) {
            self.stop_coulomb(position, velocity);
        }
    }

    /// Stops what slides against the direction in which it began the step, until the step ends.
    #[inline(always)]
    fn stop_coulomb(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        let Some(mut coulomb) = self.coulomb.take() else { return };
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        for (row, begun) in coulomb.rows.iter().zip(&mut coulomb.begun) {
            let frame = self.coulomb_frame(row.at, position);
            let v = &mut velocity[row.at.particle as usize];
            let u = sliding(&frame, *v);
            let turned = u[0] * begun.sliding[0] + u[1] * begun.sliding[1];
            begun.stopped = turned.if_below(zero, one, begun.stopped);
            replace(&frame, v, u, u.map(|u| zero.if_below(begun.stopped, zero, u)));
        }
        self.coulomb = Some(coulomb);
    }

    /// Adds Coulomb friction to all accelerations: against the sliding of what slides, and as much as it can hold of the pull on what rests.
    #[inline(always)]
    pub(super) fn admit_coulomb_acceleration(
        &mut self,
        position: &[[R; D]],
        velocity: &[[R; D]],
        acceleration: &mut [[R; D]],
    ) {
        let Some(mut coulomb) = self.coulomb.take() else { return };
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let first = core::mem::replace(&mut coulomb.fresh, false);
        for (row, begun) in coulomb.rows.iter().zip(&mut coulomb.begun) {
            let frame = self.coulomb_frame(row.at, position);
            let a = &mut acceleration[row.at.particle as usize];
            let (u, pull) = (sliding(&frame, velocity[row.at.particle as usize]), sliding(&frame, *a));
            if first {
                *begun = Begun { sliding: u, stopped: zero };
            }
            let speed = size::<R, D>(u);
            let held = slowed::<R, D>(pull, row.reach(&frame, pull, one));
            let reach = row.reach(&frame, u, one);
            let inverse = zero.if_below(speed, one / speed, zero);
            let mut net = [zero; 2];
            for i in 0..2 {
                net[i] = zero.if_below(speed, pull[i] - reach[i] * (u[i] * inverse), held[i]);
            }
            replace(&frame, a, pull, net);
        }
        self.coulomb = Some(coulomb);
    }
}

/// The components of a vector forward and across.
#[inline(always)]
fn sliding<R: Real, const D: usize>(frame: &Frame<R, D>, v: [R; D]) -> [R; 2] {
    [dot(v, frame.forward), if D == 3 { dot(v, frame.side) } else { R::splat(0.0) }]
}

/// Its size; on an axis, where it has only one component, exactly that.
#[inline(always)]
fn size<R: Real, const D: usize>(u: [R; 2]) -> R {
    if D == 3 { (u[0] * u[0] + u[1] * u[1]).sqrt() } else { u[0].abs() }
}

/// Gives `v`, whose components are `from`, the components `to`. Where `to` is zero, so are exactly all that lie in the surface.
#[inline(always)]
fn replace<R: Real, const D: usize>(frame: &Frame<R, D>, v: &mut [R; D], from: [R; 2], to: [R; 2]) {
    let (f, q) = (frame.forward, frame.side);
    if D != 3 {
        subtract(v, f, from[0] - to[0]);
        return;
    }
    // Put together anew rather than subtracted from, so that rounding leaves nothing of what stops.
    let normal = [f[1] * q[2] - f[2] * q[1], f[2] * q[0] - f[0] * q[2], f[0] * q[1] - f[1] * q[0]];
    let off = v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2];
    let upright = dot(q, q);
    for axis in 0..D {
        let anew = normal[axis] * off + f[axis] * to[0] + q[axis] * to[1];
        // A spine that points straight up has no side to it.
        let old = v[axis] - f[axis] * (from[0] - to[0]);
        v[axis] = upright.if_below(R::splat(0.5), old, anew);
    }
}

/// Newton steps for the speed that is left; from below and on a function that is nearly a line, four reach the last place.
const NEWTON_STEPS: usize = 6;

/// The v that solves v = u − (reach₀v₀, reach₁v₁)/|v|; 0 where u is within the cone, Σ(uᵢ/reachᵢ)² ≤ 1.
#[inline(always)]
fn slowed<R: Real, const D: usize>(u: [R; 2], reach: [R; 2]) -> [R; 2] {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let left = |u: R, reach: R| {
        let rest = u.abs() - reach;
        zero.if_below(rest, rest, zero)
    };
    let along = left(u[0], reach[0]);
    if D != 3 {
        return [u[0].if_below(zero, -along, along) + zero, zero];
    }
    // With r = |v|: vᵢ = uᵢr/(r + reachᵢ), so Σ(uᵢ/(r + reachᵢ))² = 1, and r is no less than each of these.
    let most = reach[0].if_below(reach[1], reach[1], reach[0]);
    let mut r = along;
    for least in [left(u[1], reach[1]), left(size::<R, D>(u), most)] {
        r = r.if_below(least, least, r);
    }
    let part = |u: R, reach: R, r: R| zero.if_below(u.abs(), u / (r + reach), zero);
    let outside = {
        let parts = [part(u[0], reach[0], zero), part(u[1], reach[1], zero)];
        parts[0] * parts[0] + parts[1] * parts[1]
    };
    for _ in 0..NEWTON_STEPS {
        let parts = [part(u[0], reach[0], r), part(u[1], reach[1], r)];
        let squares = parts.map(|part| part * part);
        let sum = squares[0] + squares[1];
        let slope = part(squares[0], reach[0], r) + part(squares[1], reach[1], r);
        let more = sum * (sum.sqrt() - one) / slope;
        // No number comes of a mass that does not move.
        r = zero.if_below(slope, r + more, r);
    }
    let v = |u: R, reach: R| one.if_below(outside, part(u, reach, r) * r, zero);
    [v(u[0], reach[0]), v(u[1], reach[1])]
}
