//! Creatures of the six-matrix particle system that play has torn or pulled off their road.

use bevy::{math::DVec3, prelude::*, time::TimeUpdateStrategy};
use wriggle::{
    body::{Particle, ParticleId, Particles, Pull},
    physics::{Frozen, PhysicsPlugin},
    scenes::{self, BodyRescued, RescuePlugin, SceneBodies, ScenesPlugin, parameters},
};

use crate::support::particles;

/// Rough Road as it is played, a frame lasting one tick, with its roller.
fn played() -> (App, Entity) {
    let mut app = App::new();
    let scene = scenes::load("rough-road").unwrap();
    app.add_plugins((MinimalPlugins, PhysicsPlugin::default(), ScenesPlugin::new(scene), RescuePlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.update();
    let roller = app.world().resource::<SceneBodies>().0[1];
    (app, roller)
}

/// What was told of rescues in six seconds, and how high the roller was just after the last.
fn rescues(app: &mut App, roller: Entity) -> (Vec<String>, f64) {
    let (mut told, mut height) = (Vec::new(), f64::NAN);
    for _ in 0..64 * 6 {
        app.update();
        let new: Vec<_> = app.world_mut().resource_mut::<Messages<BodyRescued>>().drain().collect();
        if !new.is_empty() {
            height = particles(app, roller).center().y;
        }
        told.extend(new.into_iter().map(|rescued| rescued.text));
    }
    (told, height)
}

/// A hand pulls at the roller for a moment.
fn touch(app: &mut App, roller: Entity) {
    let target = particles(app, roller).center() + DVec3::Y;
    app.world_mut().entity_mut(roller).insert(Pull { particle: ParticleId(60), target });
    app.update();
    app.world_mut().entity_mut(roller).remove::<Pull>();
}

#[test]
fn who_was_pulled_off_the_road_begins_again_and_who_fell_by_itself_does_not() {
    for pulled in [true, false] {
        let (mut app, roller) = played();
        let start = particles(&app, roller).center().y;
        if pulled {
            touch(&mut app, roller);
        }
        let mut all = app.world_mut().get_mut::<Particles>(roller).unwrap();
        for i in (0..79).map(ParticleId) {
            let particle = all.get(i).unwrap();
            all.set(i, Particle { position: particle.position - DVec3::Y * 60.0, ..particle }).unwrap();
        }
        let (told, height) = rescues(&mut app, roller);
        if pulled {
            assert_eq!(told, ["roller: it fell off its road, and begins again"]);
            assert!((height - start).abs() < 0.5, "{height}, it began at {start}");
        } else {
            assert_eq!(told, [""; 0]);
        }
    }
}

#[test]
fn who_was_torn_by_a_hand_begins_again_and_who_bursts_by_itself_does_not() {
    for pulled in [true, false] {
        let (mut app, roller) = played();
        if pulled {
            touch(&mut app, roller);
        }
        parameters::set(app.world_mut(), "roller.bonds.stiffness", 12.0).unwrap();
        app.update();
        (0..64).for_each(|_| app.update());
        assert!(app.world().get::<Frozen>(roller).is_some());
        parameters::set(app.world_mut(), "roller.bonds.stiffness", 1.0).unwrap();
        let (told, _) = rescues(&mut app, roller);
        assert_eq!(told.len(), usize::from(pulled), "{told:?}");
        assert_eq!(app.world().get::<Frozen>(roller).is_some(), !pulled);
    }
}
