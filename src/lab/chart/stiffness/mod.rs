//! Draws what a study of stiffness has found: seconds of the cheapest good run of every method over the factor of stiffness, on logarithmic axes, with
//! the crossing from which implicit methods are the cheapest.

mod figure;
mod plot;
mod words;

use super::{
    ChartError, legend, render,
    shapes::{Picture, Rect},
};
use crate::lab::StiffnessStudy;

pub use plot::{StiffnessPlot, StiffnessSeries};
pub use words::verdict;

/// Lays a study out as [`picture`] draws it.
pub fn plot(study: &StiffnessStudy) -> StiffnessPlot {
    let bottom = legend::bottom(&words::caption(study));
    StiffnessPlot::new(study, Rect { left: 108.0, top: 92.0, right: legend::LEFT - 30.0, bottom })
}

/// Draws a study.
pub fn picture(study: &StiffnessStudy) -> Picture {
    let mut picture = Picture::default();
    let plot = plot(study);
    figure::draw(&mut picture, study, &plot);
    words::draw(&mut picture, study, &plot);
    picture
}

/// Draws a study as SVG, 1600 × 900.
///
/// # Errors
/// If plotters cannot draw it.
pub fn svg(study: &StiffnessStudy) -> Result<String, ChartError> {
    render::svg(&picture(study))
}

/// Draws a study as PNG, 1600 × 900.
///
/// # Errors
/// If plotters cannot draw it, or the system has no room for temporary files.
pub fn png(study: &StiffnessStudy) -> Result<Vec<u8>, ChartError> {
    render::png(&picture(study))
}
