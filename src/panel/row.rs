//! The rows in which parameters are shown: a name, a field to type in, a reset and a slider.

use bevy_egui::egui::{
    self, Align, Layout, RichText, WidgetInfo, WidgetType, text::CCursor, text_selection::CCursorRange, vec2,
};

use super::{
    colors,
    setting::{Setting, number_text},
};
use crate::scenes::parameters::Kind;

/// Width of the field of a number.
const FIELD: f32 = 64.0;
/// Width of a reset button.
const RESET: f32 = 20.0;

/// What the user did to a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edit {
    /// Chose a value, by the slider or by typing.
    Value(f64),
    /// Asked for the default.
    Reset,
}

/// What a row cannot know by its parameter alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// It stands for elements whose values differ.
    pub mixed: bool,
    /// It, or an element that it stands for, is not at its default.
    pub changed: bool,
}

impl State {
    /// The state of a row that stands for its parameter alone.
    pub fn of(setting: &Setting) -> Self {
        Self { mixed: false, changed: setting.value != setting.default }
    }
}

/// A parameter on two lines: name, unit and field, and below them its slider. `extra` is drawn beside the name.
pub fn wide(
    ui: &mut egui::Ui,
    setting: &mut Setting,
    state: State,
    extra: impl FnOnce(&mut egui::Ui, &mut Setting),
) -> Option<Edit> {
    let mut edit = None;
    ui.horizontal(|ui| {
        name(ui, setting);
        extra(ui, setting);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            edit = reset(ui, setting, state.changed).or(edit);
            edit = control(ui, setting, state.mixed).or(edit);
        });
    });
    if setting.kind == Kind::Number {
        ui.scope(|ui| {
            // The rail belongs to the name above it.
            ui.spacing_mut().interact_size.y = 13.0;
            edit = slider(ui, setting, ui.available_width()).or(edit);
        });
    }
    refusal(ui, setting);
    edit
}

/// A parameter on one line, for the single elements of a group. `label` stands before it.
pub fn narrow(ui: &mut egui::Ui, setting: &mut Setting, label: &str) -> Option<Edit> {
    let mut edit = None;
    ui.horizontal(|ui| {
        ui.add_space(8.0);
        let label = egui::Label::new(RichText::new(label).weak()).halign(Align::LEFT).selectable(false);
        ui.add_sized(vec2(62.0, 18.0), label).on_hover_text(&setting.path);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            edit = reset(ui, setting, setting.value != setting.default).or(edit);
            edit = control(ui, setting, false).or(edit);
            let width = ui.available_width();
            edit = slider(ui, setting, width).or(edit);
        });
    });
    refusal(ui, setting);
    edit
}

/// The reason why the last value was not taken.
pub fn refusal(ui: &mut egui::Ui, setting: &Setting) {
    if let Some(refusal) = &setting.refusal {
        ui.label(RichText::new(refusal).small().color(colors::RED));
    }
}

/// A field to type in, named `label` for those who cannot see it. Answers with the text when it is entered, by Enter or by leaving the field.
pub fn field(ui: &mut egui::Ui, draft: &mut Option<String>, shown: String, label: &str, width: f32) -> Option<String> {
    let mut text = draft.clone().unwrap_or(shown);
    let output = egui::TextEdit::singleline(&mut text)
        .id_salt(label)
        .desired_width(width)
        .horizontal_align(Align::RIGHT)
        .clip_text(true)
        .show(ui);
    let response = &output.response.response;
    let announced = text.clone();
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::TextEdit, true, label);
        info.current_text_value = Some(announced.clone());
        info
    });
    if response.gained_focus() {
        // What is typed next replaces the old value.
        let mut state = output.state.clone();
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), response.id);
    }
    if response.changed() {
        *draft = Some(text);
    }
    if !response.lost_focus() {
        return None;
    }
    let entered = draft.take();
    if ui.input(|input| input.key_pressed(egui::Key::Escape)) { None } else { entered }
}

fn name(ui: &mut egui::Ui, setting: &Setting) {
    let help =
        if setting.help.is_empty() { setting.path.clone() } else { format!("{}\n{}", setting.help, setting.path) };
    ui.label(setting.label.as_str()).on_hover_text(help);
    if !setting.unit.is_empty() && setting.kind == Kind::Number {
        ui.label(RichText::new(&setting.unit).small().weak());
    }
}

fn control(ui: &mut egui::Ui, setting: &mut Setting, mixed: bool) -> Option<Edit> {
    if setting.kind == Kind::Toggle {
        let mut on = setting.value != 0.0;
        let response = ui.checkbox(&mut on, "");
        let label = setting.label.clone();
        response.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, on, &label));
        return response.changed().then_some(Edit::Value(f64::from(u8::from(on))));
    }
    let shown = if mixed { "mixed".into() } else { setting.text() };
    let label = setting.label.clone();
    // Two groups of a body may have parameters of one name.
    let entered = ui.push_id(&setting.path, |ui| field(ui, &mut setting.draft, shown, &label, FIELD)).inner?;
    if !mixed && entered == setting.text() {
        return None;
    }
    match setting.parse(&entered) {
        Ok(value) => {
            setting.refusal = None;
            (mixed || value != setting.value).then_some(Edit::Value(value))
        }
        Err(reason) => {
            setting.refusal = Some(reason);
            None
        }
    }
}

fn slider(ui: &mut egui::Ui, setting: &Setting, width: f32) -> Option<Edit> {
    ui.spacing_mut().slider_width = width;
    let mut value = setting.value;
    let slider = egui::Slider::new(&mut value, setting.range.clone())
        .show_value(false)
        .logarithmic(setting.logarithmic)
        .clamping(egui::SliderClamping::Never);
    let response = ui.add(slider);
    response.widget_info(|| WidgetInfo::slider(true, setting.value, &setting.label));
    // A slider's own digits say more than its width in pixels can mean.
    let value = number_text(value).parse().unwrap_or(value);
    (response.changed() && value != setting.value).then_some(Edit::Value(value))
}

fn reset(ui: &mut egui::Ui, setting: &mut Setting, changed: bool) -> Option<Edit> {
    let button = egui::Button::new("↺").min_size(vec2(RESET, 0.0)).frame(false);
    let response = ui.add_enabled(changed || setting.refusal.is_some(), button);
    let label = format!("reset {}", setting.label);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, changed, &label));
    let response = response.on_hover_text(format!("Back to {}", number_text(setting.default)));
    if !response.clicked() {
        return None;
    }
    setting.refusal = None;
    changed.then_some(Edit::Reset)
}
