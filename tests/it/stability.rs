//! The predicted stability limit against the true one.

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, MassDamping, Particle, ParticleId, Particles, Spring, Springs},
    cli::Headless,
    creatures::{
        Pose,
        library::{self, CREATURE},
    },
    mechanics::{BodyParts, integrators::Method},
    physics::{Plan, body_parts},
};

use crate::support::{Worm, stepping_app};

/// The methods whose step [`true_limit`] knows as a matrix.
const STEP_KNOWN: [Method; 2] = [Method::SemiImplicitEuler, Method::RungeKutta4];

/// The largest stable dt of an oscillator of squared frequency κ and damping rate γ, by the growth of its step's matrix.
fn true_limit(method: Method, modes: &[(f64, f64)]) -> f64 {
    let grows = |dt: f64| {
        modes.iter().any(|&(kappa, gamma)| {
            // Eigenvalues of the step as a map of (x, v), from its trace and determinant.
            let (trace, determinant) = match method {
                Method::SemiImplicitEuler => (2.0 - dt * gamma - dt * dt * kappa, 1.0 - dt * gamma),
                Method::RungeKutta4 => {
                    // exp(dt·A) to fourth order with A = [[0, 1], [−κ, −γ]].
                    let mut power = [[1.0, 0.0], [0.0, 1.0]];
                    let mut sum = power;
                    for n in 1..=4 {
                        let [[a, b], [c, d]] = power;
                        let h = dt / f64::from(n);
                        power = [[-kappa * b * h, (a - gamma * b) * h], [-kappa * d * h, (c - gamma * d) * h]];
                        for i in 0..2 {
                            for j in 0..2 {
                                sum[i][j] += power[i][j];
                            }
                        }
                    }
                    (sum[0][0] + sum[1][1], sum[0][0] * sum[1][1] - sum[0][1] * sum[1][0])
                }
                other => panic!("the step of {other:?} is not known here"),
            };
            let discriminant: f64 = trace * trace / 4.0 - determinant;
            let radius =
                if discriminant > 0.0 { trace.abs() / 2.0 + discriminant.sqrt() } else { f64::sqrt(determinant) };
            radius > 1.0 + 1e-9
        })
    };
    let (mut stable, mut unstable) = (1e-6, 1e3);
    while unstable / stable > 1.0 + 1e-9 {
        let middle = f64::sqrt(stable * unstable);
        if grows(middle) { unstable = middle } else { stable = middle }
    }
    stable
}

fn assert_bounds(predicted: f64, truth: f64, what: &str) {
    assert!(predicted <= truth * (1.0 + 1e-9), "{what}: predicted {predicted} is above the true limit {truth}");
    assert!(predicted >= 0.5 * truth, "{what}: predicted {predicted} is less than half of the true limit {truth}");
}

#[test]
fn a_body_that_is_turned_keeps_its_bound() {
    let snake = library::read_creature(&library::find(CREATURE, "snake", None).unwrap()).unwrap();
    let limit = |heading: f64, method| {
        let body = snake.body(Pose { heading, ..Pose::default() }).unwrap();
        BodyParts { strand: body.strand, ..BodyParts::new(&body.particles, &body.springs, method) }.stability_limit(0.0)
    };
    for method in [Method::ExplicitEuler, Method::SemiImplicitEuler, Method::RungeKutta2, Method::RungeKutta4] {
        let straight = limit(0.0, method);
        for heading in [-40.0, 17.0, 123.0] {
            let turned = limit(heading, method);
            assert!((turned / straight - 1.0).abs() < 0.02, "{method:?} at {heading}°: {turned}, straight {straight}");
        }
    }
}

#[test]
fn the_worm_limit_is_safe_and_no_less_than_half_at_rest_and_stretched() {
    for method in STEP_KNOWN {
        for damping in [0.0, 0.1, 0.9, 3.0, 12.0] {
            for gap in [0.6, 1.0, 1.4, 3.0] {
                let mut body = Worm { damping, drag: 0.0, method, ..Worm::GARDEN }.body();
                for i in 0..3 {
                    body.particles.set(ParticleId(i), Particle::at(DVec3::X * gap * f64::from(i))).unwrap();
                }
                let predicted = body.parts().stability_limit(0.0);
                let truth = true_limit(method, &[(1.5, damping), (4.5, 3.0 * damping)]);
                assert_bounds(predicted, truth, &format!("{method:?}, D {damping}, gap {gap}"));
                // Free to move off the axis, it also has the stiffness across its springs to count with.
                let free = BodyParts { gravity: Some(Gravity::new(0.0).unwrap()), ..body.parts() };
                assert_bounds(free.stability_limit(0.0), truth, &format!("{method:?}, D {damping}, gap {gap}, free"));
            }
        }
    }
}

#[test]
fn the_limit_of_the_garden_worm_is_the_known_one() {
    let limit = Worm::GARDEN.body().parts().stability_limit(0.0);
    assert!((limit - 0.5175).abs() < 5e-5, "{limit}");
}

#[test]
fn the_bound_is_the_true_limit_of_a_long_chain_and_safe_for_unequal_masses() {
    let chain = |count: u32, mass: &dyn Fn(u32) -> f64, stiffness: &dyn Fn(u32) -> f64| {
        let particles =
            Particles::new((0..count).map(|i| Particle { mass: mass(i), ..Particle::at(DVec3::X * f64::from(i)) }))
                .unwrap();
        let spring = |i| Spring {
            ends: [ParticleId(i), ParticleId(i + 1)],
            stiffness: stiffness(i),
            damping: 0.0,
            rest_length: 1.0,
        };
        let springs = Springs::new((0..count - 1).map(spring), &particles).unwrap();
        (particles, springs)
    };
    let limit = |(particles, springs): &(Particles, Springs)| {
        let parts = BodyParts::new(particles, springs, Method::SemiImplicitEuler);
        parts.stability_limit(0.0)
    };
    // ω_max = 2√(k/m)·cos(π/2n).
    let even = chain(40, &|_| 1.0, &|_| 2.0);
    let omega = 2.0 * f64::sqrt(2.0) * libm::cos(core::f64::consts::PI / 80.0);
    assert!((limit(&even) / (2.0 / omega) - 1.0).abs() < 1e-3, "{} of {}", limit(&even), 2.0 / omega);
    // Two masses: ω² = k(1/m₁ + 1/m₂).
    let pair = chain(2, &|i| [0.01, 5.0][i as usize], &|_| 3.0);
    let omega = f64::sqrt(3.0 * (100.0 + 0.2));
    assert!((limit(&pair) / (2.0 / omega) - 1.0).abs() < 1e-12);
}

#[test]
fn a_small_disturbance_dies_below_the_true_limit_and_grows_above_it() {
    for method in STEP_KNOWN {
        for damping in [0.05, 0.9, 3.0] {
            for (factor, grows) in [(0.99, false), (1.01, true)] {
                let worm = Worm { amplitude: 0.0, damping, drag: 0.0, ratchet: false, method, ..Worm::GARDEN };
                let mut body = worm.body();
                for (i, x) in [1e-9, 1.0 - 3e-9, 2.0 + 1e-9].into_iter().enumerate() {
                    body.particles.set(ParticleId(i as u32), Particle::at(DVec3::X * x)).unwrap();
                }
                let dt = factor * true_limit(method, &[(1.5, damping), (4.5, 3.0 * damping)]);
                let mut app = stepping_app(dt, 3000);
                let body = app.world_mut().spawn(body).id();
                app.update();
                let x: Vec<_> = crate::support::particles(&app, body).positions().map(|x| x.x).collect();
                let size = (x[1] - x[0] - 1.0).abs().max((x[2] - x[1] - 1.0).abs());
                assert_eq!(size > 1e-6, grows, "{method:?}, D {damping}, {factor} of the limit: {size:e}");
            }
        }
    }
}

#[test]
fn the_plan_follows_every_parameter() {
    let mut app = stepping_app(0.001, 1);
    let body = app.world_mut().spawn(Worm::GARDEN.body()).id();
    app.update();
    let limit = |app: &bevy::app::App| app.world().get::<Plan>(body).unwrap().stability_limit();
    let before = limit(&app);
    app.update();
    assert_eq!(limit(&app), before);

    let mut springs = app.world_mut().get_mut::<Springs>(body).unwrap();
    let stiff = Spring { stiffness: 1500.0, ..springs.get(wriggle::body::SpringId(0)).unwrap() };
    springs.set(wriggle::body::SpringId(0), stiff).unwrap();
    app.update();
    let stiffer = limit(&app);
    assert!(stiffer < before / 5.0, "{stiffer}");

    let mut particles = app.world_mut().get_mut::<Particles>(body).unwrap();
    for i in 0..3 {
        let heavy = Particle { mass: 100.0, ..particles.get(ParticleId(i)).unwrap() };
        particles.set(ParticleId(i), heavy).unwrap();
    }
    app.update();
    assert!(limit(&app) > 5.0 * stiffer, "{}", limit(&app));

    app.world_mut().entity_mut(body).insert(Method::RungeKutta4);
    let euler = limit(&app);
    app.update();
    assert_ne!(limit(&app), euler);
}

#[test]
fn the_plan_follows_a_parameter_while_the_app_is_paused() {
    use bevy::prelude::*;
    let mut app = crate::support::ticking_app(0.005, 3.0);
    let body = app.world_mut().spawn(Worm::GARDEN.body()).id();
    for _ in 0..5 {
        app.update();
    }
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    app.update();
    let step = app.world().resource::<wriggle::physics::Clock>().step();
    let mut springs = app.world_mut().get_mut::<Springs>(body).unwrap();
    for i in 0..2 {
        let id = wriggle::body::SpringId(i);
        let stiff = Spring { stiffness: 1500.0, ..springs.get(id).unwrap() };
        springs.set(id, stiff).unwrap();
    }
    app.update();
    assert_eq!(app.world().resource::<wriggle::physics::Clock>().step(), step);
    assert!(app.world().get::<Plan>(body).unwrap().stability_limit() < 0.05);
}

#[test]
fn springs_that_are_taut_for_a_while_raise_no_alarm() {
    for scene in ["cliff", "two-masses"] {
        let mut run = Headless::new(wriggle::scenes::load(scene).unwrap(), None).unwrap();
        let mut taut = false;
        for _ in 0..6 {
            run.step(1024);
            let clock = run.clock();
            for (name, body, _) in run.bodies() {
                let parts = body_parts(body).unwrap();
                taut |= parts.stability_limit(clock.time()) == 0.0;
                let limit = body.get::<Plan>().unwrap().stability_limit();
                assert!(clock.dt() <= limit && limit.is_finite(), "{scene}: {name} has the limit {limit}");
            }
        }
        assert!(taut, "{scene} has no taut spring");
    }
    // Nor does damping by mass, however weak: its limit is that of the springs, and a larger step is still too large.
    let particles = [DVec3::ZERO, DVec3::new(0.6, 0.8, 0.0)].map(Particle::at);
    let particles = Particles::new(particles).unwrap();
    let ends = [0, 1].map(ParticleId);
    for mass_damping in [None, MassDamping::rate(1e-6).ok()] {
        for (damping, least, most) in [(0.1, 0.05, 0.11), (0.0, 0.0, 1e-5)] {
            let spring = Spring { ends, stiffness: 1.0, damping, rest_length: 0.9 };
            let springs = Springs::new([spring], &particles).unwrap();
            let parts = BodyParts { mass_damping, ..BodyParts::new(&particles, &springs, Method::ExplicitEuler) };
            let strict = parts.stability_limit(0.0);
            assert!(strict < 1e-5, "{strict} with the damping {damping}, {mass_damping:?} by mass");
            let alarm = parts.alarm_limit(0.0);
            assert!((least..=most).contains(&alarm), "{alarm} with the damping {damping}, {mass_damping:?} by mass");
        }
    }
    // A body that no spring damps is still one that explicit Euler cannot step.
    let undamped = Worm { damping: 0.0, drag: 0.0, method: Method::ExplicitEuler, ..Worm::GARDEN }.body();
    assert_eq!(undamped.parts().alarm_limit(0.0), 0.0);
}
