//! The watch: what explodes is frozen in its last good state, is named, and does not disturb its neighbour.

use std::sync::Arc;

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{Ground, Muscle, Muscles, Particles, Spring, SpringId, Springs, Surface, Terrain, TravelingWaves},
    creatures::Pose,
    mechanics::integrators::Method,
    physics::{BodyFrozen, BodyInverted, Frozen, Restart, WavesCut},
};

use crate::{
    animal::Animal,
    support::{Worm, bits, center, particles, stepping_app},
};

fn messages(app: &mut App) -> Vec<BodyFrozen> {
    app.world_mut().resource_mut::<Messages<BodyFrozen>>().drain().collect()
}

#[test]
fn an_exploding_worm_is_frozen_and_its_neighbour_is_not() {
    const DT: f64 = 0.05;
    let explicit = [
        Method::ExplicitEuler,
        Method::SemiImplicitEuler,
        Method::StormerVerlet,
        Method::DampedVerlet,
        Method::Leapfrog,
        Method::RungeKutta2,
        Method::RungeKutta4,
    ];
    for method in explicit {
        let alone = {
            let mut app = stepping_app(DT, 500);
            let calm = app.world_mut().spawn(Worm { method, ..Worm::GARDEN }.body()).id();
            app.update();
            bits(particles(&app, calm))
        };
        let mut app = stepping_app(DT, 500);
        let stiff = Worm { method, stiffness: 1e6, ..Worm::GARDEN }.body();
        let wild = app.world_mut().spawn((Name::new("wild"), stiff)).id();
        let calm = app.world_mut().spawn((Name::new("calm"), Worm { method, ..Worm::GARDEN }.body())).id();
        app.update();

        let frozen = app.world().get::<Frozen>(wild).unwrap().clone();
        assert!(frozen.step > 1 && frozen.step < 500 && frozen.time == frozen.step as f64 * DT, "{frozen:?}");
        for [a, b] in [[0, 1], [1, 2]] {
            let x: Vec<_> = particles(&app, wild).positions().collect();
            assert!(x[a].distance(x[b]) < 10.0, "the last good state is good: {x:?}");
        }
        let text = &messages(&mut app)[0].text;
        let limit = app.world().get::<wriggle::physics::Plan>(wild).unwrap().limit_text();
        for part in
            ["wild", &format!("particle {}", frozen.particle.0), &format!("step {}", frozen.step), "0.05", &limit]
        {
            assert!(text.contains(part), "{text} does not name {part}");
        }
        assert!(app.world().get::<Frozen>(calm).is_none());
        assert_eq!(bits(particles(&app, calm)), alone, "{method:?}");

        let still = bits(particles(&app, wild));
        app.update();
        assert_eq!(bits(particles(&app, wild)), still);
        assert!(messages(&mut app).is_empty());
    }
}

#[test]
fn a_rest_length_that_is_too_small_for_the_pose_is_said_to_be_that() {
    let mut worm = Worm::GARDEN.body();
    let spring = |i| Spring { rest_length: 0.1, ..worm.springs.get(SpringId(i)).unwrap() };
    worm.springs = Springs::new([spring(0), spring(1)], &worm.particles).unwrap();
    let mut app = stepping_app(0.01, 10);
    let body = app.world_mut().spawn(worm).id();
    app.update();
    let frozen = app.world().get::<Frozen>(body).unwrap();
    assert_eq!(frozen.step, 1);
    assert!(frozen.reason.contains("ten rest lengths of 0.1, and springs were so before"), "{}", frozen.reason);
    let text = &messages(&mut app)[0].text;
    assert!(text.contains("too small for the pose, whatever dt is"), "{text}");
    // What explodes by its step is not said to have begun so.
    let mut app = stepping_app(0.05, 500);
    let body = app.world_mut().spawn(Worm { stiffness: 1e6, ..Worm::GARDEN }.body()).id();
    app.update();
    let reason = &app.world().get::<Frozen>(body).unwrap().reason;
    assert!(reason.ends_with("is longer than ten rest lengths of 1"), "{reason}");
}

#[test]
fn what_a_frozen_body_cost_does_not_depend_on_the_ticks() {
    let cost = |steps_a_tick: u64| {
        let mut app = stepping_app(0.05, steps_a_tick);
        let body = app.world_mut().spawn(Worm { stiffness: 1e6, ..Worm::GARDEN }.body()).id();
        for _ in 0..100 / steps_a_tick {
            app.update();
        }
        let frozen = app.world().get::<Frozen>(body).unwrap().step;
        let cost = app.world().resource::<wriggle::physics::Cost>();
        assert_eq!((cost.force_evaluations, cost.spring_updates), (frozen, 2 * frozen));
    };
    for steps_a_tick in [1, 10, 100] {
        cost(steps_a_tick);
    }
}

#[test]
fn a_dt_above_the_limit_warns_and_does_not_freeze() {
    // Without muscles and at rest nothing moves, however large dt is.
    let mut app = stepping_app(10.0, 10);
    let body = app.world_mut().spawn(Worm { amplitude: 0.0, ..Worm::GARDEN }.body()).id();
    app.update();
    assert!(app.world().get::<wriggle::physics::Plan>(body).unwrap().stability_limit() < 1.0);
    assert!(app.world().get::<Frozen>(body).is_none());
    assert!(messages(&mut app).is_empty());
}

#[test]
fn a_restart_thaws() {
    let mut app = stepping_app(2.0, 200);
    let body = app.world_mut().spawn(Worm::GARDEN.body()).id();
    app.update();
    assert!(app.world().get::<Frozen>(body).is_some());
    app.world_mut().resource_mut::<wriggle::physics::Clock>().set_dt(0.01).unwrap();
    app.world_mut().write_message(Restart);
    for _ in 0..10 {
        app.update();
    }
    assert!(app.world().get::<Frozen>(body).is_none());
    assert!(center(&app, body) > 1.5);
}

#[test]
fn components_of_different_bodies_are_refused_by_name() {
    let mut app = stepping_app(0.01, 1);
    let two = Particles::new((0..2).map(|i| wriggle::body::Particle::at(bevy::math::DVec3::X * f64::from(i)))).unwrap();
    let body = app.world_mut().spawn((Name::new("chimera"), two, Worm::GARDEN.body().springs)).id();
    app.update();
    assert!(app.world().get::<Frozen>(body).unwrap().reason.contains("made for another body"));
    assert!(messages(&mut app)[0].text.contains("chimera"));
}

#[test]
fn a_spring_of_no_length_pulls_nowhere_and_stays_finite() {
    let mut app = stepping_app(0.01, 100);
    let mut worm = Worm { amplitude: 0.0, ..Worm::GARDEN }.body();
    for i in 0..3 {
        worm.particles.set(wriggle::body::ParticleId(i), wriggle::body::Particle::at(bevy::math::DVec3::ZERO)).unwrap();
    }
    let on_axis = app.world_mut().spawn(worm.clone()).id();
    let in_space = app.world_mut().spawn((worm, wriggle::body::Ground::Flat)).id();
    app.update();
    for body in [on_axis, in_space] {
        assert!(particles(&app, body).positions().all(|x| x == bevy::math::DVec3::ZERO));
    }
}

#[test]
fn a_muscle_never_drives_a_spring_below_the_least_rest_length() {
    let mut body = Worm { amplitude: 3.0, ramp: 0.0, ..Worm::GARDEN }.body();
    body.springs.set(SpringId(0), Spring { rest_length: 2.0, ..body.springs.get(SpringId(0)).unwrap() }).unwrap();
    let rest =
        |springs: &Springs, time| wriggle::mechanics::rest_length(springs, Some(&body.muscles), SpringId(0), time);
    assert_eq!(rest(&body.springs, 4.5), 0.4);
    assert!((rest(&body.springs, 1.5) - 8.0).abs() < 1e-14);
}

#[test]
fn a_particle_without_springs_is_frozen_when_it_is_not_finite() {
    let mut app = stepping_app(1.0, 100);
    let particle = wriggle::body::Particle {
        velocity: bevy::math::DVec3::X * 1e307,
        ..wriggle::body::Particle::at(bevy::math::DVec3::ZERO)
    };
    let body = app.world_mut().spawn((Particles::new([particle]).unwrap(), Springs::default())).id();
    app.update();
    let frozen = app.world().get::<Frozen>(body).unwrap();
    assert_eq!((frozen.particle.0, frozen.reason.as_str()), (0, "it is not finite"));
    assert!(particles(&app, body).positions().all(|x| x.is_finite()));
}

fn told_of_inversion(app: &mut App) -> Vec<String> {
    app.world_mut().resource_mut::<Messages<BodyInverted>>().drain().map(|told| told.text).collect()
}

#[test]
fn a_worm_that_is_squeezed_inside_out_is_told_of_once() {
    let told = |wall: f64| {
        let wall = Surface::Plane { point: (wall, 0.0, 0.0), normal: (-1.0, 0.0, 0.0) };
        let ground = Terrain::new([Surface::Floor { height: 0.0 }, wall]).unwrap();
        let worm = Animal::worm().with(|worm| {
            worm.dt = 0.05;
            worm.ground = Some(Ground::Terrain(Arc::new(ground)));
            worm.pose = Pose { at: DVec3::X * 6.0, ..Pose::default() };
        });
        let mut app = stepping_app(worm.dt, 100);
        worm.spawn(app.world_mut());
        let mut texts = Vec::new();
        for _ in 0..42 {
            app.update();
            texts.extend(told_of_inversion(&mut app));
        }
        texts
    };
    // It is on its way to a wall that is far, and pushes head on against one that is near.
    assert_eq!(told(1000.0), [""; 0]);
    let near = told(18.0);
    assert!(near.len() == 1 && near[0].contains(" is inside out at step "), "{near:?}");
}

#[test]
fn a_fold_that_lasts_for_a_part_of_a_cycle_is_told_of_once_and_again_after_a_restart() {
    let cliff = Surface::Cliff { edge: 4.0, radius: 2.0, drop: Some(8.0) };
    let worm = Animal::worm().with(|worm| {
        (worm.dt, worm.gravity) = (0.05, 0.1);
        worm.ground = Some(Ground::Terrain(Arc::new(Terrain::new([cliff]).unwrap())));
        worm.pose = Pose { at: DVec3::X * -6.0, ..Pose::default() };
    });
    let (mut app, body) = worm.app();
    for _ in 0..2 {
        let mut texts = Vec::new();
        let mut inverted = 0;
        while app.world().resource::<wriggle::physics::Clock>().time() < 100.0 {
            app.update();
            texts.extend(told_of_inversion(&mut app));
            let strand = crate::animal::strand(&app, body);
            let volume = |segment| wriggle::mechanics::metrics::cell_volume(particles(&app, body), strand, segment);
            inverted += usize::from((0..strand.segments()).any(|segment| volume(segment) < 0.0));
        }
        assert!(inverted > 0 && texts.len() == 1, "{inverted} samples: {texts:?}");
        app.world_mut().write_message(Restart);
        app.world_mut().run_schedule(PreUpdate);
    }
}

#[test]
fn waves_that_come_to_be_cut_are_told_of_once() {
    fn told(app: &mut App) -> Vec<String> {
        app.update();
        app.world_mut().resource_mut::<Messages<WavesCut>>().drain().map(|told| told.text).collect()
    }
    let mut app = stepping_app(0.03, 10);
    let worm = Animal::worm().spawn(app.world_mut());
    let garden = app.world_mut().spawn((Name::new("garden"), Worm::GARDEN.body())).id();
    assert_eq!(told(&mut app), [""; 0]);
    // The wave takes 0.3.
    for (steering, cut) in [(0.5, false), (0.7, true), (-0.9, false), (0.0, false), (-0.7, true)] {
        app.world_mut().get_mut::<TravelingWaves>(worm).unwrap().set_steering(steering).unwrap();
        let texts = told(&mut app);
        let said =
            texts.iter().any(|text| text.contains("waves: their amplitudes and the steering come to 1 together"));
        assert_eq!((said, texts.len()), (cut, usize::from(cut)), "{steering}: {texts:?}");
    }
    let mut muscles = app.world_mut().get_mut::<Muscles>(garden).unwrap();
    let wide = Muscle { amplitude: 0.9, ..muscles.get(1).unwrap() };
    muscles.set(1, wide, 0.0).unwrap();
    let texts = told(&mut app);
    assert!(texts.len() == 1 && texts[0].starts_with("garden: springs[1].muscle.amplitude: 0.9 is above"), "{texts:?}");
    assert_eq!(told(&mut app), [""; 0]);
}
