//! What every method makes of an oscillation, by the closed forms of its step: frequency, decay, energy and order on one mass, on the
//! modes of a chain, and on those of a block.

use core::f64::consts::{PI, TAU};

use bevy::math::DVec3;
use faer::{Side, c64};
use wriggle::{
    body::{MassDamping, Particle, ParticleId, Particles, Spring, Springs},
    lab::limits::predicted_limit,
    mechanics::{BodyParts, integrators::Method},
};

use crate::{
    jelly_limits::stiffness,
    support::{follow, in_space},
};

/// A step as a linear map of a mode's position and velocity: uₙ₊₁ = trace·uₙ − determinant·uₙ₋₁.
#[derive(Clone, Copy, Debug)]
struct Step {
    trace: f64,
    determinant: f64,
}

impl Step {
    /// The step of a method at θ = ω·dt with a damping ratio ζ below 1, all of it from springs that are damped in proportion to their stiffness.
    fn of(method: Method, theta: f64, zeta: f64) -> Self {
        // What a method makes of y' = λy with z = λ·dt, for the two λ of the oscillation, which are conjugates.
        let z = c64::new(-zeta * theta, theta * f64::sqrt(1.0 - zeta * zeta));
        let one = c64::new(1.0, 0.0);
        let root = |r: c64| Self { trace: 2.0 * r.re, determinant: r.re * r.re + r.im * r.im };
        match method {
            Method::ExplicitEuler => root(one + z),
            Method::SemiImplicitEuler | Method::StormerVerlet | Method::DampedVerlet => {
                Self { trace: 2.0 - 2.0 * zeta * theta - theta * theta, determinant: 1.0 - 2.0 * zeta * theta }
            }
            Method::Leapfrog => {
                let (kept, most) = (1.0 - zeta * theta, 1.0 + zeta * theta);
                Self { trace: 1.0 + (kept - theta * theta) / most, determinant: kept / most }
            }
            Method::RungeKutta2 => root(one + z + z * z / 2.0),
            Method::RungeKutta4 => root(one + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0),
            Method::ImplicitMidpoint => root((one + z / 2.0) / (one - z / 2.0)),
            // One constraint is solved in one pass.
            Method::ImplicitEuler | Method::Xpbd => root(one / (one - z)),
            Method::ExactFlow => {
                let (sin, cos) = libm::sincos(z.im);
                root(c64::new(cos, sin) * libm::exp(z.re))
            }
        }
    }

    /// The step of a motion that was seen, by least squares.
    fn seen(motion: &[f64]) -> Self {
        let mut sums = [0.0; 5];
        for u in motion.windows(3) {
            let products = [u[1] * u[1], u[1] * u[0], u[0] * u[0], u[2] * u[1], u[2] * u[0]];
            sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
        }
        let [a, b, c, p, q] = sums;
        let whole = a * c - b * b;
        Self { trace: (p * c - q * b) / whole, determinant: (p * b - q * a) / whole }
    }

    /// By how much it multiplies the amplitude.
    fn factor(self) -> f64 {
        self.determinant.sqrt()
    }

    /// By how much it turns the phase.
    fn angle(self) -> f64 {
        libm::acos(0.5 * self.trace / self.factor())
    }

    /// How far a motion is from these steps at worst, as a part of its size.
    fn off(self, motion: &[f64]) -> f64 {
        let most = motion.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let miss = |u: &[f64]| (u[2] - self.trace * u[1] + self.determinant * u[0]).abs();
        motion.windows(3).map(miss).fold(0.0, f64::max) / most
    }
}

/// A body at rest, with one of its modes.
struct Mode {
    particles: Particles,
    springs: Springs,
    /// How its masses move.
    shape: Vec<DVec3>,
    /// Its frequency.
    omega: f64,
}

impl Mode {
    /// A mass of 2 on a pinned spring of stiffness 3.
    fn oscillator() -> Self {
        let pinned = Particle { pinned: true, ..Particle::at(DVec3::ZERO) };
        let particles = Particles::new([pinned, Particle { mass: 2.0, ..Particle::at(DVec3::X) }]).unwrap();
        let springs = springs(&particles, &[[0, 1]], 3.0);
        Self { particles, springs, shape: vec![DVec3::ZERO, DVec3::X], omega: f64::sqrt(1.5) }
    }

    /// Mode `j` of a free chain of `count` masses of 0.5 on springs of stiffness 40: ω = 2√(k/m)·sin(πj/2n).
    fn of_chain(count: u32, j: u32) -> Self {
        let mass = |i| Particle { mass: 0.5, ..Particle::at(DVec3::X * f64::from(i)) };
        let particles = Particles::new((0..count).map(mass)).unwrap();
        let pairs: Vec<_> = (0..count - 1).map(|i| [i, i + 1]).collect();
        let angle = PI * f64::from(j) / f64::from(count);
        let shape = (0..count).map(|i| DVec3::X * libm::cos(angle * (f64::from(i) + 0.5))).collect();
        let omega = 2.0 * f64::sqrt(40.0 / 0.5) * libm::sin(0.5 * angle);
        Self { springs: springs(&particles, &pairs, 40.0), particles, shape, omega }
    }

    /// A cube of masses of 0.5, edges, face and body diagonals of stiffness 40, that breathes: masses go out and in along the diagonals, and every spring
    /// lengthens by the same part s. The energy 48·k·s²/2 against the inertia 6·m of the eight corners makes ω² = 8k/m, however large s is.
    fn of_breathing_cube() -> Self {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let particles = Particles::new((0..8).map(|i| Particle { mass: 0.5, ..Particle::at(corner(i)) })).unwrap();
        let pairs: Vec<_> = (0..8).flat_map(|a| (a + 1..8).map(move |b| [a, b])).collect();
        let shape = (0..8).map(|i| corner(i) - 0.5 * DVec3::ONE).collect();
        Self { springs: springs(&particles, &pairs, 40.0), particles, shape, omega: f64::sqrt(8.0 * 40.0 / 0.5) }
    }

    /// A cube of 3³ masses of 0.5 whose edges, face and body diagonals have stiffness 40, in one of the modes that its stiffness matrix has, from the slowest on or, below
    /// zero, from the fastest back. The first six are motions as a whole.
    fn of_block(index: isize) -> Self {
        let at = |i: u32| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
        let particles = Particles::new((0..27).map(|i| Particle { mass: 0.5, ..Particle::at(at(i)) })).unwrap();
        let near = |[a, b]: &[u32; 2]| (at(*a) - at(*b)).abs().max_element() <= 1.0;
        let pairs: Vec<_> = (0..27).flat_map(|a| (a + 1..27).map(move |b| [a, b])).filter(near).collect();
        let springs = springs(&particles, &pairs, 40.0);
        let modes = stiffness(&particles, &springs).self_adjoint_eigen(Side::Lower).unwrap();
        let column = if index < 0 { 81 - index.unsigned_abs() } else { index.unsigned_abs() };
        let (value, vector) = (modes.S().column_vector()[column], modes.U().col(column));
        let shape = (0..27).map(|i| DVec3::new(vector[3 * i], vector[3 * i + 1], vector[3 * i + 2])).collect();
        Self { particles, springs, shape, omega: f64::sqrt(value / 0.5) }
    }

    /// Damps the springs in proportion to their stiffness, so that the mode has the damping ratio ζ = Dω/2k.
    fn damped(mut self, zeta: f64) -> Self {
        for i in (0..self.springs.len() as u32).map(wriggle::body::SpringId) {
            let spring = self.springs.get(i).unwrap();
            self.springs.set(i, Spring { damping: 2.0 * zeta * spring.stiffness / self.omega, ..spring }).unwrap();
        }
        self
    }

    /// How far along the mode the body is at first and after each of `steps`, let go at `amplitude`, and how far at worst any mass is from where the mode
    /// alone would have it.
    fn motion<const D: usize>(&self, amplitude: f64, run: Run, steps: u64) -> (Vec<f64>, f64) {
        let mut start = self.particles.clone();
        for (i, shape) in self.shape.iter().enumerate() {
            let id = ParticleId(i as u32);
            let particle = start.get(id).unwrap();
            let position = particle.position + amplitude * *shape;
            start.set(id, Particle { position, ..particle }).unwrap();
        }
        let squares: f64 = self.shape.iter().map(|shape| shape.length_squared()).sum();
        let (mut motion, mut stray) = (vec![amplitude], 0.0_f64);
        let parts = BodyParts { mass_damping: run.damping, ..BodyParts::new(&start, &self.springs, run.method) };
        follow::<D>(&parts, run.dt, steps, |_, body| {
            let moved: Vec<_> =
                body.particles.positions().zip(self.particles.positions()).map(|(x, y)| x - y).collect();
            let u = moved.iter().zip(&self.shape).map(|(x, shape)| x.dot(*shape)).sum::<f64>() / squares;
            stray = moved.iter().zip(&self.shape).map(|(x, shape)| (*x - u * *shape).length()).fold(stray, f64::max);
            motion.push(u);
        });
        (motion, stray)
    }

    /// The error of a method at four steps, each half of the one before, from `theta` = ω·dt on: the largest over five radians of the oscillation.
    fn errors<const D: usize>(&self, amplitude: f64, zeta: f64, run: Run, theta: f64) -> [f64; 4] {
        let nu = self.omega * f64::sqrt(1.0 - zeta * zeta);
        [1.0, 2.0, 4.0, 8.0].map(|parts| {
            let dt = theta / parts / self.omega;
            let (motion, _) = self.motion::<D>(amplitude, Run { dt, ..run }, (5.0 * parts / theta).ceil() as u64);
            let exact = |t: f64| {
                let wave = libm::cos(nu * t) + zeta * self.omega / nu * libm::sin(nu * t);
                amplitude * libm::exp(-zeta * self.omega * t) * wave
            };
            motion.iter().enumerate().map(|(n, u)| (u - exact(n as f64 * dt)).abs()).fold(0.0, f64::max)
        })
    }

    /// Asserts that a method has its order on the mode.
    fn assert_order<const D: usize>(&self, amplitude: f64, zeta: f64, run: Run) {
        let Run { method, damping, .. } = run;
        // Damping that sees the velocity of the step before is of first order.
        let lags = [Method::StormerVerlet, Method::DampedVerlet].contains(&method) && zeta > 0.0;
        let order = if lags { 1 } else { method.about().order };
        let theta = [0.02, 0.1, 0.1, 0.3][order.clamp(1, 4) as usize - 1];
        let errors = self.errors::<D>(amplitude, zeta, run, theta);
        if method == Method::ExactFlow {
            assert!(errors.iter().all(|error| *error < 1e-12), "{method:?}, ζ {zeta}: {errors:?}");
            return;
        }
        for pair in errors.windows(2) {
            let observed = libm::log2(pair[0] / pair[1]);
            let near = (observed - f64::from(order)).abs() < 0.1;
            assert!(near, "{method:?}, ζ {zeta}, {damping:?}: order {observed} in {errors:?}, not {order}");
        }
    }
}

/// How a mode is run.
#[derive(Clone, Copy)]
struct Run {
    method: Method,
    damping: Option<MassDamping>,
    dt: f64,
}

fn by(method: Method, dt: f64) -> Run {
    Run { method, damping: None, dt }
}

/// Springs of one stiffness, at rest where the particles are.
fn springs(particles: &Particles, pairs: &[[u32; 2]], stiffness: f64) -> Springs {
    let spring = |pair: &[u32; 2]| {
        let ends = pair.map(ParticleId);
        let [a, b] = ends.map(|end| particles.position(end).unwrap());
        Spring { ends, stiffness, damping: 0.0, rest_length: a.distance(b) }
    };
    Springs::new(pairs.iter().map(spring), particles).unwrap()
}

/// The step that a method is seen to take of an oscillator.
fn seen(method: Method, theta: f64, zeta: f64) -> Step {
    let mode = Mode::oscillator().damped(zeta);
    Step::seen(&mode.motion::<1>(0.2, by(method, theta / mode.omega), 100).0)
}

#[test]
fn one_oscillation_is_stepped_as_the_closed_form_of_the_method_says() {
    for method in Method::ALL {
        for zeta in [0.0, 0.1, 0.5] {
            let mode = Mode::oscillator().damped(zeta);
            for theta in [0.05, 0.3, 1.0] {
                let step = Step::of(method, theta, zeta);
                // No further than its amplitude keeps the mass off its pin.
                let steps = if step.determinant > 1.0 { (2.8 / libm::log(step.determinant)) as u64 } else { 200 };
                let (motion, _) = mode.motion::<1>(0.2, by(method, theta / mode.omega), steps.min(200));
                let off = step.off(&motion);
                assert!(off < 1e-13, "{method:?}, θ {theta}, ζ {zeta}: {off:e} off {step:?}");
            }
        }
    }
}

#[test]
fn frequencies_and_amplitudes_are_the_known_ones() {
    let near = |found: f64, expected: f64, part: f64, what: &str| {
        assert!((found / expected - 1.0).abs() < part, "{what}: {found}, expected {expected}");
    };
    for theta in [0.05, 0.1, 0.2] {
        // Semi-implicit Euler and Verlet are too fast by θ²/24, and lose nothing; what is of the next order is 9/80 θ² of that.
        for method in [Method::SemiImplicitEuler, Method::StormerVerlet, Method::DampedVerlet, Method::Leapfrog] {
            let step = seen(method, theta, 0.0);
            near(step.angle() / theta - 1.0, theta * theta / 24.0, 0.15 * theta * theta + 1e-6, method.name());
            near(step.factor(), 1.0, 1e-11, method.name());
        }
        // Runge–Kutta 4 keeps 1 − θ⁶/72 of the energy, and what is of the next order is −θ²/8 of that.
        let kept = seen(Method::RungeKutta4, theta, 0.0).determinant;
        let lost = libm::pow(theta, 6.0) / 72.0;
        assert!((1.0 - kept - lost).abs() < 0.13 * theta * theta * lost + 1e-11, "{kept} at {theta}");
        near(seen(Method::ExplicitEuler, theta, 0.0).determinant, 1.0 + theta * theta, 1e-11, "explicit Euler");
        let midpoint = seen(Method::ImplicitMidpoint, theta, 0.0);
        near(midpoint.angle(), 2.0 * libm::atan(0.5 * theta), 1e-10, "implicit midpoint");
        near(midpoint.factor(), 1.0, 1e-11, "implicit midpoint");
    }
    // After one period at θ = 0.1: implicit Euler, and XPBD with its one constraint.
    for method in [Method::ImplicitEuler, Method::Xpbd] {
        let kept = libm::pow(seen(method, 0.1, 0.0).factor(), TAU / 0.1);
        assert!((kept - 0.73).abs() < 0.005, "{method:?} keeps {kept}");
    }
    // Exactly e^(−ζθ) and θ√(1−ζ²).
    for zeta in [0.1, 0.5] {
        let step = seen(Method::ExactFlow, 0.3, zeta);
        near(step.factor(), libm::exp(-0.3 * zeta), 1e-10, "decay");
        near(step.angle(), 0.3 * f64::sqrt(1.0 - zeta * zeta), 1e-10, "frequency");
    }
}

#[test]
fn a_damped_oscillation_is_followed_to_the_order_of_the_method() {
    for method in Method::ALL {
        for zeta in [0.0, 0.1, 0.5] {
            let mode = Mode::oscillator().damped(zeta);
            mode.assert_order::<1>(0.2, zeta, by(method, 0.0));
            // The same from what surrounds the body.
            let mode = Mode::oscillator();
            let damping = Some(MassDamping::rate(2.0 * zeta * mode.omega).unwrap());
            mode.assert_order::<1>(0.2, zeta, Run { damping, ..by(method, 0.0) });
        }
    }
}

#[test]
fn damped_verlet_decays_exactly_and_sees_springs_too_stiff_by_half_a_steps_damping() {
    // z² − (2 − λ − θ²)z + (1 − λ) = 0 with 1 − λ = e^(−2ζθ): the decay is the exact one, and the rest is of first order, as if the stiffness were
    // k·(1 + ζθ).
    let mode = Mode::oscillator();
    for zeta in [0.1, 0.5] {
        let damping = Some(MassDamping::rate(2.0 * zeta * mode.omega).unwrap());
        for theta in [0.01, 0.1, 0.5] {
            let run = Run { damping, ..by(Method::DampedVerlet, theta / mode.omega) };
            let motion = mode.motion::<1>(0.2, run, 100).0;
            let kept = libm::exp(-2.0 * zeta * theta);
            let off = Step { trace: 1.0 + kept - theta * theta, determinant: kept }.off(&motion);
            assert!(off < 1e-13, "θ {theta}, ζ {zeta}: {off:e}");
            let step = Step::seen(&motion);
            // A hundred short steps are a fraction of a cycle, and the fit has fewer digits than what it fits.
            assert!((step.factor() / libm::exp(-zeta * theta) - 1.0).abs() < 1e-8, "{step:?}");
            let stiffness = libm::pow(step.angle() / theta, 2.0) + zeta * zeta;
            let more = (stiffness - 1.0) / (zeta * theta);
            assert!((more - 1.0).abs() < 1.2 * theta, "θ {theta}, ζ {zeta}: × {more}");
        }
    }
}

#[test]
fn a_free_chain_oscillates_in_its_modes_with_their_frequencies() {
    const COUNT: u32 = 10;
    let highest = Mode::of_chain(COUNT, COUNT - 1);
    let omega = 2.0 * f64::sqrt(40.0 / 0.5) * libm::cos(PI / (2.0 * f64::from(COUNT)));
    assert!((highest.omega / omega - 1.0).abs() < 1e-12);
    let parts = BodyParts::new(&highest.particles, &highest.springs, Method::SemiImplicitEuler);
    let limit = predicted_limit(&parts).unwrap();
    assert!((limit * omega / 2.0 - 1.0).abs() < 1e-9, "ω·dt = {} at the limit", limit * omega);
    for method in Method::ALL {
        for j in [1, 2, 3, COUNT - 1] {
            for zeta in [0.0, 0.1] {
                let mode = Mode::of_chain(COUNT, j).damped(zeta);
                if method != Method::Xpbd {
                    let dt = 0.3 / omega;
                    let step = Step::of(method, mode.omega * dt, zeta);
                    let (motion, stray) = mode.motion::<1>(0.1, by(method, dt), 30);
                    let off = step.off(&motion);
                    assert!(off < 1e-12 && stray < 1e-12, "{method:?}, mode {j}, ζ {zeta}: {off:e}, {stray:e} astray");
                }
                if j == 1 {
                    mode.assert_order::<1>(0.1, zeta, by(method, 0.0));
                }
            }
        }
    }
}

#[test]
fn one_pass_of_xpbd_slows_the_lowest_mode_of_a_chain() {
    let [lowest, next, highest] = [1, 2, 9].map(|j| Mode::of_chain(10, j));
    for (theta, expected) in [(0.2, 0.995), (1.0, 0.891), (2.0, 0.702)] {
        let dt = theta / highest.omega;
        // As long as the higher modes need to die.
        let others = (20.0 / libm::pow(next.omega * dt, 2.0)) as usize;
        let window = (TAU / (lowest.omega * dt)) as usize;
        let (motion, _) = lowest.motion::<1>(0.3, by(Method::Xpbd, dt), (others + window) as u64);
        let step = Step::seen(&motion[others..]);
        let scale = step.angle() / (lowest.omega * dt);
        assert!((scale - expected).abs() < 6e-4, "ω_max·h = {theta}: × {scale}, expected × {expected}");
    }
}

#[test]
fn a_breathing_cube_has_its_frequency_and_every_method_its_order() {
    for method in in_space() {
        for zeta in [0.0, 0.1] {
            let mode = Mode::of_breathing_cube().damped(zeta);
            if method != Method::Xpbd {
                for theta in [0.1, 0.5] {
                    let step = Step::of(method, theta, zeta);
                    let (motion, stray) = mode.motion::<3>(0.2, by(method, theta / mode.omega), 50);
                    let off = step.off(&motion[..if method == Method::ExplicitEuler { 10 } else { 51 }]);
                    assert!(off < 1e-11 && stray < 1e-9, "{method:?}, θ {theta}, ζ {zeta}: {off:e}, {stray:e}");
                }
            }
        }
        Mode::of_breathing_cube().damped(0.1).assert_order::<3>(0.2, 0.1, by(method, 0.0));
    }
}

#[test]
fn a_block_oscillates_in_its_slowest_and_its_fastest_mode() {
    let fastest = Mode::of_block(-1);
    assert!((fastest.omega / f64::sqrt(40.0 / 0.5) - 3.310).abs() < 6e-4, "{}", fastest.omega);
    for mode in [Mode::of_block(6), fastest] {
        let mode = mode.damped(0.1);
        for method in in_space().filter(|method| *method != Method::Xpbd) {
            let (amplitude, theta) = (1e-6, 0.3);
            let (motion, stray) = mode.motion::<3>(amplitude, by(method, theta / mode.omega), 40);
            let off = Step::of(method, theta, 0.1).off(&motion);
            // As small as the amplitude, by which springs are no longer linear.
            let near = off < 1e-5 && stray < 1e-4 * amplitude;
            assert!(near, "{method:?}, ω {}: {off:e}, {stray:e} astray", mode.omega);
        }
    }
}
