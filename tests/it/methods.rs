//! Every method against exact solutions: order, exactness, and what is called unconditionally stable.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{Particle, ParticleId, Particles, Spring, Springs},
    lab::{Problem, Reference},
    mechanics::integrators::{Method, StickRule},
    physics::{Cost, Frozen},
    scenes,
};

use crate::support::{Worm, follow, in_space, particles, stepping_app};

/// Positions and velocities along x.
fn columns(particles: &Particles) -> Vec<f64> {
    particles.positions().chain(particles.velocities()).map(|vector| vector.x).collect()
}

/// The worm at t = 20, after steps of `dt`.
fn worm_at_20(worm: Worm, stick: StickRule, dt: f64) -> Vec<f64> {
    worm_at(20.0, worm, stick, dt)
}

fn worm_at(time: f64, worm: Worm, stick: StickRule, dt: f64) -> Vec<f64> {
    let mut app = stepping_app(dt, (time / dt).round() as u64);
    let body = app.world_mut().spawn((worm.body(), stick)).id();
    app.update();
    assert!(app.world().get::<Frozen>(body).is_none(), "{worm:?}: {:?}", app.world().get::<Frozen>(body));
    columns(particles(&app, body))
}

fn farthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_exact_flow_is_exact_whatever_the_step() {
    let known = [3.058918927290, 3.994998746503, 5.085548685141, 0.232059061039, 0.202115095212, 0.063038244008];
    let worm = Worm { method: Method::ExactFlow, ..Worm::EXACT };
    for dt in [20.0, 0.5, 0.05, 0.01] {
        let error = farthest(&worm_at_20(worm, StickRule::InStages, dt), &known);
        assert!(error < 1e-11, "{error:e} at dt {dt}");
    }
}

#[test]
fn the_exact_flow_is_the_reference_at_every_shared_time() {
    for problem in [crate::lab::worm(Worm::EXACT.body()), Problem::of(&scenes::load("garden").unwrap()).unwrap()] {
        let reference = Reference::solve(&problem).unwrap();
        let body = problem.bodies[0].parts(Method::ExactFlow, StickRule::InStages);
        let (mut sample, mut worst) = (0, 0.0_f64);
        follow::<1>(&body, problem.spacing(), 1000, |time, body| {
            assert!((time - problem.times()[sample]).abs() < 1e-12);
            let pairs = body.particles.positions().zip(reference.positions(0, sample));
            worst = pairs.map(|(x, y)| x.distance(*y)).fold(worst, f64::max);
            sample += 1;
        });
        // The bound of the truth is 10⁻⁹; of the confirmed reference, what rounding leaves.
        assert!(sample == 1000 && worst < 1e-11, "{}: {worst:e}", problem.name);
    }
}

#[test]
fn the_exact_flow_knows_ramp_drag_and_squares() {
    use wriggle::body::{Muscle, Muscles, SpringId, Wave};
    // What converges to it knows nothing of its polynomials and events. Runge–Kutta with small steps is as near as its unlocated events let it.
    for wave in [Wave::Sine, Wave::Square] {
        let body = |method| {
            let mut body = Worm { method, ..Worm::GARDEN }.body();
            let muscle = |i: u32| Muscle {
                wave,
                ..Muscle {
                    spring: SpringId(i),
                    wave,
                    amplitude: 0.3,
                    period: 6.0,
                    phase: 0.25 * f64::from(i),
                    ramp: 1.0,
                }
            };
            body.muscles = Muscles::new((0..2).map(muscle), &body.springs).unwrap();
            body
        };
        let run = |method, dt: f64| {
            let mut app = stepping_app(dt, (18.0 / dt).round() as u64);
            let entity = app.world_mut().spawn(body(method)).id();
            app.update();
            columns(particles(&app, entity))
        };
        let (exact, other) = (run(Method::ExactFlow, 0.3), run(Method::RungeKutta4, 0.0005));
        assert!(farthest(&exact, &run(Method::ExactFlow, 0.05)) < 1e-11, "{wave:?}: steps of the flow matter");
        let error = farthest(&exact, &other);
        // A square wave switches within a step.
        let bound = if wave == Wave::Sine { 1e-6 } else { 1e-3 };
        assert!(error < bound, "{wave:?}: {error:e}");
    }
}

#[test]
fn the_exact_flow_of_stiff_worms_follows_every_event_to_the_end() {
    // Rounding once turned resting masses to and fro without end where stiff springs start at rest.
    for factor in [10.0, 1e3] {
        let stiff = |method| Worm { stiffness: 1.5 * factor, damping: 0.9 * f64::sqrt(factor), method, ..Worm::GARDEN };
        let exact = worm_at(12.0, stiff(Method::ExactFlow), StickRule::InStages, 0.3);
        let steps = farthest(&exact, &worm_at(12.0, stiff(Method::ExactFlow), StickRule::InStages, 0.05));
        assert!(steps < 1e-11, "× {factor}: steps of the flow matter: {steps:e}");
        let error = farthest(&exact, &worm_at(12.0, stiff(Method::RungeKutta4), StickRule::Located, 0.002));
        assert!(error < 1e-7, "× {factor}: {error:e}");
    }
}

#[test]
fn every_method_has_its_order() {
    // Smooth: no friction, the muscles driving. Damping makes Verlet's methods see an old velocity: first order.
    for damping in [0.0, 0.9] {
        for method in Method::ALL {
            let worm = Worm { method, damping, ratchet: false, drag: 0.0, ..Worm::EXACT };
            let exact = worm_at(4.0, Worm { method: Method::ExactFlow, ..worm }, StickRule::InStages, 0.5);
            let order = match method {
                Method::ExactFlow => continue,
                Method::StormerVerlet | Method::DampedVerlet if damping > 0.0 => 1,
                method => method.about().order,
            };
            let first = if order == 1 { 0.004 } else { 0.05 };
            let errors: Vec<_> = (0..4)
                .map(|halvings| worm_at(4.0, worm, StickRule::InStages, first / f64::from(1 << halvings)))
                .map(|end| farthest(&end, &exact))
                .collect();
            for pair in errors.windows(2) {
                let observed = libm::log2(pair[0] / pair[1]);
                assert!((observed - f64::from(order)).abs() < 0.1, "{method:?}, D {damping}: {observed} of {errors:?}");
            }
        }
    }
}

#[test]
fn friction_at_the_end_of_the_step_makes_every_method_first_order() {
    let exact = worm_at_20(Worm { method: Method::ExactFlow, ..Worm::EXACT }, StickRule::InStages, 0.5);
    for method in [Method::RungeKutta4, Method::RungeKutta2, Method::Leapfrog, Method::ImplicitMidpoint] {
        let worm = Worm { method, ..Worm::EXACT };
        let error = |stick, dt| farthest(&worm_at_20(worm, stick, dt), &exact);
        let (coarse, fine) = (error(StickRule::EndOfStep, 0.01), error(StickRule::EndOfStep, 0.0025));
        let order = libm::log2(coarse / fine) / 2.0;
        assert!((0.7..1.3).contains(&order), "{method:?}: order {order}");
        assert!(error(StickRule::InStages, 0.01) < 0.2 * coarse, "{method:?} gains from the rule in its stages");
    }
}

#[test]
fn located_events_keep_the_order() {
    // Over the first three events: at .368 C slips, at .836 A slips, at 1.008 B sticks.
    let exact = worm_at(1.4, Worm { method: Method::ExactFlow, ..Worm::EXACT }, StickRule::InStages, 1.4);
    for method in Method::ALL.into_iter().filter(|method| method.locates()) {
        let worm = Worm { method, ..Worm::EXACT };
        let error =
            |halvings| farthest(&worm_at(1.4, worm, StickRule::Located, 0.05 / f64::from(1 << halvings)), &exact);
        let errors: Vec<_> = (0..4).map(error).collect();
        let observed = libm::log2(errors[0] / errors[3]) / 3.0;
        let order = f64::from(method.about().order);
        assert!((observed - order).abs() < 0.1, "{method:?}: order {observed} of {errors:?}");
    }
}

#[test]
fn located_events_keep_the_order_across_the_ends_of_ramps_and_the_switches_of_square_waves() {
    use wriggle::body::{Muscle, Muscles, Wave};
    // A ramp ends at 6, square waves switch at 1.5, 3, 4.5, 6 and 7.5: within steps, by all of these.
    let end = |method, wave, dt: f64| {
        let mut body = Worm { method, ..Worm::GARDEN }.body();
        let muscles: Vec<_> = body.muscles.iter().map(|muscle| Muscle { wave, ..muscle }).collect();
        body.muscles = Muscles::new(muscles, &body.springs).unwrap();
        let mut app = stepping_app(dt, (9.0 / dt).round() as u64);
        let entity = app.world_mut().spawn((body, StickRule::Located)).id();
        app.update();
        columns(particles(&app, entity))
    };
    for wave in [Wave::Sine, Wave::Square] {
        let exact = end(Method::ExactFlow, wave, 9.0);
        for method in Method::ALL.into_iter().filter(|method| method.locates()) {
            let error = |halvings| farthest(&end(method, wave, 9.0 / f64::from(91 << halvings)), &exact);
            let errors: Vec<_> = (0..5).map(error).collect();
            let observed = libm::log2(errors[0] / errors[4]) / 4.0;
            let order = f64::from(method.about().order);
            assert!((observed - order).abs() < 0.1, "{wave:?}, {method:?}: order {observed} of {errors:?}");
        }
    }
}

/// Three masses in a triangle whose spine turns while friction holds some of them, in space.
fn triangle(method: Method, stick: StickRule, dt: f64) -> Vec<f64> {
    use wriggle::body::{Muscle, Muscles, SpineFriction, SpringId, Wave};
    let corners = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.6), DVec3::new(2.0, 0.0, 0.0)];
    let body = Particles::new(corners.map(Particle::at)).unwrap();
    let spring = |a: usize, b: usize| Spring {
        ends: [ParticleId(a as u32), ParticleId(b as u32)],
        stiffness: 1.5,
        damping: 0.4,
        rest_length: corners[a].distance(corners[b]),
    };
    let springs = Springs::new([spring(0, 1), spring(1, 2), spring(0, 2)], &body).unwrap();
    let muscle = |(i, phase): (u32, f64)| Muscle {
        spring: SpringId(i),
        wave: Wave::Sine,
        amplitude: 0.3,
        period: 4.0,
        phase,
        ramp: 0.0,
    };
    let muscles = Muscles::new([(0, 0.0), (1, 0.25), (2, 0.6)].map(muscle), &springs).unwrap();
    let friction = SpineFriction::new((0..3).map(ParticleId), &body).unwrap();
    let mut app = stepping_app(dt, (8.0 / dt).round() as u64);
    let entity = app.world_mut().spawn((body, springs, muscles, friction, method, stick)).id();
    app.update();
    let particles = particles(&app, entity);
    particles.positions().chain(particles.velocities()).flat_map(|v| v.to_array()).collect()
}

#[test]
fn located_events_keep_the_order_where_a_held_spine_turns() {
    let fine = triangle(Method::RungeKutta4, StickRule::Located, 1.0 / 1024.0);
    // What goes to the same place, by first order, does not locate anything.
    let other = |dt| farthest(&triangle(Method::RungeKutta2, StickRule::InStages, dt), &fine);
    let (coarse, half) = (other(1.0 / 512.0), other(1.0 / 1024.0));
    assert!(half < 1e-3 && (libm::log2(coarse / half) - 1.0).abs() < 0.2, "{coarse:e}, {half:e}");
    for method in Method::ALL.into_iter().filter(|method| method.locates()) {
        let error =
            |halvings| farthest(&triangle(method, StickRule::Located, 0.0625 / f64::from(1 << halvings)), &fine);
        let errors: Vec<_> = (0..4).map(error).collect();
        let observed = libm::log2(errors[0] / errors[3]) / 3.0;
        let order = f64::from(method.about().order);
        assert!((observed - order).abs() < 0.4, "{method:?}: order {observed} of {errors:?}");
    }
}

#[test]
fn a_mass_that_stops_within_a_step_comes_to_true_rest() {
    // How much of the time each mass of the garden's worm rests, by the exact flow: .225, .275, .343.
    for method in Method::ALL {
        if [Method::ExplicitEuler, Method::ImplicitEuler, Method::Xpbd].contains(&method) {
            // At this step they crawl another way.
            continue;
        }
        let mut app = stepping_app(0.1, 1);
        let body = app.world_mut().spawn(Worm { method, ..Worm::GARDEN }.body()).id();
        let mut rests = [0; 3];
        for step in 0..600 {
            app.update();
            for (rests, velocity) in rests.iter_mut().zip(particles(&app, body).velocities()) {
                *rests += i32::from(step >= 300 && velocity == DVec3::ZERO);
            }
        }
        for (rests, exact) in rests.into_iter().zip([0.225, 0.275, 0.343]) {
            let part = f64::from(rests) / 300.0;
            assert!((part - exact).abs() < 0.06, "{method:?}: rests {part} of the time, exactly {exact}");
        }
    }
}

#[test]
fn what_no_step_makes_unstable_stays_bounded_a_thousand_times_beyond() {
    // ω·dt = 1000 for the fastest mode, ω² = 3k/m, with the muscles running.
    let dt = 0.05;
    for method in Method::ALL
        .into_iter()
        .filter(|method| Worm { method: *method, ..Worm::EXACT }.body().parts().stability_limit(0.0).is_infinite())
    {
        let stiffness = (1000.0 / dt) * (1000.0 / dt) / 3.0;
        for damping in [0.0, 0.9, 1e4] {
            // The exact flow follows every oscillation; a few steps of it say as much.
            let steps = if method == Method::ExactFlow { 5 } else { 2000 };
            let mut app = stepping_app(dt, steps);
            let mut worm = Worm { method, stiffness, damping, ..Worm::EXACT }.body();
            // It starts as its muscles want it: stiff springs that start stretched would rightly throw it far.
            for (i, (x, v)) in [(0.0, 0.0), (1.0, 0.25), (1.75, 0.25)].into_iter().enumerate() {
                let velocity = DVec3::X * v * core::f64::consts::PI;
                worm.particles.set(ParticleId(i as u32), Particle { velocity, ..Particle::at(DVec3::X * x) }).unwrap();
            }
            let body = app.world_mut().spawn(worm).id();
            app.update();
            assert!(app.world().get::<Frozen>(body).is_none(), "{method:?}, D {damping}");
            let x: Vec<_> = particles(&app, body).positions().map(|x| x.x).collect();
            for length in [x[1] - x[0], x[2] - x[1]] {
                assert!((0.4..1.6).contains(&length), "{method:?}, D {damping}: length {length}");
            }
        }
    }
}

#[test]
fn a_step_that_does_not_converge_is_refused_by_name() {
    for method in [Method::ImplicitEuler, Method::ImplicitMidpoint] {
        let ends =
            [Particle::at(DVec3::ZERO), Particle { velocity: DVec3::new(1e200, 1e200, 0.0), ..Particle::at(DVec3::X) }];
        let body = Particles::new(ends).unwrap();
        let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness: 1.0, damping: 0.0, rest_length: 1.0 };
        let springs = Springs::new([spring], &body).unwrap();
        let mut app = stepping_app(0.1, 3);
        let entity = app.world_mut().spawn((body.clone(), springs, method)).id();
        app.update();
        let frozen = app.world().get::<Frozen>(entity).unwrap();
        assert!(frozen.reason.contains(method.name()) && frozen.reason.contains("converge"), "{}", frozen.reason);
        assert_eq!((frozen.step, particles(&app, entity)), (1, &body), "it stays where it was");
    }
}

#[test]
fn the_exact_flow_refuses_what_is_not_on_an_axis() {
    let mut app = stepping_app(0.1, 3);
    let body = Worm { method: Method::ExactFlow, ..Worm::GARDEN }.body().moved(DVec3::ZERO, 0.4);
    let entity = app.world_mut().spawn(body).id();
    app.update();
    assert!(app.world().get::<Frozen>(entity).unwrap().reason.contains("on an axis"));
}

#[test]
fn the_same_force_is_one_evaluation_in_every_method() {
    for method in Method::ALL.into_iter().filter(|method| method.about().evaluations.is_some()) {
        let mut app = stepping_app(0.01, 100);
        app.world_mut().spawn(Worm { method, ..Worm::GARDEN }.body());
        app.update();
        let evaluations = app.world().resource::<Cost>().force_evaluations;
        assert_eq!(Some(evaluations), method.about().evaluations.map(|each| 100 * each), "{method:?}");
    }
}

#[test]
fn damped_verlet_takes_its_part_of_the_velocity_in_each_step() {
    use wriggle::body::MassDamping;
    // A mass alone, against the closed forms: e^(−ct) for a rate, (1 − λ)^n for a part.
    for method in in_space() {
        let coasting = |damping| {
            let mut app = stepping_app(0.01, 100);
            let particle = Particle { velocity: DVec3::X, ..Particle::at(DVec3::ZERO) };
            let body = (Particles::new([particle]).unwrap(), Springs::default(), method, damping);
            let entity = app.world_mut().spawn(body).id();
            app.update();
            particles(&app, entity).velocity(ParticleId(0)).unwrap().x
        };
        let rate = coasting(MassDamping::rate(0.7).unwrap());
        let exact = libm::exp(-0.7);
        let bound = if method == Method::DampedVerlet { 1e-14 } else { 2e-3 };
        assert!((rate - exact).abs() < bound, "{method:?}: {rate} for {exact}");
        let part = coasting(MassDamping::per_step(0.05).unwrap());
        let exact = libm::pow(0.95, 100.0);
        assert!((part - exact).abs() < if method == Method::DampedVerlet { 1e-14 } else { 1e-3 }, "{method:?}: {part}");
    }
    assert!(MassDamping::per_step(1.0).is_err() && MassDamping::rate(-0.1).is_err());
}

#[test]
fn an_event_at_the_very_end_of_a_step_ends_it() {
    // With this step the pieces of one add up to more than the whole, by a rounding error.
    let folder = tempfile::tempdir().unwrap();
    let distance = |dt: &str, time: &str| {
        let scene = include_str!("../../assets/scenes/sand.scene.ron").replace("dt: 0.022", &format!("dt: {dt}"));
        let scene = scene.replace("method: StormerVerlet, stick: EndOfStep", "method: RungeKutta2, stick: Located");
        assert!(scene.contains(dt) && scene.contains("Located"));
        let file = folder.path().join("sand.scene.ron");
        std::fs::write(&file, scene).unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_wriggle"));
        let output = command.arg("run").arg(&file).args(["--json", "--for", time]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        found["bodies"][0]["distance"].as_f64().unwrap()
    };
    let (plain, at_the_end) = (distance("0.04", "199.92"), distance("0.042", "199.92"));
    assert!(plain > 1.0 && (at_the_end / plain - 1.0).abs() < 0.02, "{at_the_end} and {plain}");
}
