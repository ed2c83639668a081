//! Frames with logarithmic axes.

use super::{
    scale::{LogScale, Tick},
    shapes::{Color, Picture, Place, Rect},
    text::{Anchor, Text},
};

/// The em of the numbers at an axis.
pub(super) const TICK_SIZE: f64 = 14.0;
const TITLE_SIZE: f64 = 16.0;
const GRID: Color = [0xdc; 3];
const FAINT_GRID: Color = [0xf0; 3];
const LINE: Color = [0x80; 3];

fn color(tick: &Tick) -> Color {
    if tick.digit == 1 { GRID } else { FAINT_GRID }
}

/// The lines of an axis from left to right, with its numbers and its title below.
pub(super) fn across(picture: &mut Picture, frame: Rect, scale: &LogScale, title: &str) {
    for tick in scale.ticks() {
        let x = scale.place(tick.value);
        picture.line([(x, frame.top), (x, frame.bottom)], color(&tick), 1.0);
        if tick.written {
            picture.line([(x, frame.bottom), (x, frame.bottom + 5.0)], LINE, 1.2);
            number(picture, tick, (x, frame.bottom + 22.0), Anchor::Middle);
        }
    }
    let middle = (frame.left + frame.right) / 2.0;
    picture.text(Text::new(title, (middle, frame.bottom + 46.0), TITLE_SIZE).anchored(Anchor::Middle));
}

/// The lines of an axis from the bottom to the top, with its numbers and its title at the left if it has one.
pub(super) fn upwards(picture: &mut Picture, frame: Rect, scale: &LogScale, title: Option<&str>) {
    for tick in scale.ticks() {
        let y = scale.place(tick.value);
        picture.line([(frame.left, y), (frame.right, y)], color(&tick), 1.0);
        if tick.written && title.is_some() {
            picture.line([(frame.left - 5.0, y), (frame.left, y)], LINE, 1.2);
            number(picture, tick, (frame.left - 9.0, y + 5.0), Anchor::End);
        }
    }
    if let Some(title) = title {
        let at = (frame.left - 66.0, (frame.top + frame.bottom) / 2.0);
        picture.text(Text { upwards: true, ..Text::new(title, at, TITLE_SIZE) }.anchored(Anchor::Middle));
    }
}

/// The frame itself.
pub(super) fn border(picture: &mut Picture, frame: Rect) {
    let corners = frame.corners();
    picture.line([corners[0], corners[1], corners[2], corners[3], corners[0]], LINE, 1.2);
}

/// Writes a digit times a power of ten. The exponent is a text of its own, because the bundled font has no raised minus.
fn number(picture: &mut Picture, tick: Tick, (x, y): Place, anchor: Anchor) {
    let base = match tick.digit {
        1 => "10".to_owned(),
        digit => format!("{digit}·10"),
    };
    let base = Text::new(base, (x, y), TICK_SIZE);
    let power = Text::new(tick.exponent.to_string().replace('-', "−"), (x, y - 6.0), 12.0);
    let width = |text: &Text| text.bounds().right - text.bounds().left;
    let (base_width, power_width) = (width(&base), width(&power));
    let split = match anchor {
        Anchor::Start => x + base_width,
        Anchor::Middle => x + (base_width - power_width) / 2.0,
        Anchor::End => x - power_width,
    };
    picture.text(Text { at: (split, y), ..base }.anchored(Anchor::End));
    picture.text(Text { at: (split + 1.0, y - 6.0), ..power });
}
