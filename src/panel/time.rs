//! Time: pause, one tick, restart, slow motion, the step and the method.

use bevy_egui::egui::{self, RichText};

use super::{
    row::{self, State},
    setting::number_text,
    settings::{Action, Settings},
};
use crate::mechanics::integrators::Method;

/// The path of the step.
pub const DT: &str = "clock.dt";
/// The path of the time scale.
pub const TIME_SCALE: &str = "clock.time_scale";
/// Slow motion is slower by this factor.
const SLOWER: f64 = 10.0;

/// The buttons that one reaches for while watching; they stay in sight.
pub fn buttons(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        let text = if settings.paused { "▶ resume" } else { "⏸ pause" };
        if ui.button(text).on_hover_text("Space").clicked() {
            settings.pause(!settings.paused);
        }
        if ui.button("⏭ tick").on_hover_text("One tick, then stand still ( . )").clicked() {
            settings.tick();
        }
        if ui.button("⏮ restart").on_hover_text("Every body back to its start; parameters stay (R)").clicked() {
            settings.actions.push(Action::Restart);
        }
        let slow = settings.normal_time_scale.is_some();
        if ui.selectable_label(slow, "slow").on_hover_text("Slow motion: a tenth of the time scale").clicked() {
            slow_motion(settings);
        }
    });
}

/// The clock's parameters and the method.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.label(
        RichText::new(format!("time {:.2} · step {}", settings.time, settings.step)).weak().monospace().size(11.5),
    );
    parameter(ui, settings, TIME_SCALE);
    parameter(ui, settings, DT);
    steps_per_tick(ui, settings);
    // In a race each lane has its own.
    if settings.without_method {
        ui.weak("The six-matrix particle system has one rule of motion.");
    } else if settings.race.is_empty() {
        method(ui, settings);
    }
}

/// Turns slow motion on, or back to the time scale before it.
pub fn slow_motion(settings: &mut Settings) {
    let Some(scale) = settings.get(TIME_SCALE).map(|setting| setting.value) else { return };
    let (scale, normal) = match settings.normal_time_scale.take() {
        // A time scale that was changed meanwhile is the one to speed up.
        Some(normal) => (if scale == normal / SLOWER { normal } else { scale * SLOWER }, None),
        None => (scale / SLOWER, Some(scale)),
    };
    settings.normal_time_scale = normal;
    settings.request(TIME_SCALE, scale);
}

fn parameter(ui: &mut egui::Ui, settings: &mut Settings, path: &str) {
    let Some(setting) = settings.get_mut(path) else { return };
    if let Some(edit) = row::wide(ui, setting, State::of(setting), |_, _| {}) {
        settings.edit(path, edit);
    }
}

/// The steps that fit a tick; whoever changes them changes dt.
fn steps_per_tick(ui: &mut egui::Ui, settings: &mut Settings) {
    let (Some(dt), Some(scale)) = (settings.get(DT), settings.get(TIME_SCALE)) else { return };
    let span = scale.value * settings.tick;
    if !(span > 0.0 && dt.value > 0.0) {
        return;
    }
    let shown = number_text(span / dt.value);
    let mut entered = None;
    ui.horizontal(|ui| {
        ui.label("steps a tick").on_hover_text(
            "How many steps the method takes between two pictures of the physics. A new number sets dt.",
        );
        ui.label(RichText::new(format!("of {} s", number_text(settings.tick))).small().weak());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(26.0);
            entered = row::field(ui, &mut settings.steps_draft, shown.clone(), "steps a tick", 80.0);
        });
    });
    if let Some(text) = entered.filter(|text| *text != shown) {
        match text.trim().parse::<u64>() {
            Ok(steps) if steps > 0 => {
                settings.steps_refusal = None;
                settings.request(DT, span / steps as f64);
            }
            _ => {
                let text = text.trim();
                settings.steps_refusal =
                    Some(format!("steps a tick: “{text}” is not allowed; give a whole number of 1 or more"));
            }
        }
    }
    if let Some(reason) = &settings.steps_refusal {
        ui.label(RichText::new(reason).small().color(super::colors::RED));
    }
}

fn method(ui: &mut egui::Ui, settings: &mut Settings) {
    let mut chosen = settings.method;
    egui::ComboBox::from_label("method").selected_text(name(chosen)).width(180.0).show_ui(ui, |ui| {
        for method in Method::ALL {
            ui.selectable_value(&mut chosen, method, name(method)).on_hover_text(method.name());
        }
    });
    if chosen != settings.method {
        settings.method = chosen;
        settings.actions.push(Action::Method(chosen));
    }
}

/// A method's name in words: `RungeKutta4` as `Runge Kutta 4`.
pub(super) fn name(method: Method) -> String {
    let mut words = String::new();
    for character in method.name().chars() {
        if !words.is_empty() && !character.is_lowercase() {
            words.push(' ');
        }
        words.push(character);
    }
    words
}
