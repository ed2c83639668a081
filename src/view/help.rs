//! The keys, written on the screen.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPlugin, EguiPrimaryContextPass,
    egui::{self, Align2, Color32, RichText},
    input::EguiWantsInput,
};

use super::{
    camera::FollowWorm,
    peel::{LEGEND, Peeled},
    steering::Selected,
};

/// Whether the keys are written on the screen; key `H`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, Resource)]
#[reflect(Resource)]
pub struct KeyHelp(pub bool);

impl Default for KeyHelp {
    fn default() -> Self {
        Self(true)
    }
}

/// Every key and what it does.
const KEYS: [(&str, &str); 15] = [
    ("Drag", "look around"),
    ("Drag a body", "pull at it"),
    ("Right drag", "move"),
    ("Wheel", "nearer, further"),
    ("C", "follow the animal"),
    ("X", "take off the skin"),
    (LEAD[0], "lead it there"),
    (LEAD[1], "to the left, to the right"),
    (LEAD[2], "stop, go on"),
    (LEAD[3], "the next animal"),
    ("Space", "pause"),
    (". (dot)", "one tick"),
    ("R", "start again"),
    ("F1", "the panel"),
    ("H", "hide this"),
];

/// Keys that do something only where there is an animal to lead.
const LEAD: [&str; 4] = ["Click", "Left, Right", "Down, Up", "Tab"];

pub(super) fn plugin(app: &mut App) {
    if !app.is_plugin_added::<EguiPlugin>() {
        app.add_plugins(EguiPlugin::default());
    }
    app.init_resource::<KeyHelp>()
        .add_systems(Update, toggle.run_if(not(typing)))
        .add_systems(EguiPrimaryContextPass, (write, write_legend));
}

/// Whether keys go into a panel's text field.
pub(super) fn typing(wants: Option<Res<EguiWantsInput>>) -> bool {
    wants.is_some_and(|wants| wants.wants_any_keyboard_input())
}

fn toggle(keys: Res<ButtonInput<KeyCode>>, mut help: ResMut<KeyHelp>) {
    if keys.just_pressed(KeyCode::KeyH) {
        help.0 = !help.0;
    }
}

/// What the colours of the view without skins mean.
fn write_legend(mut contexts: EguiContexts, peeled: Res<Peeled>) -> Result {
    if !peeled.0 {
        return Ok(());
    }
    let context = contexts.ctx_mut()?;
    let frame = egui::Frame::new().fill(Color32::from_black_alpha(190)).corner_radius(8).inner_margin(10);
    egui::Area::new("legend".into()).anchor(Align2::RIGHT_TOP, [-12.0, 12.0]).interactable(false).show(context, |ui| {
        frame.show(ui, |ui| {
            egui::Grid::new("legend").spacing([10.0, 3.0]).show(ui, |ui| {
                for (color, means) in LEGEND {
                    let [r, g, b, _] = color.to_u8_array();
                    ui.label(RichText::new("■").color(Color32::from_rgb(r, g, b)));
                    ui.label(RichText::new(means).color(Color32::WHITE));
                    ui.end_row();
                }
            });
        });
    });
    Ok(())
}

fn write(
    mut contexts: EguiContexts,
    help: Res<KeyHelp>,
    following: Res<FollowWorm>,
    selected: Res<Selected>,
) -> Result {
    if !help.0 {
        return Ok(());
    }
    let context = contexts.ctx_mut()?;
    let frame = egui::Frame::new().fill(Color32::from_black_alpha(190)).corner_radius(8).inner_margin(10);
    egui::Area::new("keys".into()).anchor(Align2::RIGHT_BOTTOM, [-12.0, -12.0]).interactable(false).show(
        context,
        |ui| {
            frame.show(ui, |ui| {
                egui::Grid::new("keys").spacing([12.0, 3.0]).show(ui, |ui| {
                    for (key, does) in KEYS {
                        if selected.0.is_none() && LEAD.contains(&key) {
                            continue;
                        }
                        let does = if key == "C" && following.0 { "stop following" } else { does };
                        ui.label(RichText::new(key).strong().color(Color32::from_rgb(255, 214, 140)));
                        ui.label(RichText::new(does).color(Color32::WHITE));
                        ui.end_row();
                    }
                });
            });
        },
    );
    Ok(())
}
