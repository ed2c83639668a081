//! The gait in the panel: what is kept of it, and how it is plotted.

use bevy::prelude::*;
use bevy_egui::egui::{self, Pos2, Shape, vec2};
use egui_kittest::{Harness, kittest::Queryable};
use wriggle::{
    mechanics::{
        BodyParts,
        metrics::{Gait, GaitMetrics},
    },
    panel::{
        Settings, Traces,
        gait::{GaitWatch, KEPT, Measured},
        plots,
        traces::Observation,
    },
    physics::{Clock, body_parts},
};

use crate::animal::Animal;

/// Runs an animal for so many cycles, and shows it after every tick with the time and the step.
fn run(animal: &Animal, cycles: usize, mut see: impl FnMut(Entity, &BodyParts<'_>, f64, f64)) {
    let (mut app, body) = animal.app();
    let mut time = 0.0;
    while time < cycles as f64 * animal.period() {
        app.update();
        let clock = app.world().resource::<Clock>();
        time = clock.time();
        see(body, &body_parts(app.world().entity(body)).unwrap(), time, clock.dt());
    }
}

#[test]
fn what_was_measured_of_a_gait_is_kept_with_its_time() {
    let animal = Animal::worm();
    let (mut watch, mut own) = (GaitWatch::default(), None);
    let mut expected = Vec::new();
    run(&animal, 3, |body, parts, time, dt| {
        let gait = own.get_or_insert_with(|| Gait::new(parts).unwrap());
        gait.sample(parts, time, dt);
        let before = watch.history.len();
        watch.look(body, parts, time, dt);
        if watch.history.len() > before {
            expected.push(Measured { time, metrics: gait.measure().unwrap() });
        }
    });
    assert_eq!(watch.history.iter().copied().collect::<Vec<_>>(), expected);
    let times: Vec<_> = expected.iter().map(|measured| measured.time).collect();
    // Known once a cycle is over, and then eight times a cycle.
    let eighth = animal.period() / 8.0;
    assert!((times[0] - animal.period()).abs() < eighth, "{times:?}");
    assert!(times.windows(2).all(|pair| (pair[1] / eighth - pair[0] / eighth - 1.0).abs() < 0.05), "{times:?}");
    assert!((16..=17).contains(&times.len()), "{times:?}");
}

#[test]
fn the_history_of_a_gait_is_bounded_and_begins_anew() {
    let mut world = World::new();
    let [worm, snake] = [Animal::worm(), Animal::snake()].map(|animal| animal.spawn(&mut world));
    let parts = |body| body_parts(world.entity(body)).unwrap();
    // Nothing asks it to move.
    let (tick, dt) = (Animal::worm().period() / 16.0, 0.03);
    let mut watch = GaitWatch::default();
    let ticks = 4 * KEPT;
    for i in 0..=ticks {
        watch.look(worm, &parts(worm), i as f64 * tick, dt);
    }
    let end = ticks as f64 * tick;
    let times: Vec<_> = watch.history.iter().map(|measured| measured.time).collect();
    assert_eq!((times.len(), times[KEPT - 1]), (KEPT, end));
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] == 2.0 * tick), "the last ones, in order");
    let left = |body, time| {
        let mut watch = watch.clone();
        watch.look(body, &parts(body), time, dt);
        watch.history.len()
    };
    assert_eq!(left(worm, end + tick), KEPT);
    assert_eq!(left(snake, end + tick), 0, "another animal");
    assert_eq!(left(worm, end - tick), 0, "time went back");
    // Ticks that are longer than the cycles that are measured.
    for i in 1..=2 {
        watch.look(worm, &parts(worm), end + f64::from(i) * 100.0 * tick, dt);
    }
    assert!(watch.is_of_animal() && watch.history.is_empty(), "a gait that is no longer known");
}

/// What the panel plots of a gait: for each plot, the value of each line.
type Value = fn(&GaitMetrics) -> f64;
const PLOTS: [&[Value]; 4] = [
    &[|gait| gait.body_lengths],
    &[|gait| gait.angle, |gait| gait.turn],
    &[|gait| gait.slip, |gait| gait.lifted, |gait| gait.worst_strain, |gait| gait.residue],
    &[|gait| gait.path_error, |gait| gait.smallest_cell],
];

/// The lines through `count` points that a section draws, in order.
fn lines(harness: &Harness<'_, Settings>, count: usize) -> Vec<Vec<Pos2>> {
    let shapes = harness.output().shapes.iter();
    let lines = shapes.filter_map(|clipped| match &clipped.shape {
        Shape::Path(path) if !path.closed && path.points.len() == count => Some(path.points.clone()),
        _ => None,
    });
    lines.collect()
}

#[test]
fn a_gait_is_told_and_plotted_to_scale() {
    let mut traces = Traces::default();
    run(&Animal::sidewinder(), 3, |body, parts, time, dt| {
        traces.record(body, &Observation { time, ..Observation::default() });
        traces.gait.look(body, parts, time, dt);
    });
    let history: Vec<_> = traces.gait.history.iter().copied().collect();
    let now = history[history.len() - 1].metrics;
    let section = move |ui: &mut egui::Ui, settings: &mut Settings| plots::section(ui, settings, &traces);
    let harness = Harness::builder().with_size(vec2(300.0, 1200.0)).build_ui_state(section, Settings::default());
    for title in ["speed (body lengths a cycle)", "to the right (°)", "in %", "shape"] {
        assert!(harness.query_by_label(title).is_some(), "no plot {title}");
    }
    // In the table and beside the line.
    for name in ["angle", "slip", "lifted", "worst strain", "residue", "off the path", "smallest cell"] {
        assert_eq!(harness.query_all_by_label(name).count(), 2, "{name}");
    }
    for value in [
        format!("{:.3} lengths", now.body_lengths),
        format!("{:.0} %", 100.0 * now.worst_strain),
        format!("{:.2}", now.smallest_cell),
    ] {
        assert!(harness.query_all_by_label(&value).next().is_some(), "{value} is not shown");
    }
    let mut drawn = lines(&harness, history.len()).into_iter();
    for (plot, values) in PLOTS.iter().enumerate() {
        let points: Vec<_> = (values.iter())
            .flat_map(|value| {
                let line = drawn.next().unwrap_or_else(|| panic!("a line of plot {plot} is missing"));
                history.iter().map(|measured| (measured.time, value(&measured.metrics))).zip(line)
            })
            .collect();
        // Later is further right and more is further up: both are straight lines through the extremes.
        type Drawn = ((f64, f64), Pos2);
        let is_straight = |of: fn(&Drawn) -> (f64, f64), sign: f64| {
            let all: Vec<_> = points.iter().map(of).collect();
            let (low, high) = all.iter().fold((all[0], all[0]), |(low, high), &at| {
                (if at.0 < low.0 { at } else { low }, if at.0 > high.0 { at } else { high })
            });
            let scale = (high.1 - low.1) / (high.0 - low.0);
            assert!(sign * scale > 0.0, "plot {plot}: {scale}");
            all.iter().all(|at| (low.1 + scale * (at.0 - low.0) - at.1).abs() < 0.05)
        };
        assert!(is_straight(|((time, _), at)| (*time, at.x.into()), 1.0), "plot {plot} in time: {points:?}");
        assert!(is_straight(|((_, value), at)| (*value, at.y.into()), -1.0), "plot {plot} in value: {points:?}");
    }
    assert!(drawn.next().is_none(), "more lines than are told of");
}

#[test]
fn a_gait_is_not_plotted_before_it_is_known() {
    let mut world = World::new();
    let worm = Animal::worm().spawn(&mut world);
    let mut traces = Traces::default();
    traces.record(worm, &Observation::default());
    traces.gait.look(worm, &body_parts(world.entity(worm)).unwrap(), 0.0, 0.03);
    let section = move |ui: &mut egui::Ui, settings: &mut Settings| plots::section(ui, settings, &traces);
    let harness = Harness::builder().with_size(vec2(300.0, 900.0)).build_ui_state(section, Settings::default());
    assert!(harness.query_by_label("It is known once a cycle is over.").is_some());
    assert!(harness.query_by_label("in %").is_none() && harness.query_by_label("slip").is_none());
}
