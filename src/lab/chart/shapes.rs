//! A picture as lines, areas and texts, before any of them is drawn.

use super::text::Text;

/// A place in a picture, in pixels from its upper left corner.
pub type Place = (f64, f64);

/// Red, green and blue.
pub type Color = [u8; 3];

/// An upright rectangle of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Its left edge.
    pub left: f64,
    /// Its upper edge.
    pub top: f64,
    /// Its right edge.
    pub right: f64,
    /// Its lower edge.
    pub bottom: f64,
}

impl Rect {
    /// The square around a place that is `radius` from each side.
    pub fn around((x, y): Place, radius: f64) -> Self {
        Self { left: x - radius, top: y - radius, right: x + radius, bottom: y + radius }
    }

    /// Whether the two share more than an edge.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    /// Whether it has `other` inside.
    pub fn contains(&self, other: &Self) -> bool {
        self.left <= other.left && other.right <= self.right && self.top <= other.top && other.bottom <= self.bottom
    }

    /// The part of the straight line from `a` to `b` that lies inside, if any (Liang and Barsky).
    pub fn clip(&self, a: Place, b: Place) -> Option<[Place; 2]> {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        let edges = [(-dx, a.0 - self.left), (dx, self.right - a.0), (-dy, a.1 - self.top), (dy, self.bottom - a.1)];
        for (direction, distance) in edges {
            if direction == 0.0 {
                if distance < 0.0 {
                    return None;
                }
            } else if direction < 0.0 {
                from = from.max(distance / direction);
            } else {
                to = to.min(distance / direction);
            }
        }
        let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
        (from < to).then(|| [at(from), at(to)])
    }

    /// Its corners.
    pub fn corners(&self) -> Vec<Place> {
        vec![(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)]
    }
}

/// One thing in a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A line through places.
    Line {
        /// Where it goes.
        points: Vec<Place>,
        /// Its colour.
        color: Color,
        /// How wide it is, in pixels.
        width: f64,
    },
    /// The inside of a polygon.
    Area {
        /// The corners.
        points: Vec<Place>,
        /// Its colour.
        color: Color,
        /// How much it covers, from 0 to 1.
        alpha: f64,
    },
    /// A line of text.
    Text(Text),
}

/// A picture: what is later lies over what is earlier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// What is in it.
    pub shapes: Vec<Shape>,
}

impl Picture {
    /// How wide every picture is, in pixels.
    pub const WIDTH: f64 = 1600.0;
    /// How high every picture is, in pixels.
    pub const HEIGHT: f64 = 900.0;

    /// All of its texts.
    pub fn texts(&self) -> impl Iterator<Item = &Text> {
        self.shapes.iter().filter_map(|shape| match shape {
            Shape::Text(text) => Some(text),
            _ => None,
        })
    }

    pub(super) fn line(&mut self, points: impl Into<Vec<Place>>, color: Color, width: f64) {
        self.shapes.push(Shape::Line { points: points.into(), color, width });
    }

    pub(super) fn area(&mut self, points: Vec<Place>, color: Color, alpha: f64) {
        self.shapes.push(Shape::Area { points, color, alpha });
    }

    pub(super) fn text(&mut self, text: Text) {
        self.shapes.push(Shape::Text(text));
    }

    /// A line in dashes of the lengths of `pattern`, by turns drawn and left out; a whole line where it is empty.
    pub(super) fn dashed(&mut self, points: &[Place], pattern: &[f64], color: Color, width: f64) {
        if pattern.is_empty() {
            return self.line(points, color, width);
        }
        let (mut turn, mut left) = (0, pattern[0]);
        let mut dash = Vec::new();
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let length = libm::hypot(b.0 - a.0, b.1 - a.1);
            let mut done = 0.0;
            while done < length {
                let here = |at: f64| (a.0 + (b.0 - a.0) * at / length, a.1 + (b.1 - a.1) * at / length);
                if turn % 2 == 0 && dash.is_empty() {
                    dash.push(here(done));
                }
                let stride = left.min(length - done);
                done += stride;
                left -= stride;
                if turn % 2 == 0 {
                    dash.push(here(done));
                }
                if left <= 0.0 {
                    if !dash.is_empty() {
                        self.line(core::mem::take(&mut dash), color, width);
                    }
                    turn = (turn + 1) % pattern.len();
                    left = pattern[turn];
                }
            }
        }
        if dash.len() > 1 {
            self.line(dash, color, width);
        }
    }
}
