//! Contact with the ground.

use super::{
    Model, Real, State,
    friction::{dot, subtract},
    ground::ContactKind,
};

impl<R: Real, const D: usize> Model<R, D> {
    /// Remembers where a step begins, for contact with a terrain, and tears the springs that are too long there.
    #[inline(always)]
    pub fn begin_step(&mut self, state: &State<R, D>) {
        self.contact.begin_step(state);
        if self.tearing.is_some() {
            self.tear(state);
        }
    }

    /// Puts what came to be below the ground back on it and takes the velocity that leads into it.
    ///
    /// On the flat ground this projection is the exact answer for a mass that moved in a straight line. Over a terrain a mass that came below it meets it on its
    /// way x₀ → x₁ at τ = φ₀/(φ₀ − φ₁), loses there what of its velocity leads inwards, and goes on with the rest. With a bounce e > 0 it meets
    /// the ground when it has fallen so far under gravity, leaves with e of the speed of impact, and flies for the rest of the step; what would land
    /// again within the step comes to rest. A surface that curves is taken for its tangent plane where it is met, and what is still below it is pushed out.
    #[inline(always)]
    pub fn apply_contact(&self, state: &mut State<R, D>) {
        match self.contact.kind {
            _ if D != 3 => {}
            ContactKind::None => {}
            ContactKind::Flat => self.project(state),
            ContactKind::Terrain => self.collide(state),
        }
    }

    #[inline(always)]
    fn project(&self, state: &mut State<R, D>) {
        let zero = R::splat(0.0);
        for ((x, v), &inverse_mass) in state.position.iter_mut().zip(&mut state.velocity).zip(&self.inverse_mass) {
            let free_below = zero.if_below(inverse_mass, x[1], zero);
            v[1] = free_below.if_below(zero, v[1].if_below(zero, zero, v[1]), v[1]);
            x[1] = free_below.if_below(zero, zero, x[1]);
        }
    }

    // On its own: in every method it would take as long to compile as the method, and no scene spends its time here.
    #[inline(never)]
    fn collide(&self, state: &mut State<R, D>) {
        let zero = R::splat(0.0);
        for mass in 0..state.position.len() {
            let (x, v) = (&mut state.position[mass], &mut state.velocity[mass]);
            let depth = zero.if_below(self.inverse_mass[mass], self.contact.distance(*x).0, zero);
            if !depth.any_below(zero) {
                continue;
            }
            let start = self.contact.start[mass];
            let (hit_x, hit_v) = if self.contact.bounce > 0.0 {
                self.bounce(start, *x, *v, depth)
            } else {
                self.stop(start, *x, *v, depth)
            };
            for axis in 0..D {
                x[axis] = depth.if_below(zero, hit_x[axis], x[axis]);
                v[axis] = depth.if_below(zero, hit_v[axis], v[axis]);
            }
        }
    }

    /// Where, in parts of the step, a mass on the straight way from `start` to `end` meets the ground, and the normal there.
    fn crossing(&self, start: [R; D], end: [R; D], depth: R) -> (R, [R; D], [R; D]) {
        let zero = R::splat(0.0);
        let above = self.contact.distance(start).0;
        let above = zero.if_below(above, above, zero);
        let part = above / (above - depth);
        let mut at = start;
        for axis in 0..D {
            at[axis] += part * (end[axis] - start[axis]);
        }
        (part, at, self.contact.distance(at).1)
    }

    /// Contact without bounce.
    fn stop(&self, start: [R; D], end: [R; D], mut v: [R; D], depth: R) -> ([R; D], [R; D]) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let (part, mut x, normal) = self.crossing(start, end, depth);
        let inward = dot(v, normal);
        subtract(&mut v, normal, inward.if_below(zero, inward, zero));
        let rest = (one - part) * R::splat(self.dt);
        for axis in 0..D {
            x[axis] += rest * v[axis];
        }
        self.push_out(&mut x, &mut v, normal, one);
        (x, v)
    }

    /// Contact with bounce: along the normal the mass falls from where the step began with what of gravity points there, y = φ₀ + v₀t − ½gt².
    ///
    /// v₀ is that of the parabola through both ends of the step. Methods keep velocities of other moments (semi-implicit Euler, half a step before the
    /// positions); the difference is left to the mass, so that it rises as it fell.
    fn bounce(&self, start: [R; D], end: [R; D], mut v: [R; D], depth: R) -> ([R; D], [R; D]) {
        let (zero, half, dt) = (R::splat(0.0), R::splat(0.5), R::splat(self.dt));
        let (part, at, normal) = self.crossing(start, end, depth);
        let mut way = end;
        subtract(&mut way, at, R::splat(1.0));
        // In a corner what the step ends below most deeply need not be what it met.
        let depth = dot(way, normal);
        let height = self.contact.distance(start).0;
        let height = zero.if_below(height, height, zero);
        let weight = self.gravity.map_or(zero, |gravity| gravity * normal[1]);
        let mean = (depth - height) / dt;
        let speed = mean + half * weight * dt;
        let kept = dot(v, normal) - (mean - half * weight * dt);
        let square = speed * speed + R::splat(2.0) * weight * height;
        let falling = zero.if_below(square, square, zero).sqrt();
        // Without weight towards the surface the crossing is that of the straight way.
        let fallen = zero.if_below(weight, (speed + falling) / weight, part * dt);
        let fallen = fallen.if_below(dt, fallen, dt);
        let leaving = R::splat(-self.contact.bounce) * (speed - weight * fallen);
        let left = dt - fallen;
        let up = leaving * left - half * weight * left * left;
        let up_speed = zero.if_below(up, leaving - weight * left + kept, zero);
        let up = zero.if_below(up, up, zero);
        let mut x = end;
        subtract(&mut x, normal, depth.if_below(zero, depth - up, zero));
        let inward = dot(v, normal);
        subtract(&mut v, normal, depth.if_below(zero, inward - up_speed, zero));
        self.push_out(&mut x, &mut v, normal, R::splat(1.0 + self.contact.bounce));
        (x, v)
    }

    /// Puts what is still below the ground, after it met the surface of this normal, on what it is below.
    ///
    /// If that is another surface, steeply to the first as a wall on a floor (no one surface turns so far within a step), the mass has met it too, and `loses`
    /// times what of its velocity leads inwards: else a mass that rests in the corner would gather speed into the wall for ever. As many surfaces meet
    /// in a corner as there are axes.
    fn push_out(&self, x: &mut [R; D], v: &mut [R; D], mut met: [R; D], loses: R) {
        let zero = R::splat(0.0);
        for _ in 1..D {
            let (distance, normal) = self.contact.distance(*x);
            subtract(x, normal, distance.if_below(zero, distance, zero));
            let inward = dot(*v, normal);
            let inward = inward.if_below(zero, inward, zero);
            let inward = distance.if_below(zero, dot(met, normal).if_below(R::splat(0.5), inward, zero), zero);
            if !inward.any_below(zero) {
                break;
            }
            subtract(v, normal, loses * inward);
            met = normal;
        }
    }
}
