//! Curves over time, on plain axes.

use super::{
    ChartError, axes, render,
    scale::short,
    shapes::{Color, Picture, Place, Rect},
    text::{Anchor, Text},
};

/// A figure of curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// What it shows.
    pub title: String,
    /// What is along the axis to the right.
    pub across: String,
    /// What is along the axis upwards.
    pub upwards: String,
    /// The curves by their names; each goes through places of the axes.
    pub curves: Vec<(String, Vec<(f64, f64)>)>,
}

/// Colours that are told apart also by people who see fewer of them (M. Okabe, K. Ito, 2008).
const COLORS: [Color; 6] =
    [[0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00], [0x00, 0x9e, 0x73], [0xcc, 0x79, 0xa7], [0xe6, 0x9f, 0x00], [0; 3]];
/// How a curve is dashed where colours alone might not do.
const DASHES: [&[f64]; 6] = [&[], &[12.0, 5.0], &[3.0, 4.0], &[14.0, 4.0, 3.0, 4.0], &[7.0, 4.0], &[20.0, 6.0]];
const GRID: Color = [0xdc; 3];
const FRAME: Rect = Rect { left: 118.0, top: 84.0, right: 1230.0, bottom: 800.0 };

/// Draws a figure.
pub fn picture(figure: &Curves) -> Picture {
    let mut picture = Picture::default();
    picture.text(Text::new(figure.title.clone(), (FRAME.left, 50.0), 24.0));
    let places = || figure.curves.iter().flat_map(|(_, places)| places).filter(|(x, y)| x.is_finite() && y.is_finite());
    let (low_x, high_x) = range(places().map(|place| place.0));
    let (low_y, high_y) = range(places().map(|place| place.1));
    let at = |(x, y): (f64, f64)| -> Place {
        let along = |value: f64, low: f64, high: f64| (value - low) / (high - low);
        let across = FRAME.left + along(x, low_x, high_x) * (FRAME.right - FRAME.left);
        (across, FRAME.bottom - along(y, low_y, high_y) * (FRAME.bottom - FRAME.top))
    };
    for value in ticks(low_x, high_x) {
        let (x, _) = at((value, low_y));
        picture.line([(x, FRAME.top), (x, FRAME.bottom)], GRID, 1.0);
        picture.text(Text::new(short(value), (x, FRAME.bottom + 24.0), axes::TICK_SIZE).anchored(Anchor::Middle));
    }
    for value in ticks(low_y, high_y) {
        let (_, y) = at((low_x, value));
        picture.line([(FRAME.left, y), (FRAME.right, y)], GRID, 1.0);
        picture.text(Text::new(short(value), (FRAME.left - 9.0, y + 5.0), axes::TICK_SIZE).anchored(Anchor::End));
    }
    axes::border(&mut picture, FRAME);
    let middle = ((FRAME.left + FRAME.right) / 2.0, (FRAME.top + FRAME.bottom) / 2.0);
    picture.text(Text::new(figure.across.clone(), (middle.0, FRAME.bottom + 54.0), 16.0).anchored(Anchor::Middle));
    let upwards = Text::new(figure.upwards.clone(), (FRAME.left - 76.0, middle.1), 16.0).anchored(Anchor::Middle);
    picture.text(Text { upwards: true, ..upwards });
    for (i, (name, curve)) in figure.curves.iter().enumerate() {
        let (color, dashes) = (COLORS[i % COLORS.len()], DASHES[i % DASHES.len()]);
        let curve: Vec<_> =
            curve.iter().filter(|(x, y)| x.is_finite() && y.is_finite()).map(|place| at(*place)).collect();
        picture.dashed(&curve, dashes, color, 2.2);
        let y = FRAME.top + 14.0 + 28.0 * i as f64;
        picture.dashed(&[(FRAME.right + 24.0, y), (FRAME.right + 72.0, y)], dashes, color, 2.6);
        picture.text(Text::new(name.clone(), (FRAME.right + 82.0, y + 5.0), 16.0));
    }
    picture
}

/// Draws a figure as SVG.
///
/// # Errors
/// If plotters cannot draw it.
pub fn svg(figure: &Curves) -> Result<String, ChartError> {
    render::svg(&picture(figure))
}

/// What an axis shows: all values, and never nothing.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match high - low {
        span if span > 0.0 => (low, high + 0.04 * span),
        _ if low.is_finite() => (low - 0.5, high + 0.5),
        _ => (0.0, 1.0),
    }
}

/// Some round values between two, 1, 2 or 5 times a power of ten apart.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 6.0;
    let power = libm::pow(10.0, libm::log10(rough).floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * power).find(|step| *step >= rough).unwrap_or(rough);
    let first = (low / step).ceil();
    (0..20).map(|i| (first + f64::from(i)) * step).take_while(|value| *value <= high).collect()
}
