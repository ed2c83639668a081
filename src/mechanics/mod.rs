//! Mechanics.
pub mod integrators;

use crate::body::{Muscles, SpringId, Springs};

/// The rest length of a spring at a time (stub: sines without ramp).
pub fn rest_length(springs: &Springs, muscles: Option<&Muscles>, spring: SpringId, time: f64) -> f64 {
    let rest = springs.get(spring).map_or(0.0, |spring| spring.rest_length);
    let muscle = muscles.and_then(|muscles| muscles.iter().find(|muscle| muscle.spring == spring));
    muscle
        .map_or(rest, |m| rest * (1.0 + m.amplitude * libm::sin(core::f64::consts::TAU * (time / m.period - m.phase))))
}
