//! Finds room for words between marks and lines.

use super::{
    shapes::{Place, Rect},
    text::Text,
};

/// What is taken in a panel.
#[derive(Clone, Debug)]
pub(super) struct Placer {
    bounds: Rect,
    taken: Vec<Rect>,
    lines: Vec<[Place; 2]>,
}

impl Placer {
    /// Room within `bounds`.
    pub(super) fn new(bounds: Rect) -> Self {
        Self { bounds, taken: Vec::new(), lines: Vec::new() }
    }

    /// Keeps words away from a mark.
    pub(super) fn take(&mut self, mark: Rect) {
        self.taken.push(mark);
    }

    /// Keeps words away from a line, where that is possible.
    pub(super) fn take_line(&mut self, points: &[Place]) {
        self.lines.extend(points.windows(2).map(|pair| [pair[0], pair[1]]));
    }

    /// The first of `candidates` that lies on nothing; with `over_lines`, else the first that lies on lines only.
    pub(super) fn place(&mut self, candidates: impl IntoIterator<Item = Text>, over_lines: bool) -> Option<Text> {
        let mut second = None;
        for text in candidates {
            let room = text.bounds();
            let room = Rect { left: room.left - 2.0, right: room.right + 2.0, ..room };
            if !self.bounds.contains(&room) || self.taken.iter().any(|taken| taken.overlaps(&room)) {
                continue;
            }
            if !self.lines.iter().any(|[a, b]| room.clip(*a, *b).is_some()) {
                self.taken.push(room);
                return Some(text);
            }
            if over_lines && second.is_none() {
                second = Some((text, room));
            }
        }
        let (text, room) = second?;
        self.taken.push(room);
        Some(text)
    }
}

/// Places around a mark for a text, from the nearest outwards.
pub(super) fn around(text: &Text, (x, y): Place, radius: f64) -> Vec<Text> {
    use super::text::Anchor::{End, Middle, Start};
    let up = 0.27 * text.size;
    let mut places = Vec::new();
    for distance in [radius + 4.0, radius + 11.0] {
        let slant = 0.75 * distance;
        places.extend([
            (Start, x + distance, y + up),
            (Middle, x, y - distance),
            (End, x - distance, y + up),
            (Middle, x, y + distance + 0.7 * text.size),
            (Start, x + slant, y - slant),
            (Start, x + slant, y + slant + 0.6 * text.size),
            (End, x - slant, y - slant),
            (End, x - slant, y + slant + 0.6 * text.size),
        ]);
    }
    places.into_iter().map(|(anchor, x, y)| Text { at: (x, y), ..text.clone() }.anchored(anchor)).collect()
}
