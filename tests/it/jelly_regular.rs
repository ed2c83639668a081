//! Regular blocks, stepped without lists of their springs, against the general springs and on several threads.

use std::{path::Path, process::Command};

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, Ground, MassDamping, Neighbours, Particle, ParticleId, Particles, SpringId},
    creatures::{Body, Creature, JellyPlan, NeighboursPlan, Pose, SpringPlan},
    mechanics::{Advance, BodyParts, Model, State, Timeline, integrators::Method},
};

use crate::{
    jelly::{KINDS, body, cube},
    support::bits,
};

fn parts(body: &Body, method: Method) -> BodyParts<'_> {
    BodyParts {
        lattice: body.block.map(|(lattice, _)| lattice),
        gravity: Gravity::new(0.01).ok(),
        ground: Some(&Ground::Flat),
        mass_damping: MassDamping::rate(0.05).ok(),
        ..BodyParts::new(&body.particles, &body.springs, method)
    }
}

fn after(parts: &BodyParts<'_>, steps: u64) -> Particles {
    after_all(parts, [steps])
}

/// After one run of so many steps after the other.
fn after_all(parts: &BodyParts<'_>, runs: impl IntoIterator<Item = u64>) -> Particles {
    let dt = 0.1;
    let mut model = Model::<f64, 3>::new(parts, [], dt);
    let mut state = State::new(parts.particles.len());
    state.set_lane(0, parts.particles);
    let timeline = Timeline { dt, base_step: 0, base_time: 0.0 };
    let mut first = 0;
    for steps in runs {
        Advance { model: &mut model, state: &mut state, method: parts.method, timeline, first, steps }.run();
        first += steps;
    }
    model.note(&state);
    assert!(!model.has_exploded(0));
    let mut particles = parts.particles.clone();
    state.write_lane(0, &mut particles);
    particles
}

/// A block that is deformed and moves, with a mass that is pinned and one that is heavy.
fn moving(size: (u32, u32, u32), kinds: &[Neighbours]) -> Body {
    let springs = NeighboursPlan {
        edges: Some(SpringPlan { stiffness: 1.0, damping: 0.0 }),
        faces: kinds.contains(&Neighbours::Faces).then_some(SpringPlan { stiffness: 0.7, damping: 0.2 }),
        cubes: kinds.contains(&Neighbours::Cubes).then_some(SpringPlan { stiffness: 0.4, damping: 0.1 }),
    };
    let mut body = body(JellyPlan { size, neighbours: springs, drop: 0.3, tilt: 8.0, ..cube(1, kinds, 0.0) });
    for i in 0..body.particles.len() as u32 {
        let wobble = |prime: u32, modulus: u32| f64::from(i * prime % modulus) / f64::from(modulus) - 0.5;
        let offset = DVec3::new(wobble(7, 11), wobble(5, 13), wobble(3, 17)) * 0.2;
        let particle = body.particles.get(ParticleId(i)).unwrap();
        let velocity = if i == 1 { DVec3::ZERO } else { offset };
        let changed = Particle {
            position: particle.position + offset,
            velocity,
            mass: if i == 2 { 3.0 } else { 1.0 },
            pinned: i == 1,
        };
        body.particles.set(ParticleId(i), changed).unwrap();
    }
    body
}

#[test]
fn a_regular_block_moves_as_its_springs_one_by_one_would_move_it() {
    let sizes = [((4, 3, 5), KINDS[3]), ((9, 2, 3), KINDS[3]), ((17, 4, 2), KINDS[1]), ((2, 2, 2), KINDS[2])];
    // The neighbours of a row of seven are a whole vector further.
    let more = [((1, 4, 5), KINDS[1]), ((3, 1, 1), KINDS[0]), ((7, 3, 4), KINDS[3]), ((8, 4, 3), KINDS[3])];
    for (size, kinds) in sizes.into_iter().chain(more) {
        let body = moving(size, kinds);
        for method in Method::ALL.into_iter().filter(|method| method.asks_forces_alone()) {
            let parts = parts(&body, method);
            assert!(parts.is_regular());
            let (regular, general) = (after(&parts, 60), after(&BodyParts { lattice: None, ..parts }, 60));
            let apart = |a: DVec3, b: DVec3| (a - b).abs().max_element();
            let far = regular.positions().zip(general.positions()).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
            let fast = regular.velocities().zip(general.velocities()).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
            assert!(far < 1e-12 && fast < 1e-12, "{size:?} {method:?}: {far:e}, {fast:e} apart");
            assert!(regular.positions().zip(body.particles.positions()).any(|(a, b)| a.distance(b) > 0.1));
        }
    }
}

#[test]
fn steps_at_once_and_one_by_one_have_the_same_bits() {
    let body = moving((4, 3, 5), KINDS[3]);
    for method in Method::ALL.into_iter().filter(|method| method.asks_forces_alone()) {
        let parts = parts(&body, method);
        let at_once = bits(&after(&parts, 60));
        assert!(bits(&after_all(&parts, [1; 60])) == at_once, "{method:?}, one by one");
        assert!(bits(&after_all(&parts, [2, 7, 51])) == at_once, "{method:?}, 2, 7 and 51");
    }
}

#[test]
fn a_block_of_which_one_spring_differs_is_not_regular() {
    let mut body = body(cube(3, KINDS[3], 0.0));
    assert!(parts(&body, Method::DampedVerlet).is_regular());
    assert!(!parts(&body, Method::ImplicitEuler).is_regular());
    let spring = body.springs.get(SpringId(60)).unwrap();
    body.springs.set(SpringId(60), wriggle::body::Spring { stiffness: 2.0, ..spring }).unwrap();
    assert!(!parts(&body, Method::DampedVerlet).is_regular());
    assert_eq!(body.springs.get(SpringId(60)).unwrap().stiffness, 2.0);
    assert!([59, 61].iter().all(|&i| body.springs.get(SpringId(i)).unwrap().stiffness == 1.0));
    body.springs.set(SpringId(60), spring).unwrap();
    assert!(parts(&body, Method::DampedVerlet).is_regular());
    // All of a kind, one after the other.
    for i in 0..54 {
        let spring = body.springs.get(SpringId(i)).unwrap();
        body.springs.set(SpringId(i), wriggle::body::Spring { damping: 0.5, ..spring }).unwrap();
    }
    assert!(parts(&body, Method::DampedVerlet).is_regular());
    assert!(body.springs.iter().enumerate().all(|(i, spring)| spring.damping == if i < 54 { 0.5 } else { 0.0 }));
}

#[test]
fn the_number_of_threads_changes_no_bit_of_a_block() {
    let folder = tempfile::TempDir::new().unwrap();
    let block = |name: &str, size: &str, damping: [f64; 2]| {
        let file = folder.path().join(name);
        let [edges, cubes] = damping;
        let text = format!(
            "Creature(version: 1, body: Jelly(size: {size}, tilt: 10, drop: 0.01,
               neighbours: (edges: (stiffness: 1, damping: {edges:?}), faces: (stiffness: 1), cubes: (stiffness: 1, damping: {cubes:?}))),
             ground: Flat, gravity: 0.05)"
        );
        std::fs::write(&file, text).unwrap();
        file
    };
    let hash = |file: &Path, method: &str, threads: &str| {
        let run = ["--for", "1", "--dt", "0.1", "--method", method, "--threads", threads, "--json"];
        let output = Command::new(env!("CARGO_BIN_EXE_wriggle")).arg("run").arg(file).args(run).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        (result["hash"].to_string(), result["threads"].as_u64())
    };
    // A slab takes 4096 masses: two slabs with two threads, three with three; three of one layer; and three, the last of which has one layer, where four would do.
    let (damped, stiff) = ([0.1, 0.2], [0.0, 0.0]);
    let blocks = [
        (block("damped.creature.ron", "(23, 23, 25)", damped), &["2", "3"][..]),
        (block("stiff.creature.ron", "(23, 23, 25)", stiff), &["2", "3"]),
        (block("layers.creature.ron", "(64, 64, 3)", damped), &["3"]),
        (block("uneven.creature.ron", "(64, 64, 5)", stiff), &["4"]),
    ];
    // What a slab hears from the one behind: where masses are, where they are when they have drifted, and nothing.
    for method in ["SemiImplicitEuler", "StormerVerlet", "RungeKutta4"] {
        for (file, on) in &blocks {
            let (one, threads) = hash(file, method, "1");
            assert_eq!(threads, Some(1));
            for threads in *on {
                assert_eq!(hash(file, method, threads).0, one, "{} by {method} on {threads} threads", file.display());
            }
        }
    }
}

#[test]
fn nothing_is_left_of_an_explosion_in_a_model_that_is_used_again() {
    let body = moving((5, 3, 4), KINDS[3]);
    let parts = parts(&body, Method::StormerVerlet);
    let mut model = Model::<f64, 3>::new(&parts, [], 0.1);
    let mut steps = |particles: &Particles| {
        let mut state = State::new(particles.len());
        state.set_lane(0, particles);
        let timeline = Timeline { dt: 0.1, base_step: 0, base_time: 0.0 };
        Advance { model: &mut model, state: &mut state, method: parts.method, timeline, first: 0, steps: 10 }.run();
        state
    };
    let first = steps(&body.particles);
    let mut torn = body.particles.clone();
    for i in [3, 7, 14, 15, 59] {
        let position = DVec3::new(1e200, -1e200, 1e300);
        torn.set(ParticleId(i), Particle { position, ..body.particles.get(ParticleId(i)).unwrap() }).unwrap();
    }
    assert!(steps(&torn).position.iter().flatten().any(|x| !x.is_finite()));
    let again = steps(&body.particles);
    assert!(first.position == again.position && first.velocity == again.velocity);
}

#[test]
fn two_equal_blocks_have_the_bits_of_one_alone() {
    use crate::support::{particles, stepping_app};
    use bevy::ecs::system::EntityCommand;
    let run = |count: usize| {
        let mut app = stepping_app(0.1, 20);
        let blocks: Vec<_> = (0..count)
            .map(|_| {
                let block =
                    app.world_mut().spawn((Method::DampedVerlet, Gravity::new(0.01).unwrap(), Ground::Flat)).id();
                let body =
                    Creature::from(cube(3, KINDS[3], 0.1)).body(Pose { heading: 20.0, ..Pose::default() }).unwrap();
                body.apply(app.world_mut().entity_mut(block));
                crate::jelly::shake(&mut app, block, 0.5);
                block
            })
            .collect();
        app.update();
        app.update();
        blocks.into_iter().map(|block| bits(particles(&app, block))).collect::<Vec<_>>()
    };
    let alone = run(1);
    assert!(run(3).iter().all(|block| *block == alone[0]));
}

#[test]
fn a_block_that_explodes_is_frozen_at_the_same_step_whatever_the_ticks() {
    use crate::support::{particles, stepping_app};
    use bevy::ecs::system::EntityCommand;
    use wriggle::physics::{Clock, Frozen};
    let run = |steps: u64| {
        let mut app = stepping_app(0.6, steps);
        let block = app.world_mut().spawn(Method::SemiImplicitEuler).id();
        body(cube(4, KINDS[3], 0.0)).apply(app.world_mut().entity_mut(block));
        crate::jelly::shake(&mut app, block, 0.1);
        while app.world().resource::<Clock>().step() < 600 {
            app.update();
        }
        (app.world().get::<Frozen>(block).cloned(), bits(particles(&app, block)))
    };
    let one_by_one = run(1);
    assert!(one_by_one.0.as_ref().is_some_and(|frozen| frozen.reason.contains("longer than ten rest lengths")));
    assert_eq!(run(600), one_by_one);
    assert_eq!(run(7).0, one_by_one.0);
}
