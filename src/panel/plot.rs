//! One plot: its title with the names of its lines, and its axes.

use bevy_egui::egui::{self, Color32, FontId, RichText, Sense, Vec2b, vec2};
use egui_plot::{AxisHints, Plot, PlotPoints, PlotUi, uniform_grid_spacer};

use super::{
    colors::{self, SERIES},
    ring::Ring,
    setting::number_text,
};

/// The title of a plot, with the names of its lines in their colours.
pub fn legend<'a>(ui: &mut egui::Ui, title: &str, names: impl IntoIterator<Item = &'a str>) {
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(title).size(12.0));
        for (name, color) in names.into_iter().zip(SERIES) {
            let (stroke, _) = ui.allocate_exact_size(vec2(10.0, 3.0), Sense::hover());
            ui.painter().rect_filled(stroke, 1.0, color);
            ui.label(RichText::new(name).size(11.5).color(color));
        }
    });
}

/// What a plot is drawn in, as wide as the panel and as high as its lines ask for.
#[derive(Clone, Copy, Debug)]
pub struct Axes<'a> {
    id: &'a str,
    span: (f64, f64),
    least: &'a [f64],
    height: f32,
}

impl<'a> Axes<'a> {
    /// Axes over `span`, the first and the last time that is shown.
    pub fn new(id: &'a str, span: (f64, f64)) -> Self {
        Self { id, span, least: &[], height: 108.0 }
    }

    /// Shows these values in any case, so that noise looks like noise.
    pub fn least(self, least: &'a [f64]) -> Self {
        Self { least, ..self }
    }

    /// Gives the plot another height than 108 points.
    pub fn height(self, height: f32) -> Self {
        Self { height, ..self }
    }

    /// Shows what `draw` draws.
    pub fn show<'b>(self, ui: &mut egui::Ui, draw: impl FnOnce(&mut PlotUi<'b>) + 'b) {
        let Self { id, span: (start, end), least, height } = self;
        let font = FontId::proportional(10.0);
        let axes = [
            AxisHints::new_x().label_spacing(30.0..=50.0),
            AxisHints::new_y().label_spacing(10.0..=18.0).min_thickness(26.0),
        ];
        let [x, y] = axes.map(|axis| {
            axis.tick_label_font(font.clone())
                .tick_label_color(Color32::from_gray(0x90))
                .formatter(|mark, _| number_text(mark.value))
        });
        ui.visuals_mut().extreme_bg_color = colors::WELL;
        let plot = Plot::new(id.to_string());
        least
            .iter()
            .fold(plot, |plot, value| plot.include_y(*value))
            .height(height)
            .width(ui.available_width() - 2.0)
            .custom_x_axes(vec![x])
            .custom_y_axes(vec![y])
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_axis_zoom_drag(false)
            .allow_double_click_reset(false)
            .grid_color(Color32::from_gray(0x58))
            .grid_spacing(8.0..=120.0)
            .x_grid_spacer(uniform_grid_spacer(|input| [step(input.bounds); 3]))
            .y_grid_spacer(uniform_grid_spacer(|input| [step(input.bounds); 3]))
            .show(ui, move |plot| {
                plot.set_auto_bounds(Vec2b::new(false, true));
                draw(plot);
                // A span of no length has no scale.
                plot.set_plot_bounds_x(start..=end.max(start + 1e-3));
            });
    }
}

/// How far the numbers at an axis are apart: 1, 2 or 5 times a power of ten, so that there are a few of them.
fn step((low, high): (f64, f64)) -> f64 {
    let least = (high - low).max(f64::MIN_POSITIVE) / 4.0;
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0].into_iter().map(|times| times * power).find(|step| *step >= least).unwrap_or(10.0 * power)
}

/// The points of a line.
pub fn points<'a>(time: &Ring<f64>, values: &Ring<f64>) -> PlotPoints<'a> {
    time.iter().zip(values.iter()).map(|(&time, &value)| [time, value]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_round_numbers_are_at_an_axis() {
        for (span, expected) in [(1.01, 0.5), (0.79, 0.2), (0.81, 0.5), (3.9, 1.0), (120.0, 50.0), (1e-6, 5e-7)] {
            for low in [0.0, -0.3 * span] {
                let step = step((low, low + span));
                assert!((step / expected - 1.0).abs() < 1e-12, "{step} over {span}");
                assert!((1.6..=4.0 + 1e-9).contains(&(span / step)), "{step} over {span}");
            }
        }
        assert!(step((1.0, 1.0)) > 0.0);
    }
}
