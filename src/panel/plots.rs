//! The plots: lengths, velocities, distance, and the cost of a frame.

use bevy_egui::egui::{self, Color32, RichText, vec2};
use egui_plot::{Line, PlotPoints, Polygon};

use super::{
    colors::{SERIES, faint, rgb},
    gait_plots,
    plot::{Axes, legend, points},
    ring::Ring,
    settings::Settings,
    traces::{self, BesideBlock, Block, Traces},
};

/// All plots.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings, traces: &Traces) {
    if traces.time.is_empty() {
        ui.weak("The plots begin with the first tick.");
    } else {
        let shown = span(settings, traces);
        if !traces.blocks.is_empty() {
            block(ui, traces, shown);
        } else if !traces.masses.is_empty() {
            lengths(ui, traces, shown);
            velocities(ui, traces, shown);
        }
        distance(ui, traces, shown);
        gait_plots::section(ui, &traces.gait);
    }
    cost(ui, settings, traces);
}

fn lengths(ui: &mut egui::Ui, traces: &Traces, shown: (f64, f64)) {
    legend(ui, "spring length (thin: rest length)", traces.springs.iter().map(|trace| trace.name.as_str()));
    Axes::new("lengths", shown).show(ui, |plot| {
        for (trace, color) in traces.springs.iter().zip(SERIES) {
            let rest = format!("rest length {}", trace.name);
            plot.line(Line::new(rest, points(&traces.time, &trace.rest)).color(faint(color, 0.6)).width(1.0));
            plot.line(Line::new(trace.name.as_str(), points(&traces.time, &trace.length)).color(color).width(1.8));
        }
    });
}

fn velocities(ui: &mut egui::Ui, traces: &Traces, shown: (f64, f64)) {
    legend(ui, "velocity (bars: at rest)", traces.masses.iter().map(|trace| trace.name.as_str()));
    Axes::new("velocities", shown).show(ui, |plot| {
        // A lane below zero for each mass: shades across the whole plot would hide each other.
        let fastest = traces.masses.iter().flat_map(|trace| trace.velocity.iter()).fold(0.0_f64, |a, v| a.max(v.abs()));
        let lane = (fastest * 0.12).max(1e-9);
        for (index, color) in (0..traces.masses.len()).zip(SERIES) {
            let (top, bottom) = (-lane * (index as f64 + 0.3), -lane * (index as f64 + 1.1));
            for rest in traces.rests(index) {
                let (start, end) = (*rest.start(), *rest.end());
                let corners = vec![[start, bottom], [end, bottom], [end, top], [start, top]];
                let lane =
                    Polygon::new("at rest", corners).fill_color(faint(color, 0.75)).width(0.0).allow_hover(false);
                plot.polygon(lane);
            }
        }
        for (trace, color) in traces.masses.iter().zip(SERIES) {
            plot.line(Line::new(trace.name.as_str(), points(&traces.time, &trace.velocity)).color(color).width(1.6));
        }
    });
}

/// What a block on a grid has in place of a spine.
fn block(ui: &mut egui::Ui, traces: &Traces, shown: (f64, f64)) {
    /// Id, title, what is plotted, and the values that are shown at least, so that noise looks like noise.
    type Plotted = (&'static str, &'static str, fn(&Block) -> f64, [f64; 2]);
    let plots: [Plotted; 4] = [
        ("shape", "shape error (spacings)", |block| block.shape.shape_error, [0.0, 0.1]),
        ("volume", "volume (1: undeformed)", |block| block.shape.volume.unwrap_or(1.0), [0.9, 1.1]),
        ("inverted", "cells inside out", |block| block.shape.inverted as f64, [0.0, 1.0]),
        ("energy", "energy: kinetic, elastic and of height", |block| block.energy, [0.0, 1e-6]),
    ];
    if !traces.side_by_side.is_empty() {
        side_by_side(ui, traces);
    }
    for ((id, title, value, least), color) in plots.into_iter().zip(SERIES) {
        let now = traces.blocks.last().map(value).unwrap_or_default();
        legend(ui, &format!("{title}: {now:.3}"), []);
        Axes::new(id, shown).least(&least).show(ui, |plot| {
            let line = |name: &str, blocks: &Ring<Block>, color: Color32| {
                let line = traces.time.iter().zip(blocks.iter()).map(|(&time, block)| [time, value(block)]);
                Line::new(name, line.collect::<PlotPoints<'_>>()).color(color).width(1.8)
            };
            if traces.side_by_side.is_empty() {
                plot.line(line(title, &traces.blocks, color));
            }
            for trace in &traces.side_by_side {
                plot.line(line(&trace.now.name, &trace.values, rgb(trace.now.color)));
            }
        });
    }
}

/// What holds its shape, at what cost, and at which largest step: a row for each of several blocks.
fn side_by_side(ui: &mut egui::Ui, traces: &Traces) {
    egui::Grid::new("blocks").num_columns(5).spacing(vec2(9.0, 2.0)).show(ui, |ui| {
        for heading in ["block", "springs", "largest dt", "shape", "volume"] {
            ui.label(RichText::new(heading).small().weak());
        }
        ui.end_row();
        for BesideBlock { name, color, springs, limit, block } in traces.side_by_side.iter().map(|trace| &trace.now) {
            ui.label(RichText::new(name).size(12.0).strong().color(rgb(*color)));
            ui.label(RichText::new(springs.to_string()).size(12.0)).on_hover_text("as many forces an evaluation");
            let limit = if limit.is_finite() { format!("{limit:.3}") } else { "none".into() };
            ui.label(RichText::new(limit).size(12.0)).on_hover_text("the largest stable step that is sure");
            ui.label(RichText::new(format!("{:.3}", block.shape.shape_error)).size(12.0))
                .on_hover_text("shape error, in spacings");
            let volume = block.shape.volume.map_or("–".into(), |volume| format!("{volume:.3}"));
            ui.label(RichText::new(volume).size(12.0)).on_hover_text("1: undeformed");
            ui.end_row();
        }
    });
}

fn distance(ui: &mut egui::Ui, traces: &Traces, shown: (f64, f64)) {
    let now = traces.distance.last().copied().unwrap_or_default();
    legend(ui, &format!("distance travelled: {now:.2}"), []);
    // What rests is to look like it.
    Axes::new("distance", shown).least(&[0.0, 0.01]).show(ui, |plot| {
        plot.line(Line::new("distance", points(&traces.time, &traces.distance)).color(SERIES[0]).width(1.8));
    });
}

fn cost(ui: &mut egui::Ui, settings: &Settings, traces: &Traces) {
    let cost = settings.cost;
    let rate = if cost.frame > 0.0 { 1000.0 / cost.frame } else { 0.0 };
    legend(ui, "milliseconds a frame", ["frame", "physics"]);
    ui.label(
        RichText::new(format!(
            "{:.1} ms ({rate:.0} a second) · physics {:.3} ms · {} steps a tick",
            cost.frame, cost.physics, cost.steps_per_tick
        ))
        .small()
        .weak(),
    );
    let Some((first, last)) = traces.frames.first().zip(traces.frames.last()) else { return };
    Axes::new("cost", (first.time, last.time)).show(ui, |plot| {
        let line = |value: fn(&traces::Frame) -> f64| -> PlotPoints<'_> {
            traces.frames.iter().map(|frame| [frame.time, value(frame)]).collect()
        };
        plot.line(Line::new("frame", line(|frame| frame.frame)).color(SERIES[0]).fill(0.0).fill_alpha(0.15));
        plot.line(Line::new("physics", line(|frame| frame.physics)).color(SERIES[1]).width(1.8));
    });
}

/// The last ten seconds of what was recorded, in simulated time.
fn span(settings: &Settings, traces: &Traces) -> (f64, f64) {
    let scale = settings.get("clock.time_scale").map_or(1.0, |setting| setting.value);
    let end = traces.time.last().copied().unwrap_or_default();
    let recorded = traces.time.first().copied().unwrap_or_default();
    (if scale > 0.0 { recorded.max(end - 10.0 * scale) } else { recorded }, end)
}
