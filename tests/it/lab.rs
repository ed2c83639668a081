//! The laboratory: references, runs and sweeps.

use std::fs;

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, Muscle, Muscles, Particle, ParticleId, Particles, SpineFriction, Spring, SpringId, Springs, Wave},
    lab::{
        Cache, Edge, GaitSpeeds, Point, Problem, ProblemBody, Reference, Setting, Shapes, SweepOptions, Truth, Unit,
        limits::edges, measure, resumed_sweep, work_precision,
    },
    mechanics::integrators::{Method, StickRule},
    scenes,
};

use crate::support::{Body, Worm};

pub const SETTING: Setting = Setting { method: Method::SemiImplicitEuler, stick: StickRule::InStages, dt: 0.01 };

pub fn worm(body: Body) -> Problem {
    let body = ProblemBody {
        name: "worm".into(),
        particles: body.particles,
        springs: body.springs,
        muscles: Some(body.muscles),
        strand: None,
        lattice: None,
        tearing: None,
        waves: None,
        friction: Some(body.friction),
        coulomb: None,
        gravity: None,
        ground: None,
        mass_damping: None,
    };
    Problem::new("worm", vec![body], SETTING)
}

/// Two masses of 1 and 3 joined by a spring that is stretched by `stretch` at the start, on the x axis.
fn oscillator(stiffness: f64, damping: f64, stretch: f64) -> Problem {
    let at = |x: f64, mass| Particle { mass, ..Particle::at(DVec3::X * x) };
    let particles = Particles::new([at(0.0, 1.0), at(1.0 + stretch, 3.0)]).unwrap();
    let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness, damping, rest_length: 1.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    Problem::new("oscillator", vec![loose(particles, springs)], SETTING)
}

#[test]
fn the_reference_of_the_exact_worm_is_the_known_one() {
    let problem = worm(Worm::EXACT.body());
    assert_eq!((problem.duration, problem.times().len()), (20.0, 1000));
    assert!((problem.spacing() - 0.02).abs() < 1e-15);
    let reference = Reference::solve(&problem).unwrap();
    assert!(reference.error() < 1e-12, "{:e} from what confirms it", reference.error());
    let last: Vec<_> = reference.positions(0, 999).iter().map(|x| x.x).collect();
    let known = [3.058918927290, 3.994998746503, 5.085548685141];
    assert!(last.iter().zip(known).all(|(x, known)| (x - known).abs() < 1e-11), "{last:?}");
    let speeds: Vec<_> = reference.last_velocities(0).iter().map(|v| v.x).collect();
    let known = [0.232059061039, 0.202115095212, 0.063038244008];
    assert!(speeds.iter().zip(known).all(|(v, known)| (v - known).abs() < 1e-11), "{speeds:?}");
    let travelled = last.iter().sum::<f64>() / 3.0 - 1.0;
    assert!((travelled - 3.046488786311).abs() < 1e-11, "{travelled}");
    let events = reference.events();
    assert_eq!(events.len(), 26, "{events:?}");
    let first = [(2, true, 0.368158542829), (0, true, 0.835621599543), (1, false, 1.008115772431)];
    for (event, (particle, slides, time)) in events.iter().zip(first) {
        assert_eq!((event.particle, event.slides), (ParticleId(particle), slides), "{event:?}");
        assert!((event.time - time).abs() < 1e-11, "{event:?}, known at {time}");
    }
    let cycles = [0.149138, 0.285996, 0.314267, 0.321484, 0.325558, 0.327983, 0.329459, 0.330370, 0.330938, 0.331296];
    let center = |cycle: usize| match cycle {
        0 => 1.0,
        _ => reference.positions(0, 100 * cycle - 1).iter().map(|x| x.x).sum::<f64>() / 3.0,
    };
    for (cycle, known) in cycles.into_iter().enumerate() {
        let way = center(cycle + 1) - center(cycle);
        assert!((way - known).abs() < 1e-6, "cycle {cycle}: {way}, known {known}");
    }
}

#[test]
fn the_reference_of_an_oscillator_is_its_closed_form() {
    // d = stretch·e^(−γt/2)·(cos νt + γ/2ν·sin νt) with κ = k(1/m₁ + 1/m₂), γ = D(1/m₁ + 1/m₂), ν² = κ − γ²/4.
    for (stiffness, damping) in [(2.0, 0.0), (2.0, 0.3), (40.0, 0.5)] {
        let problem = oscillator(stiffness, damping, 0.2);
        let reference = Reference::solve(&problem).unwrap();
        assert!(reference.error() < 1e-12 && reference.events().is_empty());
        let (kappa, gamma) = (stiffness * 4.0 / 3.0, damping * 4.0 / 3.0);
        let nu = f64::sqrt(kappa - 0.25 * gamma * gamma);
        for (sample, t) in problem.times().into_iter().enumerate() {
            let wave = libm::cos(nu * t) + gamma / (2.0 * nu) * libm::sin(nu * t);
            let length = 1.0 + 0.2 * libm::exp(-0.5 * gamma * t) * wave;
            // The centre of mass stays where it is, a fourth of the length before the heavier mass.
            let exact = [0.75 * 1.2 - 0.75 * length, 0.75 * 1.2 + 0.25 * length];
            for (x, exact) in reference.positions(0, sample).iter().zip(exact) {
                assert!((x.x - exact).abs() < 1e-11, "k {stiffness}, D {damping}, t {t}: {} is not {exact}", x.x);
            }
        }
    }
}

#[test]
fn a_turned_worm_has_the_reference_of_the_straight_one() {
    // Turned about y, it needs all three dimensions and its spine's direction; the garden's worm has a ramp and drag as well.
    for worm_of in [Worm::EXACT, Worm::GARDEN] {
        let turn = 0.7;
        let solve = |body| Reference::solve(&Problem { duration: 10.0, ..worm(body) }).unwrap();
        let straight = solve(worm_of.body());
        let turned = solve(worm_of.body().moved(DVec3::new(2.0, 0.0, -1.0), turn));
        assert!(straight.error() < 1e-12 && turned.error() < 1e-12);
        assert_eq!(straight.events().len(), turned.events().len());
        let rotation = bevy::math::DQuat::from_rotation_y(turn);
        for sample in (0..1000).step_by(37) {
            for (a, b) in straight.positions(0, sample).iter().zip(turned.positions(0, sample)) {
                let moved = rotation * *a + DVec3::new(2.0, 0.0, -1.0);
                assert!(moved.distance(*b) < 1e-11, "{worm_of:?} at sample {sample}: {moved} is not {b}");
            }
        }
    }
}

/// A body that is no worm.
fn loose(particles: Particles, springs: Springs) -> ProblemBody {
    ProblemBody {
        name: "body".into(),
        particles,
        springs,
        muscles: None,
        strand: None,
        lattice: None,
        tearing: None,
        waves: None,
        friction: None,
        coulomb: None,
        gravity: None,
        ground: None,
        mass_damping: None,
    }
}

#[test]
fn the_reference_of_a_square_wave_switches_when_it_does() {
    // Half a period of 1 long, the rest length is 1.2, then 0.8, and so on: in each, x'' = −κ(x − L) − γx' from where the last ended.
    let (stiffness, damping, amplitude) = (5.0, 0.4, 0.2);
    let mut problem = oscillator(stiffness, damping, 0.0);
    let muscle = Muscle { spring: SpringId(0), wave: Wave::Square, amplitude, period: 1.0, phase: 0.0, ramp: 0.0 };
    let body = &mut problem.bodies[0];
    body.muscles = Some(Muscles::new([muscle], &body.springs).unwrap());
    let problem = Problem::new("square", problem.bodies, SETTING);
    assert_eq!(problem.duration, 10.0);
    let reference = Reference::solve(&problem).unwrap();
    assert!(reference.error() < 1e-12, "{:e}", reference.error());
    let (kappa, gamma) = (stiffness * 4.0 / 3.0, damping * 4.0 / 3.0);
    let nu = f64::sqrt(kappa - 0.25 * gamma * gamma);
    let after = |(x, v): (f64, f64), rest: f64, t: f64| {
        let (d, c, s, e) = (x - rest, libm::cos(nu * t), libm::sin(nu * t), libm::exp(-0.5 * gamma * t));
        (rest + e * (d * c + (v + 0.5 * gamma * d) / nu * s), e * (v * c - (0.5 * gamma * v + kappa * d) / nu * s))
    };
    let (mut state, mut half) = ((1.0, 0.0), 0);
    for (sample, t) in problem.times().into_iter().enumerate() {
        let rest = |half: i32| if half % 2 == 0 { 1.2 } else { 0.8 };
        while t > 0.5 * f64::from(half + 1) {
            (state, half) = (after(state, rest(half), 0.5), half + 1);
        }
        let exact = after(state, rest(half), t - 0.5 * f64::from(half)).0;
        let at = reference.positions(0, sample);
        let length = at[1].x - at[0].x;
        assert!((length - exact).abs() < 1e-10, "at {t}: {length} is not {exact}");
    }
}

#[test]
fn the_reference_of_a_swinging_mass_keeps_its_energy() {
    let pin = Particle { pinned: true, ..Particle::at(DVec3::Y) };
    let particles = Particles::new([pin, Particle::at(DVec3::new(0.8, 0.9, 0.3))]).unwrap();
    let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness: 60.0, damping: 0.0, rest_length: 0.9 };
    let springs = Springs::new([spring], &particles).unwrap();
    let body = ProblemBody { gravity: Some(Gravity::new(9.81).unwrap()), ..loose(particles, springs) };
    let problem = Problem::new("swing", vec![body], SETTING);
    let reference = Reference::solve(&problem).unwrap();
    assert!(reference.error() < 1e-9, "{:e}", reference.error());
    let energy = |x: DVec3, v: DVec3| {
        let stretch = x.distance(DVec3::Y) - 0.9;
        0.5 * v.length_squared() + 9.81 * x.y + 30.0 * stretch * stretch
    };
    let start = energy(DVec3::new(0.8, 0.9, 0.3), DVec3::ZERO);
    let end = energy(reference.positions(0, 999)[1], reference.last_velocities(0)[1]);
    assert!((end - start).abs() < 1e-9, "{start} has become {end}");
    assert_eq!(reference.positions(0, 999)[0], DVec3::Y);
}

#[test]
fn runs_of_a_bent_crawler_come_to_its_reference() {
    // Its spine turns while masses are held, grip and drag act, and a cut wave has kinks: all that a straight worm does not show.
    let at = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.2), DVec3::new(1.9, 0.0, -0.3), DVec3::new(2.9, 0.0, 0.1)];
    let particles = Particles::new(at.map(Particle::at)).unwrap();
    let spring = |[a, b]: [u32; 2]| Spring {
        ends: [ParticleId(a), ParticleId(b)],
        stiffness: 3.0,
        damping: 0.6,
        rest_length: at[a as usize].distance(at[b as usize]),
    };
    let springs = Springs::new([[0, 1], [1, 2], [2, 3], [0, 2], [1, 3]].map(spring), &particles).unwrap();
    let muscle = |i: u32, amplitude, phase| Muscle {
        spring: SpringId(i),
        wave: Wave::Sine,
        amplitude,
        period: 2.0,
        phase,
        ramp: 0.75,
    };
    let muscles = Muscles::new([muscle(0, 0.9, 0.1), muscle(2, 0.3, 0.35), muscle(3, 0.2, 0.6)], &springs).unwrap();
    let friction = SpineFriction::new((0..4).map(ParticleId), &particles).unwrap();
    let friction = friction.with_drag(0.4).unwrap().with_grip(2.0).unwrap();
    let body = ProblemBody { muscles: Some(muscles), friction: Some(friction), ..loose(particles, springs) };
    let mut problem = Problem::new("bent", vec![body], SETTING);
    problem.duration = 8.0;
    let reference = Reference::solve(&problem).unwrap();
    assert!(reference.error() < 1e-11 && reference.events().len() > 10, "{:e}", reference.error());
    let truth = Truth::Positions(reference);
    let error = |dt| {
        let setting = Setting { method: Method::RungeKutta4, stick: StickRule::InStages, dt };
        measure(&problem, &truth, setting, 1).errors.unwrap().largest
    };
    let errors = [0.01, 0.005, 0.0025, 0.00125].map(error);
    assert!(errors[3] < 2e-4 && errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{errors:?}");
}

#[test]
fn drag_without_a_ratchet_acts_on_forward_sliding_alone() {
    // A mass on a spring of 1 to a pinned one, drag 0.3: x'' = −x − 0.3·max(x', 0), damped on every second half swing. Each swing forward takes
    // e^(−0.15·π/ν) of the amplitude with ν² = 1 − 0.15², each swing back nothing.
    let pin = Particle { pinned: true, ..Particle::at(DVec3::ZERO) };
    let particles = Particles::new([pin, Particle::at(DVec3::X * 2.5)]).unwrap();
    let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness: 1.0, damping: 0.0, rest_length: 2.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    let friction = SpineFriction::new((0..2).map(ParticleId), &particles).unwrap().with_ratchet(false);
    let body = ProblemBody { friction: Some(friction.with_drag(0.3).unwrap()), ..loose(particles, springs) };
    let mut problem = Problem::new("half damped", vec![body], SETTING);
    let nu = f64::sqrt(1.0 - 0.15 * 0.15);
    let (back, forward) = (core::f64::consts::PI, core::f64::consts::PI / nu);
    problem.duration = 2.0 * (back + forward);
    let reference = Reference::solve(&problem).unwrap();
    assert!(reference.error() < 1e-12, "{:e}", reference.error());
    let exact = 2.0 + 0.5 * libm::exp(-0.15 * 2.0 * forward);
    let end = reference.positions(0, 999)[1].x;
    assert!((end - exact).abs() < 1e-11, "{end} is not {exact}");
}

#[test]
fn methods_have_their_order_against_the_reference() {
    for (method, order, damping, steps) in [
        (Method::ExplicitEuler, 1.0, 0.3, [0.002, 0.001, 0.0005, 0.00025]),
        (Method::SemiImplicitEuler, 1.0, 0.3, [0.002, 0.001, 0.0005, 0.00025]),
        (Method::SemiImplicitEuler, 1.0, 0.0, [0.002, 0.001, 0.0005, 0.00025]),
        (Method::StormerVerlet, 2.0, 0.0, [0.05, 0.025, 0.0125, 0.00625]),
        (Method::RungeKutta2, 2.0, 0.3, [0.02, 0.01, 0.005, 0.0025]),
        (Method::RungeKutta2, 2.0, 0.0, [0.02, 0.01, 0.005, 0.0025]),
        (Method::RungeKutta4, 4.0, 0.3, [0.1, 0.05, 0.025, 0.0125]),
        (Method::RungeKutta4, 4.0, 0.0, [0.1, 0.05, 0.025, 0.0125]),
    ] {
        let problem = Problem { duration: 5.0, ..oscillator(2.0, damping, 0.2) };
        let reference = Reference::solve(&problem).unwrap();
        let truth = Truth::Positions(reference);
        let errors = steps.map(|dt| {
            let setting = Setting { method, stick: StickRule::InStages, dt };
            measure(&problem, &truth, setting, 1).errors.unwrap().largest
        });
        for pair in errors.windows(2) {
            let observed = libm::log2(pair[0] / pair[1]);
            assert!((observed - order).abs() < 0.1, "{method:?}, D {damping}: order {observed} in {errors:?}");
        }
    }
}

#[test]
fn a_step_that_meets_no_shared_time_is_compared_as_exactly() {
    let problem = oscillator(2.0, 0.3, 0.2);
    let reference = Reference::solve(&problem).unwrap();
    let truth = Truth::Positions(reference);
    let error = |dt| {
        let setting = Setting { method: Method::RungeKutta4, stick: StickRule::InStages, dt };
        measure(&problem, &truth, setting, 1).errors.unwrap().largest
    };
    let (even, odd) = (error(0.1), error(0.0997));
    assert!((odd / even - 1.0).abs() < 0.1, "{even} at 0.1, {odd} at 0.0997");
}

#[test]
fn a_run_that_blows_up_is_a_point_without_errors() {
    let problem = worm(Worm::EXACT.body());
    let reference = Reference::solve(&problem).unwrap();
    let limit = problem.stability_limit(Method::SemiImplicitEuler, StickRule::InStages);
    let truth = Truth::Positions(reference);
    let run = |dt| measure(&problem, &truth, Setting { dt, ..SETTING }, 2);
    let (well, blown) = (run(0.5 * limit), run(4.0 * limit));
    assert!(well.errors.is_some() && blown.errors.is_none(), "{well:?} {blown:?}");
    assert_eq!(well.steps, (20.0 / (0.5 * limit)).ceil() as u64);
    assert_eq!(well.evaluations, well.steps);
    assert!(0.0 < well.seconds && well.seconds <= well.median_seconds);
    // The known errors of the document's method: 5e-3 or so a unit of dt.
    let known = run(0.0005).errors.unwrap();
    assert!((known.largest - 1.03e-3).abs() < 2e-4 && (known.distance - 1.0217e-3).abs() < 1e-6, "{known:?}");
    assert!(known.rms < known.largest);
    // What is missed in the end is missed in its ten cycles about evenly, and all of it where there is one.
    assert!((0.1..0.3).contains(&(known.cycle.unwrap() / known.distance)), "{known:?}");
    let problem = Problem { duration: 2.0, ..problem };
    let truth = Truth::of(&problem, &Cache::none()).unwrap();
    let first = measure(&problem, &truth, Setting { dt: 0.01, ..SETTING }, 1).errors.unwrap();
    assert_eq!((first.cycle, first.penetration), (Some(first.distance), None));
}

#[test]
fn what_conserves_energy_drifts_as_its_method_lets_it() {
    // Explicit Euler multiplies the energy of an oscillator without damping by 1 + (ω·dt)² a step.
    let problem = Problem { duration: 5.0, ..oscillator(2.0, 0.0, 0.2) };
    let truth = Truth::of(&problem, &Cache::none()).unwrap();
    let drift = |method, dt| {
        let setting = Setting { method, stick: StickRule::InStages, dt };
        measure(&problem, &truth, setting, 1).errors.unwrap().energy.unwrap()
    };
    let law = libm::pow(1.0 + 2.0 * 4.0 / 3.0 * 1e-6, 5000.0) - 1.0;
    let found = drift(Method::ExplicitEuler, 1e-3);
    assert!((found / law - 1.0).abs() < 1e-8, "{found}, by the law {law}");
    // Semi-implicit Euler keeps it within a half of ω·dt, and the midpoint rule, of what is linear, altogether.
    let theta = 1e-2 * f64::sqrt(2.0 * 4.0 / 3.0);
    let bounded = drift(Method::SemiImplicitEuler, 1e-2);
    assert!(bounded < 0.5 * theta / (1.0 - 0.5 * theta) && bounded > 0.2 * theta, "{bounded}");
    assert!(drift(Method::ImplicitMidpoint, 0.1) < 1e-10);
}

#[test]
fn the_mean_error_is_in_lengths_of_the_body() {
    // A pinned mass far away makes the body eight times as long, and is where it should be.
    let short = oscillator(2.0, 0.3, 0.2);
    let mut long = short.clone();
    let at = |i| long.bodies[0].particles.get(ParticleId(i)).unwrap();
    let pin = Particle { pinned: true, ..Particle::at(DVec3::X * 9.6) };
    long.bodies[0].particles = Particles::new([at(0), at(1), pin]).unwrap();
    assert_eq!([&short, &long].map(|problem| problem.bodies[0].length()), [1.2, 9.6]);
    let [short, long] = [short, long].map(|problem| {
        let truth = Truth::of(&problem, &Cache::none()).unwrap();
        measure(&problem, &truth, SETTING, 1).errors.unwrap()
    });
    assert_eq!(short.largest, long.largest);
    let ratio = short.rms / long.rms;
    assert!((ratio / (8.0 * f64::sqrt(3.0 / 2.0)) - 1.0).abs() < 1e-9, "{ratio}");
}

#[test]
fn the_edges_of_the_garden_are_those_of_its_linearised_worm() {
    // Three equal masses and two springs: modes of κ = k and 3k with γ = D and 3D. The larger one decides: θ³/4 − ζθ² + 2ζ²θ − 2ζ = 0 by RK2,
    // θ = 2(√(1 + ζ²) − ζ) by semi-implicit Euler, and 2 by leapfrog.
    let problem = Problem::of(&scenes::load("garden").unwrap()).unwrap();
    let edges = edges(&problem);
    assert_eq!(edges.len(), Method::ALL.len());
    let omega = f64::sqrt(3.0 * 1.5);
    let zeta = 3.0 * 0.9 / (2.0 * omega);
    let theta = |method| {
        let edge = edges.iter().find(|edge| edge.method == method).unwrap();
        assert!(edge.predicted);
        omega * edge.dt
    };
    let two = theta(Method::RungeKutta2);
    let cubic = two.powi(3) / 4.0 - zeta * two * two + 2.0 * zeta * zeta * two - 2.0 * zeta;
    assert!(cubic.abs() < 1e-6 && (two / omega - 1.01).abs() < 1e-3, "{cubic} at {two}");
    assert!((theta(Method::SemiImplicitEuler) - 2.0 * (f64::sqrt(1.0 + zeta * zeta) - zeta)).abs() < 1e-6);
    assert!((theta(Method::Leapfrog) - 2.0).abs() < 1e-6);
    assert!(theta(Method::ImplicitEuler).is_infinite());
    // The bound is another.
    assert!(problem.stability_limit(Method::RungeKutta2, StickRule::InStages) < 0.7);
}

#[test]
fn every_method_has_eight_steps_of_a_block_from_its_edge_down() {
    let problem = Problem::of(&scenes::load("jelly").unwrap()).unwrap();
    // A short fall is enough of a truth for a sweep that does not measure.
    let truth = Truth::of(&Problem { duration: 1.0, ..problem.clone() }, &Cache::none()).unwrap();
    let options = SweepOptions { quick: false, cache: Cache::none() };
    let mut nothing = |setting| {
        Ok::<_, ()>(Point {
            setting,
            steps: 1,
            evaluations: 1,
            runs: 1,
            seconds: 1.0,
            median_seconds: 1.0,
            errors: None,
        })
    };
    let chart = resumed_sweep(&problem, &truth, &options, &mut nothing, &mut |_, _, _| {}).unwrap();
    for &Edge { method, dt, predicted } in &chart.edges {
        let points = chart.points.iter().filter(|point| point.setting.method == method);
        let mut steps: Vec<_> = points.map(|point| point.setting.dt).collect();
        if [Shapes::METHOD, Method::ExactFlow].contains(&method) {
            assert!(steps.is_empty(), "{method:?}");
            continue;
        }
        assert!(predicted && steps.len() >= 8, "{method:?} has {} steps", steps.len());
        if dt.is_finite() {
            assert_eq!((steps.remove(0), steps[0]), (2.0 * dt, dt), "{method:?}");
        }
        steps.retain(|step| *step != problem.setting.dt);
        assert!(steps.len() >= 8 && steps.is_sorted_by(|a, b| a > b), "{method:?}: {steps:?}");
    }
}

#[test]
fn a_reference_is_kept_and_a_damaged_file_is_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    // What does not exist yet is made.
    let cache = Cache::at(folder.path().join("a/b"));
    let problem = Problem { duration: 2.0, ..worm(Worm::EXACT.body()) };
    let file = cache.file(&problem).unwrap();
    let computed = cache.reference(&problem).unwrap();
    let good = fs::read(&file).unwrap();
    assert!(cache.reference(&problem).unwrap() == computed);
    // Whatever is wrong with the file: the same reference comes back, and the file is good again.
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 1;
    let mut other_version = good.clone();
    other_version[18] = b'0';
    for damaged in [flipped, other_version, good[..good.len() - 5].to_vec(), good[..20].to_vec(), Vec::new()] {
        fs::write(&file, &damaged).unwrap();
        assert!(cache.reference(&problem).unwrap() == computed);
        assert!(fs::read(&file).unwrap() == good);
    }
    // The file is what is read: a reference with a right checksum is believed.
    let other = Problem { duration: 2.0, ..worm(Worm { stiffness: 1.6, ..Worm::EXACT }.body()) };
    assert_ne!(cache.file(&other), Some(file.clone()));
    fs::write(cache.file(&other).unwrap(), &good).unwrap();
    assert!(cache.reference(&other).unwrap() != computed, "a file of another problem was believed");
    // A folder that cannot be is no error.
    fs::write(folder.path().join("plain"), "no folder").unwrap();
    assert!(Cache::at(folder.path().join("plain")).reference(&problem).unwrap() == computed);
}

#[test]
fn the_hash_goes_by_the_physics_alone() {
    let load = |change: &dyn Fn(&mut scenes::LoadedScene)| {
        let mut scene = scenes::load("garden").unwrap();
        change(&mut scene);
        Problem::of(&scene).unwrap().hash()
    };
    let plain = load(&|_| {});
    let same = load(&|scene| {
        scene.file.title = "another".into();
        scene.file.camera = scenes::Camera::default();
        scene.file.method = Method::RungeKutta4;
        scene.file.clock.step = scenes::StepSize::Dt(0.01);
    });
    assert_eq!(plain, same);
    let stiffer = load(&|scene| scene.file.set = [("worm.springs.stiffness".into(), 1.6)].into());
    let moved = load(&|scene| scene.file.creatures[0].at = (1.0, 0.0, 0.0));
    assert!(plain != stiffer && plain != moved && stiffer != moved);
}

#[test]
fn a_scene_on_the_ground_has_no_reference_and_says_so() {
    let mut scene = scenes::load("glide").unwrap();
    scene.file.ground = Some(wriggle::body::Ground::Flat);
    let error = Reference::solve(&Problem::of(&scene).unwrap()).unwrap_err();
    assert!(error.to_string().contains("glide") && error.to_string().contains("ground"), "{error}");
}

#[test]
fn a_pixel_of_the_garden_is_the_known_length() {
    let problem = Problem::of(&scenes::load("garden").unwrap()).unwrap();
    // 2·16.5·tan 21°/1080.
    assert!((problem.budget - 0.011729).abs() < 1e-6, "{}", problem.budget);
    assert_eq!((problem.duration, problem.time_scale), (60.0, 3.0));
}

#[test]
fn a_sweep_has_eight_steps_of_every_method_and_both_settings() {
    let options = SweepOptions { quick: true, cache: Cache::none() };
    let mut said = Vec::new();
    let scene = scenes::load("glide").unwrap();
    let chart =
        work_precision(&scene, &options, &mut |done, total, what| said.push((done, total, what.to_owned()))).unwrap();
    assert_eq!((chart.scene.as_str(), chart.duration, chart.real_time), ("glide", 20.0, 20.0));
    assert_eq!(chart.edges, edges(&Problem::of(&scene).unwrap()));
    for method in Method::ALL {
        let steps: Vec<_> = chart.points.iter().filter(|point| point.setting.method == method).collect();
        let edge = chart.edges.iter().find(|edge| edge.method == method).unwrap().dt;
        assert!(edge.is_infinite() || [2.0 * edge, edge] == [0, 1].map(|i| steps[i].setting.dt), "{method:?}");
        assert!(steps.iter().all(|point| point.runs == if point.errors.is_some() { 3 } else { 1 }));
        assert!(steps.len() >= 8, "{method:?} has {} points", steps.len());
        for pair in steps.windows(2).filter(|pair| pair[0].setting.stick == pair[1].setting.stick) {
            assert!(pair[0].setting.dt > pair[1].setting.dt && pair[0].steps < pair[1].steps);
        }
        let has_variant = steps.iter().any(|point| point.setting.stick == StickRule::EndOfStep);
        assert_eq!(has_variant, method == Method::RungeKutta4 || has_variant && method != Method::SemiImplicitEuler);
    }
    let own = chart.points.iter().filter(|point| point.setting == chart.setting).count();
    assert_eq!((own, chart.setting.dt), (1, 0.074));
    assert!(chart.points.iter().any(|point| point.errors.is_none()), "nothing blew up");
    assert!(said.last().is_some_and(|last| last.0 == last.1 && last.0 == chart.points.len()));
}

#[test]
fn a_scene_with_a_budget_of_gait_speed_has_no_reference_of_positions() {
    let problem = Problem::of(&scenes::load("meadow").unwrap()).unwrap();
    assert_eq!((problem.unit, problem.budget), (Unit::PartOfSpeed, 0.01));
    let error = Cache::none().reference(&problem).unwrap_err().to_string();
    assert_eq!(
        error,
        "meadow: there is no reference solution of a body on the ground, whose contacts are not located; its error budget is a gait speed within 1 %"
    );
}

#[test]
fn the_speed_of_a_gait_is_that_of_the_reference() {
    // On flat ground without gravity the smallest worm moves as it does on an axis, where its motion is known. One that rests goes nowhere.
    let mut problem = Problem::of(&scenes::load("two-masses").unwrap()).unwrap();
    problem.bodies[0].ground = None;
    let mut resting = problem.bodies[0].clone();
    resting.muscles = None;
    problem.bodies.push(resting);
    let speeds = GaitSpeeds::solve(&problem).unwrap();
    assert_eq!((speeds.speeds().len(), speeds.speeds()[1]), (2, 0.0));
    problem.unit = Unit::Length;
    let reference = Reference::solve(&problem).unwrap();
    let center = |sample| reference.positions(0, sample).iter().map(|position| position.x).sum::<f64>() / 2.0;
    // Of the thousand shared times the 600th is four of ten cycles before the last.
    let exact = (center(999) - center(599)) / (0.4 * problem.duration);
    let error = (speeds.speeds()[0] / exact - 1.0).abs();
    assert!(error < 2.0 * speeds.error() && speeds.error() < 1e-3, "{error:e}, said to be {:e}", speeds.error());
}

#[test]
fn a_sweep_on_the_ground_is_of_the_speeds_of_gaits() {
    let options = SweepOptions { quick: true, cache: Cache::none() };
    let chart = work_precision(&scenes::load("two-masses").unwrap(), &options, &mut |_, _, _| {}).unwrap();
    assert_eq!((chart.unit, chart.budget), (Unit::PartOfSpeed, 0.01));
    for method in Method::ALL {
        let steps = chart.points.iter().filter(|point| point.setting.method == method).count();
        // What tells the truth is not judged by it.
        // Nor does what cannot step a body on the ground blow up.
        let left_out = [GaitSpeeds::METHOD, Method::ExactFlow].contains(&method);
        assert!(if left_out { steps == 0 } else { steps >= 8 }, "{method:?} has {steps} points");
    }
    // Whatever follows the motion comes to its speed.
    for method in [Method::SemiImplicitEuler, Method::RungeKutta2, Method::ImplicitMidpoint] {
        let points = chart.points.iter().filter(|point| point.setting.method == method);
        let finest = points.min_by(|a, b| a.setting.dt.total_cmp(&b.setting.dt)).unwrap();
        let errors = finest.errors.unwrap();
        assert!(errors.largest < 0.01 && errors.rms <= errors.largest && errors.distance < 0.1, "{finest:?}");
        // Flat ground lets nothing in, and no energy is known.
        assert_eq!((errors.penetration, errors.energy, errors.cycle), (Some(0.0), None, None));
    }
    let own = chart.points.iter().find(|point| point.setting == chart.setting).unwrap();
    assert!(own.errors.unwrap().largest <= 0.01, "{own:?}");
}

#[test]
fn what_is_below_the_ground_is_seen() {
    let mut problem = Problem::of(&scenes::load("two-masses").unwrap()).unwrap();
    let mut sunk = problem.bodies[0].clone();
    sunk.muscles = None;
    let first = sunk.particles.get(ParticleId(0)).unwrap();
    let below = Particle { position: first.position - 0.25 * DVec3::Y, pinned: true, ..first };
    sunk.particles.set(ParticleId(0), below).unwrap();
    problem.bodies.push(sunk);
    let truth = Truth::of(&problem, &Cache::none()).unwrap();
    let errors = measure(&problem, &truth, problem.setting, 1).errors.unwrap();
    assert_eq!(errors.penetration, Some(0.25 - first.position.y));
}

#[test]
fn speeds_are_kept_and_a_damaged_file_is_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::at(folder.path());
    let problem = Problem::of(&scenes::load("two-masses").unwrap()).unwrap();
    let found = cache.gait_speeds(&problem).unwrap();
    let files = || fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>();
    let [file] = &files()[..] else { panic!("{:?}", files()) };
    let whole = fs::read(file).unwrap();
    let mut damaged = whole.clone();
    damaged[60] ^= 1;
    fs::write(file, &damaged).unwrap();
    assert_eq!(cache.gait_speeds(&problem).unwrap(), found);
    assert_eq!(fs::read(file).unwrap(), whole);
    // Another friction, another ground and another step are other problems.
    let mut others = [(); 3].map(|()| problem.clone());
    others[0].bodies[0].friction = None;
    others[1].bodies[0].ground = None;
    others[2].setting.dt *= 0.5;
    others.iter().for_each(|other| drop(cache.gait_speeds(other)));
    assert_eq!(files().len(), 4);
    // What is kept is not written again.
    let written = || fs::metadata(file).unwrap().modified().unwrap();
    let before = written();
    assert_eq!((cache.gait_speeds(&problem).unwrap(), written()), (found, before));
}
