//! How large a step may be, predicted from the springs.
//!
//! For masses M, stiffness matrix K and damping matrix C of the linearised body, the fastest oscillation is bounded from above:
//!
//! - **directional edge bound**: for a spring e, Σ over springs f that share an end with it of w_f |n_e·n_f|/m, with
//!   directions n and the mass m of the shared end (both ends for e itself). Exact for a chain of three. It leaves out the stiffness
//!   that a stretched spring has across its line, k(1 − L/l), which a body on an axis does not feel. By Gershgorin's theorem.
//! - **node bound**: for a particle, 2/m·Σ of w over its springs. Safe in every pose, and looser: a quarter of the limit of a cube. By the same theorem.
//! - **[Lanczos bound](largest_eigenvalue)**: near the largest eigenvalue of M⁻¹K, and of M⁻¹C, in the present pose. Where a body can move across its springs, it is the tightest
//!   of the three, and the least of them counts.

mod lanczos;
mod limit;

use bevy::math::DVec3;

use crate::body::{MassDamping, ParticleId, Particles, SpineFriction, Spring, SpringId, Strand};

use super::{BodyParts, rest_lengths};

use lanczos::{FEW, MANY, largest_eigenvalue};

/// Springs stretched so little are stiff along their lines alone, as far as a bound is concerned: k(1 − L/l) is below this part of k.
const ALONG: f64 = 0.2;

/// How much stiffer a strand is at most whose rest lengths follow its pose: the shipped ones are by 2 %.
const FOLLOWING: f64 = 1.05;

/// Bounds of one row of the body's equations, from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// κ: of M⁻¹K, a squared frequency.
    pub stiffness: f64,
    /// γ: of M⁻¹C, a rate.
    pub damping: f64,
}

/// How the damping of the springs goes with their stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damping {
    /// D = βk with the same β in every spring: modes are damped one by one.
    Proportional,
    /// Anything else.
    General,
}

/// What a method's largest stable step is computed from.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityBound {
    /// One pair of rates a spring on an axis, one for the whole body in space.
    pub rates: Vec<Rates>,
    /// How damping goes with stiffness.
    pub damping: Damping,
    /// β: no mode is damped less by the springs than γ = βκ; the least D/k of all springs.
    pub least_ratio: f64,
    /// No mode is damped more by the springs than γ = βκ with this β; the largest D/k of all springs, and infinite where nothing is known.
    pub most_ratio: f64,
    /// The rate c of damping in proportion to mass; 0 where it is given for a step.
    pub mass_damping: f64,
    /// The damping in proportion to mass that is given as a part of the velocity in each step.
    pub loss_per_step: Option<f64>,
    /// The largest rate of drag or grip, which methods with friction in their stages integrate as a force.
    pub friction: f64,
}

/// Bounds the oscillations of a body in its present pose, with its rest lengths as at `time`.
pub fn stability_bound(body: &BodyParts<'_>, time: f64) -> StabilityBound {
    let [least, most] = ratios(body);
    let (rates, least_ratio, most_ratio) = if body.on_axis() {
        (directional_rates(body), least, most)
    } else {
        let lines = lines(body, time);
        let across = lines.iter().any(|line| line.across > 0.0);
        let rates = vec![rates_in_space(body, &lines, across)];
        let squeezed = lines.iter().any(|line| line.across < 0.0);
        // Across a stretched spring there is stiffness and no damping; a squeezed one takes stiffness away.
        (rates, if across { 0.0 } else { least }, if squeezed { f64::INFINITY } else { most })
    };
    StabilityBound {
        rates,
        damping: damping_law(body),
        least_ratio,
        most_ratio,
        mass_damping: match body.mass_damping {
            Some(MassDamping::Rate(rate)) => rate,
            _ => 0.0,
        },
        loss_per_step: match body.mass_damping {
            Some(MassDamping::PerStep(loss)) => Some(loss),
            _ => None,
        },
        friction: body.friction.map_or(0.0, SpineFriction::fastest),
    }
}

impl StabilityBound {
    /// The least of a method's `limit(κ, γ)` for one oscillation x'' = −κx − γx' over all modes within the bounds, for methods whose limit first
    /// grows with γ and then falls, and falls with κ where γ goes with it.
    pub(super) fn least(&self, limit: impl Fn(f64, f64) -> f64) -> f64 {
        let stiffness = self.rates.iter().map(|rates| rates.stiffness).fold(0.0, f64::max);
        let most = self.rates.iter().map(|rates| rates.damping).fold(0.0, f64::max) + self.mass_damping + self.friction;
        let least = self.least_ratio * stiffness + self.mass_damping;
        if stiffness == 0.0 {
            return if most > 0.0 { 2.0 / most } else { f64::INFINITY };
        }
        // Damping that does not go with stiffness also meets modes that have hardly any of that.
        let alone = match self.damping {
            Damping::Proportional if self.mass_damping + self.friction == 0.0 => f64::INFINITY,
            _ => 2.0 / most,
        };
        limit(stiffness, least).min(limit(stiffness, most)).min(alone)
    }
}

/// A spring in its present pose.
#[derive(Clone, Copy, Debug)]
struct Line {
    ends: [usize; 2],
    /// From the first end to the second, of length 1; zero where the spring has no length.
    direction: DVec3,
    /// Stiffness and damping along it.
    stiffness: f64,
    damping: f64,
    /// Stiffness across it, k(1 − L/l): negative while it is squeezed.
    across: f64,
}

/// A bond of unit masses, as its largest eigenvalue is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct BondLine {
    pub(super) ends: [usize; 2],
    /// Of length 1, or zero for a bond without length, which then resists in all directions.
    pub(super) direction: DVec3,
    /// Stiffness along it.
    pub(super) stiffness: f64,
}

/// The largest eigenvalue of bonds between so many unit masses, from above.
pub(super) fn largest_bond_eigenvalue(bonds: impl Iterator<Item = BondLine>, masses: usize) -> f64 {
    let line = |BondLine { ends, direction, stiffness }| {
        let across = if direction == DVec3::ZERO { stiffness } else { 0.0 };
        Line { ends, direction, stiffness, damping: 0.0, across }
    };
    let lines: Vec<_> = bonds.map(line).collect();
    largest_eigenvalue(&lines, &vec![1.0; masses], MANY, |line| (line.stiffness, line.across))
}

/// 1 − L/l, and 0 where that is no more than the rounding errors of a body that was turned: stiffness without damping, however little, is none that
/// explicit Euler can step.
fn stretch(length: f64, rest: f64) -> f64 {
    const ROUNDING: f64 = 1e-12;
    let stretch = 1.0 - rest / length;
    if stretch.abs() < ROUNDING { 0.0 } else { stretch }
}

fn lines(body: &BodyParts<'_>, time: f64) -> Vec<Line> {
    let line = |(spring, rest): (Spring, f64)| {
        let difference = difference(body.particles, spring.ends);
        let (direction, length) = difference.normalize_and_length();
        Line {
            ends: spring.ends.map(ParticleId::index),
            direction,
            stiffness: spring.stiffness,
            damping: spring.damping,
            // A spring of no length has a direction only once it moves: any.
            across: if length > 0.0 { spring.stiffness * stretch(length, rest) } else { spring.stiffness },
        }
    };
    let torn = |i: usize| body.tearing.is_some_and(|tearing| tearing.is_torn(SpringId(i as u32)));
    let whole = body.springs.iter().zip(rest_lengths(body, time)).enumerate().filter(|(i, _)| !torn(*i));
    whole.map(|(_, spring)| line(spring)).collect()
}

/// The least of what bounds each rate of a body that can move across its springs.
fn rates_in_space(body: &BodyParts<'_>, lines: &[Line], across: bool) -> Rates {
    let inverse_mass = inverse_masses(body.particles);
    let most = |rates: Vec<Rates>| {
        rates.into_iter().fold(Rates { stiffness: 0.0, damping: 0.0 }, |a, b| Rates {
            stiffness: a.stiffness.max(b.stiffness),
            damping: a.damping.max(b.damping),
        })
    };
    let node = most(node_rates(body));
    // Of a block in space, the directional bound takes longest to find and is never the least.
    let safe = if across || body.lattice.is_some() {
        node
    } else {
        let directional = most(directional_rates(body));
        Rates { stiffness: node.stiffness.min(directional.stiffness), damping: node.damping.min(directional.damping) }
    };
    let stiffness = largest_eigenvalue(lines, &inverse_mass, FEW, |line| (line.stiffness, line.across.max(0.0)));
    let damping = match (damping_law(body), ratios(body)) {
        // C = βK but for the stiffness across stretched springs, which K has more.
        (Damping::Proportional, [ratio, _]) if lines.iter().all(|line| line.across < ALONG * line.stiffness) => {
            ratio * stiffness
        }
        _ => largest_eigenvalue(lines, &inverse_mass, FEW, |line| {
            (line.damping, if line.direction == DVec3::ZERO { line.damping } else { 0.0 })
        }),
    };
    let follows = if body.strand.is_some_and(Strand::bulge) { FOLLOWING } else { 1.0 };
    Rates { stiffness: follows * safe.stiffness.min(stiffness), damping: safe.damping.min(damping) }
}

fn difference(particles: &Particles, [a, b]: [ParticleId; 2]) -> DVec3 {
    match (particles.position(a), particles.position(b)) {
        (Some(a), Some(b)) => b - a,
        _ => DVec3::ZERO,
    }
}

fn inverse_masses(particles: &Particles) -> Vec<f64> {
    particles.masses().iter().zip(particles.pinned()).map(|(m, &pinned)| if pinned { 0.0 } else { 1.0 / m }).collect()
}

fn directional_rates(body: &BodyParts<'_>) -> Vec<Rates> {
    let inverse_mass = inverse_masses(body.particles);
    let mut springs_of = vec![Vec::new(); body.particles.len()];
    let springs: Vec<_> = body.springs.iter().collect();
    let directions: Vec<_> =
        springs.iter().map(|spring| difference(body.particles, spring.ends).normalize_or_zero()).collect();
    for (i, spring) in springs.iter().enumerate() {
        for end in spring.ends {
            springs_of[end.index()].push(i);
        }
    }
    let row = |e: usize| {
        let mut rates = Rates { stiffness: 0.0, damping: 0.0 };
        for end in springs[e].ends.map(ParticleId::index) {
            for &f in &springs_of[end] {
                // A spring of no length has a direction only once it moves: any.
                let along = if f == e || directions[e] == DVec3::ZERO || directions[f] == DVec3::ZERO {
                    1.0
                } else {
                    directions[e].dot(directions[f]).abs()
                };
                rates.stiffness += springs[f].stiffness * along * inverse_mass[end];
                rates.damping += springs[f].damping * along * inverse_mass[end];
            }
        }
        rates
    };
    (0..springs.len()).map(row).collect()
}

fn node_rates(body: &BodyParts<'_>) -> Vec<Rates> {
    let inverse_mass = inverse_masses(body.particles);
    let mut rates = vec![Rates { stiffness: 0.0, damping: 0.0 }; body.particles.len()];
    for spring in body.springs.iter() {
        for end in spring.ends.map(ParticleId::index) {
            rates[end].stiffness += 2.0 * spring.stiffness * inverse_mass[end];
            rates[end].damping += 2.0 * spring.damping * inverse_mass[end];
        }
    }
    rates
}

/// The least and the largest D/k of all springs; 0 and infinite where no spring has any stiffness.
fn ratios(body: &BodyParts<'_>) -> [f64; 2] {
    let springs = body.springs.iter().filter(|spring| spring.stiffness > 0.0 || spring.damping > 0.0);
    let ratios = springs.map(|spring| spring.damping / spring.stiffness);
    ratios.map(|ratio| [ratio; 2]).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).unwrap_or([0.0, f64::INFINITY])
}

fn damping_law(body: &BodyParts<'_>) -> Damping {
    let Some(first) = body.springs.get(SpringId(0)) else { return Damping::Proportional };
    let same = |(a, b): (f64, f64)| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    let proportional =
        body.springs.iter().all(|spring| same((spring.damping * first.stiffness, first.damping * spring.stiffness)));
    if proportional { Damping::Proportional } else { Damping::General }
}
