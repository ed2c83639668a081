//! The Inchworm (Holopainen and Rönkkö 2007, section 3).

use serde::{Deserialize, Serialize};

use super::{Composed, GroupPlan, LegPlan, MusclePlan, PairPlan, ParticlePlace, RangePlace, RulePlan, Shape, SixSkin};
use crate::{body::Free, creatures::numbers};

/// Sixty particles in a row that are one muscle, and two legs. It goes towards +z and feels no weight.
///
/// Every field is a number of the printed formulas with the sign that makes it walk; the print lost all minus signs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Inchworm {
    /// p⁰_i = (x, 4, body_step·i + 5). −15 is the mirror image.
    #[serde(deserialize_with = "numbers::finite")]
    pub x: f64,
    /// −0.3 restored. With +0.3, and legs where they are, legs are bound to nothing and it bursts.
    #[serde(deserialize_with = "numbers::finite")]
    pub body_step: f64,
    /// The legs' x; it has the sign of x.
    #[serde(deserialize_with = "numbers::finite")]
    pub legs_x: f64,
    /// The legs are at leg_step·(i − 60) + 4.1; −15.3 restored, so that they sit at body particles 3 and 54. With both steps above zero it gets on by 0.8 a
    /// cycle without contraction, with one of them it bursts.
    #[serde(deserialize_with = "numbers::finite")]
    pub leg_step: f64,
    /// The force of the muscle; 0.1. With −0.1 it forms no arch and slides.
    #[serde(deserialize_with = "numbers::finite")]
    pub strength: f64,
    /// How many steps contraction and relaxation last each; 1000.
    #[serde(deserialize_with = "numbers::positive")]
    pub half: f64,
    /// How strongly legs seek the road; 0.5. Below zero it bursts.
    #[serde(deserialize_with = "numbers::finite")]
    pub seek: f64,
    /// How strongly the free front leg is pushed away from the tail leg; 0.2. With 0 or −0.2 it gets nowhere.
    #[serde(deserialize_with = "numbers::finite")]
    pub push: f64,
    /// How strongly a leg grips; 1. Below zero it bursts.
    #[serde(deserialize_with = "numbers::finite")]
    pub grip: f64,
    /// d of all particles; 0.95.
    #[serde(deserialize_with = "numbers::finite")]
    pub damping: f64,
}

impl Default for Inchworm {
    fn default() -> Self {
        Self {
            x: 15.0,
            body_step: -0.3,
            legs_x: 15.3,
            leg_step: -15.3,
            strength: 0.1,
            half: 1000.0,
            seek: 0.5,
            push: 0.2,
            grip: 1.0,
            damping: 0.95,
        }
    }
}

impl Inchworm {
    /// How many particles it has.
    pub const PARTICLES: usize = 62;

    /// Written out in groups, relations and rules.
    pub fn composed(&self) -> Composed {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let place = |name: &str, i| ParticlePlace(name.into(), i);
        let body = Shape::Row { count: 60, from: (self.x, 4.0, 5.0), step: (0.0, 0.0, self.body_step) };
        let legs = Shape::Row { count: 2, from: (self.legs_x, 3.8, 4.1), step: (0.0, 0.0, self.leg_step) };
        let leg = |i, free, push| {
            RulePlan::Leg(LegPlan {
                particle: place("legs", i),
                clock: place("body", 0),
                free,
                seek: self.seek,
                push,
                from: Some(place("legs", 1)).filter(|_| i == 0),
                grip: self.grip,
            })
        };
        Composed {
            groups: vec![
                GroupPlan { name: "body".into(), shape: body, damping: self.damping },
                GroupPlan { name: "legs".into(), shape: legs, damping: self.damping },
            ],
            bonds: vec![
                PairPlan { of: names(&["body"]), with: names(&["body", "legs"]), nearer: Some(2.5), farther: None },
                PairPlan { of: names(&["legs"]), with: names(&["body"]), nearer: Some(2.5), farther: None },
            ],
            collisions: vec![PairPlan {
                of: names(&["body"]),
                with: names(&["body", "legs"]),
                nearer: None,
                farther: Some(2.5),
            }],
            rules: vec![
                RulePlan::Muscle(MusclePlan {
                    counting: names(&["body"]),
                    half: self.half,
                    on: RangePlace("body".into(), 15, 45),
                    from: place("legs", 1),
                    to: place("body", 53),
                    strength: self.strength,
                }),
                leg(0, Free::Relaxing, self.push),
                leg(1, Free::Contracting, 0.0),
            ],
            forward: (0.0, 0.0, 1.0),
            skin: SixSkin::Organic,
        }
    }
}
