//! The skin of jelly: its outer masses, joined to a smooth translucent surface.

use bevy::{
    asset::RenderAssetUsages,
    camera::visibility::NoFrustumCulling,
    mesh::{Indices, PrimitiveTopology, VertexAttributeValues},
    prelude::*,
};

use super::{
    clay::tint,
    light::SUN,
    paint::Paint,
    skins::{Cloth, SkinOf},
};
use crate::{
    body::{Ground, Lattice, Neighbours},
    mechanics::ground_distance,
    physics::Shown,
    scenes::SceneMember,
};

/// How much of what is behind it the skin covers.
const OPACITY: f32 = 0.82;
/// How far the skin is from the masses, in lengths: what lies flat on the ground would otherwise be drawn in the plane of the ground, now above it and now below.
const THICKNESS: f32 = 0.05;
/// How dark its shade on the ground is, and how far above the ground it is drawn.
const SHADE: f32 = 0.42;
const LIFT: f32 = 0.012;
/// Steps along a ray of the sun until it meets the ground; a plane takes one.
const RAY_STEPS: usize = 12;

/// The skin that a block wears.
#[derive(Component)]
pub(super) struct JellySkin {
    mesh: Handle<Mesh>,
    /// Its shade on the ground, where no shadow map draws one.
    shade: Option<Handle<Mesh>>,
    /// The particle of each vertex.
    outer: Vec<usize>,
    triangles: Vec<[u32; 3]>,
    /// Scratch.
    positions: Vec<[f32; 3]>,
    normals: Vec<Vec3>,
}

/// The colour of the skin of a block, as 0xRRGGBB: it says which neighbours are joined.
pub fn skin_color(lattice: Lattice) -> u32 {
    match (lattice.joins(Neighbours::Faces), lattice.joins(Neighbours::Cubes)) {
        (false, false) => 0xe39b2f,
        (true, false) => 0x35a86b,
        (false, true) => 0x3f7fd6,
        (true, true) => 0xd0435a,
    }
}

/// Spawns the skin of a block.
pub(super) fn dress(body: Entity, lattice: Lattice, cloth: &mut Cloth<'_>, commands: &mut Commands) -> Entity {
    let (outer, triangles) = surface(lattice.size());
    let [red, green, blue, _] = tint(skin_color(lattice));
    let count = outer.len();
    let mut mesh = |color: [f32; 4]| {
        let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3]; count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 1.0, 0.0]; count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![color; count])
            .with_inserted_indices(Indices::U32(triangles.as_flattened().to_vec()));
        cloth.meshes.add(mesh)
    };
    let shadows = cloth.quality.shadows();
    let skin = mesh([red, green, blue, OPACITY]);
    let shade = (!shadows).then(|| mesh([0.02, 0.03, 0.01, 1.0]));
    let paint = cloth.paints.add(Paint { sheer: true, ..Paint::glossy(shadows, 0.8) });
    // The meshes move away from where their bounds were taken.
    let skin_child = (Mesh3d(skin.clone()), MeshMaterial3d(paint), NoFrustumCulling);
    let shade_child = shade.clone().map(|shade| {
        let paint = cloth.paints.add(Paint::blot(SHADE));
        (Mesh3d(shade), MeshMaterial3d(paint), NoFrustumCulling)
    });
    let worn = JellySkin { mesh: skin, shade, outer, triangles, positions: Vec::new(), normals: Vec::new() };
    let root = commands.spawn((SceneMember, SkinOf(body), worn, Transform::default(), Visibility::default())).id();
    commands.spawn((skin_child, ChildOf(root)));
    if let Some(shade) = shade_child {
        commands.spawn((shade, ChildOf(root)));
    }
    root
}

/// Lays every skin over the masses of its body where they are shown.
pub(super) fn follow(
    bodies: Query<(&Shown, Option<&Ground>)>,
    mut skins: Query<(&SkinOf, &mut JellySkin)>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    for (of, mut skin) in &mut skins {
        let Ok((shown, ground)) = bodies.get(of.0) else { continue };
        let JellySkin { mesh, shade, outer, triangles, positions, normals } = &mut *skin;
        positions.clear();
        positions.extend(outer.iter().map(|&i| shown.positions().get(i).copied().unwrap_or_default().to_array()));
        if let Some(mut shade) = shade.as_ref().and_then(|shade| meshes.get_mut(shade))
            && let Some(VertexAttributeValues::Float32x3(values)) = shade.attribute_mut(Mesh::ATTRIBUTE_POSITION)
        {
            values.clear();
            values.extend(positions.iter().map(|at| shaded(Vec3::from(*at), ground).to_array()));
        }
        let Some(mut mesh) = meshes.get_mut(&*mesh) else { continue };
        normals.clear();
        normals.resize(outer.len(), Vec3::ZERO);
        for corners in triangles {
            let [a, b, c] = corners.map(|corner| Vec3::from(positions[corner as usize]));
            // As long as the triangle is large.
            let normal = (b - a).cross(c - a);
            for corner in corners {
                normals[*corner as usize] += normal;
            }
        }
        normals.iter_mut().for_each(|normal| *normal = normal.normalize_or(Vec3::Y));
        if let Some(VertexAttributeValues::Float32x3(values)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
            values.clear();
            let outwards = positions.iter().zip(&*normals);
            values.extend(outwards.map(|(at, normal)| (Vec3::from(*at) + THICKNESS * *normal).to_array()));
        }
        if let Some(VertexAttributeValues::Float32x3(values)) = mesh.attribute_mut(Mesh::ATTRIBUTE_NORMAL) {
            values.clear();
            values.extend(normals.iter().map(Vec3::to_array));
        }
    }
}

/// Where what is at `at` throws its shade; of a block without a ground there is none. Of the faces that are laid down on the ground so, those that face the sun
/// face up, and no other is drawn: one layer of shade, unless the block is folded.
fn shaded(at: Vec3, ground: Option<&Ground>) -> Vec3 {
    let Some(ground) = ground else { return Vec3::ZERO };
    let (mut at, sun) = (at, SUN.normalize());
    for _ in 0..RAY_STEPS {
        let (distance, normal) = ground_distance(ground, at.as_dvec3());
        let (away, facing) = (distance as f32 - LIFT, normal.as_vec3().dot(sun));
        if away.abs() < 1e-4 {
            break;
        }
        // As far as the plane under it; past what is turned away from the sun no further than is free.
        at -= sun * if facing > 0.1 { away / facing } else { away };
    }
    at
}

/// Whether a grid has a surface: a row of masses has none.
pub(super) fn has_surface(lattice: Lattice) -> bool {
    lattice.size().into_iter().filter(|count| *count > 1).count() > 1
}

/// The outer masses of a grid, and triangles between them by their order, counterclockwise as seen from outside. A mass of a single layer is there
/// twice, once for each side: they look in opposite ways.
fn surface(size: [usize; 3]) -> (Vec<usize>, Vec<[u32; 3]>) {
    let [across, along, layers] = size;
    let mut outer = Vec::new();
    // One vertex a mass, and another for the far side of a single layer.
    let mut sides = [vec![None; across * along * layers], vec![None; across * along * layers]];
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for far in [false, true] {
            let vertices = &mut sides[usize::from(far && size[axis] == 1)];
            let mut vertex = |i: usize, j: usize| {
                let mut place = [0; 3];
                (place[axis], place[u], place[v]) = (if far { size[axis] - 1 } else { 0 }, i, j);
                let particle = place[0] + across * (place[1] + along * place[2]);
                *vertices[particle].get_or_insert_with(|| {
                    outer.push(particle);
                    outer.len() as u32 - 1
                })
            };
            for i in 0..size[u] - 1 {
                for j in 0..size[v] - 1 {
                    let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                    // u × v leads along the axis, which is outwards on the far side.
                    triangles.extend(if far { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
                }
            }
        }
    }
    (outer, triangles)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::body::{Surface, Terrain};

    #[test]
    fn the_surface_of_a_grid_is_closed_and_looks_outwards() {
        let size = [4, 3, 5];
        let (outer, triangles) = surface(size);
        // All masses but those inside; two triangles for each face of a cell.
        assert_eq!(outer.len(), 4 * 3 * 5 - 2 * 3);
        assert_eq!(triangles.len(), 2 * 2 * (3 * 2 + 3 * 4 + 2 * 4));
        let place = |corner: u32| {
            let i = outer[corner as usize];
            Vec3::new((i % 4) as f32, (i / 4 % 3) as f32, (i / 12) as f32)
        };
        let middle = Vec3::new(1.5, 1.0, 2.0);
        let volume: f32 = triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| place(corner) - middle);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!((volume - 3.0 * 2.0 * 4.0).abs() < 1e-4, "{volume}");
    }

    #[test]
    fn a_shade_lies_on_the_ground_away_from_the_sun() {
        for at in [Vec3::new(1.0, 4.0, -2.0), Vec3::new(0.0, 0.0, 3.0)] {
            let shade = shaded(at, Some(&Ground::Flat));
            assert!((shade.y - LIFT).abs() < 1e-6, "{shade}");
            assert!((at - shade).cross(SUN).length() < 1e-5, "{shade} is not behind {at}");
        }
        assert_eq!(shaded(Vec3::Y, None), Vec3::ZERO);
        // Over a hill, too.
        let hill = Surface::Hill { center: (0.0, 0.0), radius: 8.0, height: 2.0 };
        let ground = Ground::Terrain(Arc::new(Terrain::new([hill]).unwrap()));
        let at = Vec3::new(-1.0, 5.0, 1.0);
        let shade = shaded(at, Some(&ground));
        assert!((ground_distance(&ground, shade.as_dvec3()).0 as f32 - LIFT).abs() < 1e-3, "{shade}");
        assert!((at - shade).cross(SUN).length() < 1e-4, "{shade} is not behind {at}");
    }

    #[test]
    fn the_two_sides_of_a_single_layer_look_in_opposite_ways() {
        let (outer, triangles) = surface([4, 3, 1]);
        // Every mass twice, and two triangles a cell on each side.
        assert_eq!((outer.len(), triangles.len()), (2 * 4 * 3, 2 * 2 * 3 * 2));
        let side = |corner: u32| {
            triangles.iter().filter(move |corners| corners.contains(&corner)).map(|corners| {
                let [a, b, c] = corners.map(|corner| {
                    let i = outer[corner as usize];
                    Vec3::new((i % 4) as f32, (i / 4) as f32, 0.0)
                });
                (b - a).cross(c - a).z.signum()
            })
        };
        for corner in 0..outer.len() as u32 {
            let sides: Vec<_> = side(corner).collect();
            assert!(!sides.is_empty() && sides.iter().all(|side| *side == sides[0]), "{corner}: {sides:?}");
        }
    }
}
