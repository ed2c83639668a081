//! How a creature file is shown that is opened without a scene: from where all of it is seen, and as fast as it wants to be watched.

use bevy::math::DVec3;

use super::Camera;
use crate::{body::longest_period, creatures::Body};

/// How far away a camera stands of what it looks at, in radii of that: it fills most of the height of a picture.
const DISTANCE: f64 = 3.2;
/// No nearer than this, in lengths: around a small creature there is something to be seen of the place.
const NEAREST: f64 = 6.0;
/// In how many seconds one cycle of a gait is shown.
const CYCLE: f64 = 2.5;

/// A camera that sees a creature from where it starts, down to the ground where it has one.
pub(super) fn camera(body: &Body, on_ground: bool) -> Camera {
    let bounds = body.particles.positions().fold(None, |bounds: Option<(DVec3, DVec3)>, at| {
        let (low, high) = bounds.unwrap_or((at, at));
        Some((low.min(at), high.max(at)))
    });
    let Some((mut low, high)) = bounds else { return Camera::default() };
    if on_ground {
        low.y = low.y.min(0.0);
    }
    let Camera::Orbit { pitch, yaw, .. } = Camera::default();
    let distance = (DISTANCE * 0.5 * low.distance(high)).max(NEAREST);
    Camera::Orbit { target: (0.5 * (low + high)).into(), distance, pitch, yaw }
}

/// How much simulated time a second shows of a creature.
pub(super) fn time_scale(body: &Body) -> f64 {
    let period = longest_period(body.muscles.as_ref(), body.waves.as_ref());
    period.map_or(1.0, |period| (period / CYCLE).clamp(0.01, 100.0))
}
