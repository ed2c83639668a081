//! Colours, markers and line styles of methods: told apart by colour, and without colour by shape.

use super::shapes::{Color, Picture, Place};
use crate::mechanics::integrators::{Method, StickRule};

/// The colours of Okabe and Ito (<https://jfly.uni-koeln.de/color/>), which the colour-blind can tell apart; grey stands in for their
/// yellow, which is too light on white.
const COLORS: [Color; 8] = [
    [0xd5, 0x5e, 0x00],
    [0x00, 0x00, 0x00],
    [0x00, 0x72, 0xb2],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0x7f, 0x7f, 0x7f],
];

/// Dashes and gaps, in pixels.
const DASHES: [&[f64]; 5] = [&[], &[14.0, 5.0], &[12.0, 4.0, 2.5, 4.0], &[7.0, 4.0], &[12.0, 4.0, 2.5, 4.0, 2.5, 4.0]];
const DOTS: &[f64] = &[2.0, 4.0];

/// How many shapes of markers there are.
const MARKERS: usize = 12;

/// How a method is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The colour of its lines and markers.
    pub color: Color,
    /// Dashes and gaps of its lines, in pixels; none for a whole line.
    pub dashes: &'static [f64],
    /// Which marker, from 0 to 11.
    marker: usize,
    /// When friction acts: markers are hollow where it acts at the end of the step, and have a dot where it is located.
    stick: StickRule,
}

impl Look {
    /// The look of a method with a stick rule; that of a method stays the same in every chart.
    pub fn of(method: Method, stick: StickRule) -> Self {
        let i = Method::ALL.iter().position(|&other| other == method).unwrap_or(0);
        Self {
            color: COLORS[i % COLORS.len()],
            dashes: if stick == StickRule::EndOfStep { DOTS } else { DASHES[i % DASHES.len()] },
            marker: i % MARKERS,
            stick,
        }
    }

    /// The colour for text: dark enough to be read on white.
    pub fn ink(&self) -> Color {
        let luminance: f64 =
            self.color.iter().zip([0.3, 0.6, 0.1]).map(|(&part, weight)| f64::from(part) * weight).sum();
        let factor = (95.0 / luminance.max(1.0)).min(1.0);
        self.color.map(|part| (f64::from(part) * factor) as u8)
    }

    /// Draws its marker.
    pub(super) fn mark(&self, picture: &mut Picture, at: Place, radius: f64) {
        let scaled = |radius: f64| -> Vec<Place> {
            outline(self.marker).into_iter().map(|(x, y)| (at.0 + radius * x, at.1 + radius * y)).collect()
        };
        // A thin rim of white keeps markers apart that lie over each other.
        picture.area(scaled(radius + 1.3), [0xff; 3], 1.0);
        picture.area(scaled(radius), self.color, 1.0);
        if self.stick != StickRule::InStages {
            picture.area(scaled(radius - 2.0), [0xff; 3], 1.0);
        }
        if self.stick == StickRule::Located {
            picture.area(scaled(radius - 4.0), self.color, 1.0);
        }
    }
}

/// The corners of a marker of radius 1, with y downwards.
fn outline(marker: usize) -> Vec<Place> {
    match marker {
        0 => regular(24, 0.0, 0.95),
        1 => regular(4, 0.125, 1.2),
        2 => regular(3, 0.0, 1.25),
        3 => regular(4, 0.0, 1.2),
        4 => regular(3, 0.5, 1.25),
        5 => regular(5, 0.0, 1.1),
        6 => regular(3, 0.25, 1.25),
        7 => plus(),
        8 => regular(3, 0.75, 1.25),
        9 => regular(6, 0.0, 1.1),
        10 => vec![(-1.0, -1.1), (1.0, -1.1), (0.2, 0.0), (1.0, 1.1), (-1.0, 1.1), (-0.2, 0.0)],
        _ => vec![(-1.1, -1.0), (0.0, -0.2), (1.1, -1.0), (1.1, 1.0), (0.0, 0.2), (-1.1, 1.0)],
    }
}

fn plus() -> Vec<Place> {
    let (long, short) = (1.15, 0.42);
    let quarter = [(short, -short), (short, -long), (-short, -long)];
    let turns: [fn(Place) -> Place; 4] = [|p| p, |(x, y)| (y, -x), |(x, y)| (-x, -y), |(x, y)| (-y, x)];
    turns.iter().flat_map(|turn| quarter.map(turn)).collect()
}

/// A regular polygon with a corner above its middle, turned by a part of a full turn.
pub(super) fn regular(corners: u32, turn: f64, radius: f64) -> Vec<Place> {
    (0..corners).map(|i| on_circle(f64::from(i) / f64::from(corners) + turn, radius)).collect()
}

/// A star with five points.
pub(super) fn star((x, y): Place, radius: f64) -> Vec<Place> {
    let corner = |i: u32| on_circle(f64::from(i) / 10.0, if i.is_multiple_of(2) { radius } else { 0.42 * radius });
    (0..10).map(corner).map(|(dx, dy)| (x + dx, y + dy)).collect()
}

fn on_circle(turn: f64, radius: f64) -> Place {
    let (sin, cos) = libm::sincos(turn * core::f64::consts::TAU);
    (radius * sin, -radius * cos)
}
