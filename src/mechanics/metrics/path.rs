//! How well sections follow a path.

use bevy::math::DVec2;

/// The distance of a point from the polyline through `path`; infinite where there is none.
pub(super) fn distance(path: &[DVec2], point: DVec2) -> f64 {
    let alone = path.first().map_or(f64::INFINITY, |start| start.distance_squared(point));
    let square = path.windows(2).map(|piece| {
        let [from, to] = [piece[0], piece[1]];
        let along = to - from;
        let length = along.length_squared();
        let part = if length > 0.0 { ((point - from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        (from + along * part).distance_squared(point)
    });
    square.fold(alone, f64::min).sqrt()
}
