//! The work-precision chart of the scene that is open, measured in the background, with a marker at the present setting.

use bevy::ecs::prelude::*;
use bevy_egui::egui::{self, Color32, RichText, vec2};
use egui_plot::{GridMark, HLine, Line, LineStyle, MarkerShape, Plot, PlotPoint, Points, Text};
use std::sync::mpsc::{Receiver, channel};

use super::{
    colors::{self, SERIES},
    settings::{Action, Settings},
};
use crate::{
    lab::{Point, SweepOptions, Unit, WorkPrecision, work_precision},
    mechanics::integrators::{Method, StickRule},
    scenes::{self, CurrentScene},
};

/// What the page shows.
#[derive(Clone, Debug, Default)]
pub enum ChartState {
    /// Nothing was asked for yet.
    #[default]
    Idle,
    /// Runs are being measured: how many of how many, and of what.
    Running {
        /// How many are done.
        done: usize,
        /// How many there are.
        total: usize,
        /// What is measured now.
        what: String,
    },
    /// The chart.
    Ready(Box<WorkPrecision>),
    /// Why there is none.
    Failed(String),
}

/// The measuring that goes on beside the scene.
#[derive(Default, Resource)]
pub(super) struct Measuring(Option<std::sync::Mutex<Receiver<ChartState>>>);

/// The page. It begins to measure when it is first seen.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings) {
    match &settings.chart {
        ChartState::Idle => settings.actions.push(Action::Measure),
        ChartState::Running { done, total, what } => {
            let part = *done as f32 / (*total).max(1) as f32;
            ui.add(egui::ProgressBar::new(part).desired_height(14.0).text(RichText::new(what).small()));
            ui.weak("Every method is being measured over many steps; the scene goes on.");
        }
        ChartState::Failed(problem) => {
            ui.label(RichText::new(problem).color(colors::AMBER));
        }
        ChartState::Ready(chart) => draw(ui, chart, settings),
    }
}

fn draw(ui: &mut egui::Ui, chart: &WorkPrecision, settings: &Settings) {
    let error = match chart.unit {
        Unit::Length => "error (lengths)",
        Unit::PartOfSpeed => "error of the speed (part of it)",
        Unit::PartOfCell => "error of shape, height or volume (part of a cell)",
    };
    ui.label(RichText::new(format!("{error} against force evaluations")).size(12.0));
    let power = |mark: GridMark, _: &core::ops::RangeInclusive<f64>| {
        if mark.value.fract() == 0.0 { format!("1e{}", mark.value) } else { String::new() }
    };
    Plot::new("work-precision")
        .height(230.0)
        .width(ui.available_width() - 2.0)
        .allow_scroll(false)
        .x_axis_formatter(power)
        .y_axis_formatter(power)
        .show(ui, |plot| {
            plot.hline(
                HLine::new("budget", libm::log10(chart.budget)).color(colors::GREEN).style(LineStyle::dashed_loose()),
            );
            for (index, method) in methods(chart).into_iter().enumerate() {
                let color = SERIES[index % SERIES.len()];
                // Six colours, and a form for each six methods.
                let form = [MarkerShape::Circle, MarkerShape::Diamond, MarkerShape::Square][index / SERIES.len() % 3];
                let line = curve(chart, method, StickRule::InStages);
                plot.line(Line::new(method.name(), line.clone()).color(color).width(1.2));
                plot.points(Points::new(method.name(), line).color(color).radius(2.5).shape(form));
            }
            // In the scene's own way that friction acts, where that is another.
            let stick = rule(chart, settings.method, settings.stick);
            if stick != StickRule::InStages {
                let index = methods(chart).iter().position(|method| *method == settings.method).unwrap_or_default();
                let line = curve(chart, settings.method, stick);
                let name = format!("{}, {}", settings.method.name(), stick.words());
                let color = SERIES[index % SERIES.len()];
                plot.line(Line::new(name, line).color(color).width(1.2).style(LineStyle::dotted_dense()));
            }
            if let Some([x, y]) = marker(chart, settings.method, settings.stick, settings.dt()) {
                plot.points(
                    Points::new("now", vec![[x, y]]).color(Color32::WHITE).radius(8.0).shape(MarkerShape::Asterisk),
                );
                plot.text(
                    Text::new("now", PlotPoint::new(x, y + 0.35), RichText::new("now").size(11.0))
                        .color(Color32::WHITE),
                );
            }
        });
    ui.spacing_mut().item_spacing = vec2(6.0, 1.0);
    ui.horizontal_wrapped(|ui| {
        for (index, method) in methods(chart).into_iter().enumerate() {
            let mark = ["●", "◆", "■"][index / SERIES.len() % 3];
            let color = SERIES[index % SERIES.len()];
            ui.label(RichText::new(format!("{mark} {}", method.name())).small().color(color));
        }
    });
    ui.label(RichText::new(format!("budget {:.2e} · over {} of time", chart.budget, chart.duration)).small().weak());
    ui.label(RichText::new(&chart.reference).small().weak());
}

fn methods(chart: &WorkPrecision) -> Vec<Method> {
    let measured = |method: &Method| chart.points.iter().any(|point| point.setting.method == *method);
    Method::ALL.into_iter().filter(measured).collect()
}

/// The runs of a method with a stick rule as (log₁₀ evaluations, log₁₀ error), from the largest step down.
fn curve(chart: &WorkPrecision, method: Method, stick: StickRule) -> Vec<[f64; 2]> {
    let place = |(point, error): (&Point, f64)| [libm::log10(point.evaluations as f64), libm::log10(error)];
    runs(chart, method, stick).map(place).collect()
}

fn runs(chart: &WorkPrecision, method: Method, stick: StickRule) -> impl Iterator<Item = (&Point, f64)> {
    let of_method = move |point: &&Point| (point.setting.method, point.setting.stick) == (method, stick);
    // What is exact to the last bit has no logarithm.
    chart.points.iter().filter(of_method).filter_map(|point| Some((point, point.errors?.largest.max(1e-16))))
}

/// The stick rule under which a method was measured that stands for `stick`: where it makes no difference, only that in stages was.
fn rule(chart: &WorkPrecision, method: Method, stick: StickRule) -> StickRule {
    if runs(chart, method, stick).next().is_some() { stick } else { StickRule::InStages }
}

/// Where the present setting stands: between the measured steps of its method and stick rule, along straight lines of the chart; beyond them, at their
/// end.
pub fn marker(chart: &WorkPrecision, method: Method, stick: StickRule, dt: f64) -> Option<[f64; 2]> {
    let mut known: Vec<_> = runs(chart, method, rule(chart, method, stick))
        .map(|(point, error)| {
            (libm::log10(point.setting.dt), [libm::log10(point.evaluations as f64), libm::log10(error)])
        })
        .collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = libm::log10(dt);
    let after = known.partition_point(|(step, _)| *step < at);
    let (Some(&(low, a)), Some(&(high, b))) =
        (known.get(after.saturating_sub(1)), known.get(after.min(known.len().max(1) - 1)))
    else {
        return None;
    };
    let part = if high > low { ((at - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
    Some([a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part])
}

/// Begins to measure the open scene as its files have it, on a thread of its own.
pub(super) fn begin(world: &mut World) -> ChartState {
    let Some(name) = world.get_resource::<CurrentScene>().map(|scene| scene.source.clone()) else {
        return ChartState::Failed("no scene is open".into());
    };
    let (sender, receiver) = channel();
    let work = move || {
        let mut progress = |done: usize, total: usize, what: &str| {
            // Nobody listens any more once another scene is open.
            sender.send(ChartState::Running { done, total, what: what.into() }).ok();
        };
        let options = SweepOptions { quick: true, ..SweepOptions::default() };
        let state = match scenes::load(&name) {
            Ok(scene) => match work_precision(&scene, &options, &mut progress) {
                Ok(chart) => ChartState::Ready(Box::new(chart)),
                Err(error) => ChartState::Failed(error.to_string()),
            },
            Err(error) => ChartState::Failed(error.to_string()),
        };
        sender.send(state).ok();
    };
    if let Err(error) = std::thread::Builder::new().name("work-precision".into()).spawn(work) {
        return ChartState::Failed(format!("cannot measure: {error}"));
    }
    world.insert_resource(Measuring(Some(std::sync::Mutex::new(receiver))));
    ChartState::Running { done: 0, total: 1, what: "reference".into() }
}

/// Takes up what the measuring reports.
pub(super) fn listen(mut measuring: ResMut<Measuring>, mut settings: ResMut<Settings>) {
    let Some(receiver) = &mut measuring.0 else { return };
    let news = receiver.get_mut().ok().and_then(|receiver| receiver.try_iter().last());
    if let Some(state) = news {
        let over = !matches!(state, ChartState::Running { .. });
        settings.chart = state;
        if over {
            measuring.0 = None;
        }
    }
}

/// Another scene is open: its chart is another one.
pub(super) fn forget(world: &mut World, settings: &mut Settings) {
    settings.chart = ChartState::Idle;
    world.insert_resource(Measuring(None));
}
