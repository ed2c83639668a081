//! Waves that the least rest length cuts.

use bevy::ecs::prelude::*;

use crate::body::{LEAST_REST_FRACTION, Muscles, TravelingWaves};

/// Tells that the least rest length may cut the waves of a body from now on: its muscles do not drive it as their numbers say.
#[derive(Clone, Debug, Message)]
pub struct WavesCut {
    /// The body.
    pub body: Entity,
    /// What happened, for people: body, which amplitude, and how large it may be.
    pub text: String,
}

/// The paths of amplitudes that are too large, and why.
pub(crate) fn cut_waves<'a>(
    muscles: Option<&'a Muscles>,
    waves: Option<&'a TravelingWaves>,
) -> impl Iterator<Item = (String, String)> + 'a {
    let most = 1.0 - LEAST_REST_FRACTION;
    let wide = muscles.into_iter().flat_map(Muscles::iter).filter(move |muscle| muscle.amplitude > most);
    let wide = wide.map(move |muscle| {
        let path = format!("springs[{}].muscle.amplitude", muscle.spring.0);
        let problem = format!(
            "{} is above {most}; the rest length never falls below {LEAST_REST_FRACTION} of its length, so the wave is cut",
            muscle.amplitude
        );
        (path, problem)
    });
    wide.chain(waves.filter(|waves| waves.is_cut()).map(move |waves| {
        let problem = format!(
            "their amplitudes and the steering come to {} together, above {most}; a rest length never falls below {LEAST_REST_FRACTION} of its \
             length, so the waves may be cut",
            waves.reach(),
        );
        ("waves".into(), problem)
    }))
}
