//! Fills the traces: once a tick from the body that the panel shows, and once a frame with what it cost.

use bevy::{
    ecs::{prelude::*, resource::IsResource},
    time::{Real, Time},
};

use super::{
    blocks,
    settings::Settings,
    traces::{BesideBlock, Frame, Observation, Traces, block, observe},
};
use crate::{
    body::{Lattice, Particles},
    physics::{Clock, Cost, Plan, StartState, body_parts},
    scenes::SceneBodies,
    view::skin_color,
};

/// How much of a new frame's cost goes into the numbers that are shown.
const SMOOTHING: f64 = 0.08;

/// What has been measured since the last frame.
#[derive(Debug, Default, Resource)]
pub(super) struct Meter {
    physics: f64,
    steps_per_tick: u64,
}

/// Samples the body after a tick.
pub(super) fn tick(
    clock: Option<Res<Clock>>,
    cost: Option<Res<Cost>>,
    settings: Res<Settings>,
    scene: Option<Res<SceneBodies>>,
    bodies: Query<EntityRef, (With<Particles>, Without<IsResource>)>,
    mut traces: ResMut<Traces>,
    mut meter: ResMut<Meter>,
) {
    if let Some(cost) = cost {
        meter.physics += cost.seconds;
        meter.steps_per_tick = cost.steps;
    }
    let Some(clock) = clock else { return };
    let Some(body) = settings.body().map(|body| body.entity) else { return };
    let Ok(entity) = bodies.get(body) else { return };
    let Some(particles) = entity.get::<Particles>() else { return };
    let start = entity.get::<StartState>().map_or_else(|| particles.center(), |start| start.0.center());
    let Some(parts) = body_parts(entity) else {
        // The six-matrix particle system has no springs and no spine.
        let distance = particles.center().distance(start);
        traces.record(body, &Observation { time: clock.time(), distance, ..Observation::default() });
        return;
    };
    let mut seen = observe(&parts, start, clock.time());
    if seen.block.is_some() {
        seen.side_by_side = side_by_side(scene.as_deref(), &bodies, clock.time());
    }
    traces.record(body, &seen);
    traces.gait.look(body, &parts, clock.time(), clock.dt());
}

/// All blocks of a scene that has several, as the plots compare them.
fn side_by_side(
    scene: Option<&SceneBodies>,
    bodies: &Query<EntityRef, (With<Particles>, Without<IsResource>)>,
    time: f64,
) -> Vec<BesideBlock> {
    let beside = |(entity, lattice): (EntityRef<'_>, Lattice)| {
        let parts = body_parts(entity)?;
        Some(BesideBlock {
            name: blocks::name(entity),
            color: skin_color(lattice),
            springs: parts.springs.len(),
            limit: entity.get::<Plan>().map_or(f64::INFINITY, Plan::stability_limit),
            block: block(&parts, time)?,
        })
    };
    blocks::side_by_side(scene, |body| bodies.get(body).ok()).into_iter().filter_map(beside).collect()
}

/// Samples the cost of a frame.
pub(super) fn frame(
    time: Res<Time<Real>>,
    mut meter: ResMut<Meter>,
    mut traces: ResMut<Traces>,
    mut settings: ResMut<Settings>,
) {
    let frame = Frame {
        time: time.elapsed_secs_f64(),
        frame: time.delta_secs_f64() * 1e3,
        physics: core::mem::take(&mut meter.physics) * 1e3,
    };
    traces.frames.push(frame);
    let cost = &mut settings.cost;
    let weight = if cost.frame == 0.0 { 1.0 } else { SMOOTHING };
    cost.frame += (frame.frame - cost.frame) * weight;
    cost.physics += (frame.physics - cost.physics) * weight;
    cost.steps_per_tick = meter.steps_per_tick;
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce;

    use super::{super::bridge, *};
    use crate::scenes;

    #[test]
    fn a_tick_is_traced_of_every_kind_of_body() {
        for (scene, block, animal) in [
            ("garden", 0, false),
            ("jelly", 1, false),
            ("jelly-lab", 1, false),
            ("meadow", 0, true),
            ("rough-road", 0, false),
        ] {
            let mut world = World::new();
            world.init_resource::<Settings>();
            world.init_resource::<bridge::Known>();
            world.init_resource::<Traces>();
            world.init_resource::<Meter>();
            scenes::load(scene).and_then(|loaded| scenes::open(&mut world, loaded)).unwrap();
            bridge::read(&mut world);
            world.run_system_once(tick).unwrap();
            let traces = world.resource::<Traces>();
            let seen = (traces.time.len(), traces.blocks.len(), traces.gait.is_of_animal());
            assert_eq!(seen, (1, block, animal), "{scene}");
            let names: Vec<_> = traces.side_by_side.iter().map(|trace| trace.now.name.as_str()).collect();
            let several = if scene == "jelly-lab" { &["edges", "faces", "cubes", "all"][..] } else { &[] };
            assert_eq!(names, several, "{scene}");
            for trace in &traces.side_by_side {
                assert!(trace.now.limit > 0.0 && trace.values.len() == 1, "{scene}: {:?}", trace.now);
            }
        }
    }
}
