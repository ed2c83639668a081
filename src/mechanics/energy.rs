//! Quantities that mechanics conserves, or loses in a known way.

use bevy::math::DVec3;

use crate::body::{Particles, SpringId};

use super::{BodyParts, rest_lengths};

/// Kinetic energy, ½ Σ m v².
pub fn kinetic_energy(particles: &Particles) -> f64 {
    particles.velocities().zip(particles.masses()).map(|(v, m)| 0.5 * m * v.length_squared()).sum()
}

/// Elastic energy at `time`, ½ Σ k (l − L)² over the springs that are not torn.
pub fn elastic_energy(body: &BodyParts<'_>, time: f64) -> f64 {
    let positions: Vec<_> = body.particles.positions().collect();
    let energy = |(spring, rest): (crate::body::Spring, f64)| {
        let [a, b] = spring.ends.map(|end| positions[end.index()]);
        let stretch = a.distance(b) - rest;
        0.5 * spring.stiffness * stretch * stretch
    };
    let torn = |i: usize| body.tearing.is_some_and(|tearing| tearing.is_torn(SpringId(i as u32)));
    let whole = body.springs.iter().zip(rest_lengths(body, time)).enumerate().filter(|(i, _)| !torn(*i));
    whole.map(|(_, spring)| energy(spring)).sum()
}

/// Energy in the field of gravity, Σ m g y; zero for what lies at y = 0.
pub fn gravity_energy(body: &BodyParts<'_>) -> f64 {
    let acceleration = body.gravity.map_or(0.0, |gravity| gravity.acceleration());
    body.particles.positions().zip(body.particles.masses()).map(|(x, m)| m * acceleration * x.y).sum()
}

/// Momentum, Σ m v.
pub fn momentum(particles: &Particles) -> DVec3 {
    particles.velocities().zip(particles.masses()).map(|(v, &m)| v * m).sum()
}

/// Angular momentum about the origin, Σ m x × v.
///
/// That of a free body stays, but for rounding, by semi-implicit Euler, Störmer–Verlet, damped Verlet without damping by mass, leapfrog, and the implicit midpoint rule: they kick
/// masses along the lines between places at which these stay meanwhile, and move them along velocities between the kicks. Runge–Kutta methods keep it to
/// their order, since stages see forces and velocities of different places; both Euler methods that evaluate at one end of a step alone, to order 1, and so does XPBD,
/// which pushes along lines that turn within the step. Every method keeps momentum.
pub fn angular_momentum(particles: &Particles) -> DVec3 {
    let moments = particles.positions().zip(particles.velocities()).zip(particles.masses());
    moments.map(|((x, v), &m)| x.cross(v) * m).sum()
}
