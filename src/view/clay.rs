//! Shapes gathered into one mesh: few draw calls for a whole garden.

use core::f32::consts::{PI, TAU};

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

/// A colour and, in its fourth number, how far the wind moves the vertex (lengths at full wind), or, below 0, how much of its paint's maps it does without.
pub(crate) type Tint = [f32; 4];

/// The colour of a web code such as `0xd9825b`, standing still in the wind.
pub(crate) fn tint(code: u32) -> Tint {
    let [_, r, g, b] = code.to_be_bytes();
    let color = Srgba::rgb_u8(r, g, b);
    let linear = LinearRgba::from(color);
    [linear.red, linear.green, linear.blue, 0.0]
}

/// A colour made brighter or darker by a factor.
pub(crate) fn shade(tint: Tint, factor: f32) -> Tint {
    [tint[0] * factor, tint[1] * factor, tint[2] * factor, tint[3]]
}

/// A colour between two.
pub(crate) fn blend(a: Tint, b: Tint, t: f32) -> Tint {
    core::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// The same colour, moved by the wind.
pub(crate) fn swaying(tint: Tint, reach: f32) -> Tint {
    [tint[0], tint[1], tint[2], reach]
}

/// Vertices and triangles under construction; every vertex has a normal and a [`Tint`].
#[derive(Default)]
pub(crate) struct Clay {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    tints: Vec<Tint>,
    indices: Vec<u32>,
}

impl Clay {
    /// Adds a vertex and returns its number.
    pub fn vertex(&mut self, position: Vec3, normal: Vec3, tint: Tint) -> u32 {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.tints.push(tint);
        (self.positions.len() - 1) as u32
    }

    /// Adds a triangle, counterclockwise seen from outside.
    pub fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.indices.extend([a, b, c]);
    }

    /// A flat four-cornered face, counterclockwise seen from outside.
    pub fn quad(&mut self, corners: [Vec3; 4], tint: Tint) {
        let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize_or_zero();
        let [a, b, c, d] = corners.map(|corner| self.vertex(corner, normal, tint));
        self.indices.extend([a, b, c, a, c, d]);
    }

    /// A grid of vertices, `rows` × `columns`, that `at` places; row after row runs to the left of column after column as seen
    /// from outside.
    pub fn grid(&mut self, rows: usize, columns: usize, at: impl Fn(usize, usize) -> (Vec3, Vec3, Tint)) {
        let first = self.positions.len() as u32;
        for row in 0..rows {
            for column in 0..columns {
                let (position, normal, tint) = at(row, column);
                self.vertex(position, normal, tint);
            }
        }
        let width = columns as u32;
        for row in 0..rows as u32 - 1 {
            for column in 0..width - 1 {
                let corner = first + row * width + column;
                self.indices.extend([corner, corner + 1, corner + width + 1]);
                self.indices.extend([corner, corner + width + 1, corner + width]);
            }
        }
    }

    /// A box of the unit cube, moved by `place`.
    pub fn block(&mut self, place: Transform, tint: Tint) {
        for (normal, right) in [
            (Vec3::X, Vec3::NEG_Z),
            (Vec3::NEG_X, Vec3::Z),
            (Vec3::Y, Vec3::X),
            (Vec3::NEG_Y, Vec3::X),
            (Vec3::Z, Vec3::X),
            (Vec3::NEG_Z, Vec3::NEG_X),
        ] {
            let up = normal.cross(right);
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(r, u)| place.transform_point((normal + right * r + up * u) * 0.5));
            self.quad(corners, tint);
        }
    }

    /// An axis-aligned box between two corners.
    pub fn cuboid(&mut self, least: Vec3, most: Vec3, tint: Tint) {
        self.block(Transform::from_translation((least + most) * 0.5).with_scale(most - least), tint);
    }

    /// An ellipsoid: the unit ball moved by `place`, coloured by the direction from its centre.
    pub fn ball(&mut self, place: Transform, sides: usize, color: impl Fn(Vec3) -> Tint) {
        let rows = (sides / 2).max(3);
        self.grid(rows + 1, sides + 1, |row, column| {
            let (down, around) = (PI * row as f32 / rows as f32, TAU * column as f32 / sides as f32);
            let direction = Vec3::new(down.sin() * around.cos(), -down.cos(), -down.sin() * around.sin());
            let normal = place.rotation * (direction / place.scale).normalize();
            (place.transform_point(direction), normal, color(direction))
        });
    }

    /// A surface of revolution about `place`'s y axis: `profile` lists radius and height from the bottom up (outside to the right).
    /// Gentle turns of the profile are shaded round, sharp ones as edges.
    pub fn lathe(
        &mut self,
        place: Transform,
        profile: &[(f32, f32)],
        sides: usize,
        color: impl Fn(usize, f32) -> Tint,
    ) {
        let slopes: Vec<Vec2> = profile
            .windows(2)
            .map(|pair| Vec2::new(pair[1].1 - pair[0].1, pair[0].0 - pair[1].0).normalize_or(Vec2::X))
            .collect();
        for (part, pair) in profile.windows(2).enumerate() {
            let slope = slopes[part];
            let round = |other: Option<&Vec2>| match other {
                Some(&other) if other.dot(slope) > 0.7 => (slope + other).normalize(),
                _ => slope,
            };
            let ends = [round(part.checked_sub(1).map(|before| &slopes[before])), round(slopes.get(part + 1))];
            self.grid(2, sides + 1, |row, column| {
                let ((radius, height), slope) = (pair[row], ends[row]);
                let around = TAU * column as f32 / sides as f32;
                let spoke = Vec3::new(around.cos(), 0.0, -around.sin());
                let normal = place.rotation * (spoke * slope.x + Vec3::Y * slope.y);
                (place.transform_point(spoke * radius + Vec3::Y * height), normal, color(part + row, around))
            });
        }
    }

    /// A tube along `points`; `radius` and `color` are asked with how far along it is, 0 to 1.
    pub fn tube(&mut self, points: &[Vec3], sides: usize, radius: impl Fn(f32) -> f32, color: impl Fn(f32) -> Tint) {
        let last = points.len() - 1;
        let mut side = (points[1] - points[0]).any_orthonormal_vector();
        let frames: Vec<_> = (0..=last)
            .map(|i| {
                let along = (points[(i + 1).min(last)] - points[i.saturating_sub(1)]).normalize_or(Vec3::Y);
                side = (side - along * side.dot(along)).normalize_or(along.any_orthonormal_vector());
                (side, along.cross(side))
            })
            .collect();
        self.grid(points.len(), sides + 1, |row, column| {
            let (t, around) = (row as f32 / last as f32, TAU * column as f32 / sides as f32);
            let normal = frames[row].0 * around.cos() + frames[row].1 * around.sin();
            (points[row] + normal * radius(t), normal, color(t))
        });
    }

    /// The finished mesh.
    pub fn fire(self) -> Mesh {
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, self.tints)
            .with_inserted_indices(Indices::U32(self.indices))
    }

    /// The finished mesh of what lies flat, with its place on maps that cover so many lengths; they lie along x and z.
    pub fn fire_mapped(self, covers: f32) -> Mesh {
        let places: Vec<_> = self.positions.iter().map(|at| [at[0] / covers, at[2] / covers]).collect();
        let tangents = vec![[1.0, 0.0, 0.0, -1.0]; places.len()];
        self.fire()
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, places)
            .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, tangents)
    }

    /// How many triangles there are so far.
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every closed shape must show its outside: the triangles' normals agree with the vertices' normals.
    #[test]
    fn shapes_are_wound_outwards() {
        let mut shapes = [(); 4].map(|()| Clay::default());
        shapes[0].ball(Transform::from_scale(Vec3::new(1.0, 2.0, 0.5)), 12, |_| [0.0; 4]);
        shapes[1].block(Transform::from_xyz(1.0, 2.0, 3.0), [0.0; 4]);
        shapes[2].lathe(Transform::IDENTITY, &[(1.0, 0.0), (1.5, 1.0), (0.5, 2.0)], 12, |_, _| [0.0; 4]);
        shapes[3].tube(&[Vec3::ZERO, Vec3::X, Vec3::new(2.0, 1.0, 0.0)], 8, |_| 0.2, |_| [0.0; 4]);
        for clay in shapes {
            for triangle in clay.indices.chunks(3) {
                let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(clay.positions[triangle[i] as usize]));
                let facing = (b - a).cross(c - a);
                let normal = Vec3::from(clay.normals[triangle[0] as usize]);
                assert!(facing.length() < 1e-6 || facing.dot(normal) > 0.0, "{a} {b} {c}");
            }
        }
    }
}
