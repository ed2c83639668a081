//! Steps that jitter, and what they do to the energy of an oscillation.

use wriggle::mechanics::{Advance, Model, State, Timeline, integrators::Method};

use crate::failures::oscillator;

/// A repeatable number from −1 to 1.
fn noise(seed: &mut u32) -> f64 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    2.0 * f64::from(*seed >> 8) / f64::from(1 << 24) - 1.0
}

/// Steps of ω·dt = 0.3 that jitter by a fifth, in 64 equal levels.
struct Jitter(Vec<usize>);

impl Jitter {
    const LEVELS: usize = 64;

    fn new(mut seed: u32, steps: usize) -> Self {
        let level = |noise: f64| ((0.5 * (noise + 1.0) * Self::LEVELS as f64) as usize).min(Self::LEVELS - 1);
        Self((0..steps).map(|_| level(noise(&mut seed))).collect())
    }

    fn dt(level: usize) -> f64 {
        0.3 * (1.0 + 0.2 * ((2 * level + 1) as f64 / Self::LEVELS as f64 - 1.0))
    }

    fn steps(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().map(|&level| Self::dt(level))
    }

    /// By how much one of our methods multiplies the energy of an oscillator.
    fn growth(&self, method: Method) -> f64 {
        // So small that the mass does not reach its pin with ten thousand times the amplitude.
        let amplitude = 1e-5;
        let row = oscillator(1.0 + amplitude, None);
        let body = row.parts(method);
        let mut models: Vec<_> =
            (0..Self::LEVELS).map(|level| Model::<f64, 1>::new(&body, [], Self::dt(level))).collect();
        let mut state = State::new(2);
        state.set_lane(0, &row.particles);
        for &level in &self.0 {
            let timeline = Timeline { dt: Self::dt(level), base_step: 0, base_time: 0.0 };
            Advance { model: &mut models[level], state: &mut state, method, timeline, first: 0, steps: 1 }.run();
        }
        let (x, v) = (state.position[1][0] - 1.0, state.velocity[1][0]);
        (x * x + v * v) / (amplitude * amplitude)
    }

    /// The same of x⁺ = 2x − x⁻ + a·dt², or of x⁺ = x + (x − x⁻)·dt/dt⁻ + a·dt·(dt + dt⁻)/2, which knows the step before.
    fn growth_of_verlet(&self, corrected: bool) -> f64 {
        let (mut x, mut last, mut before) = (1.0_f64, 1.0_f64, Self::dt(0));
        for dt in self.steps() {
            let (way, square) = if corrected { (dt / before, 0.5 * dt * (dt + before)) } else { (1.0, dt * dt) };
            (x, last, before) = (x + (x - last) * way - x * square, x, dt);
        }
        let v = (x - last) / before - 0.5 * before * x;
        x * x + v * v
    }

    fn growth_of_kick_drift_kick(&self) -> f64 {
        let (mut x, mut v) = (1.0_f64, 0.0_f64);
        for dt in self.steps() {
            v -= 0.5 * dt * x;
            x += dt * v;
            v -= 0.5 * dt * x;
        }
        x * x + v * v
    }
}

/// The mean of some numbers, and how far from it they are in the root of the mean square.
fn mean_and_spread(numbers: &[f64]) -> (f64, f64) {
    let count = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / count;
    (mean, f64::sqrt(numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0)))
}

#[test]
fn steps_that_jitter_feed_energy_into_what_equal_steps_keep() {
    // A method with equal steps keeps an ellipse that depends on the step, and each change of the step puts the mass on another one: the logarithm of its size
    // walks at random. Semi-implicit Euler keeps x² − θxv + v². Of N steps θ(1 + ε), where the mean of ε² is s², each adds ε·θ²·cos 2φ for a phase φ: a variance
    // of Nθ⁴s²/2, 10.8 here, and half of it on average, as where all phases are alike. Störmer–Verlet and its like keep x² + (1 − θ²/4)v² or that with x and v
    // exchanged, and walk by θ³/2 instead of θ²: a variance of Nθ⁶s²/8, 0.24. One run says little: ×5·10⁴ by semi-implicit Euler, ×1.2 to 1.4
    // by time-corrected Verlet and ×0.7 by kick, drift, kick are all within two spreads of these means.
    const STEPS: usize = 200_000;
    let (theta, square) = (0.3, 0.2 * 0.2 / 3.0);
    let all: Vec<_> = (1..=8).map(|seed| Jitter::new(seed, STEPS)).collect();
    type Growth = fn(&Jitter) -> f64;
    let walks = |of: Growth| mean_and_spread(&all.iter().map(|jitter| libm::log(of(jitter))).collect::<Vec<_>>());
    let law = |part: f64, order: f64| {
        let variance = part * STEPS as f64 * libm::pow(theta, order) * square;
        (0.5 * variance, variance.sqrt())
    };
    let cases: [(&str, Growth, _, &[f64]); 4] = [
        ("semi-implicit Euler", |jitter| jitter.growth(Method::SemiImplicitEuler), law(0.5, 4.0), &[5e4]),
        ("Störmer–Verlet", |jitter| jitter.growth(Method::StormerVerlet), law(0.125, 6.0), &[]),
        ("time-corrected Verlet", |jitter| jitter.growth_of_verlet(true), law(0.125, 6.0), &[1.2, 1.4]),
        ("kick, drift, kick", Jitter::growth_of_kick_drift_kick, law(0.125, 6.0), &[0.7]),
    ];
    for (name, of, (mean, spread), known) in cases {
        let found = walks(of);
        // Eight walks give the mean within two of its errors, and the spread within a half.
        assert!((found.0 - mean).abs() < 2.0 * spread / f64::sqrt(8.0), "{name}: {found:?}, expected {mean}, {spread}");
        assert!((found.1 / spread - 1.0).abs() < 0.5, "{name}: {found:?}, expected {mean}, {spread}");
        for growth in known {
            assert!((libm::log(*growth) - mean).abs() < 2.0 * spread, "{name}: × {growth} is not of this walk");
        }
    }
    // Plain Verlet takes the way of one step for that of another.
    let least = all.iter().map(|jitter| jitter.growth_of_verlet(false)).fold(f64::INFINITY, f64::min);
    assert!(least > 1e12, "× {least}");
    // Equal steps keep what they began with, each method within its bounds.
    let equal = Jitter(vec![Jitter::LEVELS / 2; STEPS]);
    for method in [Method::SemiImplicitEuler, Method::StormerVerlet] {
        let kept = equal.growth(method);
        assert!((1.0 / (1.0 + 0.3 / 2.0)..=1.0 / (1.0 - 0.3 / 2.0)).contains(&kept), "{method:?}: × {kept}");
    }
}
