//! The panel: sliders, the gauge of the step, plots, and files. [`PanelPlugin`] puts it on the left of the window.
//!
//! Each section is one pure function on [`Settings`], plain data, so that it is tested without an app: [`bodies`], [`time`], [`gauge`],
//! [`plots`] and [`files`]. The bridge fills the settings from the world before the panel is drawn and does
//! afterwards what the user asked for.

pub mod blocks;
pub mod bodies;
pub mod bridge;
pub mod chart;
mod colors;
pub mod files;
pub mod gait;
mod gait_plots;
pub mod gauge;
mod keys;
mod labels;
mod names;
mod plot;
pub mod plots;
pub mod race;
mod ring;
mod row;
mod sampling;
mod setting;
mod settings;
pub mod time;
pub mod traces;

use bevy::{
    app::{App, FixedPostUpdate, Plugin, PostUpdate, PreUpdate, Update},
    camera::{Camera, RenderTarget},
    ecs::prelude::*,
    prelude::Result,
};
use bevy_egui::{
    EguiContext, EguiContexts, EguiGlobalSettings, EguiPlugin, EguiPostUpdateSet, EguiPreUpdateSet,
    EguiPrimaryContextPass, PrimaryEguiContext, egui, input::EguiWantsInput,
};

pub use names::{Name, Path};
pub use ring::Ring;
pub use setting::{Setting, number_text};
pub use settings::{Action, BodyInfo, CostInfo, Files, Note, Settings};
pub use traces::Traces;

use crate::{
    physics::{BodyFrozen, BodyInverted, Restart, WavesCut},
    scenes::{BodyRescued, SceneChange, SceneProblem},
    view::{CoveredLeft, LeaveToPanel, PointerOnPanel},
};

/// How wide the panel is, in points.
pub const WIDTH: f32 = 300.0;

/// Draws the panel in the window of the camera that is drawn last, and connects it with the world.
///
/// Adds bevy_egui's plugin where it is missing. Keys: Space pauses, `.` takes one tick, R restarts, F1 puts the panel away; they are
/// left alone while a field has the focus.
#[derive(Clone, Copy, Debug, Default)]
pub struct PanelPlugin;

impl Plugin for PanelPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins(EguiPlugin::default());
        }
        // Its own choice is the first camera that is spawned, which may draw into an image.
        app.world_mut().resource_mut::<EguiGlobalSettings>().auto_create_primary_context = false;
        app.add_message::<BodyFrozen>()
            .add_message::<BodyInverted>()
            .add_message::<BodyRescued>()
            .add_message::<WavesCut>()
            .add_message::<Restart>()
            .add_message::<SceneChange>()
            .add_message::<SceneProblem>()
            .init_resource::<Settings>()
            .init_resource::<Traces>()
            .init_resource::<bridge::Known>()
            .init_resource::<sampling::Meter>()
            .init_resource::<chart::Measuring>()
            .init_resource::<PointerOnPanel>()
            .init_resource::<CoveredLeft>()
            .add_systems(PreUpdate, choose_camera.before(EguiPreUpdateSet::InitContexts))
            .add_systems(FixedPostUpdate, sampling::tick)
            .add_systems(Update, keys::keys)
            .add_systems(
                PostUpdate,
                (sampling::frame, bridge::listen, chart::listen, bridge::read)
                    .chain()
                    .before(EguiPostUpdateSet::EndPass),
            )
            .add_systems(PostUpdate, (bridge::apply, say_width).after(EguiPostUpdateSet::ProcessOutput))
            .add_systems(PostUpdate, say_pointer.after(EguiPostUpdateSet::ProcessOutput).before(LeaveToPanel))
            .add_systems(EguiPrimaryContextPass, draw);
    }
}

/// Gives the panel to the camera that is drawn last into a window, and to another one once that is gone.
fn choose_camera(
    mut commands: Commands,
    contexts: Query<(), With<PrimaryEguiContext>>,
    cameras: Query<(Entity, &Camera, &RenderTarget)>,
) {
    if !contexts.is_empty() {
        return;
    }
    let in_window = cameras.iter().filter(|(_, _, target)| matches!(target, RenderTarget::Window(_)));
    if let Some((camera, ..)) = in_window.max_by_key(|(_, camera, _)| camera.order) {
        commands.entity(camera).insert((EguiContext::default(), PrimaryEguiContext));
    }
}

fn draw(mut contexts: EguiContexts, mut settings: ResMut<Settings>, traces: Res<Traces>) -> Result {
    // For a frame without a camera there is nothing to draw on.
    if let Ok(context) = contexts.ctx_mut() {
        show(context, &mut settings, &traces);
    }
    Ok(())
}

/// A click on the panel is not one on the scene.
fn say_pointer(egui: Res<EguiWantsInput>, mut on_panel: ResMut<PointerOnPanel>) {
    on_panel.set_if_neq(PointerOnPanel(egui.wants_any_pointer_input()));
}

/// The scene's middle is beside the panel.
fn say_width(settings: Res<Settings>, mut covered: ResMut<CoveredLeft>) {
    covered.set_if_neq(CoveredLeft(if settings.hidden { 0.0 } else { WIDTH }));
}

/// The whole panel.
///
/// It is an area and no side panel of egui's: only areas count as under the pointer while they have no background of egui's around
/// them, and without that a click between two sliders would move the camera.
pub fn show(context: &egui::Context, settings: &mut Settings, traces: &Traces) {
    race::labels(context, settings);
    blocks::labels(context, &settings.blocks);
    let area = egui::Area::new(egui::Id::new("panel")).fixed_pos(egui::Pos2::ZERO).movable(false).constrain(false);
    if settings.hidden {
        area.show(context, |ui| {
            colors::style(ui);
            if ui.button("☰").on_hover_text("Show the panel (F1)").clicked() {
                settings.hidden = false;
            }
        });
        return;
    }
    let height = context.viewport_rect().height();
    area.show(context, |ui| {
        colors::style(ui);
        colors::frame().show(ui, |ui| {
            // Margins belong to the frame.
            ui.set_width(WIDTH - 14.0);
            ui.set_height(height - 16.0);
            sections(ui, settings, traces);
        });
    });
}

fn sections(ui: &mut egui::Ui, settings: &mut Settings, traces: &Traces) {
    ui.horizontal(|ui| {
        ui.heading(if settings.files.title.is_empty() { "Wriggle" } else { &settings.files.title });
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(6.0);
            if ui.add(egui::Button::new("✖").frame(false)).on_hover_text("Hide the panel (F1)").clicked() {
                settings.hidden = true;
            }
        });
    });
    time::buttons(ui, settings);
    ui.add_space(2.0);
    ui.scope(|ui| {
        ui.set_max_width(WIDTH - 26.0);
        gauge::section(ui, settings);
        files::frozen(ui, settings);
        files::messages(ui, settings);
    });
    ui.separator();
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        // The bar of the area floats; nothing is to lie below it.
        ui.set_max_width(WIDTH - 26.0);
        let body = settings.body().map_or_else(|| "Body".into(), |body| format!("Body: {}", body.name));
        section(ui, "body", &body, true, |ui| bodies::section(ui, settings));
        section(ui, "time", "Time and method", true, |ui| time::section(ui, settings));
        if !settings.race.is_empty() {
            section(ui, "race", "Race", true, |ui| race::section(ui, settings));
        }
        section(ui, "plots", "Plots", true, |ui| plots::section(ui, settings, traces));
        section(ui, "chart", "Speed against accuracy", false, |ui| chart::section(ui, settings));
        section(ui, "files", "Scenes and files", true, |ui| files::section(ui, settings));
    });
}

fn section(ui: &mut egui::Ui, id: &str, title: &str, open: bool, add: impl FnOnce(&mut egui::Ui)) {
    let title = egui::RichText::new(title).strong().size(14.0);
    egui::CollapsingHeader::new(title).id_salt(id).default_open(open).show_unindented(ui, add);
    ui.add_space(4.0);
}
