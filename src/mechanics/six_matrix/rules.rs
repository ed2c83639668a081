//! R and M: what the rules of a creature come to.

use bevy::math::DVec3;

use crate::body::{Contraction, Counter, Free, Leg, Rule, Rules, Weight};

use super::{drive, road::RoadSearch};

/// What the rules read of the old state.
pub(super) struct Old<'a> {
    pub(super) position: &'a [DVec3],
    pub(super) velocity: &'a [DVec3],
    pub(super) memory: &'a [DVec3],
    /// Which particles touch the road.
    pub(super) touches: &'a [bool],
}

/// Writes R_i into `reaction` and M_i into `memory`, rule after rule. What no rule writes is remembered.
pub(super) fn apply(
    rules: &Rules,
    old: &Old<'_>,
    road: Option<&impl RoadSearch>,
    reaction: &mut [DVec3],
    memory: &mut [DVec3],
) {
    reaction.fill(DVec3::ZERO);
    memory.copy_from_slice(old.memory);
    for rule in rules.iter() {
        match rule {
            Rule::Counter(Counter { on, half }) => {
                for i in on.iter().map(|id| id.index()) {
                    let count = old.memory[i].x;
                    let back = if half - 1.0 < count { 2.0 * half } else { 0.0 };
                    memory[i] = DVec3::new(count + 1.0 - back, 0.0, 0.0);
                }
            }
            Rule::Contraction(Contraction { on, along, strength }) => {
                let [from, to] = along.map(|end| old.position[end.index()]);
                for i in on.iter().map(|id| id.index()).filter(|&i| old.memory[i].x > 0.0) {
                    reaction[i] += *strength * (to - from);
                }
            }
            Rule::Leg(leg) => step_out(leg, old, road, reaction, memory),
            Rule::Weight(Weight { on, pull }) => on.iter().for_each(|id| reaction[id.index()].y -= pull),
            Rule::Drive(drive) => {
                drive::add(drive, old.position, old.velocity, old.touches, road, reaction);
            }
        }
    }
}

/// Whether a leg may move.
pub(super) fn is_free(leg: &Leg, memory: &[DVec3]) -> bool {
    let count = memory[leg.clock.index()].x;
    match leg.free {
        Free::Contracting => 0.0 <= count,
        Free::Relaxing => count < 0.0,
    }
}

fn step_out(leg: &Leg, old: &Old<'_>, road: Option<&impl RoadSearch>, reaction: &mut [DVec3], memory: &mut [DVec3]) {
    let i = leg.particle.index();
    let here = old.position[i];
    if let Some(nearest) = road.and_then(|road| road.nearest(here)) {
        reaction[i] += leg.seek * (nearest - here);
    }
    if is_free(leg, old.memory) {
        reaction[i] += leg.push * (here - old.position[leg.from.index()]);
        memory[i] = here;
    } else {
        reaction[i] += leg.grip * (old.memory[i] - here);
    }
}
