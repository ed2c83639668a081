//! Draws what work-precision runs have measured: error over cost, in force evaluations and in seconds, on logarithmic axes.
//!
//! And what good enough costs with stiffer springs, in [`stiffness`]; [`curves`] are plain figures over time.
//!
//! [`Plot`] says where everything is, [`picture`] draws it into lines, areas and texts, [`svg`] and [`png`] draw those with plotters.

mod axes;
pub mod curves;
mod figure;
mod labels;
mod legend;
mod look;
mod plot;
mod render;
mod scale;
mod series;
mod shapes;
pub mod stiffness;
mod text;
mod tracks;
mod words;

use super::WorkPrecision;

pub use look::Look;
pub use plot::{Guide, Panel, Plot, Room};
pub use render::ChartError;
pub use scale::{LogScale, Tick, short};
pub use series::{Cost, Series, error};
pub use shapes::{Color, Picture, Place, Rect, Shape};
pub use text::{Anchor, Text};
pub use tracks::Track;

/// Lays a chart out as [`picture`] draws it.
pub fn plot(chart: &WorkPrecision) -> Plot {
    Plot::new(chart, legend::room(&legend::caption(chart)))
}

/// Draws a chart.
pub fn picture(chart: &WorkPrecision) -> Picture {
    let caption = legend::caption(chart);
    let plot = Plot::new(chart, legend::room(&caption));
    let mut picture = Picture::default();
    for (i, panel) in plot.panels.iter().enumerate() {
        figure::draw(&mut picture, chart, &plot, panel, i == 0);
    }
    legend::draw(&mut picture, chart, &plot, &caption);
    picture
}

/// Draws a chart as SVG, 1600 × 900.
///
/// # Errors
/// If plotters cannot draw it.
pub fn svg(chart: &WorkPrecision) -> Result<String, ChartError> {
    render::svg(&picture(chart))
}

/// Draws a chart as PNG, 1600 × 900.
///
/// # Errors
/// If plotters cannot draw it, or the system has no room for temporary files.
pub fn png(chart: &WorkPrecision) -> Result<Vec<u8>, ChartError> {
    render::png(&picture(chart))
}
