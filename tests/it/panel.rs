//! The panel's sections as pure functions, its traces, and its bridge to the world.

use bevy::{math::DVec3, prelude::*};
use bevy_egui::egui::{self, Key, accesskit::Role, vec2};
use egui_kittest::{Harness, kittest::Queryable};
use wriggle::{
    body::{Muscle, Muscles, Particle, ParticleId, Particles, SpineFriction, Spring, SpringId, Springs, Wave},
    mechanics::{BodyParts, integrators::Method},
    panel::{
        self, Action, BodyInfo, Ring, Setting, Settings, Traces, bodies, bridge,
        gauge::{self, Gauge, Stability},
        number_text, time,
        traces::{KEPT, Observation, observe, rest_intervals},
    },
    physics::{Clock, Restart},
};

type Section = fn(&mut egui::Ui, &mut Settings);

/// The settings of a worm of three masses.
fn worm() -> Settings {
    let number = |path: &str, value: f64| Setting::new(path, value, 0.0..=10.0);
    Settings {
        parameters: vec![
            number("clock.dt", 0.0005),
            number("clock.time_scale", 3.0),
            number("worm.springs.stiffness", 1.5),
            number("worm.springs[0].stiffness", 1.5),
            number("worm.springs[1].stiffness", 1.5),
            number("worm.particles.mass", 1.0),
            number("worm.muscles.phase", 0.0),
            number("worm.muscles[0].phase", 0.0),
            number("worm.muscles[1].phase", 0.25),
            number("other.springs.stiffness", 7.0),
        ],
        bodies: vec![
            BodyInfo { entity: Entity::from_raw_u32(1).unwrap(), name: "worm".into(), frozen: None },
            BodyInfo { entity: Entity::from_raw_u32(2).unwrap(), name: "other".into(), frozen: None },
        ],
        tick: 1.0 / 64.0,
        ..Settings::default()
    }
}

fn harness(section: Section, settings: Settings) -> Harness<'static, Settings> {
    Harness::builder().with_size(vec2(300.0, 900.0)).build_ui_state(section, settings)
}

/// Types `text` over what is in the field `label`, and presses Enter.
fn enter(harness: &mut Harness<'_, Settings>, label: &str, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, label).focus();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, label).type_text(text);
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
}

fn click(harness: &mut Harness<'_, Settings>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

fn set(path: &str, value: f64) -> Action {
    Action::Set { path: path.into(), value }
}

#[test]
fn a_typed_value_is_asked_for() {
    let mut harness = harness(bodies::section, worm());
    enter(&mut harness, "stiffness k", "2.25");
    assert_eq!(harness.state().actions, [set("worm.springs.stiffness", 2.25)]);
    assert_eq!(harness.state().get("worm.springs[1].stiffness").unwrap().value, 2.25);
}

#[test]
fn a_value_that_cannot_be_is_refused_with_the_reason() {
    for (label, path, text, reason) in [
        (
            "stiffness k",
            "worm.springs.stiffness",
            "-1",
            "stiffness k: -1 is not allowed; give a finite number, 0 or more",
        ),
        ("stiffness k", "worm.springs.stiffness", "NaN", "stiffness k: NaN is not allowed"),
        ("stiffness k", "worm.springs.stiffness", "1e999", "stiffness k: 1e999 is not allowed"),
        ("stiffness k", "worm.springs.stiffness", "soft", "stiffness k: “soft” is not a number"),
        ("stiffness k", "worm.springs.stiffness", "1,5", "with a point before its decimals"),
        ("mass m", "worm.particles.mass", "0", "mass m: 0 is not allowed; give a finite number above 0"),
    ] {
        let mut harness = harness(bodies::section, worm());
        let old = harness.state().get(path).unwrap().value;
        enter(&mut harness, label, text);
        let setting = harness.state().get(path).unwrap();
        assert_eq!(setting.value, old, "{text}");
        assert!(setting.refusal.as_ref().is_some_and(|refusal| refusal.contains(reason)), "{:?}", setting.refusal);
        assert_eq!(harness.state().actions, [], "{text}");
        assert!(harness.query_by_label_contains(reason).is_some(), "the reason is not shown");
        // The field shows the old value again, and a good value takes the reason away.
        assert_eq!(harness.get_by_role_and_label(Role::TextInput, label).value(), Some(number_text(old)));
        enter(&mut harness, label, "3");
        assert_eq!(harness.state().get(path).unwrap().refusal, None);
        assert_eq!(harness.state().actions, [set(path, 3.0)]);
    }
}

#[test]
fn escape_and_leaving_a_field_untouched_change_nothing() {
    let mut harness = harness(bodies::section, worm());
    harness.get_by_role_and_label(Role::TextInput, "stiffness k").focus();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, "stiffness k").type_text("9");
    harness.run();
    harness.key_press(Key::Escape);
    harness.run();
    assert_eq!(harness.state().actions, []);
    assert_eq!(harness.get_by_role_and_label(Role::TextInput, "stiffness k").value().as_deref(), Some("1.5"));
}

#[test]
fn a_reset_gives_the_default_back() {
    let mut settings = worm();
    settings.get_mut("worm.springs.stiffness").unwrap().value = 4.0;
    let mut harness = harness(bodies::section, settings);
    click(&mut harness, "reset stiffness k");
    assert_eq!(harness.state().actions, [set("worm.springs.stiffness", 1.5)]);
    assert_eq!(harness.state().get("worm.springs.stiffness").unwrap().value, 1.5);
}

#[test]
fn a_reset_gives_unlike_elements_their_own_defaults_back() {
    let mut settings = worm();
    settings.get_mut("worm.springs[1].stiffness").unwrap().default = 2.0;
    for setting in settings.parameters.iter_mut().filter(|setting| setting.path.ends_with("stiffness")) {
        setting.value = 4.0;
    }
    let mut harness = harness(bodies::section, settings);
    click(&mut harness, "reset stiffness k");
    assert_eq!(harness.state().actions, [set("worm.springs[0].stiffness", 1.5), set("worm.springs[1].stiffness", 2.0)]);
}

#[test]
fn a_reset_is_offered_while_only_one_element_is_changed() {
    let mut settings = worm();
    settings.get_mut("worm.springs[1].stiffness").unwrap().value = 4.0;
    let mut harness = harness(bodies::section, settings);
    click(&mut harness, "reset stiffness k");
    assert_eq!(harness.state().actions, [set("worm.springs.stiffness", 1.5)]);
    assert_eq!(harness.state().get("worm.springs[1].stiffness").unwrap().value, 1.5);
}

#[test]
fn one_element_changes_alone() {
    let mut harness = harness(bodies::section, worm());
    click(&mut harness, "each stiffness k");
    enter(&mut harness, "stiffness k of spring 1", "2");
    assert_eq!(harness.state().actions, [set("worm.springs[1].stiffness", 2.0)]);
    let value = |path: &str| harness.state().get(path).unwrap().value;
    assert_eq!((value("worm.springs[0].stiffness"), value("worm.springs[1].stiffness")), (1.5, 2.0));
    assert_eq!(harness.get_by_role_and_label(Role::TextInput, "stiffness k").value().as_deref(), Some("mixed"));
}

#[test]
fn phases_are_set_one_by_one_and_other_bodies_are_not_shown() {
    let mut harness = harness(bodies::section, worm());
    assert!(harness.query_by_role_and_label(Role::TextInput, "phase φ").is_none());
    enter(&mut harness, "phase φ of muscle 1", "0.5");
    assert_eq!(harness.state().actions, [set("worm.muscles[1].phase", 0.5)]);
    harness.state_mut().selected = 1;
    harness.run();
    assert_eq!(harness.get_by_role_and_label(Role::TextInput, "stiffness k").value().as_deref(), Some("7"));
}

#[test]
fn the_buttons_of_time_ask_for_what_they_say() {
    let mut harness = harness(time::buttons, worm());
    click(&mut harness, "⏸ pause");
    click(&mut harness, "▶ resume");
    click(&mut harness, "⏭ tick");
    assert!(harness.state().paused, "after one tick time stands still");
    click(&mut harness, "⏮ restart");
    assert_eq!(harness.state().actions, [Action::Pause(true), Action::Pause(false), Action::Tick, Action::Restart]);
}

#[test]
fn slow_motion_is_a_tenth_and_back() {
    let mut harness = harness(time::buttons, worm());
    let scale = |harness: &Harness<'_, Settings>| harness.state().get(time::TIME_SCALE).unwrap().value;
    click(&mut harness, "slow");
    assert!((scale(&harness) - 0.3).abs() < 1e-12);
    click(&mut harness, "slow");
    assert_eq!(scale(&harness), 3.0);
    // A time scale that is changed in slow motion is the one that is sped up again.
    click(&mut harness, "slow");
    harness.state_mut().request(time::TIME_SCALE, 0.5);
    click(&mut harness, "slow");
    assert_eq!(scale(&harness), 5.0);
}

#[test]
fn steps_a_tick_set_dt() {
    let mut harness = harness(time::section, worm());
    assert_eq!(harness.get_by_role_and_label(Role::TextInput, "steps a tick").value().as_deref(), Some("93.75"));
    enter(&mut harness, "steps a tick", "0");
    assert_eq!(harness.state().actions, []);
    assert!(harness.state().steps_refusal.as_ref().is_some_and(|reason| reason.contains("whole number of 1 or more")));
    enter(&mut harness, "steps a tick", "4");
    assert_eq!(harness.state().actions, [set("clock.dt", 3.0 / 64.0 / 4.0)]);
    assert_eq!(harness.state().steps_refusal, None);
}

#[test]
fn the_gauge_is_red_before_anything_explodes() {
    let at = |fraction: f64| Gauge { dt: 0.5 * fraction, limit: 0.5, body: "worm".into() };
    for (fraction, stability, words, advice) in [
        (0.1, Stability::Safe, "dt 0.05 is 10 % of the limit 0.5", "stable"),
        (0.6, Stability::Close, "dt 0.3 is 60 % of the limit 0.5", "coarse"),
        (1.0, Stability::Unstable, "dt 0.5 is 100 % of the limit 0.5", "explode"),
        (1.2, Stability::Unstable, "dt 0.6 is 120 % of the limit 0.5", "explode"),
    ] {
        let gauge = at(fraction);
        assert_eq!(gauge.stability(), stability);
        let harness = harness(gauge::section, Settings { gauge: Some(gauge), ..worm() });
        assert!(harness.query_by_label_contains(words).is_some(), "{words}");
        assert!(harness.query_by_label_contains(advice).is_some(), "{advice}");
    }
    let document = Gauge { dt: 0.0005, limit: 0.5175, body: "worm".into() };
    assert_eq!(document.words(), "dt 0.0005 is 0.1 % of the limit 0.5175");
    let free = Gauge { limit: f64::INFINITY, ..at(0.1) };
    assert_eq!(free.stability(), Stability::Safe);
    assert_eq!(Gauge { limit: f64::NAN, ..at(0.1) }.stability(), Stability::Unstable);
    let colors = [Stability::Safe, Stability::Close, Stability::Unstable].map(Stability::color);
    assert!(colors[0] != colors[1] && colors[1] != colors[2] && colors[0] != colors[2]);
    let [safe, .., unstable] = colors;
    assert!(unstable.r() > 2 * unstable.g() && safe.g() > 2 * safe.r(), "red is red and green is green");
}

/// Whether egui takes what a pointer at (x, y) does, with the whole panel drawn as the app draws it.
fn takes_pointer(settings: &mut Settings, x: f32, y: f32) -> bool {
    let context = egui::Context::default();
    let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, vec2(1280.0, 720.0));
    for _ in 0..3 {
        let input = egui::RawInput {
            screen_rect: Some(screen),
            events: vec![egui::Event::PointerMoved(egui::pos2(x, y))],
            ..Default::default()
        };
        let mut output = context.run_ui(input, |ui| panel::show(ui.ctx(), settings, &Traces::default()));
        output.textures_delta.clear();
    }
    context.is_pointer_over_egui()
}

#[test]
fn the_panel_takes_clicks_on_its_ground_and_nowhere_else() {
    let mut settings = worm();
    // Long words widened the panel once.
    settings.tell(true, "my-garden.scene.ron:3:14: expected a number for `stiffness` and not this text without an end");
    settings.get_mut("worm.springs.stiffness").unwrap().refusal = Some("a reason ".repeat(20));
    settings.bodies[0].frozen = Some("a spring is longer than ten rest lengths ".repeat(3));
    for (x, y, expected) in [(4.0, 4.0, true), (294.0, 715.0, true), (306.0, 300.0, false), (1000.0, 5.0, false)] {
        assert_eq!(takes_pointer(&mut settings, x, y), expected, "at {x}, {y}");
    }
    settings.hidden = true;
    assert!(!takes_pointer(&mut settings, 100.0, 300.0), "a panel that is put away still takes clicks");
}

#[test]
fn numbers_are_written_short() {
    for (value, text) in
        [(0.0, "0"), (1.5, "1.5"), (0.1 + 0.2, "0.3"), (0.0005, "0.0005"), (93.75, "93.75"), (1e-7, "1e-7")]
    {
        assert_eq!(number_text(value), text);
    }
}

#[test]
fn a_ring_never_grows_beyond_its_capacity() {
    let mut ring = Ring::new(3);
    (0..10).for_each(|value| ring.push(value));
    assert_eq!(ring.iter().copied().collect::<Vec<_>>(), [7, 8, 9]);
}

#[test]
fn rests_are_found() {
    let velocity = |i: usize| match i {
        2..=4 | 7 => 0.0,
        8 => 9e-7,
        9 => -2e-6,
        _ => 0.3,
    };
    let samples = (0..12).map(|i| (i as f64 * 0.5, velocity(i)));
    assert_eq!(rest_intervals(samples), [1.0..=2.0, 3.5..=4.0]);
}

#[test]
fn traces_are_bounded_and_begin_anew_when_time_goes_back() {
    let seen = |time: f64| Observation {
        time,
        springs: vec![("A–B".into(), 1.0, 1.1)],
        masses: vec![("A".into(), if time < 400.0 { 0.0 } else { 1.0 })],
        distance: time,
        block: None,
        side_by_side: Vec::new(),
    };
    let body = Entity::from_raw_u32(1).unwrap();
    let mut traces = Traces::default();
    for tick in 0..3 * KEPT {
        traces.record(body, &seen(tick as f64));
        traces.record(body, &seen(tick as f64));
    }
    for length in
        [traces.time.len(), traces.springs[0].length.len(), traces.masses[0].velocity.len(), traces.distance.len()]
    {
        assert_eq!(length, KEPT);
    }
    traces.record(body, &seen(0.0));
    traces.record(body, &seen(1.0));
    assert_eq!(traces.time.iter().copied().collect::<Vec<_>>(), [0.0, 1.0]);
    assert_eq!(traces.rests(0), [0.0..=1.0]);
    traces.record(Entity::from_raw_u32(2).unwrap(), &seen(2.0));
    assert_eq!(traces.time.len(), 1, "another body is another trace");
}

/// Three masses on a line that is not an axis, listed from the head, with velocities along and across it.
fn bent() -> (Particles, Springs, Muscles, SpineFriction) {
    let along = DVec3::new(0.6, 0.0, 0.8);
    let across = DVec3::new(0.8, 0.0, -0.6);
    let particle = |place: f64, velocity: DVec3| Particle { velocity, ..Particle::at(along * place) };
    let particles =
        Particles::new([particle(2.5, along * 0.5), particle(1.0, across * 3.0), particle(0.0, along * -0.25)])
            .unwrap();
    let spring = |a, b| Spring { ends: [ParticleId(a), ParticleId(b)], stiffness: 1.5, damping: 0.9, rest_length: 1.0 };
    let springs = Springs::new([spring(0, 2), spring(0, 1), spring(1, 2)], &particles).unwrap();
    let muscle = Muscle { spring: SpringId(1), wave: Wave::Sine, amplitude: 0.3, period: 6.0, phase: 0.0, ramp: 0.0 };
    let muscles = Muscles::new([muscle], &springs).unwrap();
    let friction = SpineFriction::new([ParticleId(2), ParticleId(1), ParticleId(0)], &particles).unwrap();
    (particles, springs, muscles, friction)
}

#[test]
fn velocities_are_those_along_the_spine_and_springs_those_of_the_spine() {
    let (particles, springs, muscles, friction) = bent();
    let start = particles.center() - DVec3::X * 3.0;
    let parts = BodyParts {
        muscles: Some(&muscles),
        friction: Some(&friction),
        ..BodyParts::new(&particles, &springs, Method::default())
    };
    let seen = observe(&parts, start, 1.5);
    let names: Vec<_> = seen.masses.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["A", "B", "C"], "from tail to head");
    for ((_, velocity), expected) in seen.masses.iter().zip([-0.25, 0.0, 0.5]) {
        assert!((velocity - expected).abs() < 1e-12, "{velocity} instead of {expected}");
    }
    let springs: Vec<_> = seen.springs.iter().map(|(name, ..)| name.as_str()).collect();
    assert_eq!(springs, ["B–C", "A–B"], "the spring from tail to head is none of the spine's");
    for ((_, length, rest), expected) in seen.springs.iter().zip([(1.5, 1.3), (1.0, 1.0)]) {
        assert!((length - expected.0).abs() < 1e-12 && (rest - expected.1).abs() < 1e-12, "{length} {rest}");
    }
    assert!((seen.distance - 3.0).abs() < 1e-12);
}

/// An app without a window whose bridge is called by hand.
fn app() -> App {
    let (particles, springs, muscles, friction) = bent();
    let mut app = App::new();
    app.add_plugins(MinimalPlugins)
        .insert_resource(Clock::new(0.0005, 3.0).unwrap())
        .add_message::<Restart>()
        .init_resource::<Settings>()
        .init_resource::<Traces>()
        .init_resource::<bridge::Known>()
        .init_resource::<Ticks>()
        .add_systems(FixedUpdate, |mut ticks: ResMut<Ticks>| ticks.0 += 1);
    app.world_mut().spawn((Name::new("worm"), particles, springs, muscles, friction, Method::SemiImplicitEuler));
    app
}

#[derive(Default, Resource)]
struct Ticks(usize);

fn ask(app: &mut App, action: Action) {
    bridge::read(app.world_mut());
    app.world_mut().resource_mut::<Settings>().actions.push(action);
    bridge::apply(app.world_mut());
    bridge::read(app.world_mut());
}

#[test]
fn the_bridge_brings_changes_to_the_world_and_back() {
    let mut app = app();
    ask(&mut app, set("worm.springs[1].stiffness", 4.0));
    let settings = app.world().resource::<Settings>();
    assert_eq!(
        settings.get("worm.springs[1].stiffness").map(|setting| (setting.value, setting.default)),
        Some((4.0, 1.5))
    );
    assert_eq!(settings.get("worm.springs[0].stiffness").map(|setting| setting.value), Some(1.5));
    ask(&mut app, Action::Method(Method::RungeKutta4));
    assert_eq!(app.world().resource::<Settings>().method, Method::RungeKutta4);
    // What the world refuses is said beside the slider, and the old value stays.
    ask(&mut app, set("clock.time_scale", 1e6));
    let scale = app.world().resource::<Settings>().get("clock.time_scale").cloned().unwrap();
    assert_eq!(scale.value, 3.0);
    assert!(scale.refusal.is_some_and(|refusal| refusal.contains("clock.time_scale")));
}

#[test]
fn the_bridge_touches_nothing_that_was_not_asked_for() {
    let mut app = app();
    bridge::read(app.world_mut());
    let before = app.world_mut().increment_change_tick();
    for _ in 0..3 {
        bridge::read(app.world_mut());
        bridge::apply(app.world_mut());
    }
    let world = app.world_mut();
    let mut bodies = world.query::<(Ref<Springs>, Ref<Particles>, Ref<Muscles>, Ref<Method>)>();
    let (springs, particles, muscles, method) = bodies.single(world).unwrap();
    for changed in [springs.last_changed(), particles.last_changed(), muscles.last_changed(), method.last_changed()] {
        assert!(!changed.is_newer_than(before, world.read_change_tick()));
    }
    for changed in [
        world.get_resource_ref::<Clock>().unwrap().last_changed(),
        world.get_resource_ref::<Time<Virtual>>().unwrap().last_changed(),
        world.get_resource_ref::<Time<Fixed>>().unwrap().last_changed(),
    ] {
        assert!(!changed.is_newer_than(before, world.read_change_tick()));
    }
}

#[test]
fn a_paused_world_takes_exactly_one_tick_a_press() {
    let mut app = app();
    app.update();
    ask(&mut app, Action::Pause(true));
    let before = app.world().resource::<Ticks>().0;
    for presses in 1..=3 {
        ask(&mut app, Action::Tick);
        for _ in 0..4 {
            app.update();
        }
        assert_eq!(app.world().resource::<Ticks>().0, before + presses);
    }
    ask(&mut app, Action::Pause(false));
    assert!(!app.world().resource::<Time<Virtual>>().is_paused() && !app.world().resource::<Settings>().paused);
}

#[test]
fn a_restart_clears_the_plots_and_asks_the_physics() {
    let mut app = app();
    let seen = Observation { time: 1.0, ..Observation::default() };
    app.world_mut().resource_mut::<Traces>().record(Entity::PLACEHOLDER, &seen);
    ask(&mut app, Action::Restart);
    assert!(app.world().resource::<Traces>().time.is_empty());
    assert_eq!(app.world().resource::<Messages<Restart>>().len(), 1);
}
