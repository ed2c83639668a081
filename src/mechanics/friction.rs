//! Friction along and across the spine; `coulomb` has the dry kind.
//!
//! `ratchet`: s = S·v; if s < 0, v −= s S (Miller 1988). `drag` and `grip` are rates at which forward and sideways sliding die away, `isotropic` one for
//! sliding in any direction.
//! A method either lets them act once at the end of its step ([`Model::apply_friction`]), as the documents do, or
//! asks in each of its stages what friction admits ([`Model::admit_velocity`], [`Model::admit_acceleration`]): there, a mass that
//! does not slide forward and is pushed back stays where it is. [`StickRule`] says which.

use crate::body::Ground;

use super::{
    Model, Real,
    forces::direction,
    ground::ContactKind,
    integrators::StickRule,
    model::{Fading, FrictionRow, Sections, SpineRow},
};

/// A mass that the push back brings to rest within this fraction of a step is at rest.
const AT_ONCE: f64 = 1e-9;

/// Directions in which friction acts on one mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame<R, const D: usize> {
    /// Forward along the spine, S.
    pub(super) spine: [R; D],
    /// Forward along the surface, S_t; without a ground, S itself.
    pub(super) forward: [R; D],
    /// Sideways, q = n × S_t with the surface's normal n; without a ground, n points up.
    pub(super) side: [R; D],
    /// The surface's normal n; up without a ground.
    pub(super) normal: [R; D],
    /// 1 where the mass touches the ground or there is none, else 0.
    pub(super) touches: R,
}

impl<R: Real, const D: usize> Model<R, D> {
    #[inline(always)]
    pub(super) fn frame(&self, row: SpineRow, position: &[[R; D]]) -> Frame<R, D> {
        self.frame_along(row.particle, self.spine_vector(row, position), position)
    }

    /// S, from the sections before and behind.
    #[inline(always)]
    fn spine_vector(&self, row: SpineRow, position: &[[R; D]]) -> [R; D] {
        direction([R::splat(0.0); D], self.span(row, position)).1
    }

    /// What lies between the sections before and behind: X_next − X_previous or V_next − V_previous, times the number of particles in a section.
    #[inline(always)]
    fn span(&self, row: SpineRow, columns: &[[R; D]]) -> [R; D] {
        match &self.sections {
            None => {
                let (previous, next) = (columns[row.previous as usize], columns[row.next as usize]);
                core::array::from_fn(|axis| next[axis] - previous[axis])
            }
            Some(sections) => sections.span(row, columns),
        }
    }

    /// The frame of a particle where the spine has this direction.
    #[inline(always)]
    pub(super) fn frame_along(&self, particle: u32, spine: [R; D], position: &[[R; D]]) -> Frame<R, D> {
        self.lay(self.level_frame(spine), position[particle as usize])
    }

    /// The frame of a mass that stands on level ground.
    #[inline(always)]
    fn level_frame(&self, spine: [R; D]) -> Frame<R, D> {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let mut frame = Frame { spine, forward: spine, side: [zero; D], normal: [zero; D], touches: one };
        if D == 3 {
            frame.normal[1] = one;
            if self.contact.kind == ContactKind::Flat {
                let mut level = spine;
                level[1] = zero;
                frame.forward = direction([zero; D], level).1;
            }
            let mut side = [zero; D];
            side[0] = frame.forward[2];
            side[2] = -frame.forward[0];
            frame.side = direction([zero; D], side).1;
        }
        frame
    }

    /// How fast S turns: dS/dt = (I − SSᵀ)(V_next − V_previous)/|X_next − X_previous|.
    #[inline(always)]
    pub(super) fn spine_turn(&self, row: SpineRow, position: &[[R; D]], velocity: &[[R; D]]) -> [R; D] {
        // On an axis there is nowhere to turn to.
        if D == 1 {
            return [R::splat(0.0); D];
        }
        let (length, spine) = direction([R::splat(0.0); D], self.span(row, position));
        let mut turn = self.span(row, velocity);
        let along = dot(turn, spine);
        subtract(&mut turn, spine, along);
        let inverse = R::splat(0.0).if_below(length, R::splat(1.0) / length, R::splat(0.0));
        turn.map(|value| value * inverse)
    }

    /// Lays the frame of a level ground where a mass is.
    #[inline(always)]
    fn lay(&self, level: Frame<R, D>, x: [R; D]) -> Frame<R, D> {
        match self.contact.kind {
            ContactKind::Terrain if D == 3 => self.lay_on_terrain(level, x),
            _ => Frame { touches: self.touches(x), ..level },
        }
    }

    /// 1 where a mass touches the ground or there is none, else 0.
    #[inline(always)]
    fn touches(&self, x: [R; D]) -> R {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let near = R::splat(Ground::CONTACT_DISTANCE);
        match self.contact.kind {
            ContactKind::Flat if D == 3 => x[1].if_below(near, one, zero),
            ContactKind::Terrain if D == 3 => self.contact.distance(x).0.if_below(near, one, zero),
            _ => one,
        }
    }

    // On its own: methods ask for frames in many places and are compiled for many kinds of bodies and processors.
    #[inline(never)]
    fn lay_on_terrain(&self, mut frame: Frame<R, D>, x: [R; D]) -> Frame<R, D> {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let (distance, n) = self.contact.distance(x);
        frame.touches = distance.if_below(R::splat(Ground::CONTACT_DISTANCE), one, zero);
        frame.normal = n;
        let mut along = frame.spine;
        subtract(&mut along, n, dot(frame.spine, n));
        let f = direction([zero; D], along).1;
        frame.forward = f;
        frame.side[0] = n[1] * f[2] - n[2] * f[1];
        frame.side[1] = n[2] * f[0] - n[0] * f[2];
        frame.side[2] = n[0] * f[1] - n[1] * f[0];
        frame
    }

    /// The side grip where a mass stands.
    #[inline(always)]
    pub(super) fn grip_at(&self, friction: &FrictionRow<R>, x: [R; D]) -> Fading<R> {
        if D == 3 && self.contact.has_patches() { self.contact.grip(x, friction.grip) } else { friction.grip }
    }

    /// What of a velocity isotropic friction works against: what lies in the surface, and all of it without a ground.
    #[inline(always)]
    pub(super) fn sliding(&self, frame: &Frame<R, D>, v: [R; D]) -> [R; D] {
        let mut sliding = v;
        if self.contact.kind != ContactKind::None {
            subtract(&mut sliding, frame.normal, dot(v, frame.normal));
        }
        sliding
    }

    /// Lets friction act on all velocities for a whole step: the ratchet first, then drag, grip and isotropic friction as
    /// exact decays over dt, then Coulomb friction.
    #[inline(always)]
    pub fn apply_friction(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        self.apply_spine_friction(position, velocity);
        self.apply_coulomb(position, velocity);
    }

    #[inline(always)]
    fn apply_spine_friction(&self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        let Some(friction) = self.friction else { return };
        for section in self.by_section() {
            let level = self.level_frame(self.spine_vector(section[0], position));
            for row in section {
                let mass = row.particle as usize;
                let (x, v) = (position[mass], velocity[mass]);
                // Each kind of ground by itself: a frame that may come from either is put together in memory, which takes longer than what it is for.
                velocity[mass] = match self.contact.kind {
                    ContactKind::Terrain if D == 3 => self.slow(&friction, &self.lay_on_terrain(level, x), x, v),
                    _ => self.slow(&friction, &Frame { touches: self.touches(x), ..level }, x, v),
                };
            }
        }
    }

    /// The spine section by section: the masses of one share its spine vector and how fast that turns.
    #[inline(always)]
    fn by_section(&self) -> impl Iterator<Item = &[SpineRow]> {
        self.spine.chunks(self.sections.as_ref().map_or(1, |sections| sections.width))
    }

    /// What spine friction leaves of a velocity over a step.
    #[inline(always)]
    fn slow(&self, friction: &FrictionRow<R>, frame: &Frame<R, D>, x: [R; D], mut v: [R; D]) -> [R; D] {
        if friction.ratchet {
            v = ratchet(frame.spine, frame.touches, v);
        }
        if friction.has_drag {
            let zero = R::splat(0.0);
            let sliding = dot(v, frame.forward);
            subtract(&mut v, frame.forward, zero.if_below(sliding, sliding, zero) * friction.drag_loss * frame.touches);
        }
        if friction.has_grip && D == 3 {
            let loss = self.grip_at(friction, x).loss;
            let sideways = dot(v, frame.side);
            subtract(&mut v, frame.side, sideways * loss * frame.touches);
        }
        if friction.has_isotropic {
            let sliding = self.sliding(frame, v);
            subtract(&mut v, sliding, friction.isotropic.loss * frame.touches);
        }
        v
    }

    /// Lets friction act on the velocities with which a step ends: what the stages admit, or all of it where it acts only now.
    #[inline(always)]
    pub fn finish_velocity(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        match self.stick {
            StickRule::InStages | StickRule::Located => self.admit_spine_velocity(position, velocity),
            StickRule::EndOfStep => self.apply_spine_friction(position, velocity),
        }
        self.finish_coulomb(position, velocity);
    }

    /// Takes from all velocities what friction does not admit: sliding back along the spine, and past the stop. Nothing where friction acts at the end of a step.
    #[inline(always)]
    pub fn admit_velocity(&mut self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        self.admit_spine_velocity(position, velocity);
        self.admit_coulomb_velocity(position, velocity);
    }

    #[inline(always)]
    fn admit_spine_velocity(&self, position: &[[R; D]], velocity: &mut [[R; D]]) {
        let (Some(FrictionRow { ratchet: true, .. }), true) = (self.friction, self.stick.asks_in_stages()) else {
            return;
        };
        for section in self.by_section() {
            let spine = self.spine_vector(section[0], position);
            for row in section {
                let mass = row.particle as usize;
                velocity[mass] = ratchet(spine, self.touches(position[mass]), velocity[mass]);
            }
        }
    }

    /// Stops what the last stage of a step found at rest and held there: the sum of the stages still has the speed with which the step began.
    #[inline(always)]
    pub fn stop_held(
        &self,
        position: &[[R; D]],
        stage_velocity: &[[R; D]],
        acceleration: &[[R; D]],
        velocity: &mut [[R; D]],
    ) {
        let (Some(FrictionRow { ratchet: true, .. }), true) = (self.friction, self.stick.asks_in_stages()) else {
            return;
        };
        let zero = R::splat(0.0);
        for section in self.by_section() {
            let spine = self.spine_vector(section[0], position);
            let turn = self.spine_turn(section[0], position, stage_velocity);
            for row in section {
                let mass = row.particle as usize;
                let push = dot(acceleration[mass], spine) + dot(stage_velocity[mass], turn);
                let soon = dot(stage_velocity[mass], spine) + push * R::splat(2.0 * AT_ONCE * self.dt);
                let v = &mut velocity[mass];
                let sliding = dot(*v, spine);
                // What starts to slip is let go; as above, rounding errors must not decide.
                let stopped = (sliding.abs() * R::splat(AT_ONCE)).if_below(soon, zero, sliding);
                subtract(v, spine, stopped * self.touches(position[mass]));
            }
        }
    }

    /// Adds drag and grip to all accelerations, and takes from them what friction does not admit: that a mass which does not slide forward starts
    /// to slide back. `velocity` is admitted already. Nothing where friction acts at the end of a step.
    #[inline(always)]
    pub fn admit_acceleration(&mut self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        if self.stick.asks_in_stages() {
            self.admit_spine_acceleration(position, velocity, acceleration);
            self.admit_coulomb_acceleration(position, velocity, acceleration);
        }
    }

    #[inline(always)]
    fn admit_spine_acceleration(&self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let Some(friction) = self.friction else { return };
        for section in self.by_section() {
            let level = self.level_frame(self.spine_vector(section[0], position));
            let turn = self.spine_turn(section[0], position, velocity);
            for row in section {
                let mass = row.particle as usize;
                let (x, v, a) = (position[mass], velocity[mass], acceleration[mass]);
                // Each by itself, as in `apply_spine_friction`.
                acceleration[mass] = match self.contact.kind {
                    ContactKind::Terrain if D == 3 => {
                        self.admitted(&friction, &self.lay_on_terrain(level, x), turn, x, v, a)
                    }
                    _ => self.admitted(&friction, &Frame { touches: self.touches(x), ..level }, turn, x, v, a),
                };
            }
        }
    }

    /// What spine friction makes of the acceleration of one mass, whose spine vector turns so fast.
    #[inline(always)]
    fn admitted(
        &self,
        friction: &FrictionRow<R>,
        frame: &Frame<R, D>,
        turn: [R; D],
        x: [R; D],
        v: [R; D],
        mut a: [R; D],
    ) -> [R; D] {
        let zero = R::splat(0.0);
        if friction.has_drag {
            let sliding = dot(v, frame.forward);
            subtract(&mut a, frame.forward, zero.if_below(sliding, sliding, zero) * friction.drag * frame.touches);
        }
        if friction.has_grip && D == 3 {
            let rate = self.grip_at(friction, x).rate;
            subtract(&mut a, frame.side, dot(v, frame.side) * rate * frame.touches);
        }
        if friction.has_isotropic {
            subtract(&mut a, self.sliding(frame, v), friction.isotropic.rate * frame.touches);
        }
        if friction.ratchet {
            // d(S·v)/dt: what is held stays where the spine leaves it as it turns.
            let push = dot(a, frame.spine) + dot(v, turn);
            let back = push.if_below(zero, push, zero);
            // What the push would stop at once is at rest: a speed of rounding errors must not decide.
            let soon = dot(v, frame.spine) + push * R::splat(self.dt * AT_ONCE);
            let held = soon.if_below(zero, back, zero);
            subtract(&mut a, frame.spine, held * frame.touches);
        }
        a
    }
}

impl Sections {
    #[inline(always)]
    fn span<R: Real, const D: usize>(&self, row: SpineRow, columns: &[[R; D]]) -> [R; D] {
        let (previous, mut span) = (self.sum(row.previous, columns), self.sum(row.next, columns));
        for axis in 0..D {
            span[axis] -= previous[axis];
        }
        span
    }

    #[inline(always)]
    fn sum<R: Real, const D: usize>(&self, section: u32, columns: &[[R; D]]) -> [R; D] {
        let first = section as usize * self.width;
        let mut sum = [R::splat(0.0); D];
        for &particle in &self.particles[first..first + self.width] {
            for axis in 0..D {
                sum[axis] += columns[particle as usize][axis];
            }
        }
        sum
    }
}

/// Takes from a velocity what leads back along the spine, where the mass touches the ground.
#[inline(always)]
fn ratchet<R: Real, const D: usize>(spine: [R; D], touches: R, mut v: [R; D]) -> [R; D] {
    let zero = R::splat(0.0);
    let sliding = dot(v, spine);
    subtract(&mut v, spine, sliding.if_below(zero, sliding, zero) * touches);
    v
}

#[inline(always)]
pub(super) fn dot<R: Real, const D: usize>(a: [R; D], b: [R; D]) -> R {
    let mut sum = a[0] * b[0];
    for axis in 1..D {
        sum += a[axis] * b[axis];
    }
    sum
}

/// v −= amount·along
#[inline(always)]
pub(super) fn subtract<R: Real, const D: usize>(v: &mut [R; D], along: [R; D], amount: R) {
    for axis in 0..D {
        v[axis] -= amount * along[axis];
    }
}
