//! Contact with grounds of all kinds.

use std::sync::Arc;

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{Gravity, Ground, Particle, ParticleId, Particles, Patch, SpineFriction, Spring, Springs, Surface, Terrain},
    mechanics::{ground_distance, integrators::Method},
};

use crate::{
    animal::Animal,
    support::{in_space, particles, run_until, stepping_app},
};

fn terrain(surfaces: impl IntoIterator<Item = Surface>, bounce: f64) -> Ground {
    Ground::Terrain(Arc::new(Terrain::new(surfaces).unwrap().with_bounce(bounce).unwrap()))
}

/// One mass, with what it is thrown at.
fn throw(app: &mut App, position: DVec3, velocity: DVec3, gravity: f64, ground: Ground, method: Method) -> Entity {
    let mass = Particles::new([Particle { velocity, ..Particle::at(position) }]).unwrap();
    app.world_mut().spawn((mass, Springs::default(), Gravity::new(gravity).unwrap(), ground, method)).id()
}

fn mass(app: &App, body: Entity) -> Particle {
    particles(app, body).get(ParticleId(0)).unwrap()
}

#[test]
fn k1_a_mass_rebounds_as_high_as_its_bounce_says() {
    for (dt, within) in [(0.02, 0.002), (0.1, 0.01)] {
        let mut app = stepping_app(dt, 1);
        let floor = terrain([Surface::Floor { height: 0.0 }], 0.8);
        let ball = throw(&mut app, DVec3::Y, DVec3::ZERO, 1.0, floor, Method::SemiImplicitEuler);
        let (mut lowest, mut rebound) = (1.0_f64, 0.0_f64);
        // It meets the floor at √2, is up again 1.6·0.8·… = 1.13 later, and comes back after as long.
        while rebound == 0.0 || mass(&app, ball).velocity.y > 0.0 {
            app.update();
            let y = mass(&app, ball).position.y;
            lowest = lowest.min(y);
            assert!(y >= 0.0, "below the floor at {y}");
            if mass(&app, ball).velocity.y > 0.0 {
                rebound = rebound.max(y);
            }
        }
        rebound = rebound.max(mass(&app, ball).position.y);
        assert!((rebound - 0.64).abs() < within, "rebounds to {rebound} with dt {dt}");
    }
}

#[test]
fn k1_without_bounce_a_mass_stays_where_it_falls() {
    for method in in_space() {
        let mut app = stepping_app(0.02, 1);
        let floor = terrain([Surface::Floor { height: 0.0 }], 0.0);
        let ball = throw(&mut app, DVec3::Y, DVec3::X, 1.0, floor, method);
        for _ in 0..150 {
            app.update();
            let y = mass(&app, ball).position.y;
            assert!(y >= 0.0, "below the floor at {y}");
        }
        let ball = mass(&app, ball);
        assert_eq!(ball.position.y, 0.0, "{method:?}");
        assert!((ball.velocity.x - 1.0).abs() < 1e-9, "the floor has no friction: {}, {method:?}", ball.velocity);
    }
}

#[test]
fn a_bouncing_mass_comes_to_rest() {
    let mut app = stepping_app(0.02, 1);
    let floor = terrain([Surface::Floor { height: 0.0 }], 0.5);
    let ball = throw(&mut app, DVec3::Y, DVec3::ZERO, 1.0, floor, Method::SemiImplicitEuler);
    run_until(&mut app, 20.0);
    let ball = mass(&app, ball);
    assert!(ball.position.y.abs() < 1e-12 && ball.velocity.length() < 1e-12, "{ball:?}");
}

#[test]
fn k2_on_a_plane_the_crossing_is_the_projection() {
    let normal = DVec3::new(-0.3, 1.0, 0.2).normalize();
    let plane = Surface::Plane { point: (0.0, 0.0, 0.0), normal: (-0.3, 1.0, 0.2) };
    for start in [normal * 0.01, normal * 0.001 + DVec3::X * 0.3] {
        let (dt, velocity) = (0.02, DVec3::new(0.7, -1.3, 0.4));
        let mut app = stepping_app(dt, 1);
        let ball = throw(&mut app, start, velocity, 1.0, terrain([plane], 0.0), Method::SemiImplicitEuler);
        app.update();
        let v = velocity - DVec3::Y * dt;
        let end = start + v * dt;
        assert!(end.dot(normal) < 0.0, "it goes below the plane");
        let expected = (end - normal * end.dot(normal), v - normal * v.dot(normal).min(0.0));
        let is = mass(&app, ball);
        assert!((is.position - expected.0).length() < 1e-6, "{} for {}", is.position, expected.0);
        assert!((is.velocity - expected.1).length() < 1e-6, "{} for {}", is.velocity, expected.1);
    }
}

#[test]
fn k2_a_worm_crawls_on_a_floor_as_on_the_flat_ground() {
    let flat = Animal::worm().run(5);
    let floor = Animal::worm().with(|worm| worm.ground = Some(terrain([Surface::Floor { height: 0.0 }], 0.0))).run(5);
    let (flat, floor) = (flat.metrics(), floor.metrics());
    assert!((flat.distance - floor.distance).abs() < 1e-6, "{} and {}", flat.distance, floor.distance);
    assert!((flat.smallest_cell - floor.smallest_cell).abs() < 1e-6);
}

#[test]
fn without_friction_a_mass_leaves_the_round_of_a_cliff_where_it_should() {
    for radius in [1.0, 3.0] {
        let mut app = stepping_app(0.002, 1);
        let cliff = terrain([Surface::Cliff { edge: 0.0, radius, drop: None }], 0.0);
        let start = DVec3::new(1e-3, 0.0, 0.0);
        let ball = throw(&mut app, start, DVec3::X * 1e-3, 1.0, cliff.clone(), Method::SemiImplicitEuler);
        let axis = DVec3::new(0.0, -radius, 0.0);
        let mut left = 0.0;
        loop {
            app.update();
            let x = mass(&app, ball).position;
            let (distance, _) = ground_distance(&cliff, x);
            assert!(distance > -1e-9, "inside by {distance}");
            let out = x - axis;
            if distance < 1e-9 {
                left = libm::acos(out.y / out.length()).to_degrees();
            } else if distance > 1e-2 * radius {
                break;
            }
        }
        assert!((46.4..48.7).contains(&left), "leaves at {left}°");
    }
}

#[test]
fn normals_are_the_gradients_of_distances() {
    let surfaces = [
        Surface::Floor { height: 0.3 },
        Surface::Plane { point: (1.0, 2.0, 3.0), normal: (0.4, 1.5, -0.7) },
        Surface::Cliff { edge: 0.5, radius: 2.0, drop: Some(4.0) },
        Surface::Hill { center: (0.2, -0.4), radius: 3.0, height: 0.4 },
        Surface::Ball { center: (0.5, -1.0, 0.7), radius: 1.5 },
    ];
    let together = terrain(surfaces, 0.0);
    for ground in surfaces.map(|surface| terrain([surface], 0.0)).iter().chain([&together]) {
        for i in 0..400 {
            let part = |k: i32| f64::from((i * k) % 97) / 97.0 * 6.0 - 3.0;
            let x = DVec3::new(part(13), 0.7 * part(29), part(41));
            let (distance, normal) = ground_distance(ground, x);
            assert!((normal.length() - 1.0).abs() < 1e-12);
            let step = 1e-6;
            let slope = |axis: DVec3| {
                (ground_distance(ground, x + axis * step).0 - ground_distance(ground, x - axis * step).0) / (2.0 * step)
            };
            let gradient = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            // The distance from a hill is one to first order, near it; on a seam of two surfaces there is no gradient.
            let hill = matches!(ground, Ground::Terrain(terrain) if terrain.surfaces().iter().any(|s| matches!(s, Surface::Hill { .. })));
            let seam = gradient.length() < 0.99;
            if !seam && (!hill || distance.abs() < 0.05) {
                let allowed = if hill { 0.05 } else { 1e-6 };
                assert!((gradient - normal).length() < allowed, "{normal} for {gradient} at {x} of {ground:?}");
            }
        }
    }
}

#[test]
fn a_wall_takes_what_leads_into_it_and_no_more() {
    for method in in_space() {
        let mut app = stepping_app(0.01, 1);
        let wall = Surface::Plane { point: (2.0, 0.0, 0.0), normal: (-2.0, 0.0, 0.0) };
        let ball = throw(&mut app, DVec3::Y, DVec3::new(1.0, 0.2, -0.5), 0.0, terrain([wall], 0.0), method);
        run_until(&mut app, 4.0);
        let ball = mass(&app, ball);
        assert!((ball.position - DVec3::new(2.0, 1.8, -2.0)).length() < 1e-9, "{} {method:?}", ball.position);
        assert!((ball.velocity - DVec3::new(0.0, 0.2, -0.5)).length() < 1e-9, "{} {method:?}", ball.velocity);
    }
}

#[test]
fn patches_change_the_side_grip_of_what_stands_on_them_alone() {
    let patches = [
        Patch::Box { from: (-1.0, -1.0), to: (0.5, 1.0), grip: 2.0 },
        Patch::Disc { center: (4.0, 0.0), radius: 1.5, grip: 5.0 },
    ];
    let ground = Terrain::new([Surface::Floor { height: 0.0 }]).unwrap().with_patches(patches).unwrap();
    // On the rectangle, between, on the disc, and above it.
    let row = [0.0, 1.0, 3.0, 4.0].map(|x| DVec3::new(x, if x == 4.0 { 0.2 } else { 0.0 }, 0.0));
    let velocity = DVec3::new(0.5, 0.0, 1.0);
    let masses = Particles::new(row.map(|position| Particle { velocity, ..Particle::at(position) })).unwrap();
    let friction = SpineFriction::new((0..4).map(ParticleId), &masses).unwrap().with_grip(1.0).unwrap();
    let mut app = stepping_app(0.01, 1);
    let ground = Ground::Terrain(Arc::new(ground));
    let body = app.world_mut().spawn((masses, Springs::default(), friction, ground)).id();
    app.update();
    let across: Vec<_> = particles(&app, body).velocities().map(|v| v.z).collect();
    for (is, rate) in across.into_iter().zip([2.0, 1.0, 5.0, 0.0]) {
        assert!((is - libm::exp(-0.01 * rate)).abs() < 1e-3 * 0.01, "{is} at the rate {rate}");
    }
}

/// A floor with two walls that face −x and −z through (1, 0, 1).
fn corner(bounce: f64) -> Ground {
    let wall = |normal| Surface::Plane { point: (1.0, 0.0, 1.0), normal };
    terrain([Surface::Floor { height: 0.0 }, wall((-1.0, 0.0, 0.0)), wall((0.0, 0.0, -1.0))], bounce)
}

#[test]
fn in_a_corner_of_floor_and_walls_no_speed_adds_up() {
    // A spring pushes one mass into the corner; the other is pinned.
    for (bounce, most) in [(0.0, 0.0), (0.5, 0.01)] {
        for place in [DVec3::X, DVec3::X + DVec3::Z] {
            let pinned = Particle { pinned: true, ..Particle::at(place * 0.5) };
            let masses = Particles::new([pinned, Particle::at(place)]).unwrap();
            let ends = [ParticleId(0), ParticleId(1)];
            let spring = Spring { ends, stiffness: 1.0, damping: 0.0, rest_length: 1.5 };
            let springs = Springs::new([spring], &masses).unwrap();
            let mut app = stepping_app(0.01, 1);
            let body = app.world_mut().spawn((masses, springs, Gravity::new(0.02).unwrap(), corner(bounce))).id();
            for _ in 0..200 {
                app.update();
                let masses = particles(&app, body);
                let (x, v) = (masses.position(ParticleId(1)).unwrap(), masses.velocity(ParticleId(1)).unwrap());
                assert!((x - place).length() <= 0.01 * most, "at {x} for {place}");
                assert!(v.length() <= most, "{v} at {place}");
            }
        }
    }
}

#[test]
fn in_a_corner_a_mass_loses_what_leads_into_each_surface_and_no_more() {
    for (velocity, expected) in [
        (DVec3::new(1.0, -2.0, 0.3), DVec3::new(0.0, 0.0, 0.3)),
        (DVec3::new(2.0, -1.0, 0.3), DVec3::new(0.0, 0.0, 0.3)),
        (DVec3::new(2.0, 1.0, 0.3), DVec3::new(0.0, 1.0, 0.3)),
        (DVec3::new(-2.0, -1.0, 0.3), DVec3::new(-2.0, 0.0, 0.3)),
        (DVec3::new(-2.0, 1.0, -0.3), DVec3::new(-2.0, 1.0, -0.3)),
    ] {
        for bounce in [0.0, 0.5] {
            let mut app = stepping_app(0.01, 1);
            let ball = throw(&mut app, DVec3::X, velocity, 0.0, corner(bounce), Method::SemiImplicitEuler);
            app.update();
            let expected = expected - bounce * (velocity - expected);
            let ball = mass(&app, ball);
            assert!((ball.velocity - expected).length() < 1e-12, "{} for {expected} from {velocity}", ball.velocity);
            assert!(ball.position.y >= 0.0 && ball.position.x <= 1.0, "{} from {velocity}", ball.position);
        }
    }
}

#[test]
fn a_terrain_without_a_surface_is_none() {
    let error = Terrain::new([]).unwrap_err().to_string();
    assert!(error.starts_with("surfaces: there is none; give one or more"), "{error}");
    let error = Terrain::new([Surface::Ball { center: (0.0, 0.0, 0.0), radius: -1.0 }]).unwrap_err().to_string();
    assert!(error.starts_with("surfaces[0].radius: -1 is not allowed"), "{error}");
}

#[test]
fn a_patch_whose_ends_are_the_wrong_way_round_covers_nothing_and_is_refused() {
    let floor = Terrain::new([Surface::Floor { height: 0.0 }]).unwrap();
    let error = floor.with_patches([Patch::Box { from: (1.0, 0.0), to: (2.0, -1.0), grip: 1.0 }]).unwrap_err();
    assert!(error.to_string().starts_with("patches[0].to: (2.0, -1.0) is not beyond from"), "{error}");
}
