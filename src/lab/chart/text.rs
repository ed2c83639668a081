//! Lines of text, and the room that they take.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, ScaleFont};
use epaint_default_fonts::UBUNTU_LIGHT;

use super::shapes::{Color, Place, Rect};

/// The height from the lowest to the highest part of a glyph in the bundled font, in ems.
pub(super) const LINE_HEIGHT: f64 = 1.121;

/// Which part of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its begin.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// What it says.
    pub text: String,
    /// Where its baseline is.
    pub at: Place,
    /// The em, in pixels.
    pub size: f64,
    /// Its colour.
    pub color: Color,
    /// Which part of it stands at its place.
    pub anchor: Anchor,
    /// Whether it reads from the bottom to the top.
    pub upwards: bool,
}

impl Text {
    /// A text in dark grey that begins at `at`.
    pub fn new(text: impl Into<String>, at: Place, size: f64) -> Self {
        // What no font shows must not stand in an SVG either.
        let text = text.into().replace(char::is_control, " ");
        Self { text, at, size, color: [0x33; 3], anchor: Anchor::Start, upwards: false }
    }

    /// The same, anchored otherwise.
    pub fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    /// The same in another colour.
    pub fn colored(self, color: Color) -> Self {
        Self { color, ..self }
    }

    /// The room that it takes.
    pub fn bounds(&self) -> Rect {
        let width = text_width(&self.text, self.size);
        let before = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let (x, y) = self.at;
        let (ascent, descent) = (0.75 * self.size, 0.22 * self.size);
        if self.upwards {
            Rect { left: x - ascent, top: y + before - width, right: x + descent, bottom: y + before }
        } else {
            Rect { left: x - before, top: y - ascent, right: x - before + width, bottom: y + descent }
        }
    }
}

/// How wide a text is, in pixels, with an em of `size`.
pub fn text_width(text: &str, size: f64) -> f64 {
    static FONT: LazyLock<Option<FontRef<'static>>> = LazyLock::new(|| FontRef::try_from_slice(UBUNTU_LIGHT).ok());
    let Some(font) = &*FONT else { return 0.55 * size * text.chars().count() as f64 };
    let font = font.as_scaled((size * LINE_HEIGHT) as f32);
    text.chars().map(|letter| f64::from(font.h_advance(font.glyph_id(letter)))).sum()
}

/// Breaks a text between words so that no line is wider than `width`.
pub fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let space = |letter: char| letter.is_whitespace() || letter.is_control();
    for word in text.split(space).filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}
