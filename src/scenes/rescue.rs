//! Nobody who plays is left with a worm that is stuck: one of a garden that was turned inside out or thrown off its path begins again where it began.

use bevy::{log::warn, prelude::*};

use super::Runner;
use crate::{
    body::{Particles, Pull},
    physics::{Frozen, PhysicsSystems, Previous, ShownLap, StartState},
};

/// For how many seconds of the app's time a worm may be lost before it is put back.
const PATIENCE: f32 = 4.0;
/// How far a worm may be beside or above its path, or behind where it began, in lengths.
const ASTRAY: f64 = 5.0;

/// Puts lost worms back to where they began. Only for apps that are played: in a run or a picture what is lost stays lost, so that its bits are those
/// of the physics alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct RescuePlugin;

impl Plugin for RescuePlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<BodyRescued>().add_systems(FixedPostUpdate, rescue.after(PhysicsSystems::Watch));
    }
}

/// Tells that a body was put back to where it began.
#[derive(Clone, Debug, Message)]
pub struct BodyRescued {
    /// The body.
    pub body: Entity,
    /// What happened, for people.
    pub text: String,
}

/// Since how many seconds a worm is lost.
#[derive(Component, Default)]
struct Lost(f32);

/// Worms that crawl through a garden by themselves. Those of a race are measured as they are.
type Worms<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        Option<&'static Name>,
        &'static mut Particles,
        &'static mut Previous,
        &'static StartState,
        Option<&'static mut Lost>,
    ),
    (With<ShownLap>, Without<Runner>, Without<Frozen>, Without<Pull>),
>;

fn rescue(time: Res<Time>, mut worms: Worms, mut messages: MessageWriter<BodyRescued>, mut commands: Commands) {
    for (body, name, mut particles, mut previous, start, lost) in &mut worms {
        let Some(trouble) = trouble(&particles, &start.0) else {
            if lost.is_some() {
                commands.entity(body).remove::<Lost>();
            }
            continue;
        };
        let Some(mut lost) = lost else {
            commands.entity(body).insert(Lost::default());
            continue;
        };
        lost.0 += time.delta_secs();
        if lost.0 < PATIENCE {
            continue;
        }
        start.put_back(&mut particles, &mut previous);
        commands.entity(body).remove::<Lost>();
        let name = name.map_or("a worm", Name::as_str);
        let text = format!("{name}: it {trouble}, and begins again");
        warn!("{text}");
        messages.write(BodyRescued { body, text });
    }
}

/// What has become of a worm that began in a row along x, if that is nothing that it gets out of by itself.
fn trouble(now: &Particles, start: &Particles) -> Option<&'static str> {
    let [x, y, z] = start.position_columns();
    let straight = [y, z].into_iter().all(|column| column.iter().all(|value| *value == column[0]));
    let ascends = |x: &[f64]| x.windows(2).all(|pair| pair[0] < pair[1]);
    if x.len() < 2 || !straight || !ascends(x) {
        return None;
    }
    let [x, y, z] = now.position_columns().each_ref().map(Vec::as_slice);
    let astray = |column: &[f64], from: f64| column.iter().any(|value| (value - from).abs() > ASTRAY);
    let from = start.position_columns();
    if astray(y, from[1][0]) || astray(z, from[2][0]) || x.iter().any(|x| *x < from[0][0] - ASTRAY) {
        return Some("left the garden");
    }
    (!ascends(x)).then_some("was turned inside out")
}
