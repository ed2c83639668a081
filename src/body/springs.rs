//! The springs of a body.

use core::ops::Range;

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, ParticleId, Particles, Requirement, check};

/// One of a body's springs, counted from 0 in the order of its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub struct SpringId(pub u32);

impl SpringId {
    /// The id as an index into arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One spring as plain data. Its force along the line from one end to the other is f = k(L − l) − D·dl/dt
/// (Miller 1988, as quoted in "The Motion Dynamics of Snakes and Worms", G. S. Owen).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The two particles that it joins.
    pub ends: [ParticleId; 2],
    /// Stiffness k, force a length; zero or more.
    pub stiffness: f64,
    /// Spring damping coefficient D, force a velocity; zero or more.
    pub damping: f64,
    /// Rest length L without any muscle; above zero.
    pub rest_length: f64,
}

impl Spring {
    fn check(&self, index: usize, particles: usize) -> Result<(), BodyError> {
        for end in self.ends {
            if end.index() >= particles {
                return Err(BodyError::Missing {
                    path: format!("springs[{index}].ends"),
                    what: "particle",
                    index: end.0,
                    count: particles,
                });
            }
        }
        if self.ends[0] == self.ends[1] {
            return Err(BodyError::Inconsistent {
                path: format!("springs[{index}].ends"),
                problem: format!("joins particle {} to itself; give two different particles", self.ends[0].0),
            });
        }
        check(self.stiffness, Requirement::NonNegative, || format!("springs[{index}].stiffness"))?;
        check(self.damping, Requirement::NonNegative, || format!("springs[{index}].damping"))?;
        check(self.rest_length, Requirement::Positive, || format!("springs[{index}].rest_length"))?;
        Ok(())
    }
}

/// What springs in a row have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
struct Law {
    stiffness: f64,
    damping: f64,
    rest_length: f64,
}

/// Springs in a row that have the same law, up to the one before `end`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
struct Run {
    end: usize,
    law: Law,
}

/// The springs of a body: the ends of each, and stiffness, damping and rest length of each run of springs that have the same. A lattice of a million
/// springs has as many runs as kinds of neighbours.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Springs {
    particles: usize,
    ends: Vec<[ParticleId; 2]>,
    /// Whether a spring was given other ends than it was made with: what knows the springs by their order then knows them no more.
    rewired: bool,
    /// In order; no two beside each other have the same law.
    runs: Vec<Run>,
}

impl Springs {
    /// Builds the springs of a body that has `particles`.
    ///
    /// # Errors
    /// If an end is not a particle, a spring joins a particle to itself, a stiffness or damping is negative or not finite, or a rest
    /// length is not above zero.
    pub fn new(springs: impl IntoIterator<Item = Spring>, particles: &Particles) -> Result<Self, BodyError> {
        let mut all = Self { particles: particles.len(), ..Self::default() };
        for (index, spring) in springs.into_iter().enumerate() {
            spring.check(index, all.particles)?;
            all.ends.push(spring.ends);
            all.push_law(index + 1, law(&spring));
        }
        Ok(all)
    }

    /// How many springs there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no spring.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The spring as plain data, or nothing where there is no such spring.
    pub fn get(&self, id: SpringId) -> Option<Spring> {
        let i = id.index();
        (i < self.len()).then(|| spring(self.ends[i], self.runs[self.run_of(i)].law))
    }

    /// Replaces a spring.
    ///
    /// # Errors
    /// As [`new`](Self::new), and where there is no such spring; nothing is changed then.
    pub fn set(&mut self, id: SpringId, spring: Spring) -> Result<(), BodyError> {
        let i = id.index();
        if i >= self.len() {
            return Err(BodyError::Missing {
                path: format!("springs[{i}]"),
                what: "spring",
                index: id.0,
                count: self.len(),
            });
        }
        spring.check(i, self.particles)?;
        self.rewired |= self.ends[i] != spring.ends;
        self.ends[i] = spring.ends;
        self.set_law(i, law(&spring));
        Ok(())
    }

    /// All springs in order, as plain data.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Spring> + '_ {
        let mut run = 0;
        (0..self.len()).map(move |i| {
            run += usize::from(self.runs[run].end == i);
            spring(self.ends[i], self.runs[run].law)
        })
    }

    /// The ends of every spring, in order.
    pub fn ends(&self) -> &[[ParticleId; 2]] {
        &self.ends
    }

    /// The first of these springs, if all of them have its stiffness, damping and rest length; nothing where they differ, there is none, or a spring was given other
    /// ends since all were made.
    pub fn uniform(&self, range: Range<usize>) -> Option<Spring> {
        let last =
            range.end.checked_sub(1).filter(|&last| last >= range.start && last < self.len() && !self.rewired)?;
        let run = self.run_of(range.start);
        (last < self.runs[run].end).then(|| spring(self.ends[range.start], self.runs[run].law))
    }

    /// The run that a spring is in.
    fn run_of(&self, spring: usize) -> usize {
        self.runs.partition_point(|run| run.end <= spring)
    }

    /// Adds a law to the end.
    fn push_law(&mut self, end: usize, law: Law) {
        match self.runs.last_mut() {
            Some(last) if last.law == law => last.end = end,
            _ => self.runs.push(Run { end, law }),
        }
    }

    fn set_law(&mut self, spring: usize, law: Law) {
        let at = self.run_of(spring);
        if self.runs[at].law == law {
            return;
        }
        // The run falls into what is before the spring, the spring, and what is after it; those that turn out alike are one.
        let from = at.saturating_sub(1);
        let upto = (at + 2).min(self.runs.len());
        let mut parts = self.runs[from..upto].to_vec();
        let old = parts[at - from];
        let whole = [(spring, old.law), (spring + 1, law), (old.end, old.law)].map(|(end, law)| Run { end, law });
        parts.splice(at - from..=at - from, whole);
        let mut start = if from == 0 { 0 } else { self.runs[from - 1].end };
        let mut joined: Vec<Run> = Vec::with_capacity(parts.len());
        for part in parts {
            if part.end == start {
                continue;
            }
            start = part.end;
            match joined.last_mut() {
                Some(last) if last.law == part.law => last.end = part.end,
                _ => joined.push(part),
            }
        }
        self.runs.splice(from..upto, joined);
    }
}

fn law(spring: &Spring) -> Law {
    Law { stiffness: spring.stiffness, damping: spring.damping, rest_length: spring.rest_length }
}

fn spring(ends: [ParticleId; 2], law: Law) -> Spring {
    Spring { ends, stiffness: law.stiffness, damping: law.damping, rest_length: law.rest_length }
}
