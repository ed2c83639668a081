//! Nobody who plays is left with a body that is stuck: a worm of a garden that was turned inside out or thrown off its path begins again where it began, and so does
//! a creature of the six-matrix particle system that a hand has pulled apart or off its road.

use bevy::{log::warn, prelude::*};

use super::Runner;
use crate::{
    body::{Columns, Particles, Pull, Rules},
    mechanics::six_matrix::Road,
    physics::{Frozen, PhysicsSystems, Previous, Restart, ShownLap, StartState, Trail},
};

/// For how many seconds of the app's time a body may be lost before it is put back.
const PATIENCE: f32 = 4.0;
/// How far a worm may be beside or above its path, or behind where it began, in lengths.
const ASTRAY: f64 = 5.0;
/// How far below all of its road a creature has fallen off it.
const BELOW: f64 = 20.0;

/// Puts lost bodies back to where they began. Only for apps that are played: in a run or a picture what is lost stays lost, so that its bits are those
/// of the physics alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct RescuePlugin;

impl Plugin for RescuePlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<BodyRescued>().add_systems(
            FixedPostUpdate,
            (rescue_worms, (note_pulled, rescue_pulled).chain()).after(PhysicsSystems::Watch),
        );
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

/// Since how many seconds a body is lost.
#[derive(Component, Default)]
struct Lost(f32);

/// On a creature of the six-matrix particle system at which a hand has pulled since it began.
#[derive(Component)]
struct Pulled;

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

/// Whether a body has been in trouble for long enough to be put back now.
fn has_waited(trouble: bool, lost: Option<Mut<Lost>>, time: &Time, mut body: EntityCommands) -> bool {
    match lost {
        None if trouble => _ = body.insert(Lost::default()),
        None => {}
        Some(mut lost) => {
            lost.0 += time.delta_secs();
            let waited = lost.0 >= PATIENCE;
            if waited || !trouble {
                body.remove::<Lost>();
            }
            return waited && trouble;
        }
    }
    false
}

/// Tells that a body was put back.
fn tell(body: Entity, name: &str, trouble: &str, messages: &mut MessageWriter<BodyRescued>) {
    let text = format!("{name}: it {trouble}, and begins again");
    warn!("{text}");
    messages.write(BodyRescued { body, text });
}

fn rescue_worms(time: Res<Time>, mut worms: Worms, mut messages: MessageWriter<BodyRescued>, mut commands: Commands) {
    for (body, name, mut particles, mut previous, start, lost) in &mut worms {
        let trouble = trouble(&particles, &start.0);
        if has_waited(trouble.is_some(), lost, &time, commands.entity(body)) {
            start.put_back(&mut particles, &mut previous);
            tell(body, name.map_or("a worm", Name::as_str), trouble.unwrap_or_default(), &mut messages);
        }
    }
}

/// Who is pulled at for the first time.
type NewlyPulled = (With<Rules>, With<Pull>, Without<Pulled>);

/// Remembers at whom a hand has pulled, until all begin again.
fn note_pulled(
    mut restarts: MessageReader<Restart>,
    new: Query<Entity, NewlyPulled>,
    old: Query<Entity, (With<Pulled>, Without<Pull>)>,
    mut commands: Commands,
) {
    new.iter().for_each(|body| _ = commands.entity(body).insert(Pulled));
    if restarts.read().count() > 0 {
        old.iter().for_each(|body| _ = commands.entity(body).remove::<(Pulled, Lost)>());
    }
}

/// Creatures that a hand has pulled at. Who falls by itself has come as far as it comes.
type Creatures<'w, 's> = Query<
    'w,
    's,
    (
        (Entity, Option<&'static Name>, Has<Frozen>, Option<&'static mut Lost>),
        (&'static mut Particles, &'static mut Previous, &'static StartState),
        (&'static mut Columns, &'static mut Trail, Option<&'static Road>),
    ),
    (With<Pulled>, Without<Pull>),
>;

fn rescue_pulled(
    time: Res<Time>,
    mut creatures: Creatures,
    mut messages: MessageWriter<BodyRescued>,
    mut commands: Commands,
) {
    for ((body, name, frozen, lost), (mut particles, mut previous, start), (mut columns, mut trail, road)) in
        &mut creatures
    {
        let is_below = road.is_some_and(|road| particles.center().y + BELOW < road.lowest());
        let trouble = if is_below { "fell off its road" } else { "was torn" };
        if has_waited(frozen || is_below, lost, &time, commands.entity(body)) {
            start.put_back(&mut particles, &mut previous);
            columns.rewind();
            *trail = Trail::default();
            commands.entity(body).remove::<(Frozen, Pulled)>();
            tell(body, name.map_or("a creature", Name::as_str), trouble, &mut messages);
        }
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
