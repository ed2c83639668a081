//! The hairs of a caterpillar: thin spikes that stand on its skin.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

use super::surface::{Grain, Surface};
use crate::view::clay::tint;

/// Half the width of a hair where it grows.
const THICK: f32 = 0.022;
/// Corners of a hair: three on the skin and its tip.
const CORNERS: usize = 4;

/// Where hairs grow, and where they are.
#[derive(Clone, Debug, Default)]
pub(super) struct Bristles {
    /// The vertex of the skin, the length, and how far the hair leans forward.
    roots: Vec<(usize, f32, f32)>,
    /// Positions of the corners.
    pub positions: Vec<[f32; 3]>,
    /// Normals of the corners.
    pub normals: Vec<[f32; 3]>,
}

impl Bristles {
    /// Tufts on the back and the sides of every segment.
    pub fn over(segments: usize, grain: Grain) -> Self {
        let mut roots = Vec::new();
        for segment in 0..segments {
            let row = grain.cap + grain.rows * segment + grain.rows / 2;
            for tuft in 0..7 {
                // From one flank over the back to the other.
                let around = 0.2 + 0.1 * tuft as f32;
                let column = (around * grain.columns as f32).round() as usize;
                for (hair, lean) in [-0.35, 0.0, 0.35].into_iter().enumerate() {
                    let length = 0.34 + 0.1 * ((segment * 5 + tuft * 3 + hair * 7) % 4) as f32 / 3.0;
                    roots.push((row * (grain.columns + 1) + column, length, lean));
                }
            }
        }
        Self { roots, ..Self::default() }
    }

    /// The mesh, to be written in place.
    pub fn mesh(&self) -> Mesh {
        let count = CORNERS * self.roots.len();
        let sides = (0..self.roots.len() as u32).flat_map(|hair| {
            let first = CORNERS as u32 * hair;
            [0, 1, 3, 1, 2, 3, 2, 0, 3].map(|corner| first + corner)
        });
        let colors = (0..count).map(|i| tint(if i % CORNERS == 3 { 0xfff3c4 } else { 0x3a2a18 }));
        Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![[0.0; 3]; count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 1.0, 0.0]; count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors.collect::<Vec<_>>())
            .with_inserted_indices(Indices::U32(sides.collect()))
    }

    /// Lets them stand on the skin as it is now.
    pub fn grow(&mut self, skin: &Surface) {
        self.positions.clear();
        self.normals.clear();
        for &(vertex, length, lean) in &self.roots {
            let Some(at) = skin.positions.get(vertex).map(|&at| Vec3::from(at)) else { continue };
            let normal = Vec3::from(skin.normals[vertex]);
            let around = Vec4::from(skin.tangents[vertex]).truncate();
            let forward = around.cross(normal);
            let tip = at + (normal + forward * lean).normalize_or(normal) * length;
            let corners = [around, -0.5 * around + 0.87 * forward, -0.5 * around - 0.87 * forward];
            for out in corners {
                self.positions.push((at + out * THICK).to_array());
                self.normals.push(((out + normal).normalize_or(normal)).to_array());
            }
            self.positions.push(tip.to_array());
            self.normals.push(normal.to_array());
        }
    }
}
