//! The hand: what it does to steps, and what it lifts.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{Lattice, MassDamping, Neighbours, Particle, ParticleId, Particles, Pull, Springs},
    creatures::JellyPlan,
    mechanics::{
        BodyParts, elastic_energy,
        integrators::{Method, StickRule},
        kinetic_energy,
    },
    physics::{Clock, Frozen, Plan, body_parts},
};

use crate::{
    jelly::{app_of, cube, falling},
    support::{Row, Worm, follow, in_space, particles},
};

#[test]
fn a_hand_moves_a_mass_alone_as_a_critically_damped_spring_with_the_mass_of_both() {
    // κ = m = 1: D = 2√(m + a) and a = dt·D; 1 − (1 + ωt)·e^(−ωt) of the way with ω² = κ/(m + a).
    let late = |dt: f64, steps: u64| {
        let (mut app, block) = app_of(cube(1, &[], 0.0), Method::RungeKutta4, dt, steps);
        let start = particles(&app, block).position(ParticleId(0)).unwrap();
        let way = DVec3::X * 2.0;
        app.world_mut().entity_mut(block).insert(Pull { particle: ParticleId(0), target: start + way });
        let hand = 2.0 * dt * (dt + (dt * dt + 1.0).sqrt());
        let omega = 1.0 / (1.0 + hand).sqrt();
        let mut late = 0.0_f64;
        for _ in 0..5 {
            app.update();
            let t = app.world().resource::<Clock>().time();
            let done = |omega: f64| 1.0 - (1.0 + omega * t) * libm::exp(-omega * t);
            let at = particles(&app, block).position(ParticleId(0)).unwrap();
            assert!((at - start - way * done(omega)).length() < 1e-6, "{at} at {t}");
            late = late.max((at - start - way * done(1.0)).length());
        }
        late
    };
    // The smaller the step, the lighter the hand.
    let ratio = late(0.01, 100) / late(0.005, 200);
    assert!((1.9..2.1).contains(&ratio), "{ratio}");
}

#[test]
fn the_exact_flow_follows_a_hand_to_its_cap_and_from_it() {
    // κ = m = 1 and D = 2, the most is 4: x = 2t² while 10 − 2t² − 8t > 4, and critically damped from then on.
    let particles = Particles::new([Particle::at(DVec3::ZERO)]).unwrap();
    let row = Row::new(particles.clone(), Springs::new([], &particles).unwrap());
    let damped = |x: f64, v: f64, to: f64, t: f64| to + (x - to + (v + x - to) * t) * libm::exp(-t);
    let free = 7.0_f64.sqrt() - 2.0;
    for (to, sign) in [(3.0, 1.0), (10.0, 1.0), (10.0, -1.0)] {
        let exact = |t: f64| match to > 4.0 {
            true if t < free => 2.0 * t * t,
            true => damped(2.0 * free * free, 4.0 * free, to, t - free),
            false => damped(0.0, 0.0, to, t),
        };
        for (dt, steps) in [(12.0, 1), (0.7, 20), (0.01, 500)] {
            let pull = Pull { particle: ParticleId(0), target: DVec3::X * to * sign };
            let body = BodyParts { pull: Some(pull), ..row.parts(Method::ExactFlow) };
            follow::<1>(&body, dt, steps, |t, body| {
                let at = sign * body.particles.position(ParticleId(0)).unwrap().x;
                assert!((at - exact(t)).abs() < 1e-12 * to, "to {to} in steps of {dt}: {at} at {t}, not {}", exact(t));
            });
        }
    }
}

#[test]
fn a_worm_in_the_hand_goes_the_same_way_by_every_step_of_the_exact_flow_and_by_small_ones_of_others() {
    // By its tail; by its head, beyond the cap; by its middle; and back, where no ratchet holds it.
    let back = Worm { ratchet: false, drag: 0.5, ..Worm::EXACT };
    for (worm, mass, to) in [(Worm::EXACT, 0, 4.0), (Worm::EXACT, 2, 9.0), (Worm::EXACT, 1, 2.5), (back, 1, -6.0)] {
        let at_8 = |method: Method, dt: f64| {
            let worm = Worm { method, ..worm }.body();
            let pull = Pull { particle: ParticleId(mass), target: DVec3::X * to };
            let body = BodyParts { pull: Some(pull), stick: StickRule::Located, ..worm.parts() };
            let mut last = [0.0; 3];
            follow::<1>(&body, dt, (8.0 / dt).round() as u64, |_, body| {
                last = core::array::from_fn(|i| body.particles.position(ParticleId(i as u32)).unwrap().x);
            });
            last
        };
        let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        let exact = at_8(Method::ExactFlow, 8.0);
        for dt in [1.0, 0.16, 0.01] {
            let error = apart(at_8(Method::ExactFlow, dt), exact);
            assert!(error < 1e-10, "mass {mass} to {to}: {error:e} in steps of {dt}");
        }
        // Others give the hand a mass in proportion to the step.
        let errors = [0.002, 0.001].map(|dt| apart(at_8(Method::RungeKutta4, dt), exact));
        let order = (errors[0] / errors[1]).log2();
        assert!(errors[1] < 0.02 && (0.9..1.1).contains(&order), "mass {mass} to {to}: {errors:?}");
    }
}

/// The particles in the middle of a face, of an edge, at a corner and inside of a cube.
fn places(lattice: Lattice) -> [ParticleId; 4] {
    let last = lattice.size()[0] as u32 - 1;
    let middle = last / 2;
    let places = [[middle, last, middle], [last, last, middle], [last; 3], [middle; 3]];
    places.map(|place| lattice.particle(place))
}

/// The largest energies of a free block that is pulled by one mass, in a stretch in the hand and in three stretches after it was let go.
fn energies(method: Method, damping: f64, part: f64, place: usize) -> [f64; 4] {
    // Steps with a solver take a hundred times as long.
    let (count, ticks) = if method.asks_forces_alone() { (5, 100) } else { (3, 20) };
    let plan = cube(count, &Neighbours::ALL, damping);
    let (mut app, block) = app_of(plan, method, 1e-3, 1);
    app.update();
    let limit = app.world().get::<Plan>(block).unwrap().stability_limit();
    // What no step makes unstable takes those at which others become so.
    let dt = if limit.is_finite() { part * limit } else { 0.5 };
    app.world_mut().resource_mut::<Clock>().set_dt(dt).unwrap();
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(4);
    let particle = places(*app.world().get::<Lattice>(block).unwrap())[place];
    let target = particles(&app, block).position(particle).unwrap() + DVec3::new(0.4, 1.5, -0.3);
    app.world_mut().entity_mut(block).insert(Pull { particle, target });
    let energy = |app: &App| {
        let frozen = app.world().get::<Frozen>(block);
        assert!(frozen.is_none(), "{method:?}, place {place}: {frozen:?}");
        let parts = body_parts(app.world().entity(block)).unwrap();
        kinetic_energy(parts.particles) + elastic_energy(&parts, 0.0)
    };
    core::array::from_fn(|stretch| {
        if stretch == 1 {
            app.world_mut().entity_mut(block).remove::<Pull>();
        }
        let ticks = (0..ticks).map(|_| {
            app.update();
            energy(&app)
        });
        ticks.fold(0.0, f64::max)
    })
}

#[test]
fn a_hand_makes_no_step_unstable_that_the_body_bears() {
    for method in in_space() {
        // Damped, so that explicit Euler and RK2 have a limit, too.
        for place in 0..4 {
            let [held, first, second, third] = energies(method, 0.2, 0.9, place);
            // The hand does no more work than its spring of at most 6.5 holds, drawn out by 1.6 lengths.
            assert!(held < 0.5 * 6.5 * 1.6 * 1.6, "{method:?}, place {place}: {held} in the hand");
            let most = 1.001 * first;
            assert!(second < most && third <= 1.001 * second, "{method:?}, {place}: {first}, {second}, {third}");
        }
    }
    // Undamped, what keeps its energy does so within the bounds of a nearby one.
    for method in [Method::SemiImplicitEuler, Method::StormerVerlet, Method::DampedVerlet] {
        for place in 0..4 {
            let [_, first, second, third] = energies(method, 0.0, 0.9, place);
            assert!(second < 1.5 * first && third < 1.5 * first, "{method:?}, {place}: {first}, {second}, {third}");
        }
    }
}

#[test]
fn a_press_at_a_large_step_freezes_no_block() {
    // 5³ bears steps of .5258, and is pressed in the middle of a face at .45.
    let (mut app, block) = app_of(cube(5, &Neighbours::ALL, 0.0), Method::StormerVerlet, 0.45, 10);
    let particle = places(*app.world().get::<Lattice>(block).unwrap())[0];
    let target = particles(&app, block).position(particle).unwrap();
    crate::jelly::shake(&mut app, block, 0.01);
    app.world_mut().entity_mut(block).insert(Pull { particle, target });
    for _ in 0..200 {
        app.update();
    }
    assert!(!app.world().entity(block).contains::<Frozen>());
    let fastest = particles(&app, block).velocities().map(DVec3::length).fold(0.0, f64::max);
    assert!(fastest < 0.1, "{fastest}");
}

#[test]
fn any_mass_of_a_heavy_block_lifts_it() {
    // As heavy as 20³ and more: 125 masses of 64 weigh 8, and a corner has springs of 7 in all.
    let plan = JellyPlan { mass: 64.0, ..cube(5, &Neighbours::ALL, 2.0) };
    for place in 0..3 {
        let (mut app, block) = falling(plan.clone(), Method::StormerVerlet, Some(MassDamping::Rate(0.02)), 0.5, 100);
        let particle = places(*app.world().get::<Lattice>(block).unwrap())[place];
        let target = particles(&app, block).position(particle).unwrap() + DVec3::Y * 15.0;
        app.world_mut().entity_mut(block).insert(Pull { particle, target });
        let mut worst = 0.0_f64;
        let springs = app.world().get::<Springs>(block).unwrap().clone();
        for _ in 0..30 {
            app.update();
            assert!(!app.world().entity(block).contains::<Frozen>());
            worst = worst.max(longest(particles(&app, block), &springs));
        }
        let lowest = particles(&app, block).positions().map(|x| x.y).fold(f64::INFINITY, f64::min);
        assert!(lowest > 1.0, "place {place}: its lowest mass is at {lowest}");
        // Four lengths away it would be pulled with twice its weight.
        assert!(worst < 4.0, "place {place}: a spring is {worst} times as long");
    }
}

/// The longest spring, in rest lengths.
fn longest(particles: &Particles, springs: &Springs) -> f64 {
    let place = |end: ParticleId| particles.position(end).unwrap();
    let part =
        |spring: wriggle::body::Spring| place(spring.ends[0]).distance(place(spring.ends[1])) / spring.rest_length;
    springs.iter().map(part).fold(0.0, f64::max)
}
