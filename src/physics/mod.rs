//! The plugin.
mod clock;
mod sync;

use bevy::prelude::*;

use crate::body::{ParticleId, Particles};

pub use clock::{Clock, Pace};
pub use sync::{FollowParticle, Previous, Shown, ShownLap};

/// The sets in which the physics runs, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, SystemSet)]
pub enum PhysicsSystems {
    /// Steering and muscle ramps.
    Actuate,
    /// All steps of a tick.
    Step,
    /// Freezes what exploded.
    Watch,
    /// Writes what a frame shows.
    Sync,
}

/// The physics (stub: shows bodies, does not step them).
#[derive(Default)]
pub struct PhysicsPlugin;

impl Plugin for PhysicsPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<BodyFrozen>().add_message::<Restart>().init_resource::<Cost>();
        app.register_required_components::<Particles, Previous>().register_required_components::<Particles, Shown>();
        app.add_systems(FixedUpdate, sync::remember);
        app.add_systems(
            RunFixedMainLoop,
            (sync::show, sync::follow)
                .chain()
                .in_set(PhysicsSystems::Sync)
                .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
        );
    }
}

/// Put on a body by the watch: it is not stepped any more.
#[derive(Clone, Component, Debug, Reflect)]
#[reflect(Component)]
pub struct Frozen {
    /// The step after which it was frozen.
    pub step: u64,
    /// The time then.
    pub time: f64,
    /// The particle that went wrong.
    pub particle: ParticleId,
    /// Why.
    pub reason: String,
}

/// A body was frozen.
#[derive(Clone, Debug, Message)]
pub struct BodyFrozen {
    /// Its entity.
    pub body: Entity,
    /// What happened, for people.
    pub text: String,
}

/// Asks for every body to be put back to where it was spawned.
#[derive(Clone, Copy, Debug, Default, Message)]
pub struct Restart;

/// The state that a body was spawned with.
#[derive(Clone, Component, Debug)]
pub struct StartState(pub Particles);

/// What physics keeps about a body.
#[derive(Clone, Component, Debug)]
pub struct Plan {
    stability_limit: f64,
}

impl Plan {
    /// The largest stable dt of the body's method.
    pub fn stability_limit(&self) -> f64 {
        self.stability_limit
    }
}

/// What the physics cost so far.
#[derive(Clone, Copy, Debug, Default, Resource)]
pub struct Cost {
    /// Forces on a whole body, counted.
    pub force_evaluations: u64,
    /// Forces on one spring, counted.
    pub spring_updates: u64,
    /// Seconds that the last tick took.
    pub seconds: f64,
}
