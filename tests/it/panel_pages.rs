//! The panel's pages of charts, races, blocks and files, and what the app does by itself for who plays.

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_egui::egui::{self, Pos2, vec2};
use egui_kittest::{Harness, kittest::Queryable};
use wriggle::{
    body::{ParticleId, Particles, Pull},
    lab::WorkPrecision,
    mechanics::integrators::{Method, StickRule},
    panel::{
        Action, Settings, Traces,
        chart::{self, ChartState, marker},
        files, plots,
        race::{self, RunnerInfo},
        traces::{BesideBlock, Block, Observation},
    },
    physics::PhysicsPlugin,
    scenes::{self, BodyRescued, RescuePlugin, SceneBodies, ScenesPlugin},
};

use crate::chart::{of_order_two, point};

fn harness(section: fn(&mut egui::Ui, &mut Settings), settings: Settings) -> Harness<'static, Settings> {
    Harness::builder().with_size(vec2(300.0, 900.0)).build_ui_state(section, settings)
}

/// A chart on which friction at the end of the step makes RK2 a method of order 1.
fn two_rules() -> WorkPrecision {
    let mut chart = of_order_two();
    for dt in [0.5, 0.125, 0.03125, 0.0078125] {
        chart.points.push(point(Method::RungeKutta2, StickRule::EndOfStep, dt, 2, Some(0.3 * dt)));
    }
    chart
}

#[test]
fn the_marker_is_on_the_curve_of_its_method_and_stick_rule() {
    let chart = two_rules();
    for dt in [0.4, 0.1, 0.0333, 0.01] {
        let [cost, error] = marker(&chart, Method::RungeKutta2, StickRule::InStages, dt).unwrap();
        // ½·(2dt)² after two evaluations a step over 20 units of time.
        assert!((error - libm::log10(2.0 * dt * dt)).abs() < 1e-9, "dt {dt}: 10^{error}");
        assert!((cost - libm::log10(40.0 / dt)).abs() < 0.01, "dt {dt}: 10^{cost} evaluations");
        let [_, at_end] = marker(&chart, Method::RungeKutta2, StickRule::EndOfStep, dt).unwrap();
        assert!((at_end - libm::log10(0.3 * dt)).abs() < 1e-9, "dt {dt} at end: 10^{at_end}");
        // Located events were not measured on their own: they make no difference here.
        assert_eq!(marker(&chart, Method::RungeKutta2, StickRule::Located, dt).unwrap()[1], error);
    }
    assert_eq!(marker(&chart, Method::RungeKutta4, StickRule::InStages, 0.1), None, "nothing was measured of it");
    let [_, beyond] = marker(&chart, Method::RungeKutta2, StickRule::InStages, 10.0).unwrap();
    assert!((beyond - libm::log10(0.5)).abs() < 1e-9, "beyond the ends, the end: 10^{beyond}");
}

#[test]
fn the_page_of_the_chart_measures_when_it_is_seen_and_shows_what_came_of_it() {
    let with = |chart| harness(chart::section, Settings { chart, ..Settings::default() });
    assert!(with(ChartState::Idle).state().actions.contains(&Action::Measure));
    let running = with(ChartState::Running { done: 3, total: 8, what: "Leapfrog with dt 0.1".into() });
    assert!(running.query_by_label_contains("Every method is being measured").is_some());
    assert!(running.state().actions.is_empty(), "it is measured once");
    assert!(with(ChartState::Failed("no speed here".into())).query_by_label_contains("no speed here").is_some());
    let ready = with(ChartState::Ready(Box::new(two_rules())));
    let shows = |text| ready.query_all_by_label_contains(text).next().is_some();
    assert!(shows("RungeKutta2") && shows("budget") && !shows("Leapfrog"), "what was measured, and nothing else");
}

/// Where red lines begin and end that a race's labels draw over the scene.
fn red_lines(runner: RunnerInfo) -> Vec<[Pos2; 2]> {
    let (context, settings) = (egui::Context::default(), Settings { race: vec![runner], ..Settings::default() });
    let mut output = context.run_ui(egui::RawInput::default(), |ui| race::labels(ui.ctx(), &settings));
    output.textures_delta.clear();
    let red = |stroke: &egui::Stroke| stroke.color.r() > 200 && stroke.color.g() < 140 && stroke.color.b() < 80;
    let lines = output.shapes.into_iter().filter_map(|clipped| match clipped.shape {
        egui::Shape::LineSegment { points, stroke } if red(&stroke) => Some(points),
        _ => None,
    });
    lines.collect()
}

#[test]
fn a_runner_that_blew_up_is_crossed_out_where_it_is() {
    let runner = RunnerInfo {
        entity: Entity::from_raw_u32(1).unwrap(),
        truth: false,
        color: [0x56, 0xb4, 0xe9],
        method: Method::ExplicitEuler,
        error: 0.5,
        worst: 2.5,
        cost: 10.0,
        limit: 0.6,
        frozen: true,
        place: Some((400.0, 300.0)),
    };
    let [[a, b], [c, d]] = red_lines(runner.clone())[..] else { panic!("a cross has two lines") };
    assert_eq!((a + b.to_vec2(), c + d.to_vec2()), (c + d.to_vec2(), a + b.to_vec2()), "they share their middle");
    assert!((b - a).x * (d - c).x + (b - a).y * (d - c).y == 0.0, "and cross at right angles");
    let middle = a + 0.5 * (b - a);
    assert!(middle.distance(Pos2::new(400.0, 300.0)) < 40.0, "{middle}");
    assert!(red_lines(RunnerInfo { frozen: false, ..runner.clone() }).is_empty());
    assert!(red_lines(RunnerInfo { place: None, ..runner.clone() }).is_empty(), "out of sight");
    // The table says that it left, and no longer a number.
    let table = |runner| harness(race::section, Settings { race: vec![runner], ..Settings::default() });
    assert!(table(runner.clone()).query_by_label("left").is_some());
    let runs = table(RunnerInfo { frozen: false, ..runner });
    assert!(runs.query_by_label("left").is_none() && runs.query_by_label("2.500").is_some());
}

#[test]
fn a_bad_save_or_load_is_told_and_a_good_one_asked_for() {
    let mut harness = harness(files::section, Settings::default());
    harness.get_by_label("load").click();
    harness.run();
    assert_eq!(harness.state().actions, [Action::Load(files_own().into())]);
    harness.state_mut().actions.clear();
    harness.state_mut().files.load_from = "  ".into();
    harness.get_by_label("load").click();
    harness.run();
    assert!(harness.state().actions.is_empty());
    assert!(harness.state().messages.iter().any(|note| note.problem && note.text.contains("give the name")));
    harness.state_mut().files.save_to = "mine.scene.ron".into();
    harness.get_by_label("save as").click();
    harness.run();
    assert_eq!(harness.state().actions, [Action::Save("mine.scene.ron".into())]);
}

fn files_own() -> &'static str {
    wriggle::panel::Files::OWN
}

#[test]
fn several_blocks_are_compared_row_by_row() {
    let block = |shape_error| {
        let shape = wriggle::mechanics::metrics::BlockShape {
            shape_error,
            volume: Some(0.75),
            inverted: 0,
            smallest_cell: Some(0.5),
            height: 4.0,
        };
        Block { shape, energy: 1.0 }
    };
    let beside = |name: &str, springs, limit, error| BesideBlock {
        name: name.into(),
        color: 0x35a86b,
        springs,
        limit,
        block: block(error),
    };
    let mut traces = Traces::default();
    let seen = |time: f64, error: f64| Observation {
        time,
        block: Some(block(error)),
        side_by_side: vec![beside("edges", 540, 1.05, 1.25), beside("all", 1036, f64::INFINITY, error)],
        ..Observation::default()
    };
    let body = Entity::from_raw_u32(1).unwrap();
    traces.record(body, &seen(0.0, 0.125));
    traces.record(body, &seen(1.0, 0.375));
    let values: Vec<_> = traces.side_by_side[1].values.iter().map(|block| block.shape.shape_error).collect();
    assert_eq!(values, [0.125, 0.375]);
    let section = move |ui: &mut egui::Ui, settings: &mut Settings| plots::section(ui, settings, &traces);
    let harness = Harness::builder().with_size(vec2(300.0, 900.0)).build_ui_state(section, Settings::default());
    for text in ["edges", "540", "1.050", "1.250", "all", "1036", "none", "0.375", "0.750"] {
        assert!(harness.query_all_by_label(text).next().is_some(), "{text} is not shown");
    }
}

/// The garden as it is played, a frame lasting one tick.
fn garden() -> (App, Entity) {
    let mut app = App::new();
    let scene = scenes::load("garden").unwrap();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default(), ScenesPlugin::new(scene), RescuePlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.update();
    let worm = app.world().resource::<SceneBodies>().0[0];
    (app, worm)
}

/// What was told of rescues in so many seconds.
fn seconds(app: &mut App, seconds: f64) -> Vec<String> {
    let mut told = Vec::new();
    for _ in 0..(64.0 * seconds) as usize {
        app.update();
        told.extend(app.world_mut().resource_mut::<Messages<BodyRescued>>().drain().map(|rescued| rescued.text));
    }
    told
}

fn xs(app: &App, worm: Entity) -> Vec<f64> {
    app.world().get::<Particles>(worm).unwrap().positions().map(|at| at.x).collect()
}

/// Puts the head behind the tail, or the whole worm elsewhere.
fn lose(app: &mut App, worm: Entity, place: impl Fn(usize, bevy::math::DVec3) -> bevy::math::DVec3) {
    let mut particles = app.world_mut().get_mut::<Particles>(worm).unwrap();
    for i in 0..3 {
        let particle = particles.get(ParticleId(i)).unwrap();
        let position = place(i as usize, particle.position);
        particles.set(ParticleId(i), wriggle::body::Particle { position, ..particle }).unwrap();
    }
}

#[test]
fn a_worm_that_play_has_left_stuck_begins_again_where_it_began() {
    use bevy::math::DVec3;
    let (mut app, worm) = garden();
    let start = xs(&app, worm);
    let told = seconds(&mut app, 20.0);
    assert!(xs(&app, worm)[0] > start[0] + 3.0 && told.is_empty(), "who crawls is left alone: {told:?}");
    for (why, y) in [("turned inside out", 0.0), ("left the garden", -20.0)] {
        lose(&mut app, worm, |i, at| if y == 0.0 && i == 2 { at - 3.0 * DVec3::X } else { at + y * DVec3::Y });
        let told = seconds(&mut app, 3.0);
        assert!(told.is_empty(), "{why}: it may find its way by itself: {told:?}");
        let told = seconds(&mut app, 2.0);
        assert!(told.len() == 1 && told[0].contains(why), "{told:?}");
        let now = xs(&app, worm);
        assert!(now.windows(2).all(|pair| pair[0] < pair[1]) && (now[0] - start[0]).abs() < 2.0, "{now:?}");
        let told = seconds(&mut app, 20.0);
        assert!(xs(&app, worm)[0] > start[0] + 3.0 && told.is_empty(), "and crawls again");
    }
}

#[test]
fn a_worm_is_left_to_the_hand_that_holds_it() {
    use bevy::math::DVec3;
    let (mut app, worm) = garden();
    lose(&mut app, worm, |i, at| if i == 2 { at - 3.0 * DVec3::X } else { at });
    let target = app.world().get::<Particles>(worm).unwrap().position(ParticleId(2)).unwrap();
    app.world_mut().entity_mut(worm).insert(Pull { particle: ParticleId(2), target });
    let told = seconds(&mut app, 8.0);
    assert!(told.is_empty(), "{told:?}");
}
