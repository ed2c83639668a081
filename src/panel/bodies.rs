//! The sliders of a body: each parameter for all of its elements at once, and unfolded for each of them.

use bevy_egui::egui;

use super::{
    names::{Path, element},
    row::{self, Edit, State},
    settings::Settings,
};

/// The parameters that one plays with, in order; the others are folded away below them.
const FIRST: [&str; 15] = [
    "tilt",
    "edges.stiffness",
    "faces.stiffness",
    "cubes.stiffness",
    "friction",
    "stiffness",
    "damping",
    "mass",
    "rest_length",
    "amplitude",
    "period",
    "phase",
    "drag",
    "grip",
    "ratchet",
];

/// At most this many single elements of a parameter are shown: beyond it a file is the better place.
const MOST_ELEMENTS: usize = 48;

/// A parameter of the body: for all elements at once, one by one, or both.
struct Group {
    all: Option<usize>,
    elements: Vec<usize>,
    rank: usize,
}

/// The parameters of the selected body.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings) {
    selection(ui, settings);
    let Some(body) = settings.body() else {
        ui.weak("This scene has no body.");
        return;
    };
    let groups = groups(settings, &body.name);
    let (first, more) = groups.split_at(groups.partition_point(|group| group.rank < FIRST.len()));
    first.iter().for_each(|group| show(ui, settings, group));
    if !more.is_empty() {
        ui.collapsing("more", |ui| more.iter().for_each(|group| show(ui, settings, group)));
    }
}

/// Chooses one of several bodies.
fn selection(ui: &mut egui::Ui, settings: &mut Settings) {
    if settings.bodies.len() < 2 {
        return;
    }
    let name = settings.body().map_or("", |body| &body.name).to_string();
    egui::ComboBox::from_label("body").selected_text(name).show_ui(ui, |ui| {
        for (index, body) in settings.bodies.iter().enumerate() {
            ui.selectable_value(&mut settings.selected, index, &body.name);
        }
    });
    if !settings.race.is_empty() {
        return;
    }
    ui.checkbox(&mut settings.together, "set all bodies at once")
        .on_hover_text("Every body that has it gets what is set here");
}

/// The parameters of `body` by their fields, as indices into the settings.
fn groups(settings: &Settings, body: &str) -> Vec<Group> {
    let mut found: Vec<(&str, &str, Group)> = Vec::new();
    for (index, setting) in settings.parameters.iter().enumerate() {
        let path = Path::parse(&setting.path);
        if path.owner != body {
            continue;
        }
        let at = found
            .iter()
            .position(|(group, field, _)| (*group, *field) == (path.group, path.field))
            .unwrap_or_else(|| {
                let rank = FIRST.iter().position(|field| *field == path.field).unwrap_or(FIRST.len());
                found.push((path.group, path.field, Group { all: None, elements: Vec::new(), rank }));
                found.len() - 1
            });
        match path.index {
            Some(_) => found[at].2.elements.push(index),
            None => found[at].2.all = Some(index),
        }
    }
    found.sort_by_key(|(_, _, group)| group.rank);
    found.into_iter().map(|(_, _, group)| group).collect()
}

fn show(ui: &mut egui::Ui, settings: &mut Settings, group: &Group) {
    // One phase for all muscles would make a standing wave: phases are set one by one.
    let phase = group.all.is_some_and(|all| Path::parse(&settings.parameters[all].path).field == "phase");
    let Some(all) = group.all.filter(|_| !phase || group.elements.is_empty()) else {
        for &index in &group.elements {
            let parameter = &mut settings.parameters[index];
            let edit = row::wide(ui, parameter, State::of(parameter), |_, _| {});
            change(settings, index, edit);
        }
        return;
    };
    let several = group.elements.len() > 1;
    let state = state(settings, all, group);
    let edit = row::wide(ui, &mut settings.parameters[all], state, |ui, setting| {
        if several {
            unfold(ui, setting);
        }
    });
    let default = settings.parameters[all].default;
    let alike = group.elements.iter().all(|&index| settings.parameters[index].default == default);
    if edit == Some(Edit::Reset) && !alike {
        // Each gets its own value back.
        group.elements.iter().for_each(|&index| change(settings, index, edit));
    } else {
        change(settings, all, edit);
        if edit.is_some() {
            let value = settings.parameters[all].value;
            group.elements.iter().for_each(|&index| settings.parameters[index].value = value);
        }
    }
    if several && settings.parameters[all].unfolded {
        elements(ui, settings, group);
    }
}

/// The rows of the single elements.
fn elements(ui: &mut egui::Ui, settings: &mut Settings, group: &Group) {
    for &index in group.elements.iter().take(MOST_ELEMENTS) {
        let path = Path::parse(&settings.parameters[index].path);
        let label = format!("{} {}", element(path.group), path.index.unwrap_or_default());
        let edit = row::narrow(ui, &mut settings.parameters[index], &label);
        change(settings, index, edit);
    }
    if let Some(more) = group.elements.len().checked_sub(MOST_ELEMENTS).filter(|&more| more > 0) {
        ui.weak(format!("and {more} more; set them in a file or with --set"));
    }
}

/// A small button that shows or hides the single elements.
fn unfold(ui: &mut egui::Ui, setting: &mut super::setting::Setting) {
    let text = if setting.unfolded { "⏷" } else { "⏵" };
    let response = ui.add(egui::Button::new(text).frame(false).small());
    let label = format!("each {}", setting.label);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
    if response.on_hover_text("One by one").clicked() {
        setting.unfolded = !setting.unfolded;
    }
}

/// The state of a row that stands for all elements of a group.
fn state(settings: &Settings, all: usize, group: &Group) -> State {
    let parameters = &settings.parameters;
    let changed = |index: usize| parameters[index].value != parameters[index].default;
    let elements = &group.elements;
    State {
        mixed: elements.windows(2).any(|pair| parameters[pair[0]].value != parameters[pair[1]].value),
        changed: changed(all) || elements.iter().any(|&index| changed(index)),
    }
}

fn change(settings: &mut Settings, index: usize, edit: Option<Edit>) {
    if let Some(edit) = edit {
        let path = settings.parameters[index].path.clone();
        settings.edit(&path, edit);
    }
}
