//! Uniform cubic B-splines: smooth through rows of control points, periodic around rings of them.

use bevy::math::Vec3;

/// The weights of four neighbouring control points at `t` from 0 to 1 between the middle two.
pub(super) fn weights(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t].map(|w| w / 6.0)
}

/// The same for the slope by `t`.
pub(super) fn slopes(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [-s * s, t * (3.0 * t - 4.0), 1.0 - 3.0 * t * t + 2.0 * t, t * t].map(|w| w * 0.5)
}

/// Σ weight·point.
pub(super) fn blend(weights: [f32; 4], points: [Vec3; 4]) -> Vec3 {
    points[0] * weights[0] + points[1] * weights[1] + points[2] * weights[2] + points[3] * weights[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_add_up_and_reproduce_straight_lines() {
        for i in 0..=10 {
            let t = i as f32 / 10.0;
            let (w, d) = (weights(t), slopes(t));
            assert!((w.iter().sum::<f32>() - 1.0).abs() < 1e-6 && d.iter().sum::<f32>().abs() < 1e-6);
            // Control points at −1, 0, 1, 2 on a line: the curve is at t, with slope 1.
            let line = |w: [f32; 4]| -w[0] + w[2] + 2.0 * w[3];
            assert!((line(w) - t).abs() < 1e-6 && (line(d) - 1.0).abs() < 1e-6, "at {t}");
            // The slope is that of the weights.
            let e = 1e-3;
            for (slope, (a, b)) in d.iter().zip(weights(t - e).iter().zip(weights(t + e))) {
                assert!((slope - (b - a) / (2.0 * e)).abs() < 1e-3, "at {t}");
            }
        }
    }

    #[test]
    fn a_ring_of_four_corners_is_round_to_three_percent() {
        let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)].map(|(y, z)| Vec3::new(0.0, y, z));
        for i in 0..=20 {
            let radius = blend(weights(i as f32 / 20.0), corners).length();
            // animals.md, section 5: .458 to .471.
            assert!((0.457..0.472).contains(&radius), "{radius}");
        }
    }
}
