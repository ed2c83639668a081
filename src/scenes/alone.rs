//! How a creature file is shown that is opened without a scene: from where all of it is seen, and as fast as it wants to be watched.

use bevy::math::DVec3;

use super::Camera;
use crate::{
    body::{Muscles, TravelingWaves},
    creatures::Body,
};

/// How far away a camera stands of what it looks at, in radii of that: it fills most of the height of a picture.
const DISTANCE: f64 = 3.2;
/// No nearer than this, in lengths: around a small creature there is something to be seen of the place.
const NEAREST: f64 = 6.0;
/// In how many seconds one cycle of a gait is shown.
const CYCLE: f64 = 2.5;

/// A camera that sees a creature from where it starts, down to the ground where it has one.
pub(super) fn camera(body: &Body, on_ground: bool) -> Camera {
    let Camera::Orbit { target, distance, pitch, yaw } = Camera::default();
    let bounds = body.particles.positions().fold(None, |bounds: Option<(DVec3, DVec3)>, at| {
        let (low, high) = bounds.unwrap_or((at, at));
        Some((low.min(at), high.max(at)))
    });
    let Some((mut low, high)) = bounds else { return Camera::Orbit { target, distance, pitch, yaw } };
    if on_ground {
        low.y = low.y.min(0.0);
    }
    let target = (0.5 * (low + high)).into();
    let distance = (DISTANCE * 0.5 * low.distance(high)).max(NEAREST);
    Camera::Orbit { target, distance, pitch, yaw }
}

/// How much simulated time a second shows of a creature.
pub(super) fn time_scale(body: &Body) -> f64 {
    let muscles = body.muscles.iter().flat_map(Muscles::iter).map(|muscle| muscle.period);
    let waves = body.waves.as_ref().and_then(TravelingWaves::longest_period);
    muscles.chain(waves).reduce(f64::max).map_or(1.0, |period| (period / CYCLE).clamp(0.01, 100.0))
}
