//! The garden: everything around the worm, made from a seed.
//!
//! The worm crawls along the x axis from its burrow to its house; see [`scenes::garden`](crate::scenes::garden) for
//! where they are. Each thing is shaped in its own file and painted with the room's one material.

pub(super) mod backdrop;
mod burrow;
mod flowers;
mod grass;
mod house;
mod lawn;
mod path;
mod roof;

use bevy::{camera::visibility::NoFrustumCulling, light::NotShadowCaster, prelude::*};
use rand::{RngExt, SeedableRng, rngs::SmallRng};

use super::{Decor, clay::Clay, paint::Paint, quality::Quality};
use crate::scenes::SceneMember;

/// How far the lawn reaches from the middle of the path.
const FIELD: f32 = 60.0;

/// The middle of the garden, halfway along the path.
const MIDDLE: Vec2 = Vec2::new(4.4, 0.0);

/// A random number from `least` to `most`.
fn between(random: &mut SmallRng, least: f32, most: f32) -> f32 {
    random.random_range(least..most)
}

/// Spawns the garden of a seed.
pub(super) fn plant(
    seed: u64,
    quality: Quality,
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    paints: &mut Assets<Paint>,
) {
    let shadows = quality.shadows();
    let mut random = SmallRng::seed_from_u64(seed);
    let mut triangles = 0;
    let mut spawn = |clay: Clay, paint: Paint, casts: bool| {
        triangles += clay.triangles();
        let mut thing =
            commands.spawn((SceneMember, Decor, Mesh3d(meshes.add(clay.fire())), MeshMaterial3d(paints.add(paint))));
        if !casts {
            thing.insert(NotShadowCaster);
        }
        thing.id()
    };

    let sky = spawn(backdrop::sky(), Paint::glowing(), false);
    spawn(
        backdrop::clouds(&mut random, quality),
        Paint { finish: Vec4::new(0.0, 0.0, 0.0, 0.25), ..Paint::matte(false) },
        false,
    );
    spawn(backdrop::hills(&mut random, quality, 0), Paint::matte(false), false);
    for sector in backdrop::trees(&mut random, quality) {
        spawn(sector, Paint::matte(shadows), true);
    }
    spawn(backdrop::fence(&mut random), Paint::matte(shadows), true);
    spawn(lawn::lawn(quality), Paint::matte(shadows), false);
    spawn(path::path(&mut random, quality), Paint::matte(shadows), true);
    spawn(burrow::burrow(&mut random), Paint::matte(shadows), true);
    spawn(house::house(&mut random), Paint::matte(shadows), true);
    spawn(house::panes(), Paint::glossy(shadows, 1.0), false);
    spawn(flowers::pots(), Paint::glossy(shadows, 0.35), true);
    spawn(flowers::bouquets(&mut random), Paint::leafy(shadows), true);
    spawn(flowers::meadow(&mut random, quality), Paint::leafy(shadows), false);
    spawn(flowers::mushrooms(&mut random), Paint::glossy(shadows, 0.3), true);
    for patch in grass::patches(&mut random, quality) {
        spawn(patch, Paint::leafy(shadows), false);
    }
    commands.entity(sky).insert(NoFrustumCulling);
    info!("garden of seed {seed}: {triangles} triangles");
}
