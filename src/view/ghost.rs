//! Ghosts: pale balls where the truth of a race has the particles of a runner.

use bevy::{ecs::entity::EntityHashMap, light::NotShadowCaster, prelude::*};

use super::{
    clay::{Clay, tint},
    paint::Paint,
};
use crate::{
    physics::PhysicsSystems,
    scenes::{Ghost, SceneMember},
};

/// The radius of a ball: a little more than a worm's.
const RADIUS: f32 = 0.44;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Ghosts>().add_systems(
        RunFixedMainLoop,
        (appear, follow).chain().after(PhysicsSystems::Sync).in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
    );
}

/// The balls of each runner.
#[derive(Default, Resource)]
struct Ghosts(EntityHashMap<Vec<Entity>>);

/// Spawns the balls of new runners and forgets those of runners that are gone; the balls go with their scene.
fn appear(
    runners: Query<(Entity, &Ghost)>,
    mut ghosts: ResMut<Ghosts>,
    mut kit: Local<Option<(Handle<Mesh>, Handle<Paint>)>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut paints: ResMut<Assets<Paint>>,
    mut commands: Commands,
) {
    ghosts.0.retain(|runner, _| runners.contains(*runner));
    for (runner, ghost) in &runners {
        if ghosts.0.get(&runner).map_or(0, Vec::len) == ghost.0.len() {
            continue;
        }
        let (mesh, paint) = kit.get_or_insert_with(|| {
            let mut ball = Clay::default();
            ball.ball(Transform::default(), 24, |_| {
                let mut pale = tint(0xffffff);
                pale[3] = 1.0;
                pale
            });
            let paint = Paint { finish: Vec4::new(0.6, 0.0, 0.0, 0.0), ..Paint::blot(0.38) };
            (meshes.add(ball.fire()), paints.add(paint))
        });
        let ball = || {
            (SceneMember, NotShadowCaster, Transform::default(), Mesh3d(mesh.clone()), MeshMaterial3d(paint.clone()))
        };
        let balls = ghost.0.iter().map(|_| commands.spawn(ball()).id()).collect();
        ghosts.0.insert(runner, balls);
    }
}

fn follow(runners: Query<(Entity, &Ghost)>, ghosts: Res<Ghosts>, mut balls: Query<&mut Transform>) {
    for (runner, ghost) in &runners {
        for (ball, at) in ghosts.0.get(&runner).into_iter().flatten().zip(&ghost.0) {
            if let Ok(mut transform) = balls.get_mut(*ball) {
                *transform = Transform::from_translation(*at + Vec3::Y * RADIUS).with_scale(Vec3::splat(RADIUS));
            }
        }
    }
}
