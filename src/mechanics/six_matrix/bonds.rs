//! B: bonds.

use bevy::math::DVec3;

use crate::body::{Bonds, Felt};

/// A bond longer than this many times its initial length has burst.
const LONGEST: f64 = 10.0;
/// Bonds that are shorter than this at the start, between particles in the same place, burst at ten radii.
const NOTHING: f64 = 1e-6;

/// Writes B_i(p) of every particle into `force`.
///
/// A bond gives to both of its ends at once: what it gives to the one is exactly the opposite of what it gives to the other, and in this order every sum has the
/// bits of a sum over its row.
pub(super) fn add(bonds: &Bonds, position: &[DVec3], force: &mut [DVec3]) {
    force.fill(DVec3::ZERO);
    let (relation, squares) = (bonds.relation(), bonds.squares());
    for i in 0..relation.particles() {
        let here = position[i];
        let mut own = force[i];
        for pair in relation.row(i) {
            let ((j, felt), square) = (relation.at(pair), squares[pair]);
            let apart = position[j] - here;
            let now = apart.length_squared();
            // In the same place there is no direction.
            let part = if now > 0.0 { 1.0 - square / now } else { 0.0 };
            let pull = apart * part;
            match felt {
                Felt::Both => {
                    own += pull;
                    force[j] -= pull;
                }
                Felt::First => own += pull,
                Felt::Second => force[j] -= pull,
            }
        }
        force[i] = own;
    }
    force.iter_mut().for_each(|force| *force *= bonds.stiffness());
}

/// Whether every bond is within ten times its initial length.
pub(super) fn are_whole(bonds: &Bonds, position: &[DVec3]) -> bool {
    let (relation, squares) = (bonds.relation(), bonds.squares());
    let mut whole = true;
    for i in 0..relation.particles() {
        let here = position[i];
        for pair in relation.row(i) {
            whole &= (position[relation.at(pair).0] - here).length_squared() <= longest_squared(squares[pair]);
        }
    }
    whole
}

/// The square of the length that a bond is measured by: its initial one, a radius where that is none.
#[inline]
pub(super) fn length_squared(square: f64) -> f64 {
    if square < NOTHING * NOTHING { 1.0 } else { square }
}

/// The square of the longest that a bond may become.
#[inline]
fn longest_squared(square: f64) -> f64 {
    LONGEST * LONGEST * length_squared(square)
}

/// The first bond that is too long, or of no finite length, and its ends.
pub(super) fn burst(bonds: &Bonds, position: &[DVec3]) -> Option<(usize, [usize; 2])> {
    let pairs = bonds.relation().pairs().zip(bonds.squares()).enumerate();
    let is_whole =
        |i: usize, j: usize, square: f64| (position[j] - position[i]).length_squared() <= longest_squared(square);
    pairs.into_iter().find(|&(_, ((i, j, _), &square))| !is_whole(i, j, square)).map(|(k, ((i, j, _), _))| (k, [i, j]))
}
