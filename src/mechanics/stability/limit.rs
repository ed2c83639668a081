//! The limit of a body's method in its present pose.
//!
//! Bounds of the fastest oscillation and of the least and the most damping decide for most methods. Explicit Euler and RK2 let everything grow that is not damped,
//! and are limited by what is damped least, whichever direction that is. Where damping goes with stiffness that is known; across a taut spring, and where springs
//! are damped unevenly, it is not, and the roots of all motions are found.

use crate::mechanics::{
    BodyParts,
    integrators::Method,
    linear::{Across, Linear, MOST_COORDINATES, coordinate_count, polynomial_limit},
};

use super::{Damping, StabilityBound, ratios, stability_bound};

/// The most coordinates of a body whose roots the gauge of a running scene waits for: some thousandth of a second.
const MOST_WHILE_RUNNING: usize = 60;
/// Roots that are others at every step are found some fifty times, which takes as long as those of a body so many times as large once.
const BY_STEP: usize = 4;

impl BodyParts<'_> {
    /// The largest dt at which the body's method is stable in its present pose, with its rest lengths as at `time`: never above the true limit of
    /// the linearised body, but for motions that take 10⁵ times as long as the fastest and are hardly damped, which rounding hides.
    /// What grows by itself, as a squeezed chain buckles, grows at any step and is left out. Infinite for a body that cannot oscillate.
    ///
    /// 0 by explicit Euler and RK2, which damping has to hold, where it is not known how little that may be: with taut springs, or one that is not damped
    /// beside others that are, on a body that feels friction or has more than 400 coordinates (100 with damping given by step).
    pub fn stability_limit(&self, time: f64) -> f64 {
        let bound = stability_bound(self, time);
        let found = self.limit_by_roots(&bound, time, Across::Resisted, MOST_COORDINATES);
        found.unwrap_or_else(|| self.method.stability_limit(&bound))
    }

    /// The dt above which to expect that it explodes: the [limit](Self::stability_limit), but for explicit Euler and RK2 while springs are stretched.
    /// Nothing damps a motion across a taut spring, so those two often grow at any step then. Such motions are slow and grow slowly, or friction holds
    /// them; this is the limit of motions along the springs. A body that nothing but taut springs holds for good, such as a pendulum, does grow below it.
    /// 0 for a body of more than 20 particles, or one that feels friction, with a spring that is not damped beside others that are.
    pub fn alarm_limit(&self, time: f64) -> f64 {
        let [least_ratio, _] = ratios(self);
        let bound = stability_bound(self, time);
        match order(self.method) {
            None => self.method.stability_limit(&bound),
            Some(_) => {
                let bound = StabilityBound { least_ratio, ..bound };
                let along = self.limit_by_roots(&bound, time, Across::Ignored, MOST_WHILE_RUNNING);
                along.unwrap_or_else(|| self.method.stability_limit(&bound))
            }
        }
    }

    /// The limit of explicit Euler and RK2 where the bound does not know how little may be damped. Nothing for other methods and where it does know, and
    /// for bodies of more than `most` coordinates.
    fn limit_by_roots(&self, bound: &StabilityBound, time: f64, across: Across, most: usize) -> Option<f64> {
        let order = order(self.method)?;
        let [least_ratio, most_ratio] = ratios(self);
        let known = bound.damping == Damping::Proportional && bound.least_ratio == least_ratio;
        // What springs do not damp at all, mass damps evenly.
        if known || most_ratio == 0.0 || self.has_spring_without_length() {
            return None;
        }
        // Friction holds now these masses and now those, and what swings then has other roots. The bound counts it in whichever way it acts.
        if bound.friction > 0.0 {
            return None;
        }
        let most = if bound.loss_per_step.is_some() { most / BY_STEP } else { most };
        if coordinate_count(self) > most {
            return None;
        }
        polynomial_limit(&Linear::of_few(self, time, across)?, order)
    }

    /// A spring of no length resists in any direction, which no matrix does.
    fn has_spring_without_length(&self) -> bool {
        self.springs.iter().any(|spring| {
            let [a, b] = spring.ends.map(|end| self.particles.position(end).unwrap_or_default());
            a.distance(b) == 0.0
        })
    }
}

/// The order of the methods that let everything grow that is not damped.
fn order(method: Method) -> Option<u32> {
    match method {
        Method::ExplicitEuler => Some(1),
        Method::RungeKutta2 => Some(2),
        _ => None,
    }
}
