//! The skin of a strand as a surface: bicubic B-spline patches over its masses, closed at both ends.
//!
//! Sections are rows of control points, their four masses a periodic ring. Rows are clamped by one more at either end, 2P₀ − P₁, so that the
//! surface ends at the last section. Blending around comes first, once a section, so that a vertex takes four points and not sixteen.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;

use super::{
    shape::{Girth, Outline},
    spline::{blend, slopes, weights},
};

/// A ring of four control points is drawn in by the spline to 0.916 of half its side; so much larger, it reaches what its masses stand on.
const RING: f32 = 1.09;

/// How much of its pattern goes over the round end of a head.
const FACE: f32 = 0.25;

/// How finely a skin is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Grain {
    /// Rows a segment.
    pub rows: usize,
    /// Columns around.
    pub columns: usize,
    /// Rows of a round end.
    pub cap: usize,
}

/// Where the vertices of a skin lie, in order, row after row from the tail's tip to the head's.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    /// Positions.
    pub positions: Vec<[f32; 3]>,
    /// Normals, outwards, of length 1.
    pub normals: Vec<[f32; 3]>,
    /// Around the body, of length 1, with the handedness of the bump map.
    pub tangents: Vec<[f32; 4]>,
    /// Control rings and their slopes around, one column after the other: scratch.
    rings: Vec<(Vec3, Vec3)>,
}

/// The masses of a section as seen from behind: left bottom, right bottom, right top, left top.
type Corners = [Vec3; 4];

/// A section with the girth that the animal has there. The belly stays where it is: what is thinner lies on the ground and does not hover.
fn shaped(corners: Corners, girth: Girth) -> Corners {
    let [left_bottom, right_bottom, right_top, left_top] = corners;
    let middle = (left_bottom + right_bottom + right_top + left_top) * 0.25;
    let up = (left_top + right_top - left_bottom - right_bottom) * 0.25;
    let centre = middle + up * (girth.high - 1.0);
    corners.map(|corner| {
        let out = corner - middle;
        let upright = out.project_onto(up.try_normalize().unwrap_or(Vec3::Y));
        centre + (upright * girth.high + (out - upright) * girth.wide) * RING
    })
}

impl Grain {
    /// How many rows a body of so many segments has, round ends included.
    pub fn all_rows(self, segments: usize) -> usize {
        self.rows * segments + 1 + 2 * self.cap
    }
}

/// The triangles between the vertices of a body of so many segments, counterclockwise as seen from outside.
pub(super) fn triangles(segments: usize, grain: Grain) -> Vec<u32> {
    let (rows, width) = (grain.all_rows(segments) as u32, grain.columns as u32 + 1);
    let corners = (0..rows - 1).flat_map(move |row| (0..width - 1).map(move |column| row * width + column));
    corners.flat_map(|a| [a, a + width + 1, a + 1, a, a + width, a + width + 1]).collect()
}

/// Where on its pattern each vertex is: around the body from the middle of the belly, 0 to 1, and along it in segments from the tail. Over the round end of the head
/// the pattern is drawn out: its next band or saddle would sit in the middle of the face.
pub(super) fn pattern_places(segments: usize, grain: Grain) -> Vec<[f32; 2]> {
    let along = |row: usize| {
        let segment = (row as f32 - grain.cap as f32) / grain.rows as f32;
        let on_head = (segment - segments as f32).max(0.0);
        segment - on_head + FACE * on_head
    };
    let place = |row, column| [column as f32 / grain.columns as f32, along(row)];
    (0..grain.all_rows(segments)).flat_map(|row| (0..=grain.columns).map(move |column| place(row, column))).collect()
}

impl Surface {
    /// Blends the surface over the masses of a body. `masses` has four a section.
    pub fn cut(&mut self, masses: &[Vec3], outline: &Outline, grain: Grain) {
        let sections = masses.len() / 4;
        if sections < 2 {
            return;
        }
        self.ring(masses, sections, outline, grain);
        self.positions.clear();
        self.normals.clear();
        self.tangents.clear();
        let (segments, width) = (sections - 1, grain.columns + 1);
        self.cap(width, grain, outline.caps[0], 0, true);
        for row in 0..=grain.rows * segments {
            let segment = (row / grain.rows).min(segments - 1);
            let t = (row - segment * grain.rows) as f32 / grain.rows as f32;
            let (value, slope) = (weights(t), slopes(t));
            for column in 0..width {
                let control = |k: usize| self.rings[(segment + k) * width + column];
                let points = [control(0), control(1), control(2), control(3)];
                let at = blend(value, points.map(|(at, _)| at));
                let along = blend(slope, points.map(|(at, _)| at));
                let around = blend(value, points.map(|(_, around)| around));
                self.vertex(at, along.cross(around), around);
            }
        }
        self.cap(width, grain, outline.caps[1], segments, false);
    }

    /// The control rings: the shaped sections, each blended around, with one more at either end.
    fn ring(&mut self, masses: &[Vec3], sections: usize, outline: &Outline, grain: Grain) {
        self.rings.clear();
        let corners = |section: usize| {
            let girth = outline.at(section, sections);
            shaped(core::array::from_fn(|corner| masses[4 * section + corner]), girth)
        };
        let beyond = |end: Corners, before: Corners| -> Corners { core::array::from_fn(|i| 2.0 * end[i] - before[i]) };
        for row in 0..sections + 2 {
            let corners = match row {
                0 => beyond(corners(0), corners(1)),
                row if row == sections + 1 => beyond(corners(sections - 1), corners(sections - 2)),
                row => corners(row - 1),
            };
            for column in 0..=grain.columns {
                // The seam is in the middle of the belly, half way from left bottom to right bottom.
                let around = 0.5 + 4.0 * (column % grain.columns) as f32 / grain.columns as f32;
                let (side, t) = (around as usize, around.fract());
                let points = [3, 4, 5, 6].map(|k| corners[(side + k) % 4]);
                self.rings.push((blend(weights(t), points), blend(slopes(t), points)));
            }
        }
    }

    /// A round end over the first or the last row of the surface.
    fn cap(&mut self, width: usize, grain: Grain, reach: f32, segment: usize, tail: bool) {
        let value = weights(if tail { 0.0 } else { 1.0 });
        let first = if tail { 0 } else { segment - 1 };
        let control = |column: usize| {
            let points: [(Vec3, Vec3); 4] = core::array::from_fn(|k| self.rings[(first + k) * width + column]);
            (blend(value, points.map(|(at, _)| at)), blend(value, points.map(|(_, around)| around)))
        };
        let ring: Vec<_> = (0..width).map(control).collect();
        let middle = ring[..width - 1].iter().map(|(at, _)| *at).sum::<Vec3>() / (width - 1) as f32;
        let radius = ring[..width - 1].iter().map(|(at, _)| at.distance(middle)).sum::<f32>() / (width - 1) as f32;
        let flat = ring[..width - 1].iter().map(|(at, around)| around.cross(*at - middle)).sum::<Vec3>();
        // The ring runs counterclockwise as seen from behind.
        let outwards = if tail { -flat } else { flat }.normalize_or(Vec3::X);
        for row in 0..grain.cap {
            let step = if tail { grain.cap - row } else { row + 1 };
            let (sin, cos) = (FRAC_PI_2 * step as f32 / grain.cap as f32).sin_cos();
            for &(at, around) in &ring {
                let out = at - middle;
                let normal = out.normalize_or(outwards) * (cos * reach) + outwards * sin;
                self.vertex(middle + out * cos + outwards * (sin * reach * radius), normal, around);
            }
        }
    }

    fn vertex(&mut self, at: Vec3, normal: Vec3, around: Vec3) {
        self.positions.push(at.to_array());
        self.normals.push(normal.normalize_or(Vec3::Y).to_array());
        // The bump map's other axis is forward, which is to the left of around.
        self.tangents.push(around.normalize_or(Vec3::Z).extend(-1.0).to_array());
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::PI;

    use super::*;

    const GRAIN: Grain = Grain { rows: 4, columns: 16, cap: 4 };

    /// The masses of a straight strand along x that stands on y = 0, its sections so many times as wide and high.
    fn straight(segments: usize, scale: f32) -> Vec<Vec3> {
        let corners = [(0.0, -0.5), (0.0, 0.5), (1.0, 0.5), (1.0, -0.5)];
        let section = |p: usize| corners.map(|(y, z)| Vec3::new(p as f32, y * scale, z * scale));
        (0..=segments).flat_map(section).collect()
    }

    fn cut(masses: &[Vec3]) -> Surface {
        let mut surface = Surface::default();
        surface.cut(masses, &Outline::WORM, GRAIN);
        surface
    }

    #[test]
    fn there_is_a_vertex_for_every_place() {
        let surface = cut(&straight(10, 1.0));
        let count = GRAIN.all_rows(10) * (GRAIN.columns + 1);
        assert_eq!([surface.positions.len(), surface.normals.len(), surface.tangents.len()], [count; 3]);
    }

    #[test]
    fn the_belly_touches_the_ground_and_the_skin_bulges_with_its_lattice() {
        let lowest = |surface: &Surface| surface.positions.iter().map(|at| at[1]).fold(f32::INFINITY, f32::min);
        let width = |surface: &Surface| surface.positions.iter().map(|at| at[2]).fold(0.0, f32::max);
        let (thin, thick) = (cut(&straight(10, 1.0)), cut(&straight(10, 1.3)));
        for surface in [&thin, &thick] {
            assert!(lowest(surface).abs() < 0.01, "{}", lowest(surface));
        }
        assert!((width(&thick) / width(&thin) - 1.3).abs() < 1e-4);
    }

    #[test]
    fn normals_point_out_of_a_bent_body_and_are_square_to_its_tangents() {
        let bend = |at: Vec3| {
            let turn = Quat::from_rotation_y(at.x * PI / 20.0);
            turn * Vec3::new(0.0, at.y, at.z + 6.0)
        };
        let masses: Vec<_> = straight(10, 1.0).into_iter().map(bend).collect();
        let surface = cut(&masses);
        for row in GRAIN.cap..GRAIN.all_rows(10) - GRAIN.cap {
            let width = GRAIN.columns + 1;
            let ring = &surface.positions[row * width..row * width + GRAIN.columns];
            let middle = ring.iter().map(|&at| Vec3::from(at)).sum::<Vec3>() / GRAIN.columns as f32;
            for i in row * width..(row + 1) * width {
                let (at, normal) = (Vec3::from(surface.positions[i]), Vec3::from(surface.normals[i]));
                assert!((normal.length() - 1.0).abs() < 1e-4);
                assert!(normal.dot((at - middle).normalize()) > 0.6, "row {row}: {normal} at {at}");
                let tangent = Vec4::from(surface.tangents[i]).truncate();
                assert!(normal.dot(tangent).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn a_closed_skin_has_the_volume_of_its_triangles_turned_outwards() {
        // By the divergence theorem: triangles that face inwards would make it negative. A round body of radius .5 and length 10 has 7.9.
        let surface = cut(&straight(10, 1.0));
        let at = |i: u32| Vec3::from(surface.positions[i as usize]);
        let volume: f32 = triangles(10, GRAIN).chunks(3).map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum();
        assert!((6.5..8.5).contains(&volume), "{volume}");
    }
}
