//! Blocks side by side: which they are, and a label at each in the scene.

use bevy::{
    ecs::{prelude::*, world::EntityRef},
    prelude::{Name, Vec3},
};
use bevy_egui::egui::{self, Align2, Pos2};

use super::{
    colors::rgb,
    labels::{self, Sight},
};
use crate::{body::Lattice, physics::Shown, scenes::SceneBodies, view::skin_color};

/// How far a label is above its block (lengths).
const ABOVE: f32 = 0.9;

/// The name of one of several blocks, as it is written in the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockLabel {
    /// The name of the block.
    pub name: String,
    /// The colour of its skin, as 0xRRGGBB.
    pub color: u32,
    /// Where it is on the screen, in points, if it is in sight.
    pub place: Option<(f32, f32)>,
}

/// All blocks of a scene, in its order; none where there is only one. `get` finds a body by its entity.
pub(super) fn side_by_side<'a>(
    scene: Option<&SceneBodies>,
    get: impl Fn(Entity) -> Option<EntityRef<'a>>,
) -> Vec<(EntityRef<'a>, Lattice)> {
    let in_order = scene.into_iter().flat_map(|scene| &scene.0).filter_map(|body| get(*body));
    let blocks: Vec<_> = in_order.filter_map(|body| body.get::<Lattice>().copied().map(|grid| (body, grid))).collect();
    if blocks.len() > 1 { blocks } else { Vec::new() }
}

/// What a block is called.
pub(super) fn name(block: EntityRef<'_>) -> String {
    block.get::<Name>().map_or_else(|| "block".into(), ToString::to_string)
}

/// The labels of blocks side by side, each above the middle of its block.
pub(super) fn find(world: &World, sight: &Sight) -> Vec<BlockLabel> {
    let blocks = side_by_side(world.get_resource::<SceneBodies>(), |body| world.get_entity(body).ok());
    let label = |(block, lattice): (EntityRef<'_>, Lattice)| BlockLabel {
        name: name(block),
        color: skin_color(lattice),
        place: block.get::<Shown>().and_then(|shown| sight.place(above(shown.positions())?)),
    };
    blocks.into_iter().map(label).collect()
}

/// The place above the middle of a block, a little higher than its highest mass; none where there are no masses.
fn above(positions: &[Vec3]) -> Option<Vec3> {
    let top = positions.iter().map(|at| at.y).reduce(f32::max)?;
    let middle = positions.iter().sum::<Vec3>() / positions.len() as f32;
    Some(middle.with_y(top + ABOVE))
}

/// Writes the names of blocks side by side above them.
pub fn labels(context: &egui::Context, blocks: &[BlockLabel]) {
    let painter = context.layer_painter(egui::LayerId::background());
    for BlockLabel { name, color, place } in blocks {
        if let Some((x, y)) = *place {
            labels::write(&painter, Pos2::new(x, y), Align2::CENTER_BOTTOM, name.clone(), rgb(*color));
        }
    }
}
