//! The scene: which one is open, another one, and the user's own file.

use bevy_egui::egui::{self, Align, Layout, RichText, WidgetInfo, WidgetType};

use super::settings::{Action, Settings};

/// Switches, saves and loads scenes.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings) {
    switch(ui, settings);
    let save =
        path(ui, "save as", &mut settings.files.save_to, "Write the scene with its changed parameters to this file");
    if save {
        save_scene(settings);
    }
    let load = path(ui, "load", &mut settings.files.load_from, "Open this scene or file");
    if load {
        let name = settings.files.load_from.trim().to_string();
        if name.is_empty() {
            settings.tell(true, "load: give the name of a scene or file");
        } else {
            settings.actions.push(Action::Load(name));
        }
    }
}

/// The scenes that ship with the program.
fn switch(ui: &mut egui::Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        let mut chosen = None;
        egui::ComboBox::from_label("scene").selected_text(&settings.files.title).width(150.0).show_ui(ui, |ui| {
            for name in &settings.files.scenes {
                if ui.selectable_label(false, name).clicked() {
                    chosen = Some(name.clone());
                }
            }
        });
        if let Some(name) = chosen {
            settings.actions.push(Action::Load(name));
        }
        if ui
            .button("reload")
            .on_hover_text(format!("Read {} again; changed parameters go back", settings.files.source))
            .clicked()
        {
            settings.actions.push(Action::Reload);
        }
    });
}

/// A file's path with a button that does something with it.
fn path(ui: &mut egui::Ui, verb: &str, path: &mut String, help: &str) -> bool {
    let mut done = false;
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            done = ui.add_sized([60.0, 20.0], egui::Button::new(verb)).on_hover_text(help).clicked();
            let width = ui.available_width() - 6.0;
            let response = ui.add(egui::TextEdit::singleline(path).id_salt(verb).desired_width(width));
            let label = format!("file to {verb}");
            response.widget_info(|| WidgetInfo::labeled(WidgetType::TextEdit, true, &label));
            done |= response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        });
    });
    done
}

/// Asks for the scene to be saved, in a file that will be found again as a scene.
fn save_scene(settings: &mut Settings) {
    const ENDING: &str = ".scene.ron";
    let file = settings.files.save_to.trim();
    if file.is_empty() {
        settings.tell(true, format!("save: give the name of a file, such as {}", super::settings::Files::OWN));
        return;
    }
    let file =
        if file.ends_with(ENDING) { file.to_string() } else { format!("{}{ENDING}", file.trim_end_matches(".ron")) };
    settings.files.save_to.clone_from(&file);
    settings.files.load_from.clone_from(&file);
    settings.actions.push(Action::Save(file.into()));
}

/// What happened: problems and notes, each with a button to put it away.
pub fn messages(ui: &mut egui::Ui, settings: &mut Settings) {
    let mut gone = None;
    for (index, note) in settings.messages.iter().enumerate() {
        let color = if note.problem { super::colors::RED } else { super::colors::GREEN };
        egui::Frame::new().fill(super::colors::WELL).stroke((1.0, color)).inner_margin(5).corner_radius(4).show(
            ui,
            |ui| {
                ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
                    if ui.add(egui::Button::new("✖").frame(false)).on_hover_text("Put away").clicked() {
                        gone = Some(index);
                    }
                    ui.vertical(|ui| {
                        ui.add(egui::Label::new(RichText::new(&note.text).size(12.0).color(color)).wrap())
                    });
                });
            },
        );
    }
    if let Some(index) = gone {
        settings.messages.remove(index);
    }
}

/// Why bodies are frozen, and what helps.
pub fn frozen(ui: &mut egui::Ui, settings: &mut Settings) {
    let mut restart = false;
    for (body, reason) in settings.bodies.iter().filter_map(|body| Some((&body.name, body.frozen.as_ref()?))) {
        egui::Frame::new()
            .fill(super::colors::WELL)
            .stroke((1.0, super::colors::RED))
            .inner_margin(5)
            .corner_radius(4)
            .show(ui, |ui| {
                ui.set_width(ui.available_width());
                ui.label(RichText::new(format!("{body} is frozen")).strong().color(super::colors::RED));
                ui.label(RichText::new(reason).size(12.0));
                restart |= ui.button("restart").clicked();
            });
    }
    if restart {
        settings.actions.push(Action::Restart);
    }
}
