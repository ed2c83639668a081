//! Labels in the scene: white on dark, framed in the colour of what they belong to.

use bevy::{
    ecs::prelude::*,
    prelude::{Camera, GlobalTransform, Vec3},
};
use bevy_egui::egui::{Align2, Color32, FontId, Painter, Pos2, Stroke, StrokeKind, vec2};

use crate::view::SceneCamera;

/// What the camera sees.
pub struct Sight(Option<(Camera, GlobalTransform)>);

impl Sight {
    /// That of the scene's camera.
    pub fn of(world: &mut World) -> Self {
        let mut cameras = world.query_filtered::<(&Camera, &GlobalTransform), With<SceneCamera>>();
        Self(cameras.iter(world).next().map(|(camera, transform)| (camera.clone(), *transform)))
    }

    /// Where a place of the scene is on the screen, in points, if it is in sight.
    pub fn place(&self, at: Vec3) -> Option<(f32, f32)> {
        let (camera, transform) = self.0.as_ref()?;
        camera.world_to_viewport(transform, at).ok().map(|place| (place.x, place.y))
    }
}

/// Writes `text` with `anchor` of it at a point of the screen.
pub fn write(painter: &Painter, at: Pos2, anchor: Align2, text: String, color: Color32) {
    let text = painter.layout_no_wrap(text, FontId::proportional(13.0), Color32::WHITE);
    let field = anchor.anchor_size(at, text.size()).expand2(vec2(7.0, 3.0));
    painter.rect(field, 4.0, Color32::from_black_alpha(170), Stroke::new(1.5, color), StrokeKind::Outside);
    painter.galley(field.min + vec2(7.0, 3.0), text, Color32::WHITE);
}
