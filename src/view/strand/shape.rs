//! The outline of an animal: how thick it is where.

/// How much wider and higher than its lattice an animal is at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Girth {
    /// Across, to the sides.
    pub wide: f32,
    /// Up and down; the belly stays where it is.
    pub high: f32,
}

/// An outline from the tail to the head.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    /// From the tail's end on, one a section.
    tail: &'static [(f32, f32)],
    /// Up to the head's end, one a section.
    head: &'static [(f32, f32)],
    /// How far the round ends reach beyond the lattice, in their radius: tail and head.
    pub caps: [f32; 2],
}

impl Outline {
    pub const WORM: Self =
        Self { tail: &[(0.5, 0.5), (0.82, 0.82)], head: &[(0.88, 0.88), (0.62, 0.62)], caps: [1.0, 1.4] };
    pub const SNAKE: Self = Self {
        tail: &[(0.12, 0.12), (0.26, 0.26), (0.42, 0.42), (0.58, 0.58), (0.74, 0.74), (0.88, 0.88)],
        head: &[(0.9, 0.86), (0.78, 0.76), (1.02, 0.78), (0.66, 0.5)],
        caps: [3.0, 1.2],
    };
    pub const CATERPILLAR: Self =
        Self { tail: &[(0.82, 0.82), (0.98, 0.98)], head: &[(0.98, 0.98), (0.92, 0.96)], caps: [0.8, 0.9] };

    /// The girth at a section of a body with so many.
    pub fn at(&self, section: usize, sections: usize) -> Girth {
        let from_head = sections - 1 - section;
        // Of a body too short for both, each end has the half next to it.
        let (wide, high) = if from_head < self.head.len() && from_head <= section {
            self.head[self.head.len() - 1 - from_head]
        } else if section < self.tail.len() {
            self.tail[section]
        } else {
            (1.0, 1.0)
        };
        Girth { wide, high }
    }
}
