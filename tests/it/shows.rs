//! What the animals' scenes are there to show.

use bevy::prelude::*;
use wriggle::{
    body::{Strand, TravelingWaves},
    mechanics::metrics::{Gait, GaitMetrics, cell_volume},
    physics::{Clock, Frozen, body_parts},
    scenes::{self, SceneBodies, parameters},
};

use crate::support::{particles, stepping_app};

/// A shipped scene, every update five steps.
struct Show {
    app: App,
    gaits: Vec<(Entity, Option<Gait>)>,
}

impl Show {
    fn open(scene: &str, dt: f64) -> Self {
        let mut app = stepping_app(dt, 5);
        scenes::open(app.world_mut(), scenes::load(scene).unwrap()).unwrap();
        let mut clock = app.world_mut().resource_mut::<Clock>();
        clock.set_dt(dt).unwrap();
        clock.set_steps_per_tick(5);
        let bodies = app.world().resource::<SceneBodies>().0.clone();
        let gait = |body: Entity| Gait::new(&body_parts(app.world().entity(body)).unwrap());
        let gaits = bodies.into_iter().map(|body| (body, gait(body))).collect();
        Self { app, gaits }
    }

    fn run_until(&mut self, time: f64) {
        while self.app.world().resource::<Clock>().time() < time - 1e-9 {
            self.app.update();
            let clock = self.app.world().resource::<Clock>();
            for (body, gait) in &mut self.gaits {
                let body = self.app.world().entity(*body);
                assert!(!body.contains::<Frozen>());
                if let Some(gait) = gait {
                    gait.sample(&body_parts(body).unwrap(), clock.time(), clock.dt());
                }
            }
        }
    }

    fn gait(&self, body: usize) -> GaitMetrics {
        self.gaits[body].1.as_ref().unwrap().measure().unwrap()
    }
}

#[test]
fn in_the_meadow_each_animal_goes_its_way() {
    let mut show = Show::open("meadow", 0.05);
    // Shown in circles, their gaits are measured straight on.
    for animal in ["snake", "worm", "caterpillar"] {
        parameters::set(show.app.world_mut(), &format!("{animal}.gait.steering"), 0.0).unwrap();
    }
    show.run_until(400.0);
    let [sidewinder, snake, worm, caterpillar] = [0, 1, 2, 3].map(|i| show.gait(i));
    assert!(sidewinder.angle < -30.0 && sidewinder.lifted > 0.5, "{sidewinder:?}");
    // Its first cycles, in which it has yet to bend, still count.
    assert!((snake.body_lengths - 0.66).abs() < 0.05 && snake.path_error < 0.3, "{snake:?}");
    assert!((worm.body_lengths - 0.132).abs() < 0.01, "{worm:?}");
    assert!((caterpillar.body_lengths - 0.267).abs() < 0.02, "{caterpillar:?}");
    assert!([sidewinder, snake, worm, caterpillar].iter().all(|gait| gait.smallest_cell > 0.5));
}

#[test]
fn on_grass_the_snake_goes_straight_and_on_sand_it_winds_sideways() {
    let mut show = Show::open("sand", 0.05);
    show.run_until(160.0);
    let grass = show.gait(0);
    assert!(grass.angle.abs() < 15.0 && grass.forward > 3.0, "{grass:?}");
    show.run_until(1440.0);
    let sand = show.gait(0);
    assert!(sand.angle.abs() > 60.0, "{sand:?}");
}

#[test]
fn little_damping_shows_in_the_standing_waves() {
    let mut show = Show::open("standing-waves", 0.05);
    show.run_until(400.0);
    let [wild, calm] = [0, 1].map(|i| show.gait(i));
    assert!(calm.smallest_cell > 0.8 && calm.residue < 0.03, "{calm:?}");
    assert!(wild.smallest_cell < 0.3 || wild.residue > 0.1, "{wild:?}");
}

#[test]
fn two_masses_with_scales_get_on() {
    let mut show = Show::open("two-masses", 0.02);
    let body = show.gaits[0].0;
    show.run_until(60.0);
    let start = particles(&show.app, body).center().x;
    let mut rests = [0; 2];
    for _ in 0..60 {
        show.run_until(show.app.world().resource::<Clock>().time() + 0.1);
        for (rest, v) in rests.iter_mut().zip(particles(&show.app, body).velocities()) {
            *rest += u32::from(v.x == 0.0);
        }
    }
    let way = particles(&show.app, body).center().x - start;
    assert!(way > 0.2, "goes {way} a cycle");
    assert!(rests[0] > 10 && rests[1] > 10, "each holds for a part of the cycle: {rests:?}");
}

#[test]
fn feet_get_on_only_where_they_are_lifted() {
    let mut show = Show::open("foot", 0.1);
    show.run_until(400.0);
    let [sliding, lifting] = [0, 1].map(|i| show.gait(i).forward);
    assert!(sliding.abs() < 0.02, "slides {sliding}");
    assert!((lifting / 0.44 - 1.0).abs() < 0.15, "steps {lifting}");
}

#[test]
fn nothing_gets_through_the_wall() {
    let mut show = Show::open("wall", 0.05);
    for _ in 0..40 {
        show.run_until(show.app.world().resource::<Clock>().time() + 10.0);
        for (body, _) in &show.gaits {
            let furthest = particles(&show.app, *body).positions().map(|x| x.x).fold(0.0, f64::max);
            assert!(furthest <= 14.0 + 1e-9, "{furthest}");
        }
    }
    let worm = particles(&show.app, show.gaits[0].0);
    let gap = 14.0 - worm.positions().map(|x| x.x).fold(0.0, f64::max);
    assert!(gap < 0.5, "the worm stays {gap} away from the wall");
    let snake = show.gait(1);
    assert!(snake.smallest_cell > 0.7 && snake.distance > 1.0, "{snake:?}");
}

/// Runs every scene of strands for so many cycles of its slowest wave, at its own step: no cell turns inside out but of the one body that is there to show it.
fn no_cell_inverts(cycles: f64) {
    for scene in ["cliff", "foot", "meadow", "sand", "standing-waves", "wall"] {
        let mut app = stepping_app(1.0, 1);
        scenes::open(app.world_mut(), scenes::load(scene).unwrap()).unwrap();
        let bodies = app.world().resource::<SceneBodies>().0.clone();
        let periods = bodies.iter().filter_map(|&body| app.world().get::<TravelingWaves>(body)?.longest_period());
        let period = periods.fold(0.0, f64::max);
        let mut clock = app.world_mut().resource_mut::<Clock>();
        let steps = (0.05 * period / clock.dt()) as u64;
        clock.set_steps_per_tick(steps);
        let mut smallest = f64::INFINITY;
        while app.world().resource::<Clock>().time() < cycles * period {
            app.update();
            for &body in &bodies {
                if scene == "standing-waves" && app.world().get::<Name>(body).unwrap().as_str() == "undamped" {
                    continue;
                }
                assert!(!app.world().entity(body).contains::<Frozen>(), "{scene}");
                let Some(&strand) = app.world().get::<Strand>(body) else { continue };
                for segment in 0..strand.segments() {
                    smallest = smallest.min(cell_volume(particles(&app, body), strand, segment));
                }
            }
            assert!(smallest > 0.0, "{scene}: a cell inverts by t = {}", app.world().resource::<Clock>().time());
        }
        println!("{scene}: the smallest cell in {cycles} cycles is {smallest:.3}");
    }
}

#[test]
fn no_cell_inverts_in_the_first_cycles_of_a_scene() {
    no_cell_inverts(15.0);
}

#[test]
#[ignore = "takes minutes"]
fn no_cell_inverts_in_200_cycles_of_a_scene() {
    no_cell_inverts(200.0);
}

#[test]
fn what_is_set_in_a_scene_is_saved_with_it() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("mine.scene.ron");
    let mut world = World::new();
    scenes::open(&mut world, scenes::load("sand").unwrap()).unwrap();
    for (path, value) in
        [("snake.waves[1].lead", -0.25), ("snake.gait.steering", 0.04), ("snake.friction.isotropic", 0.2)]
    {
        parameters::set(&mut world, path, value).unwrap();
    }
    scenes::save(&mut world, &path).unwrap();
    let again = scenes::load(path.to_str().unwrap()).unwrap();
    assert_eq!(again.file.ground, scenes::load("sand").unwrap().file.ground);
    let mut other = World::new();
    scenes::open(&mut other, again).unwrap();
    assert_eq!(parameters::list(&mut other), parameters::list(&mut world));
}
