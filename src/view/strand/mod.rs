//! The skins of strands: worm, snake, sidewinder, caterpillar.

mod bristles;
mod coat;
mod face;
mod shape;
mod spline;
mod surface;

use bevy::{
    asset::RenderAssetUsages,
    camera::visibility::NoFrustumCulling,
    light::NotShadowCaster,
    mesh::{Indices, PrimitiveTopology, VertexAttributeValues},
    platform::collections::HashMap,
    prelude::*,
};

use super::{
    paint::Paint,
    quality::Quality,
    skins::{Cloth, SkinOf},
    worm_parts,
};
use crate::{
    body::{Ground, Strand},
    creatures::Skin,
    mechanics::ground_distance,
    physics::Shown,
    scenes::SceneMember,
};

use bristles::Bristles;
use coat::{Coat, TILE};
use shape::Outline;
use surface::{Grain, Surface, pattern_places, triangles};

/// What strands are dressed with, made when the first one of a kind is.
#[derive(Default)]
pub(super) struct StrandKit {
    coats: HashMap<Coat, Handle<Paint>>,
    shared: Option<Shared>,
}

#[derive(Clone)]
struct Shared {
    eye: Handle<Mesh>,
    eye_paint: Handle<Paint>,
    bristle_paint: Handle<Paint>,
    blot: Handle<Mesh>,
    shadow: Handle<Paint>,
    snout: Handle<Mesh>,
    tongue: Handle<Mesh>,
    smile: Handle<Mesh>,
    feeler: Handle<Mesh>,
}

/// The skin that a strand wears.
#[derive(Component)]
pub(super) struct StrandSkin {
    mesh: Handle<Mesh>,
    outline: &'static Outline,
    grain: Grain,
    surface: Surface,
    bristles: Option<(Handle<Mesh>, Bristles)>,
}

/// Something that sits on a strand's skin.
#[derive(Clone, Component, Copy, Debug)]
pub(super) enum StrandPart {
    /// An eye at a vertex of the skin, of some size.
    Eye { vertex: usize, size: f32 },
    /// A part of its face, where it is on the ball of its head.
    Face(Transform),
    /// The tongue of a snake.
    Tongue,
    /// The dark spot on the ground under a section.
    Blot { section: usize },
}

/// How an animal is drawn: its pattern, its outline, and its eyes' size and height, from the belly (0) to the back (½).
fn design(skin: Skin) -> (Coat, &'static Outline, f32, f32) {
    match skin {
        Skin::Worm => (Coat::Worm, &Outline::WORM, 0.1, 0.36),
        Skin::Snake => (Coat::Snake, &Outline::SNAKE, 0.13, 0.36),
        Skin::Sidewinder => (Coat::Sidewinder, &Outline::SNAKE, 0.13, 0.38),
        Skin::Caterpillar => (Coat::Caterpillar, &Outline::CATERPILLAR, 0.2, 0.34),
    }
}

fn grain(quality: Quality) -> Grain {
    match quality {
        Quality::Low => Grain { rows: 4, columns: 16, cap: 3 },
        Quality::High => Grain { rows: 6, columns: 28, cap: 6 },
    }
}

/// Spawns the skin of a strand.
pub(super) fn dress(
    body: Entity,
    strand: Strand,
    skin: Skin,
    kit: &mut StrandKit,
    cloth: &mut Cloth<'_>,
    commands: &mut Commands,
) -> Entity {
    let (quality, meshes, paints) = (*cloth.quality, &mut cloth.meshes, &mut cloth.paints);
    let (coat, outline, eye_size, eye_height) = design(skin);
    let (grain, shadows) = (grain(quality), quality.shadows());
    let coated = kit.coats.entry(coat).or_insert_with(|| {
        let [color, bumps] = coat.maps().map(|map| cloth.images.add(map));
        let gloss = if coat == Coat::Caterpillar { 0.25 } else { 0.6 };
        paints.add(Paint { color_map: Some(color), bump_map: Some(bumps), ..Paint::glossy(shadows, gloss) })
    });
    let coated = coated.clone();
    let shared = kit.shared.get_or_insert_with(|| Shared {
        eye: meshes.add(worm_parts::eye()),
        eye_paint: paints.add(Paint::glossy(shadows, 0.9)),
        bristle_paint: paints.add(Paint::matte(shadows)),
        blot: meshes.add(worm_parts::blot()),
        shadow: paints.add(Paint::blot(if shadows { 0.35 } else { 0.9 })),
        snout: meshes.add(face::snout()),
        tongue: meshes.add(face::tongue()),
        smile: meshes.add(worm_parts::mouth()),
        feeler: meshes.add(worm_parts::feeler()),
    });
    let shared = shared.clone();

    let segments = strand.segments();
    let mesh = meshes.add(empty_mesh(segments, grain));
    let field = (coat == Coat::Caterpillar).then(|| {
        let bristles = Bristles::over(segments, grain);
        (meshes.add(bristles.mesh()), bristles)
    });
    let bristle_mesh = field.as_ref().map(|(mesh, _)| mesh.clone());
    let worn = StrandSkin { mesh: mesh.clone(), outline, grain, surface: Surface::default(), bristles: field };
    let root = commands.spawn((SceneMember, SkinOf(body), worn, Transform::default(), Visibility::default())).id();
    // The mesh moves away from where its bounds were taken.
    commands.spawn((Mesh3d(mesh), MeshMaterial3d(coated), NoFrustumCulling, ChildOf(root)));
    if let Some(mesh) = bristle_mesh {
        commands.spawn((Mesh3d(mesh), MeshMaterial3d(shared.bristle_paint.clone()), NoFrustumCulling, ChildOf(root)));
    }
    // On the sides of the last but one section's middle.
    let row = grain.cap + grain.rows * segments - grain.rows / 2;
    for side in [eye_height, 1.0 - eye_height] {
        let vertex = row * (grain.columns + 1) + (side * grain.columns as f32).round() as usize;
        let eye = (Mesh3d(shared.eye.clone()), MeshMaterial3d(shared.eye_paint.clone()));
        commands.spawn((StrandPart::Eye { vertex, size: eye_size }, SkinOf(body), eye, ChildOf(root)));
    }
    for (part, mesh) in features(coat, &shared) {
        let looks = (Mesh3d(mesh), MeshMaterial3d(shared.eye_paint.clone()));
        commands.spawn((part, SkinOf(body), looks, ChildOf(root)));
    }
    for section in 0..strand.sections() {
        let blot = (Mesh3d(shared.blot.clone()), MeshMaterial3d(shared.shadow.clone()), NotShadowCaster);
        commands.spawn((StrandPart::Blot { section }, SkinOf(body), blot, ChildOf(root)));
    }
    root
}

/// What is in the face of an animal beside its eyes.
fn features(coat: Coat, shared: &Shared) -> Vec<(StrandPart, Handle<Mesh>)> {
    match coat {
        // An earthworm has no face to speak of.
        Coat::Worm => Vec::new(),
        Coat::Snake | Coat::Sidewinder => vec![
            (StrandPart::Face(Transform::IDENTITY), shared.snout.clone()),
            (StrandPart::Tongue, shared.tongue.clone()),
        ],
        Coat::Caterpillar => {
            let feeler = |side: f32| {
                let turn = Quat::from_rotation_x(0.4 * side) * Quat::from_rotation_z(-0.2);
                let place = Transform::from_xyz(0.2, 0.92, 0.3 * side).with_rotation(turn);
                (StrandPart::Face(place.with_scale(Vec3::splat(1.25))), shared.feeler.clone())
            };
            // It smiles a little higher than the worm in the garden: it is seen from above.
            let smile = Transform::from_rotation(Quat::from_rotation_z(0.3));
            vec![(StrandPart::Face(smile), shared.smile.clone()), feeler(1.0), feeler(-1.0)]
        }
    }
}

/// A mesh with room for every vertex, which later is written in place.
fn empty_mesh(segments: usize, grain: Grain) -> Mesh {
    let count = grain.all_rows(segments) * (grain.columns + 1);
    let places: Vec<_> = pattern_places(segments, grain).into_iter().map(|[u, v]| [u, v / TILE]).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3]; count])
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 1.0, 0.0]; count])
        .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![[1.0, 0.0, 0.0, 1.0]; count])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, places)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[1.0, 1.0, 1.0, 0.0]; count])
        .with_inserted_indices(Indices::U32(triangles(segments, grain)))
}

/// Lays every skin over the masses of its body where they are shown.
pub(super) fn follow(
    bodies: Query<(&Shown, &Strand)>,
    mut skins: Query<(&SkinOf, &mut StrandSkin)>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    // Each by itself: a hundred snakes have more than a quarter of a million vertices.
    skins.par_iter_mut().for_each(|(of, mut skin)| {
        let Ok((shown, _)) = bodies.get(of.0) else { return };
        let StrandSkin { outline, grain, surface, bristles, .. } = &mut *skin;
        surface.cut(shown.positions(), outline, *grain);
        if let Some((_, bristles)) = bristles {
            bristles.grow(surface);
        }
    });
    for (_, skin) in skins.iter().filter(|(_, skin)| !skin.surface.positions.is_empty()) {
        if let Some(mut mesh) = meshes.get_mut(&skin.mesh) {
            write(&mut mesh, &skin.surface.positions, &skin.surface.normals);
            if let Some(VertexAttributeValues::Float32x4(tangents)) = mesh.attribute_mut(Mesh::ATTRIBUTE_TANGENT) {
                tangents.clone_from(&skin.surface.tangents);
            }
        }
        if let Some((handle, bristles)) = &skin.bristles
            && let Some(mut mesh) = meshes.get_mut(handle)
        {
            write(&mut mesh, &bristles.positions, &bristles.normals);
        }
    }
}

fn write(mesh: &mut Mesh, positions: &Vec<[f32; 3]>, normals: &Vec<[f32; 3]>) {
    if let Some(VertexAttributeValues::Float32x3(values)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        values.clone_from(positions);
    }
    if let Some(VertexAttributeValues::Float32x3(values)) = mesh.attribute_mut(Mesh::ATTRIBUTE_NORMAL) {
        values.clone_from(normals);
    }
}

/// Puts eyes, faces and spots of shade where they belong.
pub(super) fn follow_parts(
    time: Res<Time<Virtual>>,
    bodies: Query<(&Shown, Option<&Ground>)>,
    skins: Query<&StrandSkin>,
    mut parts: Query<(&StrandPart, &SkinOf, &ChildOf, &mut Transform)>,
) {
    for (part, of, root, mut transform) in &mut parts {
        let (Ok((shown, ground)), Ok(skin)) = (bodies.get(of.0), skins.get(root.parent())) else { continue };
        let placed = match *part {
            StrandPart::Eye { vertex, size } => eye(&skin.surface, vertex, size),
            StrandPart::Face(place) => face::head(&skin.surface, skin.grain).map(|head| head * place),
            StrandPart::Tongue => face::head(&skin.surface, skin.grain).map(|head| {
                let out = face::flicker(time.elapsed_secs());
                // Drawn in it is short and inside of the mouth.
                head * Transform::from_xyz(0.75 * (1.0 - out), 0.0, 0.0).with_scale(Vec3::new(out.max(0.05), 1.0, 1.0))
            }),
            StrandPart::Blot { section } => blot(shown.positions(), section, ground),
        };
        if let Some(placed) = placed {
            *transform = placed;
        }
    }
}

fn eye(surface: &Surface, vertex: usize, size: f32) -> Option<Transform> {
    let at = Vec3::from(*surface.positions.get(vertex)?);
    let normal = Vec3::from(surface.normals[vertex]);
    let around = Vec4::from(surface.tangents[vertex]).truncate();
    // Ahead and outwards.
    let look = (normal + around.cross(normal) * 0.6).normalize_or(normal);
    let up = look.cross(around.cross(look)).normalize_or(Vec3::Y);
    let up = if up.y < 0.0 { -up } else { up };
    let side = look.cross(up);
    let turn = Quat::from_mat3(&Mat3::from_cols(look, up, side));
    Some(Transform { translation: at - normal * (0.35 * size), rotation: turn, scale: Vec3::splat(size) })
}

fn blot(positions: &[Vec3], section: usize, ground: Option<&Ground>) -> Option<Transform> {
    let at = |section: usize| Some((*positions.get(4 * section)? + *positions.get(4 * section + 1)?) * 0.5);
    let sections = positions.len() / 4;
    let bottom = at(section)?;
    let (distance, normal) = ground_distance(ground?, bottom.as_dvec3());
    let (distance, normal) = (distance as f32, normal.as_vec3());
    let along = at((section + 1).min(sections - 1))? - at(section.saturating_sub(1))?;
    let forward = along.reject_from_normalized(normal).normalize_or(normal.any_orthonormal_vector());
    let turn = Quat::from_mat3(&Mat3::from_cols(forward, normal, forward.cross(normal)));
    // What is lifted throws a smaller shade, a little to the side that is turned away from the sun.
    let near = (1.0 - 0.5 * distance.max(0.0)).clamp(0.0, 1.0);
    let translation = bottom - normal * (distance - 0.012) + Vec3::new(0.1, 0.0, -0.1) * (1.0 + distance.max(0.0));
    Some(Transform { translation, rotation: turn, scale: Vec3::new(0.9, 1.0, 0.72) * near.max(0.01) })
}
