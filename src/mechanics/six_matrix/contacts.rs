//! C: collisions.

use bevy::math::DVec3;

use crate::body::{Collisions, Felt};

use super::{grid::TOUCH, road::RoadSearch};

/// (p_j − p_i)·min{0, 1 − 4/‖p_j − p_i‖²} of two that overlap.
#[inline]
pub(super) fn push(apart: DVec3, square: f64) -> DVec3 {
    if square > 0.0 { apart * (1.0 - TOUCH * TOUCH / square) } else { DVec3::ZERO }
}

/// Writes C_i(p) of every particle into `force`, and whether it touches the road into `touches`: first among each other, then with the road, so that every
/// sum goes by rising numbers.
pub(super) fn add(
    collisions: &Collisions,
    road: Option<&impl RoadSearch>,
    position: &[DVec3],
    force: &mut [DVec3],
    touches: &mut [bool],
) {
    force.fill(DVec3::ZERO);
    let relation = collisions.relation();
    for i in 0..relation.particles() {
        let here = position[i];
        for pair in relation.row(i) {
            let (j, felt) = relation.at(pair);
            let apart = position[j] - here;
            let square = apart.length_squared();
            if square < TOUCH * TOUCH {
                let push = push(apart, square);
                if felt != Felt::Second {
                    force[i] += push;
                }
                if felt != Felt::First {
                    force[j] -= push;
                }
            }
        }
    }
    touches.fill(false);
    if let Some(road) = road {
        for ((&here, force), touches) in position.iter().zip(&mut *force).zip(touches) {
            road.touching(here, |there| {
                let apart = there - here;
                *force += push(apart, apart.length_squared());
                *touches = true;
            });
        }
    }
    force.iter_mut().for_each(|force| *force *= collisions.stiffness());
}
