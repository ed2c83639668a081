//! What few think of: particles in one place, roads of one particle, of none and of a million.

use bevy::math::DVec3;
use wriggle::{
    body::{Bonds, Collisions, Columns, Particle, Particles, Rule, Rules},
    creatures::{RoadForm, Roller, SixBody, Strip},
    mechanics::six_matrix::{Road, look},
};

use crate::six_matrix::Six;

/// A body of particles and rules without a plan.
pub fn bare(places: &[DVec3], bound: impl Fn(usize, usize) -> bool, rules: Vec<Rule>, road: Option<Road>) -> Six {
    let count = places.len();
    Six {
        particles: Particles::new(places.iter().map(|x| Particle::at(*x))).unwrap(),
        six: SixBody {
            columns: Columns::new(places.iter().map(|x| (0.95, *x))).unwrap(),
            bonds: Bonds::new(places.to_vec(), bound),
            collisions: Collisions::new(count, |i, j| i != j),
            rules: Rules::new(rules, count).unwrap(),
        },
        road,
    }
}

#[test]
fn particles_in_the_same_place_leave_each_other_alone() {
    let places = [DVec3::ZERO, DVec3::ZERO, DVec3::new(0.0, 3.0, 0.0)];
    let road = Road::new(vec![DVec3::ZERO], Vec::new()).unwrap();
    let six = bare(&places, |i, j| i != j, Vec::new(), Some(road));
    six.run(200, |_, state| {
        assert!(state.position.iter().all(|x| x.is_finite()));
        assert_eq!(state.position[0], state.position[1]);
    })
    .unwrap();
}

#[test]
fn roads_of_one_particle_and_of_none_are_roads() {
    let leg = wriggle::body::Leg {
        particle: wriggle::body::ParticleId(0),
        // Whose memory stays (0, 0, 0): the leg is free.
        clock: wriggle::body::ParticleId(1),
        free: wriggle::body::Free::Contracting,
        seek: 0.5,
        push: 0.0,
        from: wriggle::body::ParticleId(0),
        grip: 1.0,
    };
    let run = |road: Option<Vec<DVec3>>, from: DVec3| {
        let road = road.map(|points| Road::new(points, Vec::new()).unwrap());
        let places = [from, DVec3::new(0.0, -500.0, 0.0)];
        bare(&places, |_, _| false, vec![Rule::Leg(leg)], road).after(3000, |state| state.position[0])
    };
    // A leg is drawn to the one particle from however far, and comes to rest near it, pushed off and drawn on.
    for from in [DVec3::new(1.0, 1.0, 0.0), DVec3::new(300.0, 40.0, 0.0)] {
        let distance = run(Some(vec![DVec3::ZERO]), from).length();
        assert!((1.0..2.0).contains(&distance), "{distance}");
    }
    // Without a road it is drawn nowhere.
    let from = DVec3::new(3.0, 1.0, 0.0);
    assert_eq!(run(None, from), from);
    assert_eq!(run(Some(Vec::new()), from), from);
    // A roller over no road sees none, brakes and falls.
    let creature = Roller::default().composed();
    for road in [None, Some(Road::new(Vec::new(), Vec::new()).unwrap())] {
        let roller = Six::new(&creature, |x| x, road);
        let position: Vec<_> = roller.particles.positions().collect();
        assert_eq!(look(roller.drive(), &position, roller.road.as_ref()).goals, (-1.0, -1.0));
        assert!(roller.after(300, |state| state.center().y) < -50.0);
    }
}

/// A straight road of a hundred particles a row, how many bytes it takes a particle, and how far the roller gets on it in 100 steps.
fn wide(rows: u32) -> (f64, f64) {
    let form =
        RoadForm::Strip(Strip { rows, columns: 100, spacing: 1.5, at: (0.0, 2.0, 40.0), heading: -90.0, bump: 0.0 });
    let road = form.build().unwrap();
    let bytes = road.bytes() as f64 / road.points().len() as f64;
    let roller = Six::new(&Roller::default().composed(), |x| x, Some(road));
    (bytes, roller.after(100, |state| state.center().z))
}

#[test]
fn memory_grows_with_the_road_and_with_nothing_else() {
    for rows in [60, 600] {
        let (bytes, z) = wide(rows);
        assert!(bytes < 250.0, "{rows} rows: {bytes} bytes a particle");
        assert!((z + 0.42).abs() < 0.01, "it drives as on a short strip: {z}");
    }
}

#[test]
#[ignore = "takes long unoptimised: cargo test --release --no-default-features --test it a_road_of_a_million -- --ignored --nocapture"]
fn a_road_of_a_million_particles_takes_no_more_for_each() {
    let (bytes, z) = wide(10_000);
    println!("{bytes:.0} bytes a particle");
    assert!(bytes < 250.0 && (z + 0.42).abs() < 0.01, "{bytes}, {z}");
}
