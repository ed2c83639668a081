//! The plugin: the clock, and the systems of a tick.
//!
//! Start with [`PhysicsPlugin`]. It runs in `FixedUpdate`, or in any schedule that it is given:
//!
//! ```text
//! the schedule   Actuate   plans: what changed since the last tick; whoever tells a body where to go ([`Steer`]) belongs here
//!                Step      every step of the tick, for all bodies in parallel: rest lengths -> forces -> velocity -> spine friction ->
//!                          position -> contact, as the body's method orders it. At fixed steps in between, steered bodies look where they are
//!                Watch     freezes what exploded
//! every frame    Sync      Shown, FollowParticle: what is drawn, between the last two ticks
//! ```
//!
//! A body is one entity with [`Particles`], [`Springs`], a [`Method`], and whichever of
//! [`Muscles`](crate::body::Muscles), [`SpineFriction`](crate::body::SpineFriction), [`Gravity`](crate::body::Gravity) and [`Ground`](crate::body::Ground) it
//! needs. A body of the six-matrix particle system has [`Rules`] and what they work on in place of springs and a method. Physics adds the rest.
//! Pausing is Bevy's `Time<Virtual>::pause`; a paused app takes exactly one tick after `Time<Fixed>::accumulate_overstep(timestep)`.

mod clock;
mod cut;
mod layout;
mod plan;
mod restart;
mod six;
mod steer;
mod step;
mod sync;
mod trail;
mod watch;

use bevy::{
    app::{FixedUpdate, RunFixedMainLoop, RunFixedMainLoopSystems},
    ecs::schedule::{InternedScheduleLabel, ScheduleLabel, SingleThreadedExecutor},
    prelude::*,
};

use crate::{
    body::{Particles, Rules, Springs, TravelingWaves},
    mechanics::integrators::Method,
};

pub use clock::{Clock, Pace};
pub use cut::WavesCut;
pub(crate) use cut::cut_waves;
pub use plan::{Plan, body_parts};
pub use restart::{Restart, StartState};
pub use six::six_parts;
pub use steer::Steer;
pub use step::{Cost, Work};
pub use sync::{FollowParticle, Previous, Shown, ShownLap};
pub use trail::Trail;
pub use watch::{BodyFrozen, BodyInverted, Frozen, Verdict};

/// The sets in which physics runs, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, SystemSet)]
pub enum PhysicsSystems {
    /// Before the steps of a tick: plans, and whatever tells bodies where to go.
    Actuate,
    /// All steps of the tick.
    Step,
    /// Freezes bodies that exploded.
    Watch,
    /// Once a frame, after all ticks: writes what the frame shows. Nothing in it is read by the sets above.
    Sync,
}

/// Steps bodies. Works without a renderer, assets or a window; it needs Bevy's `TimePlugin` and task pools, as in `MinimalPlugins`.
///
/// ```
/// use bevy::prelude::*;
/// use wriggle::physics::{Clock, PhysicsPlugin};
///
/// let mut app = App::new();
/// app.add_plugins((MinimalPlugins, PhysicsPlugin::default()));
/// app.update();
/// assert_eq!(app.world().resource::<Clock>().dt(), 0.0005);
/// ```
pub struct PhysicsPlugin {
    schedule: InternedScheduleLabel,
}

/// A schedule that runs only when it is told to, for command lines, pictures and tests: add `PhysicsPlugin::new(Ticks)`, and each
/// `world.run_schedule(Ticks)` is a tick.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, PartialEq, ScheduleLabel)]
pub struct Ticks;

impl Default for PhysicsPlugin {
    fn default() -> Self {
        Self::new(FixedUpdate)
    }
}

impl PhysicsPlugin {
    /// Runs the physics in `schedule`: a tick each time it runs.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Plugin for PhysicsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Clock>().init_resource::<Cost>().add_message::<Restart>();
        app.add_message::<BodyFrozen>().add_message::<BodyInverted>().add_message::<WavesCut>();
        app.register_required_components::<Springs, Method>()
            .register_required_components::<Particles, Plan>()
            .register_required_components::<Particles, Verdict>()
            .register_required_components::<Particles, Work>()
            .register_required_components::<Particles, Previous>()
            .register_required_components::<Particles, Shown>()
            .register_required_components::<TravelingWaves, Steer>()
            .register_required_components::<Rules, Trail>()
            .add_observer(restart::remember_start);

        app.configure_sets(
            self.schedule,
            (PhysicsSystems::Actuate, PhysicsSystems::Step, PhysicsSystems::Watch).chain(),
        );
        app.add_systems(
            self.schedule,
            (
                (plan::plan, six::plan).in_set(PhysicsSystems::Actuate),
                (sync::remember, step::step).chain().in_set(PhysicsSystems::Step),
                (watch::watch, plan::watch_limit, six::watch_limit).chain().in_set(PhysicsSystems::Watch),
            ),
        );
        // Also while paused, when no tick runs.
        app.add_systems(PreUpdate, (restart::restart, plan::plan, six::plan).chain());

        // Nothing else runs in it, and handing three systems from thread to thread costs more than they do.
        app.edit_schedule(Ticks, |schedule| {
            schedule.set_executor(SingleThreadedExecutor::new());
        });

        let ticks_are_fixed = self.schedule == FixedUpdate.intern();
        let fraction = move |fixed: Option<Res<Time<Fixed>>>, clock: Res<Clock>| match fixed {
            Some(time) if ticks_are_fixed => {
                clock.shown_fraction(time.overstep_fraction_f64(), time.timestep().as_secs_f64())
            }
            _ => 1.0,
        };
        let sync = (fraction.pipe(sync::show), sync::follow).chain().in_set(PhysicsSystems::Sync);
        if ticks_are_fixed {
            app.add_systems(RunFixedMainLoop, sync.in_set(RunFixedMainLoopSystems::AfterFixedMainLoop));
        } else {
            // Else followers would be drawn where they were a frame before.
            app.add_systems(PostUpdate, sync.before(TransformSystems::Propagate));
        }
    }
}
