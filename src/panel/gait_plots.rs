//! The gait of the animal that the panel shows: a table of what it is now, and plots of what it was over its last cycles.

use bevy_egui::egui::{self, RichText};
use egui_plot::{Line, PlotPoints};

use super::{
    colors::SERIES,
    gait::{GaitWatch, Measured},
    plot::{Axes, legend},
    ring::Ring,
};
use crate::mechanics::metrics::GaitMetrics;

/// How high a plot is, in points: there are several, and they are read beside each other.
const HEIGHT: f32 = 84.0;

/// What is plotted of a gait over time.
struct Plotted {
    id: &'static str,
    title: &'static str,
    /// The values that are shown at least, so that noise looks like noise.
    least: [f64; 2],
    /// The lines by their names.
    lines: &'static [NamedLine],
}

/// A line's name and its values.
type NamedLine = (&'static str, fn(&GaitMetrics) -> f64);

const PLOTS: [Plotted; 4] = [
    Plotted {
        id: "gait speed",
        title: "speed (body lengths a cycle)",
        least: [0.0, 0.1],
        lines: &[("speed", |gait| gait.body_lengths)],
    },
    Plotted {
        id: "gait way",
        title: "to the right (°)",
        least: [-5.0, 5.0],
        lines: &[("angle", |gait| gait.angle), ("turn a cycle", |gait| gait.turn)],
    },
    Plotted {
        id: "gait parts",
        title: "in %",
        least: [0.0, 10.0],
        lines: &[
            ("slip", |gait| 100.0 * gait.slip),
            ("lifted", |gait| 100.0 * gait.lifted),
            ("worst strain", |gait| 100.0 * gait.worst_strain),
            ("residue", |gait| 100.0 * gait.residue),
        ],
    },
    Plotted {
        id: "gait shape",
        title: "shape",
        least: [0.0, 1.0],
        lines: &[("off the path", |gait| gait.path_error), ("smallest cell", |gait| gait.smallest_cell)],
    },
];

/// The table and the plots. Shows nothing of what is no animal.
pub fn section(ui: &mut egui::Ui, watch: &GaitWatch) {
    if !watch.is_of_animal() {
        return;
    }
    ui.add_space(4.0);
    ui.label(RichText::new("gait over the last cycles").size(12.0));
    let Some((first, last)) = watch.history.first().zip(watch.history.last()) else {
        ui.weak("It is known once a cycle is over.");
        return;
    };
    table(ui, &last.metrics);
    // One point is no line.
    if first.time < last.time {
        for plotted in &PLOTS {
            plot(ui, plotted, &watch.history, (first.time, last.time));
        }
    }
}

/// The metrics as they are now, in two columns of names and values.
fn table(ui: &mut egui::Ui, metrics: &GaitMetrics) {
    egui::Grid::new("gait").num_columns(4).spacing([10.0, 1.0]).show(ui, |ui| {
        for pair in rows(metrics).chunks(2) {
            for (name, value) in pair {
                ui.label(RichText::new(*name).size(11.5).weak());
                ui.label(RichText::new(value).size(11.5));
            }
            ui.end_row();
        }
    });
}

/// What is shown of a gait: names and values.
fn rows(metrics: &GaitMetrics) -> [(&'static str, String); 10] {
    let per_cent = |part: f64| format!("{:.0} %", 100.0 * part);
    [
        ("a cycle", format!("{:.3} lengths", metrics.body_lengths)),
        ("angle", format!("{:.1}°", metrics.angle)),
        ("turn", format!("{:.1}° a cycle", metrics.turn)),
        ("slip", per_cent(metrics.slip)),
        ("lifted", per_cent(metrics.lifted)),
        ("off the path", format!("{:.3}", metrics.path_error)),
        ("worst strain", per_cent(metrics.worst_strain)),
        ("residue", per_cent(metrics.residue)),
        ("smallest cell", format!("{:.2}", metrics.smallest_cell)),
        ("cycles", metrics.cycles.to_string()),
    ]
}

/// A plot over all measurements that are kept: there are eight a cycle, and the seconds that other plots show hold few of them.
fn plot(ui: &mut egui::Ui, plotted: &Plotted, history: &Ring<Measured>, span: (f64, f64)) {
    // A single line is what the title says.
    let named = if plotted.lines.len() > 1 { plotted.lines } else { &[] };
    legend(ui, plotted.title, named.iter().map(|(name, _)| *name));
    Axes::new(plotted.id, span).least(&plotted.least).height(HEIGHT).show(ui, |plot| {
        for ((name, value), color) in plotted.lines.iter().zip(SERIES) {
            let points: PlotPoints<'_> =
                history.iter().map(|measured| [measured.time, value(&measured.metrics)]).collect();
            plot.line(Line::new(*name, points).color(color).width(1.8));
        }
    });
}
