//! The view: skins, the garden, light, camera and pictures. It reads bodies and writes none.
//!
//! [`ViewPlugin`] is added beside Bevy's `DefaultPlugins` and [`PhysicsPlugin`](crate::physics::PhysicsPlugin). It draws every body
//! that has a [`Look`](crate::creatures::Look), where [`Shown`](crate::physics::Shown) says, and rebuilds the surroundings when
//! [`CurrentScene`] changes. [`Shot`] draws pictures without a window.

mod adapter;
mod blade;
mod camera;
mod clay;
mod drag;
mod garden;
mod ghost;
mod half;
mod help;
mod jelly;
mod light;
mod maps;
mod meadow;
mod offscreen;
mod paint;
mod peel;
mod plain;
mod quality;
mod six;
mod skins;
mod steering;
mod strand;
mod studio;
mod travel;
mod window;
mod worm;
mod worm_parts;

use bevy::{math::DVec3, prelude::*, render::renderer::RenderAdapterInfo, winit::WinitPlugin};

pub use adapter::{AdapterSummary, NoAdapter, NoDisplay, adapter, display};
pub use camera::{CoveredLeft, FollowWorm, LeaveToPanel, PointerOnPanel, SceneCamera};
pub use help::KeyHelp;
pub use jelly::skin_color;
pub use offscreen::{Picture, Shot, ShotError};
pub use peel::Peeled;
pub use quality::Quality;
pub use steering::Selected;
pub use window::window_plugins;

use crate::{
    mechanics::six_matrix::Road,
    scenes::{self, CurrentScene, Props},
};

/// Draws bodies and their surroundings. Add it after `DefaultPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewPlugin {
    /// How much the picture may cost; `None`, the default, picks by the graphics adapter.
    pub quality: Option<Quality>,
}

impl Plugin for ViewPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            paint::plugin,
            half::plugin,
            camera::plugin,
            skins::plugin,
            six::plugin,
            ghost::plugin,
            peel::plugin,
            travel::plugin,
        ))
        .insert_resource(ClearColor(Color::srgb(0.72, 0.87, 0.95)))
        .add_systems(Update, decorate.before(six::Lay).run_if(resource_exists_and_changed::<CurrentScene>));
        if app.is_plugin_added::<WinitPlugin>() {
            app.add_plugins((help::plugin, drag::plugin, steering::plugin, six::words::plugin));
        }
    }

    /// The adapter is known only now.
    fn finish(&self, app: &mut App) {
        let (quality, why) = match self.quality {
            Some(quality) => (quality, "as asked".to_owned()),
            None => Quality::pick(app.world().get_resource::<RenderAdapterInfo>()),
        };
        info!("quality {quality:?}: {why}");
        app.insert_resource(quality);
    }
}

/// Everything that stands around in a scene.
#[derive(Clone, Component, Copy, Debug, Default)]
struct Decor;

/// Clears away the surroundings of the last scene and sets up those of this one.
fn decorate(
    scene: Res<CurrentScene>,
    old: Query<Entity, With<Decor>>,
    roads: Query<&Road>,
    mut commands: Commands,
    mut cloth: skins::Cloth,
) {
    let skins::Cloth { quality, meshes, paints, images } = &mut cloth;
    for entity in &old {
        commands.entity(entity).try_despawn();
    }
    light::shine(**quality, &mut commands);
    match scene.file.props {
        Props::Garden { seed } => garden::plant(seed, **quality, &mut commands, meshes, paints),
        Props::None => match &scene.file.ground {
            Some(ground) => {
                let scenes::Camera::Orbit { target: (x, y, z), distance, .. } = scene.file.camera;
                let place = meadow::Place { middle: DVec3::new(x, y, z).as_vec3(), distance: distance as f32 };
                meadow::set_up(ground, place, **quality, &mut commands, meshes, paints, images);
            }
            None => studio::set_up(six::lowest(roads.iter()), **quality, &mut commands, meshes, paints),
        },
    }
}
