//! Animals go where they are sent, and stop where they are told to.

use std::sync::Arc;

use bevy::{
    math::{DVec2, DVec3},
    prelude::*,
};
use wriggle::{
    body::{Ground, Patch, Surface, Terrain},
    creatures::Pose,
    physics::{Clock, Restart, Steer},
    scenes::{self, SceneBodies},
};

use crate::{
    animal::{Animal, Ran},
    support::{bits, particles, run_until, stepping_app},
};

fn steer(app: &mut App, body: Entity) -> Mut<'_, Steer> {
    app.world_mut().get_mut::<Steer>(body).unwrap()
}

fn middle(app: &App, body: Entity) -> DVec2 {
    let center = particles(app, body).center();
    DVec2::new(center.x, center.z)
}

/// The place so many body lengths away from the middle of an animal at rest, at so many degrees to the right of where it points.
fn away(animal: &Animal, lengths: f64, degrees: f64) -> DVec2 {
    let length = f64::from(animal.plan.segments);
    DVec2::X * 0.5 * length + DVec2::from_angle(degrees.to_radians()) * lengths * length
}

fn steered() -> [Animal; 4] {
    [
        Animal::shipped("worm-steered", 0.03),
        Animal::snake(),
        Animal::shipped("caterpillar-steered", 0.1),
        Animal::sidewinder(),
    ]
}

/// Where each animal is sent that is steered, in degrees to its right.
const EACH: [f64; 3] = [0.0, 60.0, -60.0];

/// Sends an animal at rest three body lengths away at some angles. It is there within so many cycles, and stays.
fn reaches(animal: &Animal, at: &[f64], within: usize, part: f64) {
    for &degrees in at {
        let (mut app, body) = animal.app();
        let target = away(animal, 3.0, degrees);
        let mut ran = Ran::start(&mut app, body);
        steer(&mut app, body).go_to(target).unwrap();
        let mut cycles = 0;
        while !steer(&mut app, body).has_arrived() {
            assert!(cycles < within, "at {degrees}° it is at {} after {cycles} cycles", middle(&app, body));
            ran.go_on(&mut app, 1);
            cycles += 1;
        }
        ran.go_on(&mut app, 4);
        let length = f64::from(animal.plan.segments);
        let off = middle(&app, body).distance(target) / length;
        println!(
            "{degrees}°: {cycles} cycles, {off:.3} body lengths off, smallest cell {:.3}",
            ran.metrics().smallest_cell
        );
        assert!(off < part, "at {degrees}° it stays {off} body lengths off");
        assert!(ran.metrics().smallest_cell > 0.5, "smallest cell {}", ran.metrics().smallest_cell);
    }
}

#[test]
fn the_worm_reaches_its_target() {
    reaches(&steered()[0], &EACH, 32, 0.3);
}

#[test]
fn the_snake_reaches_its_target() {
    reaches(&steered()[1], &EACH, 9, 0.3);
}

#[test]
fn the_caterpillar_reaches_its_target() {
    reaches(&steered()[2], &EACH, 17, 0.3);
}

#[test]
fn the_sidewinder_nears_its_target_by_alternating_sides() {
    reaches(&steered()[3], &EACH, 24, 0.5);
}

#[test]
fn what_stops_stays_and_goes_on() {
    for animal in steered() {
        let (mut app, body) = animal.app();
        let length = f64::from(animal.plan.segments);
        run_until(&mut app, 4.0 * animal.period());
        steer(&mut app, body).stop();
        let stop = middle(&app, body);
        run_until(&mut app, 8.0 * animal.period());
        let drift = middle(&app, body).distance(stop) / length;
        println!("period {}: drifts {drift:.3} body lengths", animal.period());
        assert!(drift < 0.1, "period {}: drifts {drift} body lengths", animal.period());
        let rest = middle(&app, body);
        steer(&mut app, body).go();
        run_until(&mut app, 11.0 * animal.period());
        assert!(middle(&app, body).distance(rest) > 0.1 * length);
    }
}

#[test]
fn a_side_is_a_side() {
    for animal in steered() {
        let go = |side: f64| {
            let (mut app, body) = animal.app();
            steer(&mut app, body).turn(side).unwrap();
            run_until(&mut app, 8.0 * animal.period());
            middle(&app, body)
        };
        let (left, right) = (go(-2.0), go(1.0));
        assert!(right.y > 0.5 && left.y < -0.5, "period {}: goes to {left} and {right}", animal.period());
    }
}

/// A sidewinder on grass up to a place on x, as in the scene `sand`.
fn on_grass(to: f64) -> Animal {
    let grass = Patch::Box { from: (-30.0, -60.0), to: (to, 60.0), grip: 10.0 };
    let terrain = Terrain::new([Surface::Floor { height: 0.0 }]).unwrap().with_patches([grass]).unwrap();
    Animal::sidewinder().with(|snake| snake.ground = Some(Ground::Terrain(Arc::new(terrain))))
}

#[test]
fn on_the_grass_of_the_sand_the_snake_turns_to_the_side_that_it_is_told() {
    for side in [-1.0, 1.0] {
        let mut app = stepping_app(0.05, 8);
        scenes::open(app.world_mut(), scenes::load("sand").unwrap()).unwrap();
        let body = app.world().resource::<SceneBodies>().0[0];
        let mut clock = app.world_mut().resource_mut::<Clock>();
        clock.set_dt(0.05).unwrap();
        clock.set_steps_per_tick(8);
        steer(&mut app, body).turn(side).unwrap();
        let mut ran = Ran::start(&mut app, body);
        ran.go_on(&mut app, 3);
        let (turn, middle) = (ran.metrics().turn, middle(&app, body));
        println!("side {side}: turns {turn}° a cycle, and is at {middle}");
        assert!(middle.x < 28.0, "it has left the grass, at {middle}");
        assert!(side * turn > 16.0, "side {side}: turns {turn}° a cycle");
    }
}

#[test]
fn on_grass_a_sidewinder_reaches_targets_that_are_a_little_aside() {
    reaches(&on_grass(90.0), &[-20.0, 20.0, -60.0, 60.0], 9, 0.2);
}

#[test]
fn from_grass_to_sand_a_sidewinder_goes_on_to_its_side_in_another_way_with_the_same_bits_whatever_the_ticks() {
    let run = |steps: u64| {
        let animal = on_grass(30.0).with(|snake| snake.pose = Pose { at: DVec3::X * 14.0, ..Pose::default() });
        let mut app = stepping_app(animal.dt, steps);
        let body = animal.spawn(app.world_mut());
        steer(&mut app, body).turn(1.0).unwrap();
        while app.world().resource::<Clock>().step() < 1600 {
            app.update();
        }
        let guidance = steer(&mut app, body).guidance();
        assert!(guidance.turn_at(80.0) > 0.09 && guidance.lift_at(80.0) == 0.0, "on grass: {guidance:?}");
        while app.world().resource::<Clock>().step() < 6400 {
            app.update();
        }
        let guidance = steer(&mut app, body).guidance();
        assert!(middle(&app, body).x > 30.0, "it is on sand");
        // Its own waves roll it to the left.
        assert!(guidance.turn_at(320.0) == 0.0 && guidance.lift_at(320.0) == -1.0, "on sand: {guidance:?}");
        bits(particles(&app, body))
    };
    assert_eq!(run(64), run(1));
}

/// The bits of animals on their ways to targets after 4800 steps, by ticks of so many steps.
fn on_their_way(steps: u64, restart: bool) -> Vec<Vec<u64>> {
    let mut app = stepping_app(0.05, steps);
    let [worm, snake, _, sidewinder] = steered();
    let animals = [(snake, 50.0), (sidewinder.clone(), -60.0), (worm, -30.0), (sidewinder, 80.0)];
    let bodies = animals.map(|(mut animal, degrees)| {
        animal.pose = Pose::default();
        (animal.spawn(app.world_mut()), away(&animal, 3.0, degrees))
    });
    let send = |app: &mut App| {
        for (body, target) in bodies {
            steer(app, body).go_to(target).unwrap();
        }
    };
    send(&mut app);
    if restart {
        run_until(&mut app, 100.0);
        app.world_mut().write_message(Restart);
        app.world_mut().run_schedule(PreUpdate);
        assert_eq!(*steer(&mut app, bodies[0].0), Steer::default());
        send(&mut app);
    }
    while app.world().resource::<Clock>().step() < 4800 {
        app.update();
    }
    bodies.map(|(body, _)| bits(particles(&app, body))).into()
}

#[test]
fn steering_has_the_same_bits_whatever_the_ticks() {
    let one_by_one = on_their_way(1, false);
    assert_eq!(on_their_way(40, false), one_by_one);
    assert_eq!(on_their_way(96, false), one_by_one);
    assert_eq!(on_their_way(40, true), one_by_one, "after a restart");
}

#[test]
fn what_is_no_place_is_refused() {
    let mut steer = Steer::default();
    let error = steer.go_to(DVec2::new(0.0, f64::NAN)).unwrap_err().to_string();
    assert!(error.starts_with("steer.target.z: NaN is not allowed"), "{error}");
    let error = steer.turn(f64::INFINITY).unwrap_err().to_string();
    assert!(error.starts_with("steer.side: inf is not allowed"), "{error}");
    assert_eq!(steer, Steer::default());
}
