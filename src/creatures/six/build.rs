//! From composed data to the components of a body.

use std::collections::BTreeMap;

use bevy::math::DVec3;

use super::{
    Composed, DrivePlan, GroupPlan, LegPlan, MOST_COMPOSED, MusclePlan, PairPlan, ParticlePlace, RangePlace, RulePlan,
    Shape, Station, WeightPlan,
};
use crate::{
    body::{
        BodyError, Bonds, Collisions, Columns, Contraction, Counter, Drive, Leg, ParticleId, Rule, Rules, Weight, Wheel,
    },
    creatures::Pose,
    mechanics::six_matrix::Road,
};

/// The components of a body of the six-matrix particle system, beside its particles.
#[derive(Clone, Debug, PartialEq)]
pub struct SixBody {
    /// Damping and memory.
    pub columns: Columns,
    /// Bonds.
    pub bonds: Bonds,
    /// Collisions among its own particles.
    pub collisions: Collisions,
    /// What it does of itself.
    pub rules: Rules,
}

/// Where the particles of each group begin and end.
type Groups<'a> = BTreeMap<&'a str, core::ops::Range<u32>>;

impl Composed {
    /// How many particles it has.
    pub fn particles(&self) -> usize {
        self.groups.iter().map(|group| group.shape.count()).sum()
    }

    /// p⁰.
    pub fn rest(&self) -> Vec<DVec3> {
        self.groups.iter().flat_map(|group| group.shape.points()).collect()
    }

    /// Builds all but the particles, with the memory of legs at the places of `now`, where the particles were put.
    ///
    /// # Errors
    /// Where groups, relations and rules contradict each other, or a number is not allowed.
    pub fn build(&self, now: &[DVec3]) -> Result<SixBody, BodyError> {
        let count = self.particles();
        if count > MOST_COMPOSED {
            return Err(wrong(
                "groups",
                format!("have {count} particles together; a composed creature has at most {MOST_COMPOSED}"),
            ));
        }
        let groups = self.ranges()?;
        let rest = self.rest();
        let bonds = predicate(&self.bonds, "bonds", &groups, &rest)?;
        let collisions = predicate(&self.collisions, "collisions", &groups, &rest)?;
        let mut rules = Vec::new();
        let mut memory = vec![DVec3::ZERO; count];
        for (i, rule) in self.rules.iter().enumerate() {
            let path = format!("rules[{i}]");
            match rule {
                RulePlan::Muscle(muscle) => rules.extend(contraction(muscle, &path, &groups)?),
                RulePlan::Leg(plan) => {
                    let leg = leg(plan, &path, &groups)?;
                    let i = leg.particle.index();
                    memory[i] = now.get(i).copied().unwrap_or(rest[i]);
                    rules.push(Rule::Leg(leg));
                }
                RulePlan::Gravity(WeightPlan { on, pull }) => {
                    rules.push(Rule::Weight(Weight { on: all(&format!("{path}.on"), on, &groups)?, pull: *pull }));
                }
                RulePlan::WheelDrive(plan) => rules.push(Rule::Drive(drive(plan, &path, &groups)?)),
            }
        }
        let damping = self.groups.iter().flat_map(|group| core::iter::repeat_n(group.damping, group.shape.count()));
        Ok(SixBody {
            columns: Columns::new(damping.zip(memory))?,
            bonds: Bonds::new(rest.clone(), bonds),
            collisions: Collisions::new(count, collisions),
            rules: Rules::new(rules, count)?,
        })
    }

    fn ranges(&self) -> Result<Groups<'_>, BodyError> {
        let (mut groups, mut first) = (Groups::new(), 0);
        for (i, GroupPlan { name, shape, .. }) in self.groups.iter().enumerate() {
            let next = first + shape.count() as u32;
            if groups.insert(name.as_str(), first..next).is_some() {
                return Err(wrong(
                    &format!("groups[{i}].name"),
                    format!("`{name}` is the name of another group; give each a name of its own"),
                ));
            }
            first = next;
        }
        Ok(groups)
    }
}

impl Shape {
    fn count(&self) -> usize {
        match self {
            Self::Row { count, .. } | Self::Ring { count, .. } => *count as usize,
            Self::Points(points) => points.len(),
        }
    }

    fn points(&self) -> Vec<DVec3> {
        match *self {
            Self::Row { count, from, step } => {
                (0..count).map(|i| DVec3::from(from) + f64::from(i) * DVec3::from(step)).collect()
            }
            Self::Ring { count, center, radius, angle } => {
                let place = |i| {
                    let (sin, cos) = libm::sincos(angle * core::f64::consts::PI * f64::from(i));
                    DVec3::from(center) + radius * DVec3::new(0.0, cos, sin)
                };
                (0..count).map(place).collect()
            }
            Self::Points(ref points) => points.iter().map(|&point| point.into()).collect(),
        }
    }
}

impl Composed {
    /// The pose in which it stands on a road: its middle over a place `aside` to the right of the road's middle, its front the way the road goes and then
    /// turned by `turn` degrees, and so low that one of its particles touches the road. Nothing where no road is below it.
    pub fn pose_on(&self, road: &Road, station: Station, aside: f64, turn: f64) -> Option<Pose> {
        let (rest, (fx, _, fz)) = (self.rest(), self.forward);
        let ahead = station.ahead;
        let heading = libm::atan2(fx * ahead.z - fz * ahead.x, fx * ahead.x + fz * ahead.z).to_degrees() + turn;
        let middle = rest.iter().sum::<DVec3>() / rest.len().max(1) as f64;
        let pose = Pose { at: DVec3::ZERO, heading };
        // From above all of the road.
        let highest = road.points().iter().map(|point| point.y).fold(f64::NEG_INFINITY, f64::max);
        let over =
            (station.middle + aside * station.right()).with_y(highest + 2.0) - pose.turn(middle.with_y(0.0).into());
        let lowest = rest.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
        let at = over - lowest * DVec3::Y;
        let places: Vec<_> = rest.iter().map(|x| pose.turn((*x).into()) + at).collect();
        let down = lowered(&places, road.points())?;
        Some(Pose { at: at - down * DVec3::Y, heading })
    }
}

/// How far down a body can be moved until one of its particles touches one of the road, which is then 2 away; nothing where it would meet none.
fn lowered(body: &[DVec3], road: &[DVec3]) -> Option<f64> {
    let gaps = body.iter().flat_map(|x| {
        road.iter().filter_map(move |there| {
            let aside = (there.x - x.x) * (there.x - x.x) + (there.z - x.z) * (there.z - x.z);
            (aside < 4.0).then(|| x.y - there.y - (4.0 - aside).sqrt())
        })
    });
    gaps.reduce(f64::min)
}

fn wrong(path: &str, problem: String) -> BodyError {
    BodyError::Inconsistent { path: path.into(), problem }
}

fn range(path: &str, name: &str, groups: &Groups<'_>) -> Result<core::ops::Range<u32>, BodyError> {
    groups.get(name).cloned().ok_or_else(|| {
        let known: Vec<_> = groups.keys().map(|name| format!("`{name}`")).collect();
        wrong(path, format!("there is no group `{name}`; there are {}", known.join(", ")))
    })
}

fn all(path: &str, names: &[String], groups: &Groups<'_>) -> Result<Vec<ParticleId>, BodyError> {
    let mut all = Vec::new();
    for name in names {
        all.extend(range(path, name, groups)?.map(ParticleId));
    }
    Ok(all)
}

fn one(path: &str, ParticlePlace(name, i): &ParticlePlace, groups: &Groups<'_>) -> Result<ParticleId, BodyError> {
    let group = range(path, name, groups)?;
    let count = group.len();
    if *i as usize >= count {
        return Err(wrong(path, format!("there is no particle {i} in `{name}`; it has {count}, counted from 0")));
    }
    Ok(ParticleId(group.start + i))
}

/// A relation by particle numbers.
fn predicate<'a>(
    plans: &'a [PairPlan],
    path: &str,
    groups: &Groups<'_>,
    rest: &'a [DVec3],
) -> Result<impl Fn(usize, usize) -> bool + use<'a>, BodyError> {
    let mut sides = Vec::new();
    for (i, plan) in plans.iter().enumerate() {
        let marked = |field: &str, names: &[String]| {
            let mut marks = vec![false; rest.len()];
            all(&format!("{path}[{i}].{field}"), names, groups)?.iter().for_each(|id| marks[id.index()] = true);
            Ok(marks)
        };
        sides.push((marked("of", &plan.of)?, marked("with", &plan.with)?, plan));
    }
    Ok(move |i: usize, j: usize| {
        let distance = (rest[j] - rest[i]).length();
        let related = |(of, with, plan): &(Vec<bool>, Vec<bool>, &PairPlan)| {
            of[i]
                && with[j]
                && plan.nearer.is_none_or(|nearer| 0.0 < distance && distance < nearer)
                && plan.farther.is_none_or(|farther| farther < distance)
        };
        i != j && sides.iter().any(related)
    })
}

fn contraction(plan: &MusclePlan, path: &str, groups: &Groups<'_>) -> Result<[Rule; 2], BodyError> {
    let counting = all(&format!("{path}.counting"), &plan.counting, groups)?;
    let RangePlace(name, first, end) = &plan.on;
    let on_path = format!("{path}.on");
    let group = range(&on_path, name, groups)?;
    if first >= end || *end as usize > group.len() {
        let count = group.len();
        return Err(wrong(
            &on_path,
            format!(
                "({name}, {first}, {end}) is no stretch of it; it has {count} particles: give the first and the one behind the last"
            ),
        ));
    }
    let on: Vec<_> = (group.start + first..group.start + end).map(ParticleId).collect();
    if let Some(idle) = on.iter().find(|id| !counting.contains(id)) {
        return Err(wrong(&on_path, format!("particle {} does not count; name its group in `counting`", idle.0)));
    }
    let along = [one(&format!("{path}.from"), &plan.from, groups)?, one(&format!("{path}.to"), &plan.to, groups)?];
    Ok([
        Rule::Counter(Counter { on: counting, half: plan.half }),
        Rule::Contraction(Contraction { on, along, strength: plan.strength }),
    ])
}

fn leg(plan: &LegPlan, path: &str, groups: &Groups<'_>) -> Result<Leg, BodyError> {
    let particle = one(&format!("{path}.particle"), &plan.particle, groups)?;
    let from = plan.from.as_ref().map(|from| one(&format!("{path}.from"), from, groups)).transpose()?;
    Ok(Leg {
        particle,
        clock: one(&format!("{path}.clock"), &plan.clock, groups)?,
        free: plan.free,
        seek: plan.seek,
        push: plan.push,
        from: from.unwrap_or(particle),
        grip: plan.grip,
    })
}

fn drive(plan: &DrivePlan, path: &str, groups: &Groups<'_>) -> Result<Drive, BodyError> {
    let mut wheels = Vec::with_capacity(plan.wheels.len());
    for (i, wheel) in plan.wheels.iter().enumerate() {
        let path = |field: &str| format!("{path}.wheels[{i}].{field}");
        wheels.push(Wheel {
            rim: range(&path("rim"), &wheel.rim, groups)?.map(ParticleId).collect(),
            hub: one(&path("hub"), &wheel.hub, groups)?,
            axis: [one(&path("from"), &wheel.from, groups)?, one(&path("to"), &wheel.to, groups)?],
            side: wheel.side,
        });
    }
    Ok(Drive {
        eyes: [one(&format!("{path}.left"), &plan.left, groups)?, one(&format!("{path}.right"), &plan.right, groups)?],
        wheels,
        beams: plan.beams,
        table: plan.table,
        sense: plan.sense,
        friction: plan.friction,
        speed: plan.speed,
        mean: plan.mean,
        limit: plan.limit,
    })
}
