//! The lattice of a snake or a worm.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, ParticleId, SpringId, Springs};

/// What a spring of a [`Strand`] is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
pub enum StrandSpring {
    /// Along the body, at one corner of one segment. Muscles drive these.
    Axial {
        /// The segment, 0 at the tail.
        segment: u32,
        /// The corner of its sections that it joins.
        corner: u32,
    },
    /// Around the body: one edge of a section, from a corner to the next.
    Circumference {
        /// The section, 0 at the tail.
        section: u32,
        /// The corner at which it begins.
        corner: u32,
    },
    /// Across a section.
    SectionDiagonal {
        /// The section, 0 at the tail.
        section: u32,
    },
    /// Across one of the four side faces of a segment.
    SideDiagonal {
        /// The segment, 0 at the tail.
        segment: u32,
        /// The corner at which the face begins; it ends at the next.
        corner: u32,
    },
}

/// A row of cubes that share faces: n segments between n + 1 sections of four masses (Miller 1988).
///
/// Section p, counted from the tail, has the particles 4p + c with the corners c = 0 left bottom, 1 right bottom, 2 right top, 3 left top, left being −z
/// where the head is at +x. Springs run along every edge and across every face, 18n + 6 in all, in this order: for each section its four edges of the
/// circumference and its two diagonals; then, for the segment in front of it, the four axial edges, and across the side faces first the four diagonals from
/// (p, c) to (p + 1, c + 1), then the four from (p, c + 1) to (p + 1, c). There are none across the inside of a cube.
///
/// The rest lengths of a strand belong together. The axial ones are driven by [`TravelingWaves`](super::TravelingWaves). A strand that bulges keeps the
/// volume of its segments: the circumference is as many times its own rest length as 1/√r, where r is how many times their rest
/// length the axial springs are long now, mean of the adjoining segments, each from ¼ to 4. Diagonals follow the edges (Ptolemy, for an isosceles
/// trapezoid): across a face with the opposite edges (L₁, L₂) and (β₁, β₂), √(L₁L₂ + β₁β₂). Fixed diagonals would hold against every bend.
#[derive(Clone, Component, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
#[reflect(Component)]
pub struct Strand {
    segments: u32,
    bulge: bool,
}

impl Strand {
    /// The strand of a body that has these springs, without bulging.
    ///
    /// # Errors
    /// If there are fewer than two segments, or the springs are not those of such a lattice.
    pub fn new(segments: u32, springs: &Springs) -> Result<Self, BodyError> {
        if segments < 2 {
            return Err(BodyError::Inconsistent {
                path: "segments".into(),
                problem: format!("{segments} is not allowed; a strand has 2 segments or more"),
            });
        }
        let strand = Self { segments, bulge: false };
        let wrong = Self::ends(segments).zip(springs.ends()).position(|(ends, given)| ends != *given);
        if strand.springs() != springs.len() || wrong.is_some() {
            let problem = match wrong {
                Some(_) => format!("does not join the particles that it joins in a strand of {segments} segments"),
                None => {
                    format!("are {} springs; a strand of {segments} segments has {}", springs.len(), strand.springs())
                }
            };
            let path = wrong.map_or("springs".into(), |spring| format!("springs[{spring}].ends"));
            return Err(BodyError::Inconsistent { path, problem });
        }
        Ok(strand)
    }

    /// Switches bulging.
    #[must_use]
    pub fn with_bulge(mut self, bulge: bool) -> Self {
        self.bulge = bulge;
        self
    }

    /// The ends of all springs of a strand, in order.
    pub fn ends(segments: u32) -> impl Iterator<Item = [ParticleId; 2]> {
        let at = |section: u32, corner: u32| ParticleId(4 * section + corner % 4);
        (0..=segments).flat_map(move |p| {
            let section =
                (0..4).map(move |c| [at(p, c), at(p, c + 1)]).chain((0..2).map(move |c| [at(p, c), at(p, c + 2)]));
            let axial = (0..4).map(move |c| [at(p, c), at(p + 1, c)]);
            let rising = (0..4).map(move |c| [at(p, c), at(p + 1, c + 1)]);
            let falling = (0..4).map(move |c| [at(p, c + 1), at(p + 1, c)]);
            let segment = axial.chain(rising).chain(falling);
            section.chain(segment.take(if p < segments { 12 } else { 0 }))
        })
    }

    /// How many segments it has.
    pub fn segments(self) -> usize {
        self.segments as usize
    }

    /// How many sections it has, one more than segments.
    pub fn sections(self) -> usize {
        self.segments() + 1
    }

    /// How many particles it has.
    pub fn particles(self) -> usize {
        4 * self.sections()
    }

    /// How many springs it has.
    pub fn springs(self) -> usize {
        18 * self.segments() + 6
    }

    /// Whether it keeps the volume of its segments.
    pub fn bulge(self) -> bool {
        self.bulge
    }

    /// The particles of a section, counted from the tail, in the order of the corners.
    pub fn section(self, section: usize) -> [ParticleId; 4] {
        core::array::from_fn(|corner| ParticleId((4 * section + corner) as u32))
    }

    /// The axial spring of a segment, counted from the tail, at a corner.
    pub fn axial(self, segment: usize, corner: usize) -> SpringId {
        SpringId((18 * segment + 6 + corner) as u32)
    }

    /// What one of its springs is for.
    pub fn role(self, spring: SpringId) -> StrandSpring {
        let (part, within) = (spring.0 / 18, spring.0 % 18);
        match within {
            0..4 => StrandSpring::Circumference { section: part, corner: within },
            4..6 => StrandSpring::SectionDiagonal { section: part },
            6..10 => StrandSpring::Axial { segment: part, corner: within - 6 },
            _ => StrandSpring::SideDiagonal { segment: part, corner: (within - 10) % 4 },
        }
    }
}
