//! Jelly: blocks on a cubic grid as creatures, and what the exercise says of them.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{
        Gravity, Ground, Lattice, MassDamping, Neighbours, Particle, ParticleId, Particles, Pull, SpringId, Surface,
        Tearing, Terrain,
    },
    creatures::{Body, Creature, JellyPlan, NeighboursPlan, Pose, Rotation, SpringPlan},
    mechanics::{angular_momentum, elastic_energy, integrators::Method, kinetic_energy, metrics::BlockShape, momentum},
    physics::{Clock, Frozen, Restart, StartState, body_parts},
    scenes::{self, SceneBodies, parameters},
};

use crate::support::{in_space, particles, stepping_app};

/// Springs along edges alone, with face diagonals, with cell diagonals, with both.
pub const KINDS: [&[Neighbours]; 4] = [
    &[Neighbours::Edges],
    &[Neighbours::Edges, Neighbours::Faces],
    &[Neighbours::Edges, Neighbours::Cubes],
    &Neighbours::ALL,
];

/// How a block stands: leaning by 0, 1 or 20 degrees, or turned by 50 degrees about (1, 2, 3).
pub const ATTITUDES: [(f64, Option<Rotation>); 4] =
    [(0.0, None), (1.0, None), (20.0, None), (0.0, Some(Rotation { axis: (1.0, 2.0, 3.0), angle: 50.0 }))];

/// A cube with springs of stiffness 1 between neighbours of some kinds.
pub fn cube(count: u32, kinds: &[Neighbours], damping: f64) -> JellyPlan {
    JellyPlan {
        size: (count, count, count),
        neighbours: NeighboursPlan::alike(kinds, SpringPlan { stiffness: 1.0, damping }),
        mass: 1.0,
        tilt: 0.0,
        rotation: None,
        drop: 0.0,
    }
}

pub fn body(plan: JellyPlan) -> Body {
    Creature::from(plan).body(Pose::default()).unwrap()
}

/// An app with one block, as the exercise steps it, every update so many steps.
pub fn app_of(plan: JellyPlan, method: Method, dt: f64, steps: u64) -> (App, Entity) {
    let mut app = stepping_app(dt, steps);
    let entity = app.world_mut().spawn(method).id();
    bevy::ecs::system::EntityCommand::apply(body(plan), app.world_mut().entity_mut(entity));
    (app, entity)
}

/// The same in free fall onto the floor.
pub fn falling(plan: JellyPlan, method: Method, damping: Option<MassDamping>, dt: f64, steps: u64) -> (App, Entity) {
    let (mut app, entity) = app_of(plan, method, dt, steps);
    app.world_mut().entity_mut(entity).insert((Gravity::new(0.001).unwrap(), Ground::Flat));
    if let Some(damping) = damping {
        app.world_mut().entity_mut(entity).insert(damping);
    }
    (app, entity)
}

pub fn shape(app: &App, block: Entity) -> BlockShape {
    assert!(!app.world().entity(block).contains::<Frozen>(), "{:?}", app.world().get::<Frozen>(block));
    let lattice = *app.world().get::<Lattice>(block).unwrap();
    BlockShape::measure(particles(app, block), lattice).unwrap()
}

/// Gives every mass a velocity that is the same in every run.
pub fn shake(app: &mut App, block: Entity, speed: f64) {
    let mut particles = app.world_mut().get_mut::<Particles>(block).unwrap();
    for i in 0..particles.len() as u32 {
        let wobble = |prime: u32, modulus: u32| f64::from(i * prime % modulus) / f64::from(modulus) - 0.5;
        let velocity = DVec3::new(wobble(7, 11), wobble(5, 13), wobble(3, 17)) * speed;
        let particle = particles.get(ParticleId(i)).unwrap();
        particles.set(ParticleId(i), Particle { velocity, ..particle }).unwrap();
    }
}

#[test]
fn a_block_has_the_springs_that_the_exercise_counts() {
    // 3N²(N−1), 6N(N−1)² and 4(N−1)³.
    for (kinds, count) in KINDS.iter().zip([300, 780, 556, 1036]) {
        let body = body(cube(5, kinds, 0.0));
        assert_eq!((body.particles.len(), body.springs.len()), (125, count));
        let (lattice, _) = body.block.unwrap();
        for (i, spring) in body.springs.iter().enumerate() {
            let [a, b] = spring.ends.map(|end| body.particles.position(end).unwrap());
            assert!((a.distance(b) - spring.rest_length).abs() < 1e-12);
            assert_eq!(spring.rest_length, lattice.kind(SpringId(i as u32)).distance());
        }
    }
    let body = body(JellyPlan { size: (4, 3, 1), ..cube(1, &[Neighbours::Edges, Neighbours::Faces], 0.0) });
    assert_eq!((body.particles.len(), body.springs.len()), (12, 3 * 3 + 4 * 2 + 2 * 3 * 2));
}

#[test]
fn a_block_starts_turned_and_dropped_from_where_it_says() {
    for (tilt, rotation) in ATTITUDES {
        let body = body(JellyPlan { tilt, rotation, drop: 2.0, ..cube(4, &Neighbours::ALL, 0.0) });
        let lowest = body.particles.positions().map(|x| x.y).fold(f64::INFINITY, f64::min);
        assert!((lowest - 2.0).abs() < 1e-12);
        let shape = BlockShape::measure(&body.particles, body.block.unwrap().0).unwrap();
        assert!(shape.shape_error < 1e-7 && (shape.volume.unwrap() - 1.0).abs() < 1e-12, "{shape:?}");
    }
    let upright = body(cube(3, &Neighbours::ALL, 0.0));
    let leaning = body(JellyPlan { tilt: 90.0, ..cube(3, &Neighbours::ALL, 0.0) });
    // By a right angle about z: x becomes y.
    let [a, b] = [&upright, &leaning].map(|body| body.particles.position(ParticleId(2)).unwrap());
    assert!(
        (a - DVec3::new(1.0, 0.0, -1.0)).length() < 1e-12 && (b - DVec3::new(1.0, 2.0, -1.0)).length() < 1e-12,
        "{a} {b}"
    );
}

#[test]
fn a_block_is_turned_right_handed_and_headed_from_x_towards_z() {
    let corner = |plan: JellyPlan, heading: f64| {
        let body = Creature::from(plan).body(Pose { heading, ..Pose::default() }).unwrap();
        body.particles.position(ParticleId(2)).unwrap()
    };
    let plan = |axis, angle, tilt| JellyPlan {
        rotation: Some(Rotation { axis, angle }),
        tilt,
        ..cube(3, &Neighbours::ALL, 0.0)
    };
    let about_y = (0.0, 3.0, 0.0);
    for (found, place) in [
        (corner(plan(about_y, 0.0, 0.0), 0.0), DVec3::new(1.0, 0.0, -1.0)),
        (corner(plan(about_y, 90.0, 0.0), 0.0), DVec3::new(-1.0, 0.0, -1.0)),
        (corner(plan(about_y, 0.0, 0.0), 90.0), DVec3::new(1.0, 0.0, 1.0)),
        // Turned first, then leant, then headed.
        (corner(plan((1.0, 0.0, 0.0), 90.0, 90.0), 90.0), DVec3::new(1.0, 2.0, -1.0)),
    ] {
        assert!((found - place).length() < 1e-12, "{found}, not {place}");
    }
}

#[test]
fn cells_that_are_inside_out_are_counted() {
    let body = body(cube(3, &Neighbours::ALL, 0.0));
    let lattice = body.block.unwrap().0;
    let measured = |change: fn(DVec3) -> DVec3| {
        let places: Vec<_> = body.particles.positions().map(change).collect();
        BlockShape::of_places(&places, lattice).unwrap()
    };
    let mirrored = measured(|place| DVec3::new(-place.x, place.y, place.z));
    assert_eq!(mirrored.inverted, 8);
    assert!((mirrored.volume.unwrap() + 1.0).abs() < 1e-12 && (mirrored.smallest_cell.unwrap() + 1.0).abs() < 1e-12);
    // Masses stand at −1, 0 and 1: half of the cells are folded over.
    let folded = measured(|place| DVec3::new(place.x.abs(), place.y, place.z));
    assert_eq!((folded.inverted, folded.height), (4, 2.0));
    assert!(folded.volume.unwrap().abs() < 1e-12, "{folded:?}");
    assert_eq!(measured(|place| place).inverted, 0);
    assert_eq!(BlockShape::of_places(&[DVec3::ZERO], lattice), None);
}

#[test]
fn the_tilt_of_a_block_is_a_parameter_that_puts_it_back() {
    let mut app = stepping_app(0.1, 100);
    scenes::open(app.world_mut(), scenes::load("jelly-lab").unwrap()).unwrap();
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(100);
    app.update();
    app.update();
    let block = app.world().resource::<SceneBodies>().0[1];
    assert!(particles(&app, block).velocities().all(|v| v.y < 0.0), "it falls");
    parameters::set(app.world_mut(), "faces.block.tilt", 45.0).unwrap();
    let start = particles(&app, block).clone();
    assert!(start.velocities().all(|v| v == DVec3::ZERO));
    let corner = |i: u32| start.position(ParticleId(i)).unwrap();
    assert!(((corner(4) - corner(0)).normalize() - DVec3::new(0.5, 0.5, 0.0) * 2.0_f64.sqrt()).length() < 1e-12);
    app.update();
    app.world_mut().write_message(Restart);
    app.update();
    assert_eq!(app.world().get::<StartState>(block).unwrap().0, start);
    let tilt = parameters::list(app.world_mut()).into_iter().find(|p| p.path == "faces.block.tilt").unwrap();
    assert_eq!(tilt.value, 45.0);
}

#[test]
fn a_block_without_springs_falls_as_its_masses_do() {
    // The exercise's template: nothing but gravity and the floor.
    let (mut app, block) = falling(JellyPlan { drop: 2.0, ..cube(3, &[], 0.0) }, Method::StormerVerlet, None, 0.1, 10);
    let start = particles(&app, block).clone();
    app.update();
    for (from, to) in start.positions().zip(particles(&app, block).positions()) {
        assert!((from.y - to.y - 0.5 * 0.001).abs() < 1e-12);
    }
    for _ in 0..120 {
        app.update();
    }
    assert!(particles(&app, block).positions().all(|x| x.y == 0.0), "all masses lie on the floor");
}

/// Drops blocks with face diagonals in all attitudes, with a rate of damping of 0.1.
fn keep_their_shape(count: u32, dt: f64, time: f64) {
    for kinds in [KINDS[1], KINDS[3]] {
        for (tilt, rotation) in ATTITUDES {
            let plan = JellyPlan { tilt, rotation, drop: 2.0, ..cube(count, kinds, 0.0) };
            let damping = Some(MassDamping::per_step(0.1 * dt).unwrap());
            let (mut app, block) = falling(plan, Method::DampedVerlet, damping, dt, (time / dt) as u64);
            app.update();
            let shape = shape(&app, block);
            assert!(shape.shape_error <= 0.01, "{kinds:?} {tilt} {rotation:?}: {shape:?}");
            assert!((shape.volume.unwrap() - 1.0).abs() <= 0.005 && shape.inverted == 0, "{kinds:?} {tilt}: {shape:?}");
        }
    }
}

#[test]
fn blocks_with_diagonals_keep_their_shape_in_every_attitude() {
    keep_their_shape(5, 0.1, 2000.0);
}

/// Drops blocks without diagonals in all attitudes.
fn stand_or_collapse(count: u32, dt: f64) {
    for (tilt, rotation) in ATTITUDES {
        let plan = JellyPlan { tilt, rotation, drop: 2.0, ..cube(count, KINDS[0], 0.0) };
        let damping = Some(MassDamping::per_step(0.1 * dt).unwrap());
        let (mut app, block) = falling(plan, Method::DampedVerlet, damping, dt, (1000.0 / dt) as u64);
        app.update();
        let shape = shape(&app, block);
        if tilt == 0.0 && rotation.is_none() {
            assert!(shape.height > f64::from(count) - 1.1, "{shape:?}");
        } else {
            assert!(shape.height < 0.1, "{tilt} {rotation:?}: {shape:?}");
        }
    }
}

#[test]
fn a_block_of_edges_alone_stands_upright_and_collapses_when_it_leans() {
    stand_or_collapse(5, 0.1);
}

#[test]
fn in_the_laboratory_the_block_of_edges_alone_collapses_and_the_others_stand() {
    let mut app = stepping_app(0.2, 1);
    scenes::open(app.world_mut(), scenes::load("jelly-lab").unwrap()).unwrap();
    app.world_mut().resource_mut::<Clock>().set_steps_per_tick(5000);
    app.update();
    assert!((app.world().resource::<Clock>().time() - 1000.0).abs() < 1e-9);
    let shapes: Vec<_> = app.world().resource::<SceneBodies>().0.iter().map(|&block| shape(&app, block)).collect();
    assert!(shapes[0].height < 0.1, "{:?}", shapes[0]);
    for shape in &shapes[1..] {
        let volume = shape.volume.unwrap();
        assert!(shape.shape_error < 0.05 && shape.inverted == 0 && (volume - 1.0).abs() < 0.005, "{shape:?}");
    }
}

#[test]
fn on_a_plane_without_friction_a_block_slides_as_a_point() {
    // 30 degrees: g·sin 30° along it, whatever the block does across it.
    let (gravity, steep) = (0.001, 30.0_f64.to_radians());
    let plan = JellyPlan { tilt: -30.0, ..cube(4, KINDS[1], 0.1) };
    let (mut app, block) = falling(plan, Method::StormerVerlet, None, 0.2, 500);
    let plane = Surface::Plane { point: (0.0, -4.0, 0.0), normal: (libm::sin(steep), libm::cos(steep), 0.0) };
    let ground = Ground::Terrain(Terrain::new([plane]).unwrap().into());
    app.world_mut().entity_mut(block).insert(ground);
    let down = DVec3::new(libm::cos(steep), -libm::sin(steep), 0.0);
    let across = DVec3::new(libm::sin(steep), libm::cos(steep), 0.0);
    let start = particles(&app, block).center();
    for _ in 0..5 {
        app.update();
        let time = app.world().resource::<Clock>().time();
        let speed = momentum(particles(&app, block)).dot(down) / 64.0;
        assert!((speed / (0.5 * gravity * time) - 1.0).abs() < 1e-10, "{speed} at {time}");
        // Where within a step a mass meets the plane is known on straight ways alone: less than a step late or early.
        let moved = (particles(&app, block).center() - start).dot(down);
        let point = 0.25 * gravity * time * time;
        assert!((moved / point - 1.0).abs() < 0.2 / time, "{moved} of {point} at {time}");
    }
    // It lies on the plane, and is whole.
    let heights = particles(&app, block).positions().map(|x| (x + DVec3::Y * 4.0).dot(across));
    let lowest = heights.fold(f64::INFINITY, f64::min);
    let shape = shape(&app, block);
    assert!(lowest.abs() < 0.02 && shape.shape_error < 0.02 && shape.inverted == 0, "{lowest} {shape:?}");
}

#[test]
fn a_block_slides_off_a_cliff_and_stays_whole() {
    let plan = cube(4, KINDS[1], 0.3);
    let (mut app, block) = falling(plan, Method::StormerVerlet, None, 0.2, 500);
    let cliff = Surface::Cliff { edge: 3.0, radius: 2.0, drop: Some(6.0) };
    app.world_mut().entity_mut(block).insert(Ground::Terrain(Terrain::new([cliff]).unwrap().into()));
    let mut pushed = app.world_mut().get_mut::<Particles>(block).unwrap();
    for i in (0..64).map(ParticleId) {
        let particle = pushed.get(i).unwrap();
        pushed.set(i, Particle { velocity: DVec3::X * 0.02, ..particle }).unwrap();
    }
    for _ in 0..40 {
        app.update();
        let shape = shape(&app, block);
        assert!(shape.shape_error < 0.2 && shape.inverted == 0, "{shape:?}");
    }
    let center = particles(&app, block).center();
    // On the lower ground its middle is one and a half above −6, however it has turned.
    assert!(center.x > 5.0 && (center.y + 4.5).abs() < 0.1, "{center}");
}

#[test]
fn layers_of_an_upright_block_bear_the_weight_above_them() {
    let (count, gravity) = (4, 0.001);
    let (mut app, block) =
        falling(cube(count, KINDS[0], 0.0), Method::DampedVerlet, Some(MassDamping::Rate(0.5)), 0.5, 4000);
    app.update();
    let lattice = *app.world().get::<Lattice>(block).unwrap();
    let height = |y: u32| particles(&app, block).position(lattice.particle([1, y, 2])).unwrap().y;
    for layer in 0..count - 1 {
        let shorter = 1.0 - (height(layer + 1) - height(layer));
        let weight = gravity * f64::from(count - 1 - layer);
        assert!((shorter / weight - 1.0).abs() < 0.01, "layer {layer} is {shorter} shorter, bears {weight}");
    }
}

/// The methods that keep the spin of a free body: what they kick acts along lines between places that nobody moves on the way, and they drift along velocities.
const KEEP_SPIN: [Method; 5] = [
    Method::SemiImplicitEuler,
    Method::StormerVerlet,
    Method::DampedVerlet,
    Method::Leapfrog,
    Method::ImplicitMidpoint,
];

#[test]
fn every_method_keeps_the_momentum_of_a_free_block_and_some_its_spin() {
    for method in in_space() {
        // Those with a solver take some hundred times as long.
        let steps = if method.side_by_side() && method != Method::Xpbd { 1000 } else { 100 };
        for damping in [0.0, 0.3] {
            let dt = if method == Method::ExplicitEuler { 0.005 } else { 0.05 };
            let (mut app, block) = app_of(cube(3, &Neighbours::ALL, damping), method, dt, steps);
            shake(&mut app, block, 0.2);
            let before = particles(&app, block).clone();
            app.update();
            let after = particles(&app, block);
            let push = (momentum(after) - momentum(&before)).length();
            assert!(push < 1e-10, "{method:?} with damping {damping}: momentum changes by {push:e}");
            let way = momentum(&before) / 27.0 * (dt * steps as f64);
            assert!((after.center() - before.center() - way).length() < 1e-10, "{method:?} with damping {damping}");
            let change = (angular_momentum(after) - angular_momentum(&before)).length();
            if KEEP_SPIN.contains(&method) {
                assert!(change < 1e-10, "{method:?} with damping {damping}: spin changes by {change:e}");
            } else {
                assert!(change > 1e-9, "{method:?} with damping {damping} keeps spin, too: {change:e}");
                let most = if method == Method::RungeKutta4 { 1e-6 } else { f64::INFINITY };
                assert!(change < most, "{method:?} with damping {damping}: spin changes by {change:e}");
            }
        }
    }
}

#[test]
fn runge_kutta_keeps_the_spin_of_a_free_block_to_its_order() {
    for (method, order) in [(Method::RungeKutta2, 2), (Method::RungeKutta4, 4)] {
        let change = |dt: f64| {
            let (mut app, block) = app_of(cube(3, &Neighbours::ALL, 0.3), method, dt, (10.0 / dt).round() as u64);
            shake(&mut app, block, 0.2);
            let before = angular_momentum(particles(&app, block));
            app.update();
            (angular_momentum(particles(&app, block)) - before).length()
        };
        let changes = [0.0125, 0.00625].map(change);
        let observed = libm::log2(changes[0] / changes[1]);
        assert!((observed - f64::from(order)).abs() < 0.1, "{method:?}: order {observed} of {changes:?}");
    }
}

#[test]
fn the_middle_of_a_falling_block_falls_as_a_point() {
    let plan = JellyPlan { drop: 100.0, tilt: 20.0, ..cube(4, &Neighbours::ALL, 0.1) };
    let (mut app, block) = falling(plan, Method::StormerVerlet, None, 0.1, 1000);
    shake(&mut app, block, 0.2);
    let before = particles(&app, block).clone();
    app.update();
    let fallen = momentum(&before) / 64.0 * 100.0 - DVec3::Y * 0.5 * 0.001 * 100.0 * 100.0;
    assert!((particles(&app, block).center() - before.center() - fallen).length() < 1e-10);
}

#[test]
fn an_undamped_block_keeps_its_energy_within_the_bounds_of_verlet() {
    let dt = 0.2;
    let (mut app, block) = app_of(cube(3, &Neighbours::ALL, 0.0), Method::StormerVerlet, dt, 50);
    shake(&mut app, block, 0.05);
    let energy = |app: &App| {
        let parts = body_parts(app.world().entity(block)).unwrap();
        kinetic_energy(parts.particles) + elastic_energy(&parts, 0.0)
    };
    let start = energy(&app);
    for _ in 0..40 {
        app.update();
        // Within θ/2 with θ = ω_max·dt, Verlet's energy being that of a nearby system.
        assert!((energy(&app) / start - 1.0).abs() < 0.5 * dt * 3.68, "{}", energy(&app) / start);
    }
}

/// Energy of motion, of springs and of height.
fn energy(app: &App, block: Entity, gravity: f64) -> f64 {
    let parts = body_parts(app.world().entity(block)).unwrap();
    let height: f64 = parts.particles.positions().map(|x| gravity * x.y).sum();
    kinetic_energy(parts.particles) + elastic_energy(&parts, 0.0) + height
}

#[test]
fn a_drag_adds_no_energy_once_let_go() {
    for damping in [Some(MassDamping::Rate(0.05)), None] {
        let plan = cube(4, &Neighbours::ALL, 0.0);
        let (mut app, block) = falling(plan, Method::StormerVerlet, damping, 0.1, 10);
        app.update();
        let before = energy(&app, block, 0.001);
        let pull = Pull { particle: ParticleId(63), target: DVec3::new(6.0, 9.0, 2.0) };
        app.world_mut().entity_mut(block).insert(pull);
        for _ in 0..60 {
            app.update();
        }
        let lifted = particles(&app, block).center().y;
        assert!(lifted > 3.0, "is lifted to {lifted}");
        app.world_mut().entity_mut(block).remove::<Pull>();
        let (mut last, start) = (energy(&app, block, 0.001), energy(&app, block, 0.001));
        assert!(start > before);
        // Verlet's energy is that of a nearby system, within ω·dt/2 of what moves.
        let slack = 0.5 * 0.1 * 3.68 * (start - before);
        for _ in 0..200 {
            app.update();
            let now = energy(&app, block, 0.001);
            match damping {
                Some(_) => assert!(now < last + 0.02 * slack, "rises from {last} to {now}"),
                None => assert!(now < start + slack, "rises from {start} to {now}"),
            }
            last = now;
        }
    }
}

#[test]
fn a_pull_is_capped_and_changes_no_bit_with_the_ticks() {
    let run = |steps: u64| {
        let (mut app, block) = app_of(cube(3, &Neighbours::ALL, 0.1), Method::SemiImplicitEuler, 0.1, steps);
        let target = DVec3::splat(1e6);
        app.world_mut().entity_mut(block).insert(Pull { particle: ParticleId(26), target });
        while app.world().resource::<Clock>().step() < 60 {
            app.update();
        }
        shape(&app, block);
        (momentum(particles(&app, block)), crate::support::bits(particles(&app, block)))
    };
    let (momentum, bits) = run(60);
    // At a corner there are seven springs of stiffness 1, and the pull is at most as that of ¼ of them over four lengths.
    assert!((momentum.length() - 7.0 * 6.0).abs() < 0.05 * 42.0, "{momentum}");
    assert_eq!(run(1).1, bits);
}

#[test]
fn springs_tear_where_they_are_stretched_beyond_their_limit_and_no_sooner() {
    // All strains are 0.15.
    let torn_at = |strain: f64| {
        let mut creature = Creature::from(cube(3, &Neighbours::ALL, 0.0));
        creature.tear = Some(strain);
        let mut app = stepping_app(1e-3, 1);
        let block = app.world_mut().spawn(Method::StormerVerlet).id();
        let mut body = creature.body(Pose::default()).unwrap();
        for i in (0..27).map(ParticleId) {
            let particle = body.particles.get(i).unwrap();
            body.particles.set(i, Particle { position: particle.position * 1.15, ..particle }).unwrap();
        }
        bevy::ecs::system::EntityCommand::apply(body, app.world_mut().entity_mut(block));
        app.update();
        app.world().get::<Tearing>(block).unwrap().count()
    };
    let all = Neighbours::ALL.map(|kind| kind.springs([3; 3])).iter().sum::<u64>();
    assert_eq!((torn_at(0.149) as u64, torn_at(0.151)), (all, 0));
}

#[test]
fn a_torn_block_falls_apart_and_the_watch_is_content() {
    let torn_after = |strain: f64| {
        let mut creature = Creature::from(JellyPlan { tilt: 30.0, drop: 3.0, ..cube(4, &Neighbours::ALL, 0.0) });
        creature.tear = Some(strain);
        let mut app = stepping_app(0.05, 100);
        let block = app.world_mut().spawn((Method::StormerVerlet, Gravity::new(0.5).unwrap(), Ground::Flat)).id();
        let body = creature.body(Pose::default()).unwrap();
        bevy::ecs::system::EntityCommand::apply(body, app.world_mut().entity_mut(block));
        shake(&mut app, block, 1.0);
        for _ in 0..60 {
            app.update();
            assert!(!app.world().entity(block).contains::<Frozen>(), "{:?}", app.world().get::<Frozen>(block));
        }
        let width = |axis: usize| {
            let along: Vec<_> = particles(&app, block).positions().map(|x| x[axis]).collect();
            along.iter().copied().fold(f64::NEG_INFINITY, f64::max) - along.into_iter().fold(f64::INFINITY, f64::min)
        };
        let width = width(0).max(width(2));
        let torn = app.world().get::<Tearing>(block).unwrap().count();
        // Back at its start it is whole again.
        app.world_mut().resource_mut::<Clock>().set_steps_per_tick(1);
        app.world_mut().write_message(Restart);
        app.update();
        assert_eq!(app.world().get::<Tearing>(block).unwrap().count(), 0);
        (torn, width)
    };
    let (torn, width) = torn_after(0.1);
    assert!(torn > 100 && width > 20.0, "{torn} torn, {width} wide");
    assert_eq!(torn_after(5.0).0, 0);
}

#[test]
fn what_tears_does_not_depend_on_the_ticks() {
    let torn = |steps: u64| {
        let mut creature = Creature::from(JellyPlan { tilt: 30.0, drop: 3.0, ..cube(3, &Neighbours::ALL, 0.0) });
        creature.tear = Some(0.2);
        let mut app = stepping_app(0.05, steps);
        let block = app.world_mut().spawn((Method::StormerVerlet, Gravity::new(0.2).unwrap(), Ground::Flat)).id();
        bevy::ecs::system::EntityCommand::apply(
            creature.body(Pose::default()).unwrap(),
            app.world_mut().entity_mut(block),
        );
        while app.world().resource::<Clock>().step() < 600 {
            app.update();
        }
        let tearing = app.world().get::<Tearing>(block).unwrap().clone();
        (tearing, crate::support::bits(particles(&app, block)))
    };
    let at_once = torn(600);
    assert!(at_once.0.count() > 0);
    assert_eq!(at_once, torn(30));
}
