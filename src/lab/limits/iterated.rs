//! The growth of a large body's step by iteration: the linearised step is taken again and again.
//!
//! The matrix of a step takes twice as many steps to find as it has columns, and then its eigenvalues; what grows shows itself in fewer.
//! The first disturbance is the stiffest direction, which is the first to grow by most methods, and a little of everything else. Its energy
//! is watched: what drifts without resistance comes further with every step, which is no growth, and slow oscillations come back without having grown.

use faer::Col;

use crate::mechanics::linear::Linear;

/// How many steps are looked at first, and how many where that does not settle it; in windows of a quarter.
const STEPS: [usize; 2] = [1000, 4000];
/// What has grown or died away by so much from the third window to the last, as a logarithm of mean energy, has done so in either number of steps.
const FLUCTUATION: [f64; 2] = [0.02, 0.004];
/// What energy has grown or died away by so much, as a logarithm, has done so for sure; less is rounding.
const FOR_SURE: f64 = 46.0;
/// How much of everything else there is beside the stiffest direction.
const OTHERS: f64 = 0.03;

/// Whether disturbances do not grow in many linear steps of `dt`: `take` gives what one becomes in a step, first where each coordinate is, then how fast, in
/// [`Linear::time`]. Nothing where it gives nothing.
pub(super) fn is_calm(linear: &Linear, dt: f64, mut take: impl FnMut(&[f64]) -> Option<Vec<f64>>) -> Option<bool> {
    let mut disturbance = first(linear);
    let start = linear.energy(&disturbance, dt).ln();
    // The logarithm of what the disturbance has been divided by.
    let mut grown = 0.0;
    // The mean energies of as many windows as the longer look has in a quarter of the shorter.
    let mut sums = vec![0.0; 4 * STEPS[1] / STEPS[0]];
    let window = STEPS[1] / sums.len();
    for taken in 0..STEPS[1] {
        disturbance = take(&disturbance)?;
        let length = Col::from_iter(disturbance.iter().copied()).norm_l2();
        let energy = linear.energy(&disturbance, dt).ln() + 2.0 * grown - start;
        if !length.is_finite() || energy > FOR_SURE {
            return Some(false);
        }
        if energy < -FOR_SURE || length == 0.0 {
            return Some(true);
        }
        sums[taken / window] += libm::exp(energy);
        disturbance.iter_mut().for_each(|value| *value /= length);
        grown += length.ln();
        if taken + 1 == STEPS[0] {
            let change = (sums[3] / sums[2]).ln();
            if change.abs() > FLUCTUATION[0] {
                return Some(change < 0.0);
            }
        }
    }
    let quarter = sums.len() / 4;
    let mean = |quarters: usize| sums[quarters * quarter..][..quarter].iter().sum::<f64>();
    Some((mean(3) / mean(2)).ln() <= FLUCTUATION[1])
}

fn first(linear: &Linear) -> Vec<f64> {
    let count = linear.coordinates.len();
    // Of no regularity, so that it has a part of every direction.
    let other = |i: usize| ((i * 37 + i / 3 * 53) % 101) as f64 / 50.0 - 1.0;
    let share = OTHERS / (count as f64).sqrt();
    let positions = linear.stiffest.iter().enumerate().map(|(i, stiffest)| stiffest + share * other(i));
    positions.chain(core::iter::repeat_n(0.0, count)).collect()
}

#[cfg(test)]
mod tests {
    use bevy::math::DVec3;

    use super::*;
    use crate::{
        body::{MassDamping, Particle, ParticleId, Particles, Spring, Springs},
        lab::limits::linearised_step::LinearisedStep,
        lab::limits::step_matrix::growth_of,
        mechanics::BodyParts,
        mechanics::integrators::Method,
    };

    /// A cube of eight masses with springs between all of them.
    fn cube(damping: f64) -> (Particles, Springs) {
        let at = |i: u32| DVec3::new(f64::from(i % 2), f64::from(i / 2 % 2), f64::from(i / 4));
        let particles = Particles::new((0..8).map(|i| Particle::at(at(i)))).unwrap();
        let pairs = (0..8).flat_map(|a| (a + 1..8).map(move |b| [a, b]));
        let spring = pairs.map(|[a, b]| Spring {
            ends: [ParticleId(a), ParticleId(b)],
            stiffness: 1.0,
            damping,
            rest_length: at(a).distance(at(b)),
        });
        let springs = Springs::new(spring, &particles).unwrap();
        (particles, springs)
    }

    #[test]
    fn it_knows_what_the_matrix_of_the_step_knows() {
        for (damping, loss) in [(0.0, 0.0), (0.1, 0.0), (1.0, 0.0), (0.0, 0.01)] {
            let (particles, springs) = cube(damping);
            for method in [Method::ExplicitEuler, Method::DampedVerlet, Method::RungeKutta4] {
                let body = BodyParts::new(&particles, &springs, method);
                let mass_damping = (loss > 0.0).then(|| MassDamping::per_step(loss).unwrap());
                let body = BodyParts { mass_damping, ..body };
                let linear = Linear::of(&body).unwrap();
                for theta in [0.05, 1.5, 2.1, 3.0] {
                    let dt = theta / linear.rate;
                    let growth = growth_of(&body, &linear, dt).unwrap();
                    // What grows or dies by less than this a step is too near to the limit to be told.
                    if (growth - 1.0).abs() > 1e-9 && (growth - 1.0).abs() < 5e-6 {
                        continue;
                    }
                    let mut step = LinearisedStep::<3>::new(&body, &linear, dt);
                    let calm = is_calm(&linear, dt, |disturbance| step.take(disturbance)).unwrap();
                    assert_eq!(calm, growth < 1.0 + 1e-7, "{method:?}, D {damping}, λ {loss}, θ {theta}: {growth}");
                }
            }
        }
    }
}
