//! Springs that tear.

use crate::body::SpringId;

use super::{BodyParts, Model, Real, State, forces::direction};

/// What steps know of springs that tear.
#[derive(Clone, Debug)]
pub(super) struct TearingRows<R> {
    /// The length at which each spring tears.
    at: Vec<R>,
    /// 1 where it is torn, else 0.
    torn: Vec<R>,
}

impl<R: Real> TearingRows<R> {
    pub(super) fn idle(springs: usize) -> Self {
        let zero = R::splat(0.0);
        Self { at: vec![zero; springs], torn: vec![zero; springs] }
    }

    pub(super) fn lane(&self, lane: usize) -> TearingRows<f64> {
        let all = |values: &[R]| values.iter().map(|value| value.lane(lane)).collect();
        TearingRows { at: all(&self.at), torn: all(&self.torn) }
    }
}

impl<R: Real, const D: usize> Model<R, D> {
    /// Puts the numbers of `body` into a lane.
    pub(super) fn set_tearing_lane(&mut self, lane: usize, body: &BodyParts<'_>) {
        let (Some(rows), Some(tearing)) = (&mut self.tearing, body.tearing) else { return };
        for (i, spring) in body.springs.iter().enumerate() {
            let torn = tearing.is_torn(SpringId(i as u32));
            rows.at[i].set_lane(lane, (1.0 + tearing.strain()) * spring.rest_length);
            rows.torn[i].set_lane(lane, f64::from(u8::from(torn)));
        }
        self.let_go();
    }

    /// Tears the springs that are too long where a step begins.
    #[inline(never)]
    pub(super) fn tear(&mut self, state: &State<R, D>) {
        let Some(rows) = &mut self.tearing else { return };
        for ((spring, at), torn) in self.springs.iter().zip(&rows.at).zip(&mut rows.torn) {
            let [a, b] = spring.ends.map(|end| state.position[end as usize]);
            // A length that is not a number tears nothing; the watch has it.
            *torn = at.if_below(direction(a, b).0, R::splat(1.0), *torn);
        }
        self.let_go();
    }

    /// Takes the force from the springs that are torn.
    fn let_go(&mut self) {
        let Some(rows) = &self.tearing else { return };
        let zero = R::splat(0.0);
        for (spring, &torn) in self.springs.iter_mut().zip(&rows.torn) {
            spring.stiffness = zero.if_below(torn, zero, spring.stiffness);
            spring.damping = zero.if_below(torn, zero, spring.damping);
            spring.longest = zero.if_below(torn, R::splat(f64::INFINITY), spring.longest);
        }
    }

    /// Which springs of the body in this lane are torn, in order; none where none can.
    pub fn torn(&self, lane: usize) -> impl Iterator<Item = bool> + '_ {
        self.tearing.iter().flat_map(move |rows| rows.torn.iter().map(move |torn| torn.lane(lane) != 0.0))
    }
}
