//! The clock: whole steps, no drift, no jumps, pauses and single ticks.

use bevy::{ecs::schedule::ScheduleLabel, prelude::*, time::TimeUpdateStrategy};
use core::time::Duration;
use wriggle::physics::{Clock, Restart};

use crate::support::{Worm, bits, particles, ticking_app};

#[test]
fn time_does_not_drift_over_a_hundred_million_steps() {
    let clock = Clock::new(0.0005, 1.0).unwrap();
    assert_eq!(clock.timeline().time_at(100_000_000), 50_000.0);
}

#[test]
fn a_changed_dt_makes_no_jump() {
    let mut app = ticking_app(0.005, 3.0);
    app.world_mut().spawn(Worm::GARDEN.body());
    for _ in 0..50 {
        app.update();
    }
    let mut clock = app.world_mut().resource_mut::<Clock>();
    let (time, step) = (clock.time(), clock.step());
    clock.set_dt(0.001).unwrap();
    assert_eq!((clock.time(), clock.step()), (time, step));
    assert_eq!(clock.timeline().time_at(step + 10), time + 0.01);
    for _ in 0..50 {
        app.update();
    }
    let clock = app.world().resource::<Clock>();
    assert!((clock.time() - time - 50.0 / 64.0 * 3.0).abs() < 0.001 + 1e-12, "{}", clock.time() - time);
}

#[test]
fn the_time_scale_only_sets_how_many_whole_steps_a_tick_takes() {
    for (scale, expected) in [(0.0, 0), (0.1, 312), (1.0, 3125), (3.0, 9375)] {
        let mut app = ticking_app(0.0005, scale);
        for _ in 0..101 {
            app.update();
        }
        // 100 ticks of 1/64 s; what is left over after each is carried, so at most one step is missing.
        let steps = app.world().resource::<Clock>().step();
        assert!(steps == expected || steps + 1 == expected, "{steps} steps at scale {scale}, expected {expected}");
    }
}

#[test]
fn impossible_clocks_are_refused() {
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Clock::new(dt, 1.0).unwrap_err().to_string();
        assert!(error.contains("clock.dt") && error.contains("above 0"), "{error}");
    }
    for scale in [-1.0, f64::NAN, 1e6] {
        let mut clock = Clock::new(0.01, 2.0).unwrap();
        let error = clock.set_time_scale(scale).unwrap_err().to_string();
        assert!(error.contains("clock.time_scale"), "{error}");
        assert_eq!(clock.time_scale(), Some(2.0));
    }
}

#[test]
fn a_paused_app_stands_still_and_takes_exactly_one_tick_on_demand() {
    let mut app = ticking_app(0.005, 3.2);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(20)));
    let body = app.world_mut().spawn(Worm::GARDEN.body()).id();
    for _ in 0..20 {
        app.update();
    }
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    // The frame in which the pause begins may still run the time of the frame before.
    app.update();
    let (step, state) = (app.world().resource::<Clock>().step(), bits(particles(&app, body)));
    for _ in 0..10 {
        app.update();
    }
    assert_eq!(app.world().resource::<Clock>().step(), step);
    assert_eq!(bits(particles(&app, body)), state);

    let mut fixed = app.world_mut().resource_mut::<Time<Fixed>>();
    let tick = fixed.timestep();
    fixed.accumulate_overstep(tick);
    app.update();
    app.update();
    // 3.2/64/0.005 = 10 steps a tick.
    assert_eq!(app.world().resource::<Clock>().step(), step + 10);
}

#[test]
fn restart_goes_back_to_the_start_and_runs_the_same_again() {
    let mut app = ticking_app(0.005, 3.2);
    let body = app.world_mut().spawn(Worm::GARDEN.body()).id();
    let start = bits(particles(&app, body));
    let run = |app: &mut App| {
        while app.world().resource::<Clock>().step() < 1000 {
            app.update();
        }
        bits(particles(app, body))
    };
    let first = run(&mut app);
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    app.world_mut().write_message(Restart);
    app.update();
    assert_eq!((app.world().resource::<Clock>().step(), bits(particles(&app, body))), (0, start));
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    assert_eq!(run(&mut app), first);
}

#[test]
fn nothing_in_a_tick_is_ambiguous() {
    use bevy::ecs::schedule::{LogLevel, ScheduleBuildSettings};
    let mut app = crate::support::stepping_app(0.01, 1);
    for schedule in [Update.intern(), PreUpdate.intern(), PostUpdate.intern()] {
        app.edit_schedule(schedule, |schedule| {
            schedule.set_build_settings(ScheduleBuildSettings {
                ambiguity_detection: LogLevel::Error,
                ..ScheduleBuildSettings::default()
            });
        });
    }
    app.world_mut().spawn(Worm::GARDEN.body());
    app.update();
}

#[test]
fn a_tiny_dt_slows_time_down_and_does_not_hang_the_app() {
    let mut app = ticking_app(1e-300, 1.0);
    for _ in 0..4 {
        app.update();
    }
    assert_eq!(app.world().resource::<Clock>().step(), 3 * Clock::MOST_STEPS_A_TICK);
    app.world_mut().resource_mut::<Clock>().set_dt(0.001).unwrap();
    app.update();
    assert_eq!(app.world().resource::<Clock>().step(), 3 * Clock::MOST_STEPS_A_TICK + 15);
}
