//! The garden worm's gait: A1 to A4 of its acceptance tests, at a step twenty times finer than it needs.

use bevy::prelude::*;
use wriggle::{
    body::Muscles,
    creatures::{
        Pose,
        library::{self, CREATURE},
    },
    physics::Clock,
};

use crate::support::{Worm, center, particles, run_until, stepping_app};

const DT: f64 = 0.005;
const CYCLE: f64 = 6.0;

fn worm_app(worm: Worm, steps: u64) -> (App, Entity) {
    let mut app = stepping_app(DT, steps);
    let body = app.world_mut().spawn(worm.body()).id();
    (app, body)
}

/// Distance a cycle over the last five of `cycles`.
fn gait(worm: Worm, cycles: f64) -> f64 {
    let (mut app, body) = worm_app(worm, 100);
    run_until(&mut app, (cycles - 5.0) * CYCLE);
    let before = center(&app, body);
    run_until(&mut app, cycles * CYCLE);
    (center(&app, body) - before) / 5.0
}

#[test]
fn the_shipped_garden_worm_is_the_one_of_these_tests() {
    let shipped = library::read_creature(&library::find(CREATURE, "garden-worm", None).unwrap()).unwrap();
    assert_eq!((shipped.gravity, &shipped.ground, &shipped.coulomb), (None, &None, &None));
    let (shipped, tested) = (shipped.body(Pose::default()).unwrap(), Worm::GARDEN.body());
    assert_eq!((&shipped.particles, &shipped.springs), (&tested.particles, &tested.springs));
    assert_eq!((shipped.muscles, shipped.friction), (Some(tested.muscles), Some(tested.friction)));
    assert!(shipped.damping.is_none() && shipped.tearing.is_none());
}

/// Speed of gliding without drag, in closed form: the largest velocity amplitude of a mass about the centre of mass, over a cycle.
fn glide(worm: Worm) -> f64 {
    type Complex = (f64, f64);
    let mul = |a: Complex, b: Complex| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let sub = |a: Complex, b: Complex| (a.0 - b.0, a.1 - b.1);
    let scale = |s: f64, a: Complex| (s * a.0, s * a.1);
    let div = |a: Complex, b: Complex| {
        let n = b.0 * b.0 + b.1 * b.1;
        ((a.0 * b.0 + a.1 * b.1) / n, (a.1 * b.0 - a.0 * b.1) / n)
    };
    let omega = core::f64::consts::TAU / worm.period;
    let k = (worm.stiffness, omega * worm.damping);
    let (a1, a2) = ((worm.amplitude, 0.0), {
        let angle = -core::f64::consts::TAU * worm.phase;
        (worm.amplitude * libm::cos(angle), worm.amplitude * libm::sin(angle))
    });
    // (2K − ω²)q₁ − K q₂ = k(2a₁ − a₂), −K q₁ + (2K − ω²)q₂ = k(2a₂ − a₁), by Cramer's rule.
    let diagonal = sub(scale(2.0, k), (omega * omega, 0.0));
    let (r1, r2) = (scale(worm.stiffness, sub(scale(2.0, a1), a2)), scale(worm.stiffness, sub(scale(2.0, a2), a1)));
    let determinant = sub(mul(diagonal, diagonal), mul(k, k));
    let add = |a: Complex, b: Complex| (a.0 + b.0, a.1 + b.1);
    let q1 = div(add(mul(diagonal, r1), mul(k, r2)), determinant);
    let q2 = div(add(mul(diagonal, r2), mul(k, r1)), determinant);
    let u = [
        scale(-1.0 / 3.0, add(scale(2.0, q1), q2)),
        scale(1.0 / 3.0, sub(q1, q2)),
        scale(1.0 / 3.0, add(q1, scale(2.0, q2))),
    ];
    core::f64::consts::TAU * u.iter().map(|u| libm::hypot(u.0, u.1)).fold(0.0, f64::max)
}

#[test]
fn a1_without_drag_the_worm_comes_to_glide_at_the_predicted_speed() {
    let worm = Worm { drag: 0.0, ..Worm::GARDEN };
    let (predicted, d) = (glide(worm), gait(worm, 60.0));
    assert!((predicted - 2.1933).abs() < 1e-4, "the formula itself: {predicted}");
    assert!((d / predicted - 1.0).abs() < 0.01, "glides {d} a cycle, predicted {predicted}");
}

#[test]
fn a2_with_drag_it_crawls_and_every_mass_rests_once_a_cycle() {
    let d = gait(Worm::GARDEN, 40.0);
    assert!((d / 0.7023 - 1.0).abs() < 0.02, "crawls {d} a cycle");

    // Some three hundred looks a cycle.
    const STEPS: usize = 4;
    let (mut app, body) = worm_app(Worm::GARDEN, STEPS as u64);
    let (mut rests, mut looks) = ([0_u32; 3], 0_u32);
    for step in (0..(40.0 * CYCLE / DT) as usize).step_by(STEPS) {
        app.update();
        let masses = particles(&app, body);
        let x: Vec<_> = masses.positions().map(|x| x.x).collect();
        assert!(x[0] < x[1] && x[1] < x[2], "order lost at step {step}: {x:?}");
        if step as f64 * DT >= 35.0 * CYCLE {
            looks += 1;
            for (rest, v) in rests.iter_mut().zip(masses.velocities()) {
                *rest += u32::from(v.x == 0.0);
            }
        }
    }
    for (mass, rest) in rests.iter().enumerate() {
        let share = f64::from(*rest) / f64::from(looks);
        assert!((0.20..=0.38).contains(&share), "mass {mass} rests {share} of the cycle");
    }
}

#[test]
fn a3_without_friction_it_goes_nowhere() {
    let d = gait(Worm { ratchet: false, drag: 0.0, ..Worm::GARDEN }, 20.0);
    assert!(d.abs() < 1e-4, "moves {d} a cycle");
}

#[test]
fn a4_when_its_muscles_stop_only_drag_stops_it() {
    for (drag, cycles) in [(0.0, 25.0), (0.5, 25.0)] {
        let (mut app, body) = worm_app(Worm { drag, ..Worm::GARDEN }, 100);
        run_until(&mut app, 120.0);
        let time = app.world().resource::<Clock>().time();
        let mut muscles = app.world_mut().get_mut::<Muscles>(body).unwrap();
        for i in 0..2 {
            let muscle = muscles.get(i).unwrap();
            muscles.set(i, wriggle::body::Muscle { amplitude: 0.0, ..muscle }, time).unwrap();
        }
        run_until(&mut app, cycles * CYCLE);
        let speed = |app: &App| particles(app, body).velocities().map(|v| v.x).sum::<f64>() / 3.0;
        let (x, v) = (center(&app, body), speed(&app));
        run_until(&mut app, 30.0 * CYCLE);
        if drag == 0.0 {
            assert!(v > 0.1 && (speed(&app) / v - 1.0).abs() < 0.01, "coasts at {v}, then {}", speed(&app));
        } else {
            assert!((center(&app, body) - x).abs() < 0.01, "creeps on by {}", center(&app, body) - x);
        }
    }
}

#[test]
fn the_wave_may_run_either_way() {
    let there = gait(Worm::GARDEN, 20.0);
    let back = gait(Worm { phase: -0.25, ..Worm::GARDEN }, 20.0);
    assert!((there / back - 1.0).abs() < 1e-3, "{there} and {back}");
}

#[test]
fn a_changed_period_does_not_make_the_wave_jump() {
    let (mut app, body) = worm_app(Worm::GARDEN, 100);
    run_until(&mut app, 50.5);
    let time = app.world().resource::<Clock>().time();
    let rest = |app: &App, i| {
        let world = app.world();
        wriggle::mechanics::rest_length(
            world.get::<wriggle::body::Springs>(body).unwrap(),
            world.get::<Muscles>(body),
            wriggle::body::SpringId(i),
            time,
        )
    };
    let before = [rest(&app, 0), rest(&app, 1)];
    let mut muscles = app.world_mut().get_mut::<Muscles>(body).unwrap();
    for i in 0..2 {
        let muscle = muscles.get(i).unwrap();
        muscles.set(i, wriggle::body::Muscle { period: 3.7, ..muscle }, time).unwrap();
    }
    for (i, before) in (0..).zip(before) {
        assert!((rest(&app, i) - before).abs() < 1e-12);
    }
}
