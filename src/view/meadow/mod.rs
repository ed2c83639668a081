//! The surroundings of a scene whose creatures stand on a ground: what is grass and what is sand, rounds, hills and walls, under an open sky.

use core::f32::consts::TAU;
use std::sync::Arc;

use bevy::{light::NotShadowCaster, math::DVec3, prelude::*};
use rand::{RngExt, SeedableRng, rngs::SmallRng};

mod sward;
mod turf;

use super::{
    Decor,
    clay::{Clay, Tint, blend, shade, swaying, tint},
    garden::backdrop,
    paint::Paint,
    quality::Quality,
    travel::Travels,
};
use crate::{
    body::{Ground, Patch, Surface, Terrain},
    mechanics::ground_distance,
    scenes::SceneMember,
};

/// How far the ground is drawn finely from the middle of the view, and how far at all.
const NEAR: f32 = 64.0;
const FAR: [f32; 6] = [72.0, 84.0, 100.0, 130.0, 170.0, 240.0];
/// A plain repeats itself after this length.
const TILE: f32 = 96.0;
/// How many trees stand on each of the hills.
const TREES: usize = 3;
/// Below this side grip a patch of the ground is sand, above it grass.
const SANDY: f64 = 2.0;
/// How high a wall is drawn, and how long.
const WALL: [f32; 2] = [3.0, 200.0];
/// A plane whose normal rises less than this stands upright, as a wall.
const UPRIGHT: f64 = 0.1;

/// What is looked at, and from how far away.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub middle: Vec3,
    pub distance: f32,
}

/// Spawns the ground, what grows and lies on it, and the sky.
pub(super) fn set_up(
    ground: &Ground,
    place: Place,
    quality: Quality,
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    paints: &mut Assets<Paint>,
    images: &mut Assets<Image>,
) {
    let (middle, shadows) = (place.middle, quality.shadows());
    let mut random = SmallRng::seed_from_u64(4);
    // A plain looks the same a tile further on; what has edges, rounds and patches is one place.
    let tile = (*ground == Ground::Flat).then_some(Travels { every: TILE, middle: Vec3::ZERO });
    let with_the_view = Some(Travels { every: 0.0, middle: Vec3::ZERO });
    let mut spawn = |clay: Clay, paint: Paint, casts: bool, travels: Option<Travels>, places: &[Vec3]| {
        if clay.triangles() == 0 {
            return;
        }
        let mesh = if paint.color_map.is_some() { clay.fire_mapped(sward::COVERS) } else { clay.fire() };
        let (mesh, paint) = (meshes.add(mesh), paints.add(paint));
        for &place in places {
            let looks = (Mesh3d(mesh.clone()), MeshMaterial3d(paint.clone()), Transform::from_translation(place));
            let root = (SceneMember, Decor, Transform::default(), Visibility::default());
            let root = commands.spawn(root).id();
            if let Some(travels) = travels {
                commands.entity(root).insert(travels);
            }
            let mut thing = commands.spawn((looks, ChildOf(root)));
            if !casts {
                thing.insert(NotShadowCaster);
            }
        }
    };
    let here = [Vec3::ZERO];
    spawn(backdrop::sky(), Paint::glowing(), false, with_the_view, &here);
    let haze = Paint { finish: Vec4::new(0.0, 0.0, 0.0, 0.25), ..Paint::matte(false) };
    spawn(backdrop::clouds(&mut random, quality), haze, false, with_the_view, &here);
    let thin_haze = Paint { finish: Vec4::new(0.0, 0.0, 0.0, 0.7), ..Paint::matte(false) };
    spawn(backdrop::hills(&mut random, quality, TREES), thin_haze, false, with_the_view, &here);
    let middle = if tile.is_some() { Vec3::ZERO } else { middle };
    let lying = without_walls(ground);
    let mapped = quality == Quality::High;
    let [color_map, bump_map] = if mapped { sward::maps().map(|map| Some(images.add(map))) } else { [None, None] };
    let soil = Paint { color_map, bump_map, ..Paint::matte(shadows) };
    spawn(land(&lying, middle, mapped), soil, false, tile, &here);
    spawn(walls(ground), Paint::matte(shadows), true, None, &here);
    let [leaves, stones] = scattered(&lying, middle, quality, &mut random);
    let around: Vec<_> =
        (-1..=1).flat_map(|x| (-1..=1).map(move |z| Vec3::new(x as f32, 0.0, z as f32) * TILE)).collect();
    let places = if tile.is_some() { &around[..] } else { &here };
    spawn(leaves, Paint::leafy(shadows), false, tile, places);
    for (middle, blades) in turf::patches(&lying, place, quality, &mut random) {
        spawn(blades, Paint::leafy(shadows), false, tile.map(|tile| Travels { middle, ..tile }), &here);
    }
    spawn(stones, Paint::matte(shadows), true, tile, places);
}

/// The ground without its walls, which stand on it: masses feel them as the side of something solid, but what lies behind a fence is a meadow too.
fn without_walls(ground: &Ground) -> Ground {
    let Ground::Terrain(terrain) = ground else { return ground.clone() };
    let lies = |surface: &Surface| !matches!(*surface, Surface::Plane { normal, .. } if is_upright(normal));
    Terrain::new(terrain.surfaces().iter().copied().filter(lies))
        .and_then(|lying| lying.with_patches(terrain.patches().iter().copied()))
        .map_or_else(|_| ground.clone(), |lying| Ground::Terrain(Arc::new(lying)))
}

/// Whether a plane with this normal is a wall.
fn is_upright(normal: (f64, f64, f64)) -> bool {
    DVec3::from(normal).normalize().y <= UPRIGHT
}

/// The height of the ground at a spot, as it is seen from above.
fn height(ground: &Ground, x: f32, z: f32) -> f32 {
    let Ground::Terrain(terrain) = ground else { return 0.0 };
    let (x, z) = (f64::from(x), f64::from(z));
    let heights = terrain.surfaces().iter().filter_map(|surface| match *surface {
        Surface::Floor { height } => Some(height),
        Surface::Plane { point, normal } => {
            let (n, p) = (DVec3::from(normal).normalize(), DVec3::from(point));
            (!is_upright(normal)).then(|| p.y - (n.x * (x - p.x) + n.z * (z - p.z)) / n.y)
        }
        Surface::Cliff { edge, radius, drop } => {
            let beyond = x - edge;
            Some(match beyond {
                beyond if beyond <= 0.0 => 0.0,
                beyond if beyond < radius => (radius * radius - beyond * beyond).sqrt() - radius,
                _ => -drop.unwrap_or(40.0),
            })
        }
        Surface::Hill { center, radius, height } => {
            let part = 1.0 - ((x - center.0).powi(2) + (z - center.1).powi(2)) / (radius * radius);
            Some(height * part.max(0.0).powi(3))
        }
        Surface::Ball { center, radius } => {
            let square = radius * radius - (x - center.0).powi(2) - (z - center.2).powi(2);
            (square > 0.0).then(|| center.1 + square.sqrt())
        }
    });
    let highest = heights.fold(f64::NEG_INFINITY, f64::max);
    if highest.is_finite() { highest as f32 } else { -40.0 }
}

/// Whether nothing grows at a spot because it is too steep.
fn is_steep(ground: &Ground, x: f32, z: f32) -> bool {
    let at = || Vec3::new(x, height(ground, x, z), z).as_dvec3();
    *ground != Ground::Flat && ground_distance(ground, at()).1.y < 0.9
}

/// Whether a spot is sand.
fn is_sand(ground: &Ground, x: f32, z: f32) -> bool {
    let Ground::Terrain(terrain) = ground else { return false };
    let (x, z) = (f64::from(x), f64::from(z));
    let covers = |patch: &&Patch| match **patch {
        Patch::Disc { center, radius, .. } => (x - center.0).hypot(z - center.1) < radius,
        Patch::Box { from, to, .. } => x > from.0 && x < to.0 && z > from.1 && z < to.1,
    };
    terrain.patches().iter().rev().find(covers).is_some_and(|patch| patch.grip() < SANDY)
}

/// Its colour: grass in broad patches with a faint chequer that shows how far an animal goes, sand in ripples, rock where it is steep.
fn color(ground: &Ground, x: f32, z: f32, up: f32, mapped: bool) -> Tint {
    let chequer = if (x.floor() + z.floor()) as i64 % 2 == 0 { 1.05 } else { 0.95 };
    let sandy = is_sand(ground, x, z);
    let soft = if sandy {
        let ripple = (z * 2.4 + (x * 0.7).sin() * 0.8 + (x * 0.23 + z * 0.1).sin() * 2.0).sin() * 0.5 + 0.5;
        shade(blend(tint(0xd3b078), tint(0xe9d3a2), ripple), 0.62)
    } else {
        // As the garden's lawn: blades are brighter than what they stand on.
        let light = if mapped { 0.68 / sward::MEAN } else { 0.68 };
        shade(blend(green(x, z), tint(0x7a7440), 0.2), light)
    };
    let strata = (x * 1.7 + z * 0.35).sin() * 0.5 + 0.5;
    let rock = shade(blend(tint(0x9a8266), tint(0xb79f80), strata), 0.7);
    let grows = ((up - 0.45) / 0.35).clamp(0.0, 1.0);
    let [red, green, blue, _] = blend(rock, shade(soft, chequer), grows);
    // Neither sand nor rock is covered with the map of grass.
    let bare = if sandy { 1.0 } else { 1.0 - grows };
    [red, green, blue, if mapped { -bare } else { 0.0 }]
}

/// The colour of grass at a spot, in patches of several sizes that repeat themselves with the tile.
fn green(x: f32, z: f32) -> Tint {
    let (x, z) = (x * TAU / TILE, z * TAU / TILE);
    let broad = (3.0 * x + 1.7 * (2.0 * z + 1.0).sin()).sin() * (3.0 * z + 1.3 * (2.0 * x).sin()).sin();
    let middling = (7.0 * x + 2.0 * (5.0 * z).sin()).sin() * (6.0 * z + 1.9 * (4.0 * x + 2.0).sin()).sin();
    let small = (13.0 * x + 1.5 * (11.0 * z).sin()).sin() * (12.0 * z + 1.2 * (9.0 * x).sin()).sin();
    blend(tint(0x467a30), tint(0x6f9c3e), 0.5 + 0.28 * broad + 0.18 * middling + 0.12 * small)
}

/// Where the lines of the drawn ground are along one axis: closer near the middle, and wherever else `also` says.
fn lines(middle: f32, also: &[f32]) -> Vec<f32> {
    let near = (0..=2 * NEAR as i32).map(|i| (middle - NEAR).round() + i as f32);
    let far = FAR.iter().flat_map(|&out| [middle.round() - out, middle.round() + out]);
    let mut lines: Vec<_> = near.chain(far).chain(also.iter().copied()).collect();
    lines.sort_by(f32::total_cmp);
    lines.dedup();
    lines
}

fn land(ground: &Ground, middle: Vec3, mapped: bool) -> Clay {
    let (mut extra, mut extra_z) = (Vec::new(), Vec::new());
    if let Ground::Terrain(terrain) = ground {
        for surface in terrain.surfaces() {
            if let Surface::Cliff { edge, radius, .. } = *surface {
                let round = |i: i32| edge + radius * libm::sin(f64::from(i) / 16.0 * core::f64::consts::FRAC_PI_2);
                extra.extend((0..16).map(|i| round(i) as f32));
                // The upright part between two lines that are as good as one.
                extra.extend([(edge + radius - 1e-4) as f32, (edge + radius + 1e-4) as f32]);
            }
        }
        for patch in terrain.patches() {
            if let Patch::Box { from, to, .. } = *patch {
                let beside = |edge: f64| [edge as f32 - 0.01, edge as f32 + 0.01];
                extra.extend([from.0, to.0].into_iter().flat_map(beside));
                extra_z.extend([from.1, to.1].into_iter().flat_map(beside));
            }
        }
    }
    let (xs, zs) = (lines(middle.x, &extra), lines(middle.z, &extra_z));
    let mut clay = Clay::default();
    clay.grid(zs.len(), xs.len(), |row, column| {
        // From far to near, so that the upper side is the outside.
        let (x, z) = (xs[column], zs[zs.len() - 1 - row]);
        let at = Vec3::new(x, height(ground, x, z), z);
        let normal = match ground {
            Ground::Flat => Vec3::Y,
            Ground::Terrain(_) => ground_distance(ground, at.as_dvec3()).1.as_vec3(),
        };
        (at, normal, color(ground, x, z, normal.y, mapped))
    });
    clay
}

/// Planes that stand upright, as walls of boards.
fn walls(ground: &Ground) -> Clay {
    let mut clay = Clay::default();
    let Ground::Terrain(terrain) = ground else { return clay };
    for surface in terrain.surfaces() {
        let Surface::Plane { point, normal } = *surface else { continue };
        if !is_upright(normal) {
            continue;
        }
        let (point, normal) = (DVec3::from(point).as_vec3(), DVec3::from(normal).normalize().as_vec3());
        let along = normal.cross(Vec3::Y).normalize_or(Vec3::Z);
        let turn = Quat::from_mat3(&Mat3::from_cols(normal, along.cross(normal), along));
        let foot = height(ground, point.x + normal.x, point.z + normal.z);
        for i in 0..WALL[1] as i32 {
            let wide = 0.96;
            let middle = point.with_y(foot) + along * (i as f32 + 0.5 - 0.5 * WALL[1]) - normal * 0.15;
            let tall = WALL[0] + 0.12 * ((i * 7 % 5) as f32 - 2.0) / 2.0;
            let board = shade(blend(tint(0xa8764a), tint(0xc79a68), (i * 3 % 7) as f32 / 6.0), 0.9);
            let place = Transform::from_translation(middle + Vec3::Y * 0.5 * tall).with_rotation(turn);
            clay.block(place.with_scale(Vec3::new(0.3, tall, wide)), board);
        }
    }
    clay
}

/// Tufts of grass with flowers among them, and stones.
fn scattered(ground: &Ground, middle: Vec3, quality: Quality, random: &mut SmallRng) -> [Clay; 2] {
    let (mut leaves, mut stones) = (Clay::default(), Clay::default());
    let count = if quality == Quality::Low { 700 } else { 4000 };
    for i in 0..count {
        let (x, z) =
            (middle.x + random.random_range(-0.5..0.5) * TILE, middle.z + random.random_range(-0.5..0.5) * TILE);
        let foot = Vec3::new(x, height(ground, x, z), z);
        if is_steep(ground, x, z) {
            continue;
        }
        let sandy = is_sand(ground, x, z);
        if i % 9 == 0 {
            let size = random.random_range(0.05..0.2_f32);
            let flat = Vec3::new(size, size * 0.6, size * random.random_range(0.7..1.2_f32));
            let turn = Quat::from_rotation_y(random.random_range(0.0..TAU));
            let color = shade(tint(if sandy { 0xc9a877 } else { 0xa7a79c }), random.random_range(0.75..1.05_f32));
            stones.ball(Transform::from_translation(foot).with_rotation(turn).with_scale(flat), 8, |direction| {
                shade(color, 0.75 + 0.25 * direction.y)
            });
        }
        if !sandy {
            tuft(&mut leaves, foot, i % 5 == 0, random);
        }
    }
    [leaves, stones]
}

fn tuft(leaves: &mut Clay, foot: Vec3, flower: bool, random: &mut SmallRng) {
    let green = blend(tint(0x4f8a34), tint(0x9cc25a), random.random());
    for _ in 0..4 {
        let around = random.random_range(0.0..TAU);
        let (lean, tall) = (random.random_range(0.05..0.16_f32), random.random_range(0.16..0.42_f32));
        let out = Vec3::new(around.cos(), 0.0, around.sin());
        let side = Vec3::new(-out.z, 0.0, out.x) * 0.025;
        let root = foot + out * 0.04;
        let a = leaves.vertex(root - side, Vec3::Y, shade(green, 0.6));
        let b = leaves.vertex(root + side, Vec3::Y, shade(green, 0.6));
        let c = leaves.vertex(root + out * lean + Vec3::Y * tall, Vec3::Y, swaying(green, 0.1 * tall));
        leaves.triangle(a, b, c);
    }
    if flower {
        let petals = [0xf7f3ea, 0xf2c230, 0xe77aa5, 0x9a7be0][random.random_range(0..4)];
        let top = foot + Vec3::Y * random.random_range(0.3..0.5_f32);
        for i in 0..5 {
            let around = TAU * i as f32 / 5.0;
            let out = Vec3::new(around.cos(), 0.25, around.sin()) * 0.12;
            let side = Vec3::new(-out.z, 0.0, out.x) * 0.5;
            let color = swaying(tint(petals), 0.04);
            let corners = [top, top + out - side, top + out * 1.3, top + out + side];
            let [a, b, c, d] = corners.map(|corner| leaves.vertex(corner, Vec3::Y, color));
            leaves.triangle(a, c, b);
            leaves.triangle(a, d, c);
        }
        let heart = Transform::from_translation(top + Vec3::Y * 0.02).with_scale(Vec3::splat(0.06));
        leaves.ball(heart, 8, |_| swaying(tint(0xf0b81e), 0.04));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_is_the_surface_that_masses_stand_on() {
        let surfaces = [
            Surface::Cliff { edge: 4.0, radius: 3.0, drop: Some(3.0) },
            Surface::Hill { center: (-8.0, 2.0), radius: 5.0, height: 1.5 },
            Surface::Ball { center: (-20.0, 0.0, 0.0), radius: 2.0 },
        ];
        let ground = Ground::Terrain(Arc::new(Terrain::new(surfaces).unwrap()));
        for (x, z) in [(0.0, 0.0), (4.9, 1.0), (6.0, -3.0), (9.0, 0.0), (-8.0, 2.0), (-6.0, 3.0), (-20.0, 0.5)] {
            let at = DVec3::new(x, f64::from(height(&ground, x as f32, z as f32)), z);
            assert!(ground_distance(&ground, at).0.abs() < 1e-5, "({x}, {z}): {}", ground_distance(&ground, at).0);
        }
    }
    #[test]
    fn what_lies_behind_a_wall_is_a_meadow_too() {
        let wall = Surface::Plane { point: (14.0, 0.0, 0.0), normal: (-1.0, 0.0, 0.0) };
        let slope = Surface::Plane { point: (0.0, -9.0, 0.0), normal: (-0.6, 0.8, 0.0) };
        let ground = Ground::Terrain(Arc::new(Terrain::new([Surface::Floor { height: 0.0 }, wall, slope]).unwrap()));
        let Ground::Terrain(lying) = without_walls(&ground) else { panic!("it has surfaces") };
        assert_eq!(lying.surfaces(), [Surface::Floor { height: 0.0 }, slope]);
        // A wall alone stays: a ground without a surface is none.
        let wall = Ground::Terrain(Arc::new(Terrain::new([wall]).unwrap()));
        assert_eq!(without_walls(&wall), wall);
    }
}
