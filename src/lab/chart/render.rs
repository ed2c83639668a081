//! Draws a picture with plotters, as SVG or PNG.

use core::fmt::Display;
use std::{io, sync::LazyLock};

use epaint_default_fonts::UBUNTU_LIGHT;
use plotters::{
    backend::{BitMapBackend, DrawingBackend, SVGBackend},
    coord::Shift,
    drawing::{DrawingArea, IntoDrawingArea},
    element::{PathElement, Polygon, Text as TextElement},
    style::{
        Color as _, FontStyle, FontTransform, IntoFont, IntoTextStyle, RGBColor, ShapeStyle, WHITE, register_font,
        text_anchor::{HPos, Pos, VPos},
    },
};
use thiserror::Error;

use super::{
    shapes::{Picture, Place, Shape},
    text::{Anchor, LINE_HEIGHT, Text},
};

/// Why a chart could not be drawn.
#[derive(Debug, Error)]
#[error("the chart could not be drawn: {0}")]
pub struct ChartError(String);

impl ChartError {
    fn new(error: impl Display) -> Self {
        Self(error.to_string())
    }
}

/// The bundled font first, then what looks most alike; plotters knows the bundled font by the whole list.
const FONTS: &str = "Ubuntu, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

static REGISTERED: LazyLock<bool> = LazyLock::new(|| register_font(FONTS, FontStyle::Normal, UBUNTU_LIGHT).is_ok());

/// How a backend draws: pixels of its own to a pixel of the picture, and how it understands the size and the place of texts.
#[derive(Clone, Copy)]
struct Drawn {
    scale: u32,
    /// The size to ask for, to an em of 1.
    size: f64,
    /// How far below the place of a text its baseline comes to lie, in ems.
    drop: f64,
}

/// An SVG has whole numbers only; four to a pixel are fine enough. plotters divides a size by 1.24 and lowers text by 0.76 em.
const SVG: Drawn = Drawn { scale: 4, size: 1.24, drop: 0.76 };
/// A bitmap is drawn three times as large and averaged, which smooths what plotters leaves jagged.
const BITMAP: Drawn = Drawn { scale: 3, size: LINE_HEIGHT, drop: LINE_HEIGHT / 2.0 };

/// The picture as SVG.
pub(super) fn svg(picture: &Picture) -> Result<String, ChartError> {
    let (width, height) = size(SVG.scale);
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
    draw(picture, &area, SVG)?;
    drop(area);
    let large = format!("width=\"{width}\" height=\"{height}\"");
    let small = format!("width=\"{}\" height=\"{}\"", Picture::WIDTH, Picture::HEIGHT);
    Ok(text.replacen(&large, &small, 1))
}

/// The picture as PNG, 1600 × 900.
pub(super) fn png(picture: &Picture) -> Result<Vec<u8>, ChartError> {
    let large = size(BITMAP.scale);
    let mut pixels = vec![0xff; 3 * (large.0 * large.1) as usize];
    let area = BitMapBackend::with_buffer(&mut pixels, large).into_drawing_area();
    draw(picture, &area, BITMAP)?;
    drop(area);
    let pixels = smaller(&pixels, large.0 as usize, BITMAP.scale as usize);
    // plotters writes a PNG to a path only.
    let file = tempfile::Builder::new().suffix(".png").tempfile().map_err(ChartError::new)?;
    let size = size(1);
    let mut backend = BitMapBackend::new(file.path(), size);
    backend.blit_bitmap((0, 0), size, &pixels).map_err(ChartError::new)?;
    backend.present().map_err(ChartError::new)?;
    drop(backend);
    let read = || -> io::Result<Vec<u8>> { std::fs::read(file.path()) };
    read().map_err(ChartError::new)
}

fn size(scale: u32) -> (u32, u32) {
    (Picture::WIDTH as u32 * scale, Picture::HEIGHT as u32 * scale)
}

/// Averages squares of `scale` × `scale` pixels.
fn smaller(pixels: &[u8], width: usize, scale: usize) -> Vec<u8> {
    let mut small = Vec::with_capacity(pixels.len() / (scale * scale));
    let mut sums = vec![0_u32; 3 * width / scale];
    for rows in pixels.chunks_exact(3 * width * scale) {
        sums.fill(0);
        for row in rows.chunks_exact(3 * width) {
            for (sum, square) in sums.chunks_exact_mut(3).zip(row.chunks_exact(3 * scale)) {
                for pixel in square.chunks_exact(3) {
                    sum.iter_mut().zip(pixel).for_each(|(sum, &part)| *sum += u32::from(part));
                }
            }
        }
        let count = (scale * scale) as u32;
        small.extend(sums.iter().map(|sum| ((sum + count / 2) / count) as u8));
    }
    small
}

fn draw<B: DrawingBackend>(picture: &Picture, area: &DrawingArea<B, Shift>, how: Drawn) -> Result<(), ChartError> {
    if !*REGISTERED {
        return Err(ChartError::new("the bundled font cannot be read"));
    }
    area.fill(&WHITE).map_err(ChartError::new)?;
    let scale = f64::from(how.scale);
    let place = |(x, y): Place| ((x * scale).round() as i32, (y * scale).round() as i32);
    for shape in &picture.shapes {
        match shape {
            Shape::Line { points, color: [r, g, b], width } => {
                let mut points: Vec<_> = points.iter().copied().map(place).collect();
                // A line without length has no direction in which plotters could widen it.
                points.dedup();
                if points.len() < 2 {
                    continue;
                }
                let width = (width * scale).round().max(1.0) as u32;
                let style = ShapeStyle { color: RGBColor(*r, *g, *b).to_rgba(), filled: false, stroke_width: width };
                area.draw(&PathElement::new(points, style)).map_err(ChartError::new)?;
            }
            Shape::Area { points, color: [r, g, b], alpha } => {
                let points: Vec<_> = points.iter().copied().map(place).collect();
                area.draw(&Polygon::new(points, RGBColor(*r, *g, *b).mix(*alpha).filled())).map_err(ChartError::new)?;
            }
            Shape::Text(text) => draw_text(text, area, how).map_err(ChartError::new)?,
        }
    }
    area.present().map_err(ChartError::new)
}

fn draw_text<B: DrawingBackend>(
    text: &Text,
    area: &DrawingArea<B, Shift>,
    how: Drawn,
) -> Result<(), plotters::drawing::DrawingAreaErrorKind<B::ErrorType>> {
    let scale = f64::from(how.scale);
    let horizontal = match text.anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    let drop = how.drop * text.size;
    let (x, y) = if text.upwards { (text.at.0 - drop, text.at.1) } else { (text.at.0, text.at.1 - drop) };
    let transform = if text.upwards { FontTransform::Rotate270 } else { FontTransform::None };
    let [r, g, b] = text.color;
    let font = (FONTS, text.size * how.size * scale).into_font().transform(transform);
    let style = font.color(&RGBColor(r, g, b)).pos(Pos::new(horizontal, VPos::Top));
    let at = ((x * scale).round() as i32, (y * scale).round() as i32);
    area.draw(&TextElement::new(text.text.as_str(), at, style.into_text_style(area)))
}
