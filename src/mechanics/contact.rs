//! Contact with the ground, without bounce.

use crate::body::Ground;

use super::{Model, Real, State};

impl<R: Real, const D: usize> Model<R, D> {
    /// Puts what came to be below the ground back on it and takes the velocity that leads into it. On a plane and without bounce, this
    /// projection is the exact answer for a mass that moved in a straight line.
    #[inline(always)]
    pub fn apply_contact(&self, state: &mut State<R, D>) {
        let (Some(Ground::Flat), true) = (self.ground, D == 3) else { return };
        let zero = R::splat(0.0);
        for ((x, v), &inverse_mass) in state.position.iter_mut().zip(&mut state.velocity).zip(&self.inverse_mass) {
            let free_below = zero.if_below(inverse_mass, x[1], zero);
            v[1] = free_below.if_below(zero, v[1].if_below(zero, zero, v[1]), v[1]);
            x[1] = free_below.if_below(zero, zero, x[1]);
        }
    }
}
