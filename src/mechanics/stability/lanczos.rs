//! The largest eigenvalue of a body's matrix, by the method of Lanczos.
//!
//! M^(−½)KM^(−½) is built up in the space of a few of its powers on one vector, where it is tridiagonal; the largest eigenvalue θ of that,
//! with the eigenvector s, has an eigenvalue of the whole within β|s_last| of it, and this much is added to θ. Bare power iterations stay up
//! to 6 % below the true value, which is the wrong side. Source: B. N. Parlett, "The symmetric eigenvalue problem" (1980), ch. 13.

use bevy::math::DVec3;
use faer::{Mat, Side};

use super::Line;

/// So many steps land within 2 % above on chains, nets and blocks.
pub(super) const FEW: usize = 12;
/// So many tell apart the eigenvalues of parts that are nearly alike, as wheels are, and are for what is asked once a body: after a few steps θ is that of a mixture
/// of such modes, and what is added to it need not reach the largest.
pub(super) const MANY: usize = 60;

/// The largest eigenvalue of the matrix that the springs make with the given stiffness along and across each of them, from above, after so many steps;
/// infinite where it cannot be found.
pub(super) fn largest_eigenvalue(
    lines: &[Line],
    inverse_mass: &[f64],
    steps: usize,
    of: impl Fn(&Line) -> (f64, f64),
) -> f64 {
    let weights: Vec<_> = inverse_mass.iter().map(|inverse| inverse.sqrt()).collect();
    let mut basis = vec![start(&weights)];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let mut rest = 0.0;
    for step in 0..steps.min(3 * weights.len()) {
        let mut next = vec![DVec3::ZERO; weights.len()];
        for line in lines {
            let [a, b] = line.ends;
            let apart = basis[step][b] * weights[b] - basis[step][a] * weights[a];
            let (along, across) = of(line);
            let force = across * apart + (along - across) * apart.dot(line.direction) * line.direction;
            next[a] -= force * weights[a];
            next[b] += force * weights[b];
        }
        diagonal.push(dot(&next, &basis[step]));
        // Twice against all, so that rounding does not find the same eigenvalue again.
        for _ in 0..2 {
            for vector in &basis {
                let shadow = dot(&next, vector);
                next.iter_mut().zip(vector).for_each(|(x, v)| *x -= shadow * v);
            }
        }
        rest = dot(&next, &next).sqrt();
        let largest = diagonal.iter().copied().fold(0.0, f64::max);
        if rest <= 1e-12 * largest || rest == 0.0 {
            rest = 0.0;
            break;
        }
        next.iter_mut().for_each(|x| *x /= rest);
        basis.push(next);
        beside.push(rest);
    }
    above(&diagonal, &beside, rest).unwrap_or(f64::INFINITY)
}

/// The largest eigenvalue of the tridiagonal matrix, and how far one of the whole may be from it, together.
fn above(diagonal: &[f64], beside: &[f64], rest: f64) -> Option<f64> {
    let count = diagonal.len();
    if count == 0 {
        return Some(0.0);
    }
    let matrix = Mat::from_fn(count, count, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    });
    let found = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let last = count - 1;
    Some(found.S().column_vector()[last] + rest * found.U()[(last, last)].abs())
}

/// A vector of length 1, as good as random, so that no regularity of a body makes it blind to the stiffest mode.
fn start(weights: &[f64]) -> Vec<DVec3> {
    let mut random = 1_u32;
    let mut next = || {
        // A linear congruential generator (W. H. Press et al., "Numerical recipes", ch. 7).
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(random) / f64::from(u32::MAX) - 0.5
    };
    let mut vector: Vec<_> = (weights.iter())
        .map(|&weight| if weight > 0.0 { DVec3::new(next(), next(), next()) } else { DVec3::ZERO })
        .collect();
    let length = dot(&vector, &vector).sqrt();
    if length > 0.0 {
        vector.iter_mut().for_each(|x| *x /= length);
    }
    vector
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}
