//! Gives every body the skin of its [`Look`], and takes it away with the body.

use bevy::{
    ecs::{entity::EntityHashMap, system::SystemParam},
    prelude::*,
};

use super::{jelly, paint::Paint, plain, quality::Quality, six, strand, worm};
use crate::{
    body::{Lattice, SpineFriction, Springs, Strand},
    creatures::Look,
    physics::{PhysicsSystems, Shown},
    scenes::{CurrentScene, Props, Runner, garden},
};

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Skins>().add_systems(
        RunFixedMainLoop,
        (dress, worm::follow, plain::follow, strand::follow, strand::follow_parts, jelly::follow)
            .chain()
            .after(PhysicsSystems::Sync)
            .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
    );
}

/// The body that an entity belongs to the skin of.
#[derive(Clone, Component, Copy, Debug)]
pub(super) struct SkinOf(pub Entity);

/// The skins that bodies wear: root entity, look, and how many particles and springs it was cut for.
#[derive(Default, Resource)]
struct Skins(EntityHashMap<(Entity, Look, usize, usize)>);

/// The materials of skins, made anew for every scene.
struct Kits {
    worm: worm::WormKit,
    plain: plain::PlainKit,
    strand: strand::StrandKit,
    six: six::SixKit,
}

type Bodies<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static Look,
        &'static Shown,
        Option<&'static Springs>,
        Option<&'static Strand>,
        Option<&'static Lattice>,
        Option<&'static Runner>,
        Option<&'static SpineFriction>,
    ),
>;

/// What skins and surroundings are made from.
#[derive(SystemParam)]
pub(super) struct Cloth<'w> {
    pub quality: Res<'w, Quality>,
    pub meshes: ResMut<'w, Assets<Mesh>>,
    pub paints: ResMut<'w, Assets<Paint>>,
    pub images: ResMut<'w, Assets<Image>>,
}

fn dress(
    bodies: Bodies,
    scene: Option<Res<CurrentScene>>,
    mut skins: ResMut<Skins>,
    mut kits: Local<Option<Kits>>,
    mut cloth: Cloth,
    mut commands: Commands,
) {
    if scene.as_ref().is_some_and(|scene| scene.is_changed()) {
        *kits = None;
        for (_, (root, ..)) in skins.0.drain() {
            commands.entity(root).try_despawn();
        }
    }
    skins.0.retain(|&body, &mut (root, look, particles, springs)| {
        let stays = bodies.get(body).is_ok_and(|(_, now, shown, held, ..)| {
            (*now, shown.positions().len(), held.map_or(0, Springs::len)) == (look, particles, springs)
        });
        if !stays {
            commands.entity(root).try_despawn();
        }
        stays
    });
    for (body, &look, shown, springs, strand, block, runner, friction) in &bodies {
        let (particles, held) = (shown.positions().len(), springs.map_or(0, Springs::len));
        if particles == 0 || skins.0.contains_key(&body) {
            continue;
        }
        let kits = kits.get_or_insert_with(|| {
            let shadows = cloth.quality.shadows();
            let in_garden = scene.as_ref().is_some_and(|scene| matches!(scene.file.props, Props::Garden { .. }));
            let shelter = if in_garden {
                Vec4::new(garden::BURROW_MOUTH as f32, garden::DOOR as f32 + 0.1, 1.2, 0.0)
            } else {
                Vec4::ZERO
            };
            Kits {
                worm: worm::WormKit::new(&mut cloth.meshes, &mut cloth.paints, shadows, shelter),
                plain: plain::PlainKit::new(&mut cloth.meshes, &mut cloth.paints, shadows),
                strand: strand::StrandKit::default(),
                six: six::SixKit::default(),
            }
        });
        let strand = strand.filter(|strand| strand.particles() == particles);
        let block = block.filter(|block| block.particles() == particles);
        let root = match (look, strand, block) {
            (Look::Strand(skin), Some(&strand), _) => {
                strand::dress(body, strand, skin, &mut kits.strand, &mut cloth, &mut commands)
            }
            // Masses that no spring holds together have no skin.
            (Look::Jelly, _, Some(&block)) if held > 0 && jelly::has_surface(block) => {
                jelly::dress(body, block, &mut cloth, &mut commands)
            }
            (Look::GardenWorm, ..) if particles >= 2 => {
                let dye = runner.map(Runner::color).map(|[r, g, b]| Color::srgb_u8(r, g, b));
                worm::dress(body, particles, dye, &kits.worm, &mut cloth.paints, &mut commands)
            }
            (Look::SixMatrix(skin), ..) => {
                let Cloth { quality, meshes, paints, .. } = &mut cloth;
                six::dress(body, skin, &mut kits.six, **quality, meshes, paints, &mut commands)
            }
            _ => plain::dress(body, particles, springs, friction, &kits.plain, &mut commands),
        };
        skins.0.insert(body, (root, look, particles, held));
    }
}
