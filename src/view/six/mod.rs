//! Creatures of the six-matrix particle system and their roads: an inchworm as a tube with segments and legs, a roller with tyres, axles and beams, and the
//! way that each has come.
//!
//! Each creature is one mesh that is shaped anew where its particles are shown.

mod inchworm;
mod road;
mod roller;
mod trail;
pub(super) mod words;

use bevy::{camera::visibility::NoFrustumCulling, platform::collections::HashMap, prelude::*};

use super::{
    clay::{Clay, shade, tint},
    paint::Paint,
    quality::Quality,
    skins::SkinOf,
};
use crate::{
    body::{Columns, Rules},
    creatures::SixSkin,
    mechanics::six_matrix::Road,
    physics::{PhysicsSystems, Shown, Trail},
    scenes::SceneMember,
};

pub(super) use road::{Lay, lowest};

pub(super) fn plugin(app: &mut App) {
    app.add_plugins(road::plugin).add_systems(
        RunFixedMainLoop,
        follow.after(PhysicsSystems::Sync).in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
    );
}

/// The paint of all creatures, made when the first one is dressed.
#[derive(Default)]
pub(super) struct SixKit {
    paints: HashMap<bool, Handle<Paint>>,
}

/// The skin that a creature wears.
#[derive(Component)]
pub(super) struct SixSkinMesh {
    skin: SixSkin,
    mesh: Handle<Mesh>,
    trail: Handle<Mesh>,
    /// How many points of the trail it was drawn for.
    drawn: usize,
    sides: usize,
}

/// Spawns the skin of a creature.
pub(super) fn dress(
    body: Entity,
    skin: SixSkin,
    kit: &mut SixKit,
    quality: Quality,
    meshes: &mut Assets<Mesh>,
    paints: &mut Assets<Paint>,
    commands: &mut Commands,
) -> Entity {
    let mut paint = |glossy: bool| {
        let make = || paints.add(Paint::glossy(quality.shadows(), if glossy { 0.6 } else { 0.1 }));
        kit.paints.entry(glossy).or_insert_with(make).clone()
    };
    let [glossy, dull] = [true, false].map(&mut paint);
    let [mesh, trail] = [(); 2].map(|()| meshes.add(speck()));
    let sides = if quality == Quality::Low { 12 } else { 20 };
    let worn = SixSkinMesh { skin, mesh: mesh.clone(), trail: trail.clone(), drawn: 0, sides };
    let root = commands.spawn((SceneMember, SkinOf(body), worn, Transform::default(), Visibility::default())).id();
    for (mesh, paint) in [(mesh, glossy), (trail, dull)] {
        // The mesh moves away from where its bounds were taken.
        commands.spawn((Mesh3d(mesh), MeshMaterial3d(paint), NoFrustumCulling, ChildOf(root)));
    }
    root
}

/// A mesh that is hardly there: nothing may have no vertices.
fn speck() -> Mesh {
    let mut clay = Clay::default();
    clay.quad([Vec3::ZERO, Vec3::X * 1e-6, Vec3::ONE * 1e-6, Vec3::Z * 1e-6], tint(0xffffff));
    clay.fire()
}

type Bodies<'w, 's> =
    Query<'w, 's, (&'static Shown, &'static Rules, &'static Columns, Option<&'static Road>, &'static Trail)>;

/// Shapes every creature where it is shown.
fn follow(bodies: Bodies, mut skins: Query<(&SkinOf, &mut SixSkinMesh)>, mut meshes: ResMut<Assets<Mesh>>) {
    for (of, mut skin) in &mut skins {
        let Ok((shown, rules, columns, road, trail)) = bodies.get(of.0) else { continue };
        let at = shown.positions();
        if at.is_empty() {
            continue;
        }
        let mut clay = Clay::default();
        match skin.skin {
            SixSkin::Organic => inchworm::shape(&mut clay, at, rules, columns, skin.sides),
            SixSkin::Mechanical => roller::shape(&mut clay, at, rules, road, skin.sides),
            SixSkin::Plain => at.iter().for_each(|&x| {
                let ball = Transform::from_translation(x).with_scale(Vec3::splat(0.5));
                clay.ball(ball, skin.sides, |direction| shade(tint(0xf2b134), 0.8 + 0.2 * direction.y));
            }),
        }
        if clay.triangles() > 0 {
            meshes.insert(&skin.mesh, clay.fire()).ok();
        }
        if trail.points().len() != skin.drawn {
            skin.drawn = trail.points().len();
            meshes.insert(&skin.trail, trail::shape(trail.points(), skin.skin)).ok();
        }
    }
}
