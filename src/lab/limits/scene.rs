//! The limit of a scene: where its body explodes with muscles, friction and contact.

use bevy::math::DVec3;

use crate::{
    body::{Muscles, Particles, TravelingWaves, longest_period},
    mechanics::{
        Advance, BodyParts, Model, State, Timeline, elastic_energy, kinetic_energy,
        linear::{Linear, bisect},
        momentum,
    },
};

use super::{NEAR, is_apart};

/// For how many cycles of its slowest muscle or wave a body is watched.
const CYCLES: f64 = 50.0;
/// How many steps it is watched at least.
const LEAST_STEPS: f64 = 2000.0;
/// How many steps a body of one particle is watched at most; others so many times fewer.
const MOST_STEPS: f64 = 3e5;
/// The search looks at steps that differ by this factor.
const STRIDE: f64 = 1.05;
/// The limit is found to this part of itself.
const PRECISION: f64 = 0.005;

/// How a run went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Outcome {
    /// A spring was longer than ten rest lengths, something was not finite, or the energy was more than springs can hold.
    exploded: bool,
    /// The method could not take a step.
    refused: bool,
    /// A spring pointed the other way.
    flipped: bool,
}

/// The smallest step at which the body explodes within fifty cycles of its muscles and waves (a large body within fewer), has more energy than all of
/// its springs would hold squeezed to no length, or is refused by its method: searched from half of `linearised` to four times that, or to a whole
/// cycle where that is infinite. Infinite where nothing of that happens at any of these; nothing for a body whose rates cannot be found.
pub fn scene_limit(body: &BodyParts<'_>, linearised: f64) -> Option<f64> {
    let rate = Linear::of(body)?.rate;
    // What nothing drives is tried up to steps in which its own oscillations are long over.
    let period = longest_period(body.muscles, body.waves).unwrap_or(if rate > 0.0 { 1e3 / rate } else { 1.0 });
    let (mut dt, last, stride) = match linearised {
        0.0 => (1e-3 / rate, period, STRIDE * STRIDE),
        limit if limit.is_finite() => (0.5 * limit, 4.0 * limit, STRIDE),
        _ => (f64::min(1.0 / rate, period), period, 2.0),
    };
    let fails = |dt| {
        let outcome = run(body, dt);
        outcome.exploded || outcome.refused
    };
    let mut below = dt;
    while fails(below) {
        below *= 0.7;
        if below < 1e-3 * dt {
            return Some(0.0);
        }
    }
    if below == dt {
        while !fails(dt * stride) {
            dt *= stride;
            if dt > last {
                return Some(f64::INFINITY);
            }
        }
        below = dt;
        dt *= stride;
    }
    Some(bisect(below, dt, PRECISION, |dt| !fails(dt)))
}

/// Why a body explodes at `explodes` where its linearised step grows from `linearised` on.
pub(super) fn reason(body: &BodyParts<'_>, linearised: f64, explodes: f64) -> &'static str {
    let slippery = BodyParts { friction: None, coulomb: None, ground: None, gravity: None, ..*body };
    if run(body, explodes * (1.0 + 2.0 * PRECISION)).refused {
        return "its equations have no solution there that Newton's iteration finds";
    }
    if linearised == 0.0 {
        return "what is not damped grows too slowly to explode while it is watched";
    }
    if explodes < linearised {
        return match scene_limit(&slippery, linearised) {
            Some(without) if !is_apart(linearised, without, NEAR) => {
                match body.friction.is_some() || body.coulomb.is_some() {
                    true => "friction lets masses go with a jerk",
                    false => "it falls and strikes the ground, which is no small disturbance",
                }
            }
            _ if longest_period(body.muscles, body.waves).is_none() => {
                "it moves into poses and speeds that a small disturbance does not reach"
            }
            _ => "muscles drive it into poses and speeds that a small disturbance does not reach",
        };
    }
    let between = if explodes.is_finite() { (linearised * explodes).sqrt() } else { 1.5 * linearised };
    let (with, without) = (run(body, between), run(&slippery, between));
    if without.exploded {
        "friction holds masses, and what is held does not oscillate"
    } else if with.flipped || without.flipped {
        "a spring through zero length flips: bounded rattling"
    } else {
        "the disturbance grows too slowly to explode while it is watched"
    }
}

fn run(body: &BodyParts<'_>, dt: f64) -> Outcome {
    if body.on_axis() { run_in::<1>(body, dt) } else { run_in::<3>(body, dt) }
}

fn run_in<const D: usize>(body: &BodyParts<'_>, dt: f64) -> Outcome {
    let most = (MOST_STEPS / body.particles.len() as f64).max(LEAST_STEPS);
    let steps = (CYCLES * longest_period(body.muscles, body.waves).unwrap_or(0.0) / dt).clamp(LEAST_STEPS, most) as u64;
    let mut model = Model::<f64, D>::new(body, [], dt);
    let mut state = State::<f64, D>::new(body.particles.len());
    state.set_lane(0, body.particles);
    let (mut particles, mut tearing) = (body.particles.clone(), body.tearing.cloned());
    let directions = directions(body, &particles);
    let most_energy = squeezed(body);
    let timeline = Timeline { dt, base_step: 0, base_time: 0.0 };
    let mut outcome = Outcome::default();
    for step in 0..steps {
        let method = body.method;
        Advance { model: &mut model, state: &mut state, method, timeline, first: step, steps: 1 }.run();
        outcome.refused = model.has_refused(0);
        outcome.exploded = model.has_exploded(0) || model.explosion(&state, 0).is_some();
        if outcome.refused || outcome.exploded {
            break;
        }
        state.write_lane(0, &mut particles);
        if let Some(tearing) = &mut tearing {
            // What is too long now tears where the next step begins, and holds nothing.
            model.begin_step(&state);
            tearing.set_torn(model.torn(0));
        }
        let now = BodyParts { particles: &particles, tearing: tearing.as_ref(), ..*body };
        outcome.flipped |= directions.iter().zip(self::directions(&now, &particles)).any(|(a, b)| a.dot(b) < 0.0);
        if energy(&now, timeline.time_at(step + 1)) > most_energy {
            outcome.exploded = true;
            break;
        }
    }
    outcome
}

fn directions(body: &BodyParts<'_>, particles: &Particles) -> Vec<DVec3> {
    let position = |end| particles.position(end).unwrap_or(DVec3::ZERO);
    body.springs.ends().iter().map(|&[a, b]| position(b) - position(a)).collect()
}

/// Elastic energy, and kinetic energy about the centre of mass.
fn energy(body: &BodyParts<'_>, time: f64) -> f64 {
    let mass: f64 = body.particles.masses().iter().sum();
    let whole = if mass > 0.0 { 0.5 * momentum(body.particles).length_squared() / mass } else { 0.0 };
    elastic_energy(body, time) + kinetic_energy(body.particles) - whole
}

/// What all springs hold when they are squeezed to no length with their muscles at their longest; infinite where no spring holds anything.
fn squeezed(body: &BodyParts<'_>) -> f64 {
    let muscles = body.muscles.into_iter().flat_map(Muscles::iter).map(|muscle| muscle.amplitude).fold(0.0, f64::max);
    let waves: f64 = body.waves.into_iter().flat_map(TravelingWaves::iter).map(|wave| wave.amplitude).sum();
    let amplitude = muscles.max(waves);
    let energy = |length: f64, stiffness: f64| 0.5 * stiffness * length * length;
    let all: f64 =
        body.springs.iter().map(|spring| energy((1.0 + amplitude) * spring.rest_length, spring.stiffness)).sum();
    if all > 0.0 { all } else { f64::INFINITY }
}
