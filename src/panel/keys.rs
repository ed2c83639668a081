//! The panel's keys. They are left alone while a field has the focus.

use bevy::{input::ButtonInput, prelude::*};
use bevy_egui::input::EguiWantsInput;

use super::settings::{Action, Settings};

/// Space pauses, `.` takes one tick, R restarts, F1 puts the panel away and brings it back.
pub(super) fn keys(keys: Res<ButtonInput<KeyCode>>, egui: Option<Res<EguiWantsInput>>, mut settings: ResMut<Settings>) {
    if egui.is_some_and(|egui| egui.wants_any_keyboard_input()) {
        return;
    }
    for key in keys.get_just_pressed() {
        match key {
            KeyCode::Space => {
                let paused = !settings.paused;
                settings.pause(paused);
            }
            KeyCode::Period | KeyCode::NumpadDecimal => settings.tick(),
            KeyCode::KeyR => settings.actions.push(Action::Restart),
            KeyCode::F1 => settings.hidden = !settings.hidden,
            _ => {}
        }
    }
}
