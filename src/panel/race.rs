//! A race: each runner's method, error, cost and limit, and a label at each runner in the scene.

use bevy::ecs::entity::Entity;
use bevy_egui::egui::{self, Align2, Color32, Pos2, RichText, Stroke, vec2};

use super::{
    colors, labels,
    settings::{Action, Settings},
    time,
};
use crate::mechanics::integrators::Method;

/// One runner, as the panel shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct RunnerInfo {
    /// The body.
    pub entity: Entity,
    /// Whether it is the truth of the race.
    pub truth: bool,
    /// The colour of its lane.
    pub color: [u8; 3],
    /// Its method.
    pub method: Method,
    /// How far its worst particle is from the truth now, and was at most (lengths).
    pub error: f64,
    /// The largest error since the start (lengths).
    pub worst: f64,
    /// Evaluations of its forces for each unit of simulated time.
    pub cost: f64,
    /// The stability limit of its step; infinite for none.
    pub limit: f64,
    /// Whether it blew up and was frozen.
    pub frozen: bool,
    /// Where it is on the screen, in points, if it is in sight.
    pub place: Option<(f32, f32)>,
}

/// The table of the race. Shows nothing where there is none.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings) {
    let mut chosen = None;
    egui::Grid::new("race").num_columns(4).spacing(vec2(8.0, 4.0)).show(ui, |ui| {
        for heading in ["method", "error", "evals", "limit"] {
            ui.weak(heading);
        }
        ui.end_row();
        for runner in &settings.race {
            let mut method = runner.method;
            ui.horizontal(|ui| {
                let color = Color32::from_rgb(runner.color[0], runner.color[1], runner.color[2]);
                let mark = if runner.frozen { "✖" } else { "●" };
                ui.label(RichText::new(mark).color(color));
                if runner.truth {
                    ui.label("the truth");
                } else {
                    egui::ComboBox::from_id_salt(runner.entity).selected_text(short(method)).width(92.0).show_ui(
                        ui,
                        |ui| {
                            for each in Method::ALL {
                                ui.selectable_value(&mut method, each, time::name(each));
                            }
                        },
                    );
                }
            });
            if method != runner.method {
                chosen = Some((runner.entity, method));
            }
            ui.label(if runner.frozen { "left".into() } else { number(runner.worst) }).on_hover_text(format!(
                "largest error since the start: {} lengths; now {}",
                runner.worst, runner.error
            ));
            ui.label(number(runner.cost)).on_hover_text("force evaluations for each unit of simulated time");
            let over = settings.dt() > runner.limit;
            let limit = RichText::new(if runner.limit.is_infinite() { "none".into() } else { number(runner.limit) });
            ui.label(if over { limit.color(colors::RED) } else { limit })
                .on_hover_text("the largest stable step that is sure");
            ui.end_row();
        }
    });
    if let Some((body, method)) = chosen {
        settings.actions.push(Action::MethodOf(body, method));
    }
}

/// A label at each runner: its method and its error, and a cross where it blew up.
pub fn labels(context: &egui::Context, settings: &Settings) {
    let painter = context.layer_painter(egui::LayerId::background());
    for runner in &settings.race {
        let Some((x, y)) = runner.place else { continue };
        let at = Pos2::new(x, y);
        let text = match (runner.truth, runner.frozen) {
            (true, _) => "the truth".to_owned(),
            (false, true) => format!("{} blew up", short(runner.method)),
            (false, false) => format!("{}  {}", short(runner.method), number(runner.error)),
        };
        let [red, green, blue] = runner.color;
        labels::write(&painter, at, Align2::LEFT_CENTER, text, Color32::from_rgb(red, green, blue));
        if runner.frozen {
            let (cross, arm) = (at + vec2(-24.0, 0.0), 11.0);
            for slope in [1.0, -1.0] {
                let ends = [cross + vec2(-arm, -arm * slope), cross + vec2(arm, arm * slope)];
                painter.line_segment(ends, Stroke::new(4.0, colors::RED));
            }
        }
    }
}

/// A method's name, short enough for a label.
fn short(method: Method) -> &'static str {
    match method {
        Method::ExplicitEuler => "Explicit Euler",
        Method::SemiImplicitEuler => "Semi-implicit",
        Method::StormerVerlet => "Verlet",
        Method::DampedVerlet => "Damped Verlet",
        Method::Leapfrog => "Leapfrog",
        Method::RungeKutta2 => "RK2",
        Method::RungeKutta4 => "RK4",
        Method::ImplicitMidpoint => "Midpoint",
        Method::ImplicitEuler => "Implicit Euler",
        Method::Xpbd => "XPBD",
        Method::ExactFlow => "Exact flow",
    }
}

/// A number in few letters.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (0.01..10_000.0).contains(&size) => {
            if size < 10.0 {
                format!("{value:.3}")
            } else {
                format!("{value:.0}")
            }
        }
        _ => format!("{value:.0e}"),
    }
}
