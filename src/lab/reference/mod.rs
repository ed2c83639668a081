//! Reference solutions: the motion itself, as far as rounding errors let it be known.
//!
//! Each body is followed twice, piece by piece between events that are located: by DOP853 at a tolerance of 1e-12, which is the reference, and by
//! collocation in small fixed steps, which confirms it and looks for events at other times. They share the forces and the rules of
//! friction, which known solutions confirm in the tests.

mod events;
mod flow;
mod follow;
mod kinks;
mod piece;
mod schemes;

use bevy::math::DVec3;

use crate::mechanics::{
    integrators::{Method, StickRule},
    stability_bound,
};

use self::{
    follow::{Broken, Grain, Track, follow},
    schemes::{Dop853, Gauss},
};
use super::{
    LabError, Problem, ProblemBody, Unit,
    energy::{Energies, Energy},
};

pub use follow::StickSlip;

/// The exact motion of a problem's bodies at the shared times.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Body by body, all positions at the first of the shared times, then at the second, and so on.
    pub(super) positions: Vec<Vec<DVec3>>,
    /// Body by body, all velocities at the last of the shared times.
    pub(super) velocities: Vec<Vec<DVec3>>,
    /// Body by body, its energies at the shared times.
    pub(super) energies: Vec<Energies>,
    /// When masses start and stop to slide, in order.
    pub(super) events: Vec<StickSlip>,
    /// How far it is from what confirms it.
    pub(super) error: f64,
}

impl Reference {
    /// What it is and what confirms it.
    pub const WORDS: &str = "DOP853 at rtol 1e-12 with located events, confirmed by Gauss collocation of order 6";

    /// Follows all bodies of a problem, without looking into the cache.
    ///
    /// # Errors
    /// If the budget is a gait's speed or a shape, or a body is a strand, meets a ground, or feels isotropic or Coulomb friction, of which no smooth piece is known, or the motion of one cannot be followed.
    pub fn solve(problem: &Problem) -> Result<Self, LabError> {
        let mut reference = Self {
            positions: Vec::new(),
            velocities: Vec::new(),
            energies: Vec::new(),
            events: Vec::new(),
            error: 0.0,
        };
        for (index, body) in problem.bodies.iter().enumerate() {
            let unknown = match body {
                ProblemBody { ground: Some(_), .. } => Some("a body on the ground, whose contacts are not located"),
                ProblemBody { strand: Some(_), .. } => Some("a strand, whose friction acts on sections"),
                ProblemBody { friction: Some(friction), .. } if friction.isotropic() > 0.0 => {
                    Some("isotropic friction")
                }
                ProblemBody { tearing: Some(_), .. } => Some("springs that tear"),
                ProblemBody { coulomb: Some(_), .. } => Some("Coulomb friction, whose events are not located"),
                _ => None,
            };
            // No place that a body comes to says whether its gait has the right speed or its block the right shape.
            let within = match problem.unit {
                Unit::Length => None,
                Unit::PartOfSpeed => Some("a gait speed"),
                Unit::PartOfCell => Some("a shape"),
            };
            let budget = within.map(|what| format!("its error budget is {what} within {} %", 100.0 * problem.budget));
            let what = match (unknown, budget) {
                (Some(what), Some(budget)) => format!("{what}; {budget}"),
                (None, Some(budget)) => format!("this motion; {budget}"),
                (what, None) => what.unwrap_or_default().to_owned(),
            };
            if !what.is_empty() {
                return Err(LabError::Unsupported { scene: problem.name.clone(), what });
            }
            let on_axis = body.parts(Method::default(), StickRule::default()).on_axis();
            let tracks = if on_axis { both::<1>(problem, body) } else { both::<3>(problem, body) };
            let (track, error) = tracks.map_err(|Broken { time, problem }| {
                let body = body.name.clone();
                LabError::Reference { body, time, problem }
            })?;
            reference.error = reference.error.max(error);
            reference.events.extend(track.events.iter().map(|&event| StickSlip { body: index, ..event }));
            let count = body.particles.len();
            reference.energies.push(energies(body, &track, &problem.times()));
            reference.velocities.push(track.velocities[track.velocities.len().saturating_sub(count)..].to_vec());
            reference.positions.push(track.positions);
        }
        reference.events.sort_by(|a, b| a.time.total_cmp(&b.time));
        Ok(reference)
    }

    /// Where a body's particles are at one of the shared times, counted from 0.
    pub fn positions(&self, body: usize, sample: usize) -> &[DVec3] {
        let particles = self.velocities[body].len();
        &self.positions[body][sample * particles..(sample + 1) * particles]
    }

    /// The velocities of a body's particles at the last of the shared times.
    pub fn last_velocities(&self, body: usize) -> &[DVec3] {
        &self.velocities[body]
    }

    /// When masses start and stop to slide, in order. What slides from the start is not among them.
    pub fn events(&self) -> &[StickSlip] {
        &self.events
    }

    /// How far the reference is from what confirms it, in lengths: the largest distance of any particle at any shared time.
    pub fn error(&self) -> f64 {
        self.error
    }
}

/// The energies of a body along its track.
fn energies(body: &ProblemBody, track: &Track, times: &[f64]) -> Energies {
    let (mut energies, mut particles) = (Energies::default(), body.particles.clone());
    let count = particles.len();
    for (sample, &time) in times.iter().enumerate() {
        let (positions, velocities) = particles.state_columns_mut();
        for (columns, vectors) in [(positions, &track.positions), (velocities, &track.velocities)] {
            for (i, vector) in vectors[sample * count..][..count].iter().enumerate() {
                (0..3).for_each(|axis| columns[axis][i] = vector[axis]);
            }
        }
        energies.push(Energy::of(body, &particles, time));
    }
    energies
}

/// One body by both schemes: the track of the first, and how far the other is from it.
fn both<const D: usize>(problem: &Problem, body: &ProblemBody) -> Result<(Track, f64), Broken> {
    let times = problem.times();
    let bound = stability_bound(&body.parts(Method::default(), StickRule::default()), 0.0);
    let stiffest = bound.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max).sqrt();
    let damping = bound.rates.iter().map(|rates| rates.damping).fold(0.0, f64::max);
    let drive = body.muscles.iter().flat_map(|muscles| muscles.iter()).map(|muscle| 6.3 / muscle.period);
    let rate = (stiffest + damping + bound.mass_damping + bound.friction).max(drive.fold(0.0, f64::max));
    let rate = rate.max(1.0 / problem.duration);
    let size = body.springs.iter().map(|spring| spring.rest_length).fold(0.0, f64::max);
    let size = if size > 0.0 { size } else { 1.0 };
    let grain = |parts: f64| Grain {
        // Often enough that no mass starts and stops again in between unseen.
        chunk: (problem.spacing() / parts).min(0.3 / stiffest),
        speed: 1e-14 * size * rate,
        push: 1e-13 * size * rate * rate,
    };
    let track = follow::<D>(body, &times, &mut Dop853::new(size), grain(4.0))?;
    let confirmation = follow::<D>(body, &times, &mut Gauss::new(rate, size), grain(5.0))?;
    let pairs = track.positions.iter().zip(&confirmation.positions);
    let error = pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    Ok((track, error))
}
