//! Between the world and the panel: fills [`Settings`] before the panel is drawn, and afterwards does what was asked for. Nothing in the
//! world is touched, nor marked as changed, unless the user changed it.

use std::collections::HashMap;

use bevy::{
    ecs::{change_detection::DetectChanges, change_detection::Tick, prelude::*},
    prelude::{Name, Vec3},
    time::{Fixed, Real, Time, Virtual},
};

use super::{
    blocks, chart,
    gauge::Gauge,
    labels::Sight,
    names::Path,
    race::RunnerInfo,
    setting::Setting,
    settings::{Action, BodyInfo, Settings},
    traces::Traces,
};
use crate::{
    body::{Particles, Pull, Rules},
    creatures::library,
    mechanics::integrators::Method,
    physics::{BodyFrozen, BodyInverted, Clock, Frozen, Plan, Restart, Shown, Steer, WavesCut, Work},
    scenes::{self, BodyRescued, CurrentScene, Runner, SceneBodies, SceneChange, SceneProblem, parameters},
    view::Selected,
};

/// Seconds between two readings of all parameters: others than the panel change them rarely.
const REREAD: f64 = 0.25;
/// With more parameters than this, they are only read again when something was changed.
const MANY: usize = 2000;

/// What the bridge remembers of the world from one frame to the next.
#[derive(Debug, Default, Resource)]
pub struct Known {
    scene: Option<Tick>,
    defaults: HashMap<String, f64>,
    read_at: Option<f64>,
    selected: usize,
    /// The animal that is led.
    led: Option<Entity>,
    /// The bodies that are pulled at.
    pulled: Vec<Entity>,
    frozen: HashMap<Entity, String>,
    /// What was said of a bad file since a scene was opened.
    bad_file: Option<String>,
}

/// Takes up what the watch and the scenes report.
pub(super) fn listen(
    mut frozen: MessageReader<BodyFrozen>,
    mut inverted: MessageReader<BodyInverted>,
    mut rescued: MessageReader<BodyRescued>,
    mut cut: MessageReader<WavesCut>,
    mut problems: MessageReader<SceneProblem>,
    mut known: ResMut<Known>,
    mut settings: ResMut<Settings>,
) {
    for BodyFrozen { body, text } in frozen.read() {
        known.frozen.insert(*body, text.clone());
        known.read_at = None;
    }
    for BodyInverted { text, .. } in inverted.read() {
        settings.tell(true, text.clone());
    }
    for BodyRescued { text, .. } in rescued.read() {
        settings.tell(true, text.clone());
    }
    for WavesCut { text, .. } in cut.read() {
        settings.tell(true, text.clone());
    }
    for problem in problems.read() {
        settings.tell(true, problem.text.clone());
        known.bad_file = Some(problem.text.clone());
    }
}

/// Fills the settings from the world.
pub fn read(world: &mut World) {
    world.resource_scope(|world, mut settings: Mut<Settings>| {
        world.resource_scope(|world, mut known: Mut<Known>| {
            read_clock(world, &mut settings);
            let scene = world.get_resource_ref::<CurrentScene>().map(|scene| scene.last_changed());
            let opened = scene != known.scene || known.defaults.is_empty();
            if opened {
                known.scene = scene;
                open(world, &mut settings, &mut known);
            }
            let led = world.get_resource::<Selected>().and_then(|selected| selected.0);
            let pulled: Vec<_> = world.query_filtered::<Entity, With<Pull>>().iter(world).collect();
            let taken = pulled.iter().find(|body| !known.pulled.contains(body)).copied();
            known.pulled = pulled;
            if opened || led != known.led || taken.is_some() || is_stale(world, &settings, &known) {
                read_bodies(world, &mut settings, &known);
                // Whoever takes a body in hand wants to see that one.
                let place = settings.bodies.iter().position(|body| Some(body.entity) == taken);
                settings.selected = place.unwrap_or(settings.selected);
                share_selection(world, &mut settings, &mut known);
                read_parameters(world, &mut settings, &mut known, opened);
            }
            settings.gauge = gauge(world);
            let sight = Sight::of(world);
            settings.race = race(world, &sight);
            settings.blocks = blocks::find(world, &sight);
        });
    });
}

fn read_clock(world: &World, settings: &mut Settings) {
    if let Some(time) = world.get_resource::<Time<Virtual>>() {
        settings.paused = time.is_paused();
    }
    if let Some(time) = world.get_resource::<Time<Fixed>>() {
        settings.tick = time.timestep().as_secs_f64();
    }
    if let Some(clock) = world.get_resource::<Clock>() {
        (settings.time, settings.step) = (clock.time(), clock.step());
    }
}

/// Another scene: what belonged to the last one is forgotten.
fn open(world: &mut World, settings: &mut Settings, known: &mut Known) {
    known.defaults = parameters::list(world).into_iter().map(|parameter| (parameter.path, parameter.value)).collect();
    known.frozen.clear();
    // The file is mended, or another one is open.
    if let Some(text) = known.bad_file.take() {
        settings.messages.retain(|note| note.text != text);
    }
    settings.parameters.clear();
    chart::forget(world, settings);
    // Blocks side by side are there to be compared, in one attitude.
    settings.together = known.defaults.keys().filter(|path| path.ends_with(".block.tilt")).count() > 1;
    settings.normal_time_scale = None;
    settings.steps_refusal = None;
    settings.files.scenes = library::list(library::SCENE).into_keys().collect();
    if let Some(scene) = world.get_resource::<CurrentScene>() {
        settings.files.title.clone_from(&scene.file.title);
        settings.files.source.clone_from(&scene.source);
    }
    if let Some(mut traces) = world.get_resource_mut::<Traces>() {
        traces.clear();
    }
}

fn is_stale(world: &World, settings: &Settings, known: &Known) -> bool {
    let now = world.get_resource::<Time<Real>>().map_or(f64::INFINITY, |time| time.elapsed_secs_f64());
    known.selected != settings.selected
        || known.read_at.is_none_or(|read_at| now - read_at >= REREAD && known.defaults.len() <= MANY)
}

fn read_bodies(world: &mut World, settings: &mut Settings, known: &Known) {
    // The selection is a place in the list; it stays with the body.
    let before = settings.body().map(|body| body.entity);
    let moved = known.selected == settings.selected;
    let mut bodies: Vec<_> = world
        .query_filtered::<(Entity, &Name, Option<&Frozen>), With<Particles>>()
        .iter(world)
        .map(|(entity, name, frozen)| BodyInfo {
            entity,
            name: name.to_string(),
            frozen: frozen.map(|frozen| known.frozen.get(&entity).unwrap_or(&frozen.reason).clone()),
        })
        .collect();
    // As the scene lists them; entities have no order of their own.
    let order = world.get_resource::<SceneBodies>().map(|bodies| bodies.0.clone()).unwrap_or_default();
    bodies
        .sort_by_key(|body| (order.iter().position(|other| *other == body.entity).unwrap_or(order.len()), body.entity));
    if moved {
        settings.selected = bodies.iter().position(|body| Some(body.entity) == before).unwrap_or(0);
    }
    settings.selected = settings.selected.min(bodies.len().saturating_sub(1));
    settings.bodies = bodies;
}

/// The animal that is led and the body that the panel shows are one: who chooses last has it.
fn share_selection(world: &mut World, settings: &mut Settings, known: &mut Known) {
    let Some(led) = world.get_resource::<Selected>().map(|selected| selected.0) else { return };
    let shown = settings.body().map(|body| body.entity);
    if led != known.led {
        let place = settings.bodies.iter().position(|body| Some(body.entity) == led);
        settings.selected = place.unwrap_or(settings.selected);
        known.led = led;
    } else if shown != led && shown.is_some_and(|body| world.get::<Steer>(body).is_some()) {
        world.insert_resource(Selected(shown));
        known.led = shown;
    }
}

/// Reads the parameters of the clock and of the selected body; what is being typed and what was refused stays.
fn read_parameters(world: &mut World, settings: &mut Settings, known: &mut Known, opened: bool) {
    let mut old: HashMap<String, Setting> =
        settings.parameters.drain(..).map(|setting| (setting.path.clone(), setting)).collect();
    let body = settings.body().map(|body| body.name.clone()).unwrap_or_default();
    for parameter in parameters::list(world) {
        if !["clock", body.as_str()].contains(&Path::parse(&parameter.path).owner) {
            continue;
        }
        let mut setting = match old.remove(&parameter.path) {
            Some(setting) if !opened => setting,
            _ => Setting {
                unit: parameter.unit.into(),
                help: parameter.help.into(),
                kind: parameter.kind,
                default: *known.defaults.entry(parameter.path.clone()).or_insert(parameter.value),
                ..Setting::new(&parameter.path, parameter.value, parameter.range.clone())
            },
        };
        (setting.value, setting.range) = (parameter.value, parameter.range);
        settings.parameters.push(setting);
    }
    settings.method = parameters::method(world);
    settings.stick = parameters::stick(world);
    settings.without_method = world.query_filtered::<(), (With<Rules>, Without<Method>)>().iter(world).next().is_some()
        && world.query_filtered::<(), (With<Particles>, With<Method>)>().iter(world).next().is_none();
    known.selected = settings.selected;
    known.read_at = world.get_resource::<Time<Real>>().map(|time| time.elapsed_secs_f64());
}

/// The runners of a race, the truth first.
fn race(world: &mut World, sight: &Sight) -> Vec<RunnerInfo> {
    let time = world.get_resource::<Clock>().map_or(0.0, Clock::time);
    let mut runners = world.query::<(Entity, &Runner, &Method, &Work, &Plan, &Shown, Has<Frozen>)>();
    let mut race: Vec<_> = runners
        .iter(world)
        .map(|(entity, runner, method, work, plan, shown, frozen)| {
            // Above the head.
            let place = shown.positions().last().and_then(|head| sight.place(*head + Vec3::new(0.7, 0.5, 0.0)));
            let info = RunnerInfo {
                entity,
                truth: runner.lane == 0,
                color: runner.color(),
                method: *method,
                error: runner.error,
                worst: runner.worst,
                cost: if time > 0.0 { work.force_evaluations as f64 / time } else { 0.0 },
                limit: plan.stability_limit(),
                frozen,
                place,
            };
            (runner.lane, info)
        })
        .collect();
    race.sort_by_key(|(lane, _)| *lane);
    race.into_iter().map(|(_, info)| info).collect()
}

/// The body for which dt is nearest to its limit.
fn gauge(world: &mut World) -> Option<Gauge> {
    let dt = world.get_resource::<Clock>()?.dt();
    let mut plans = world.query::<(Option<&Name>, &Plan)>();
    let (name, plan) =
        plans.iter(world).min_by(|(_, a), (_, b)| a.stability_limit().total_cmp(&b.stability_limit()))?;
    let body = name.map_or_else(|| "body".into(), |name| name.to_string());
    Some(Gauge { dt, limit: plan.stability_limit(), body })
}

/// Does what the settings ask for.
pub fn apply(world: &mut World) {
    if world.resource::<Settings>().actions.is_empty() {
        return;
    }
    world.resource_scope(|world, mut settings: Mut<Settings>| {
        for action in core::mem::take(&mut settings.actions) {
            act(world, &mut settings, action);
        }
    });
    if let Some(mut known) = world.get_resource_mut::<Known>() {
        known.read_at = None;
    }
}

fn act(world: &mut World, settings: &mut Settings, action: Action) {
    match action {
        Action::Set { path, value } => {
            for other in same_of_others(settings, &path) {
                // What one refuses its twins refuse as well, and one answer is enough; what others have not cannot be set.
                parameters::set(world, &other, value).ok();
            }
            if let Err(refusal) = parameters::set(world, &path, value) {
                match settings.get_mut(&path) {
                    Some(setting) => setting.refusal = Some(refusal.to_string()),
                    None => settings.tell(true, refusal.to_string()),
                }
            }
        }
        Action::Method(method) => parameters::set_method(world, method),
        Action::Measure => settings.chart = chart::begin(world),
        Action::MethodOf(body, method) => {
            if let Some(mut old) = world.get_mut::<Method>(body) {
                old.set_if_neq(method);
            }
        }
        Action::Pause(paused) => pause(world, paused),
        Action::Tick => {
            pause(world, true);
            if let Some(mut time) = world.get_resource_mut::<Time<Fixed>>() {
                let tick = time.timestep();
                time.accumulate_overstep(tick);
            }
        }
        Action::Restart => {
            world.write_message(Restart);
            if let Some(mut traces) = world.get_resource_mut::<Traces>() {
                traces.clear();
            }
        }
        Action::Save(path) => match scenes::save(world, &path) {
            Ok(()) => settings.tell(false, format!("saved as {}", path.display())),
            Err(problem) => settings.tell(true, problem.to_string()),
        },
        Action::Load(name) => {
            world.write_message(SceneChange::Load(name));
        }
        Action::Reload => {
            world.write_message(SceneChange::Reload);
        }
    }
}

/// The same parameter of all other bodies where they are set together: the runners of a race stay one creature.
fn same_of_others(settings: &Settings, path: &str) -> Vec<String> {
    let owner = Path::parse(path).owner;
    let names = settings.bodies.iter().map(|body| body.name.as_str());
    let together = settings.together || !settings.race.is_empty();
    if !together || !names.clone().any(|name| name == owner) {
        return Vec::new();
    }
    names.filter(|name| *name != owner).map(|name| format!("{name}{}", &path[owner.len()..])).collect()
}

fn pause(world: &mut World, paused: bool) {
    let Some(time) = world.get_resource::<Time<Virtual>>() else { return };
    if time.is_paused() != paused
        && let Some(mut time) = world.get_resource_mut::<Time<Virtual>>()
    {
        if paused { time.pause() } else { time.unpause() }
    }
}
