//! The Roller (Holopainen and Rönkkö 2007, section 4).

use serde::{Deserialize, Serialize};

use super::{Composed, DrivePlan, GroupPlan, PairPlan, ParticlePlace, RulePlan, Shape, SixSkin, WeightPlan, WheelPlan};
use crate::{
    body::{Beams, Sense, Side, Table},
    creatures::numbers,
};

/// An axle of 39 particles and two wheels of twenty, with four beams. It goes towards −z and remembers nothing.
///
/// Every field is a number of the printed formulas with the sign that makes it drive; the print lost all minus signs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Roller {
    /// The z of axle and wheels; ±1.5, which makes no difference to how it goes.
    #[serde(deserialize_with = "numbers::finite")]
    pub z: f64,
    /// From one rim particle to the next, in half turns. Printed is 0.2, which goes round twice and puts two particles in each of ten places; 0.1 gives twenty
    /// places. Both drive alike.
    #[serde(deserialize_with = "numbers::finite")]
    pub rim_angle: f64,
    /// d of all particles; 0.999.
    #[serde(deserialize_with = "numbers::finite")]
    pub damping: f64,
    /// Weight; 0.32. Below zero it flies away.
    #[serde(deserialize_with = "numbers::finite")]
    pub gravity: f64,
    /// How the beams lie.
    pub beams: Beams,
    /// What is decided. As printed, without minus signs: (left_side: (0, 1), right_side: (1, 0)), which turns it towards the edge; (1, 0) and (0, 1) drive the
    /// other wheel forwards and do better than that.
    pub table: Table,
    /// How the present rotation of a wheel is found.
    pub sense: Sense,
    /// What a touching rim particle loses of its velocity in a step; 0.02. With 0.1, 0.2 and 0.5 ever more of them get round the curves of Rough Road. Below
    /// zero it bursts.
    #[serde(deserialize_with = "numbers::finite")]
    pub friction: f64,
    /// The desired momentum of a wheel; 20.
    #[serde(deserialize_with = "numbers::finite")]
    pub speed: f64,
    /// What the sum of rim speeds is divided by; 20.
    #[serde(deserialize_with = "numbers::positive")]
    pub mean: f64,
    /// The largest control force; 10.
    #[serde(deserialize_with = "numbers::positive")]
    pub limit: f64,
}

impl Default for Roller {
    fn default() -> Self {
        Self {
            z: 1.5,
            rim_angle: 0.1,
            damping: 0.999,
            gravity: 0.32,
            beams: Beams::default(),
            table: Table::default(),
            sense: Sense::Restored,
            friction: 0.02,
            speed: 20.0,
            mean: 20.0,
            limit: 10.0,
        }
    }
}

impl Roller {
    /// How many particles it has.
    pub const PARTICLES: usize = 79;

    /// Written out in groups, relations and rules.
    pub fn composed(&self) -> Composed {
        const ALL: [&str; 3] = ["left wheel", "right wheel", "axle"];
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let axle = |i| ParticlePlace("axle".into(), i);
        let wheel = |name: &str, x| GroupPlan {
            name: name.into(),
            shape: Shape::Ring { count: 20, center: (x, 6.0, self.z), radius: 2.1, angle: self.rim_angle },
            damping: self.damping,
        };
        let row = Shape::Row { count: 39, from: (-7.0, 6.0, self.z), step: (1.0 / 3.0, 0.0, 0.0) };
        let bound =
            |of: &str, with: &[&str]| PairPlan { of: names(&[of]), with: names(with), nearer: None, farther: None };
        let drive = DrivePlan {
            left: axle(0),
            right: axle(38),
            wheels: vec![
                WheelPlan { rim: ALL[0].into(), hub: axle(0), from: axle(0), to: axle(5), side: Side::Left },
                WheelPlan { rim: ALL[1].into(), hub: axle(38), from: axle(33), to: axle(38), side: Side::Right },
            ],
            beams: self.beams,
            table: self.table,
            sense: self.sense,
            friction: self.friction,
            speed: self.speed,
            mean: self.mean,
            limit: self.limit,
        };
        Composed {
            groups: vec![
                wheel(ALL[0], -6.0),
                wheel(ALL[1], 4.5),
                GroupPlan { name: ALL[2].into(), shape: row, damping: self.damping },
            ],
            bonds: vec![
                bound("left wheel", &["left wheel", "axle"]),
                bound("right wheel", &["right wheel", "axle"]),
                bound("axle", &ALL),
            ],
            collisions: Vec::new(),
            rules: vec![
                RulePlan::Gravity(WeightPlan { on: names(&ALL), pull: self.gravity }),
                RulePlan::WheelDrive(drive),
            ],
            forward: (0.0, 0.0, -1.0),
            skin: SixSkin::Mechanical,
        }
    }
}
