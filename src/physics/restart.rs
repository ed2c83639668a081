//! Back to the start.

use bevy::ecs::prelude::*;

use crate::body::{Columns, Muscles, Particles, Tearing, TravelingWaves};

use super::{Clock, Cost, Frozen, Previous, Steer, Trail, Work};

/// Asks for every body to be put back to where it was spawned and for time 0. Frozen bodies go on; parameters stay as they are.
#[derive(Clone, Copy, Debug, Default, Message)]
pub struct Restart;

/// The particles that a body was spawned with. Physics puts it there.
#[derive(Clone, Component, Debug)]
pub struct StartState(pub Particles);

impl StartState {
    /// Puts a body back to where it was spawned, and shows it there at once.
    pub fn put_back(&self, particles: &mut Particles, previous: &mut Previous) {
        particles.set_state(&self.0);
        previous.position.clone_from(self.0.position_columns());
    }
}

/// Remembers how a body was spawned.
pub(super) fn remember_start(add: On<Add, Particles>, bodies: Query<&Particles>, mut commands: Commands) {
    if let Ok(particles) = bodies.get(add.entity) {
        commands.entity(add.entity).insert(StartState(particles.clone()));
    }
}

/// What a restart puts back.
type Bodies<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static mut Particles,
        &'static mut Previous,
        &'static StartState,
        &'static mut Work,
        Option<&'static mut Muscles>,
        Option<&'static mut TravelingWaves>,
        Option<&'static mut Tearing>,
        Option<&'static mut Steer>,
        Option<&'static mut Columns>,
        Option<&'static mut Trail>,
    ),
>;

/// Obeys [`Restart`].
pub(super) fn restart(
    mut asked: MessageReader<Restart>,
    mut clock: ResMut<Clock>,
    mut cost: ResMut<Cost>,
    mut bodies: Bodies,
    mut commands: Commands,
) {
    if asked.read().count() == 0 {
        return;
    }
    clock.rewind();
    *cost = Cost::default();
    for (body, mut particles, mut previous, start, mut work, muscles, waves, tearing, steer, columns, trail) in
        &mut bodies
    {
        *work = Work::default();
        start.put_back(&mut particles, &mut previous);
        if let Some(mut muscles) = muscles {
            muscles.rewind();
        }
        if let Some(mut waves) = waves {
            waves.rewind();
        }
        if let Some(mut tearing) = tearing {
            tearing.mend();
        }
        if let Some(mut steer) = steer {
            *steer = Steer::default();
        }
        if let Some(mut columns) = columns {
            columns.rewind();
        }
        if let Some(mut trail) = trail {
            *trail = Trail::default();
        }
        commands.entity(body).remove::<Frozen>();
    }
}
