//! Runs over the edge of stability: a body that stays just below it and explodes just above.

use bevy::math::DVec3;
use wriggle::{
    body::{Particle, ParticleId, Particles, Spring, SpringId, Springs},
    lab::limits::predicted_limit,
    mechanics::integrators::Method,
};

use crate::{
    failures::oscillator,
    limits::{RATIOS, closed_forms},
    support::Row,
};

/// How far any mass of a body comes from where it rests at worst, as a part of how far from there it begins, over so many steps.
fn worst(row: &Row, rest: &Particles, method: Method, dt: f64, steps: u64) -> f64 {
    let off = |particles: &Particles| {
        particles.positions().zip(rest.positions()).map(|(x, y)| (x - y).length()).fold(0.0, f64::max)
    };
    let mut worst = 0.0_f64;
    row.run(method, dt, steps, |_, body| {
        let now = off(body.particles);
        worst = worst.max(if now.is_nan() { f64::INFINITY } else { now });
    });
    worst / off(&row.particles)
}

#[test]
fn one_oscillator_stays_a_percent_below_the_edge_and_explodes_a_percent_above() {
    for method in Method::ALL {
        let Some(edges) = closed_forms(method) else { continue };
        for (zeta, edge) in RATIOS.into_iter().zip(edges) {
            // So small at first that it does not reach its pin with ten thousand times as much.
            let rest = oscillator(1.0, None).particles;
            let mut row = oscillator(1.0 + 1e-6, None);
            let spring = row.springs.get(SpringId(0)).unwrap();
            row.springs.set(SpringId(0), Spring { damping: 2.0 * zeta, ..spring }).unwrap();
            let worst = |theta, steps| worst(&row, &rest, method, theta, steps);
            if edge > 0.0 {
                // Undamped, it comes to 1/√(1 − θ²/4) as far within its bounds; where both roots of the step are one, n·rⁿ is large before it is small.
                let stays = worst(if edge.is_finite() { 0.99 * edge } else { 1000.0 }, 3000);
                assert!(stays < 100.0, "{method:?}, ζ {zeta}: × {stays} below {edge}");
            }
            if edge.is_finite() {
                // Explicit Euler adds only 2·10⁻⁴ in a step above its edge at ζ = 0.1; where the edge is 0, any step is above it.
                let theta = if edge == 0.0 { 0.5 } else { 1.01 * edge };
                let explodes = [3000, 60_000].into_iter().any(|steps| worst(theta, steps) > 1e4);
                assert!(explodes, "{method:?}, ζ {zeta}: stays within ten thousand times above {edge}");
            }
        }
    }
}

/// Three masses in a row, the last of them of `mass`, on springs of stiffness 1 and `stiffness`, a little out of rest, and where they rest.
fn uneven(stiffness: f64, mass: f64) -> (Row, Particles) {
    let place = |off: [f64; 3]| {
        let at = |i: usize| Particle { mass: [1.0, 1.0, mass][i], ..Particle::at(DVec3::X * (i as f64 + off[i])) };
        Particles::new((0..3).map(at)).unwrap()
    };
    let (rest, start) = (place([0.0; 3]), place([1e-6, -0.4e-6, 0.8e-6]));
    let spring = |i: u32| Spring {
        ends: [ParticleId(i), ParticleId(i + 1)],
        stiffness: [1.0, stiffness][i as usize],
        damping: 0.0,
        rest_length: 1.0,
    };
    let springs = Springs::new([0, 1].map(spring), &rest).unwrap();
    (Row::new(start, springs), rest)
}

#[test]
fn one_stiff_spring_or_light_mass_costs_an_explicit_method_the_root_of_the_ratio() {
    for method in [Method::SemiImplicitEuler, Method::StormerVerlet, Method::Leapfrog, Method::RungeKutta4] {
        // Steps a unit of time at the edge: it stays at 0.95 of the limit and explodes at 1.1 of it.
        let steps = |stiffness, mass| {
            let (row, rest) = uneven(stiffness, mass);
            let limit = predicted_limit(&row.parts(method)).unwrap();
            let [stays, explodes] = [0.95, 1.1].map(|part| worst(&row, &rest, method, part * limit, 2000));
            let near = stays < 30.0 && explodes > 1e3;
            assert!(near, "{method:?}, {stiffness}, {mass}: × {stays} below {limit}, × {explodes} above");
            1.0 / limit
        };
        // Of equal masses and springs ω² is 3, of the stiff spring alone 2k, and of the light mass alone k/m.
        let even = steps(1.0, 1.0);
        let cost = [(1e6, 1.0, 1e3 * f64::sqrt(2.0 / 3.0)), (1.0, 1e-4, 1e2 * f64::sqrt(1.0 / 3.0))];
        for (stiffness, mass, expected) in cost {
            let found = steps(stiffness, mass) / even;
            assert!((found / expected - 1.0).abs() < 1e-3, "{method:?}: × {found}, expected × {expected}");
        }
    }
    // What solves for where a step ends takes the steps of the soft body.
    for method in [Method::ImplicitMidpoint, Method::ImplicitEuler, Method::Xpbd] {
        for (stiffness, mass) in [(1e6, 1.0), (1.0, 1e-4)] {
            let (row, rest) = uneven(stiffness, mass);
            let stays = worst(&row, &rest, method, 1.0, 2000);
            assert!(stays < 30.0, "{method:?}, {stiffness}, {mass}: × {stays}");
        }
    }
}
