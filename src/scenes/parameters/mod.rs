//! Every live parameter under one path: the panel, scene files (`set`) and `--set` share this registry.
//!
//! `worm.springs.stiffness` is that of all springs of the body `worm`, `worm.springs[1].stiffness` that of one, and `jelly.block.faces.stiffness` that of all
//! springs of a block which join neighbours across faces. Muscles are counted in the order
//! of the springs that they drive; `muscle`, `legs`, `weight` and `drive` are rules of a creature of the six-matrix particle system, in the order of its file. `clock.dt` and `clock.time_scale` belong to the scene.

mod facts;
mod quantity;
mod six;

use core::ops::{Range, RangeInclusive};
use std::collections::{BTreeMap, HashMap};

use bevy::prelude::*;
use thiserror::Error;

use self::quantity::{Group, Quantity};
use super::{CurrentScene, SceneBodies};
use crate::{
    body::{BodyError, Particles, Springs},
    creatures::library::looks_like,
    mechanics::integrators::{Method, StickRule},
    physics::Clock,
};

/// One parameter as it is now.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its path, such as `worm.springs[1].stiffness`.
    pub path: String,
    /// Its value. For all springs, particles or muscles together: that of the first.
    pub value: f64,
    /// The values that are of use, for sliders; wide enough for the value that it has. [`set`] takes everything that is possible.
    pub range: RangeInclusive<f64>,
    /// Its unit, in terms of the scene's own units of length, mass and time.
    pub unit: &'static str,
    /// What it is.
    pub help: &'static str,
    /// How it is best shown.
    pub kind: Kind,
}

/// How a parameter is best shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// 0 (off) or 1 (on).
    Toggle,
}

/// Why a parameter is not set. Nothing is changed then.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ParameterError {
    /// Nothing has this path.
    #[error("there is no parameter `{path}`; {hint}")]
    Unknown {
        /// What was asked for.
        path: String,
        /// What there is instead.
        hint: String,
    },
    /// The value is not possible.
    #[error("{path}: {value} is not allowed; give {requirement}")]
    Value {
        /// The path.
        path: String,
        /// What was given.
        value: f64,
        /// What would be right.
        requirement: String,
    },
    /// The body refused it.
    #[error(transparent)]
    Body(#[from] BodyError),
}

/// The value of one parameter of one element, as saving compares them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Values {
    body: String,
    quantity: Quantity,
    values: Vec<f64>,
    /// The springs that it sets, where it is of neighbours of a kind and they all have its value.
    springs: Option<Range<usize>>,
    /// Whether one value can be set for all elements.
    one_for_all: bool,
}

/// The elements of larger bodies can be set one by one and are not listed: nobody reads a hundred thousand springs.
const MOST_LISTED: usize = 1000;

/// The groups of a body's parameters: what stands between its name and a field in a path.
pub fn groups() -> impl Iterator<Item = &'static str> {
    Group::OF_BODIES.into_iter().map(Group::name)
}

/// Every parameter of the scene: the clock's, then body by body in the order of the scene. Of more than a thousand springs or particles only what sets them all.
pub fn list(world: &mut World) -> Vec<Parameter> {
    let mut all = Vec::new();
    for quantity in [Quantity::Dt, Quantity::TimeScale] {
        all.extend(
            clock_value(world, quantity).map(|value| quantity.parameter(format!("clock.{}", quantity.field()), value)),
        );
    }
    // What cannot be set for all is set one by one, or by neighbours of a kind.
    for Values { body, quantity, values, .. } in body_values(world).into_iter().filter(|values| values.one_for_all) {
        all.extend(values.first().map(|&first| quantity.parameter(quantity.path(&body, None), first)));
        if quantity.group().is_indexed() && values.len() <= MOST_LISTED {
            let elements = values.iter().enumerate();
            all.extend(elements.map(|(i, &value)| quantity.parameter(quantity.path(&body, Some(i)), value)));
        }
    }
    all
}

/// Sets the parameter at `path`. Components whose values stay the same are not marked as changed.
///
/// A changed period takes effect from now on: the wave goes on from where it is.
///
/// # Errors
/// If there is no such parameter or the value is not possible; the message says what would be right, and nothing is changed.
pub fn set(world: &mut World, path: &str, value: f64) -> Result<(), ParameterError> {
    let (quantity, target) = resolve(world, path)?;
    if !quantity.admits(value) {
        return Err(ParameterError::Value { path: path.into(), value, requirement: quantity.requirement() });
    }
    let Some((body, index)) = target else { return set_clock(world, quantity, value) };
    let time = world.get_resource::<Clock>().map_or(0.0, Clock::time);
    quantity.write(world.entity_mut(body), index, value, time)?;
    Ok(())
}

/// Gives every body of the scene the method.
pub fn set_method(world: &mut World, method: Method) {
    for body in bodies(world) {
        if let Some(mut old) = world.get_mut::<Method>(body) {
            old.set_if_neq(method);
        }
    }
}

/// The method of the scene: that of its first body, or of its file where there is no body.
pub fn method(world: &mut World) -> Method {
    let first = bodies(world).into_iter().find_map(|body| world.get::<Method>(body).copied());
    first.or_else(|| world.get_resource::<CurrentScene>().map(|scene| scene.file.method)).unwrap_or_default()
}

/// When friction acts within a step of the scene: as for its first body with a method.
pub fn stick(world: &mut World) -> StickRule {
    bodies(world).into_iter().find_map(|body| world.get::<StickRule>(body).copied()).unwrap_or_default()
}

/// The methods of all bodies; nothing where a body has none.
pub(super) fn methods(world: &mut World) -> Vec<Option<Method>> {
    bodies(world).into_iter().map(|body| world.get::<Method>(body).copied()).collect()
}

/// The values of all bodies, element by element.
pub(super) fn body_values(world: &mut World) -> Vec<Values> {
    let mut all = Vec::new();
    for body in bodies(world) {
        let entity = world.entity(body);
        let Some(name) = entity.get::<Name>() else { continue };
        for quantity in Quantity::OF_BODIES {
            let values = quantity.read(entity);
            if !values.is_empty() {
                let springs = quantity.springs(entity).filter(|range| {
                    entity.get::<Springs>().is_some_and(|springs| springs.uniform(range.clone()).is_some())
                });
                let one_for_all = quantity.has_one_for_all(entity);
                all.push(Values { body: name.to_string(), quantity, values, springs, one_for_all });
            }
        }
    }
    all
}

/// What has to be set for the values `base` to become `now`, by path: all elements of a body at once where they are alike, else all springs between
/// neighbours of a kind where those are.
pub(super) fn changes(base: Vec<Values>, now: Vec<Values>) -> BTreeMap<String, f64> {
    let base: HashMap<_, _> = base.into_iter().map(|base| ((base.body, base.quantity), base.values)).collect();
    let mut all = BTreeMap::new();
    for Values { body, quantity, values, one_for_all, .. } in &now {
        let Some(base) = base.get(&(body.clone(), *quantity)) else { continue };
        let changed: Vec<_> = (0..values.len()).filter(|&i| base.get(i) != Some(&values[i])).collect();
        match &values[..] {
            _ if changed.is_empty() || quantity.of_all_springs().is_some() => {}
            [first, rest @ ..] if *one_for_all && rest.iter().all(|value| value == first) => {
                all.insert(quantity.path(body, None), *first);
            }
            _ => {
                let kinds =
                    now.iter().filter(|kind| kind.body == *body && kind.quantity.of_all_springs() == Some(*quantity));
                let kinds: Vec<_> = kinds.filter_map(|kind| Some((kind.springs.clone()?, kind))).collect();
                for i in changed {
                    match kinds.iter().find(|(springs, _)| springs.contains(&i)) {
                        Some((_, kind)) => all.insert(kind.quantity.path(body, None), values[i]),
                        None => all.insert(quantity.path(body, Some(i)), values[i]),
                    };
                }
            }
        }
    }
    all
}

/// The parameters of a file in the order in which they are set: what is of all springs of a body first, so that what is of some of them holds.
pub(super) fn in_order(set: &BTreeMap<String, f64>) -> impl Iterator<Item = (&str, f64)> {
    let of_all = |path: &str| path.contains(".springs.");
    let (first, then) = (set.iter().filter(move |(path, _)| of_all(path)), set.iter());
    first.chain(then.filter(move |(path, _)| !of_all(path))).map(|(path, value)| (path.as_str(), *value))
}

/// The bodies that have a name: those of the scene in its order, then others.
fn bodies(world: &mut World) -> Vec<Entity> {
    let mut found: Vec<_> = world.query_filtered::<Entity, (With<Particles>, With<Name>)>().iter(world).collect();
    let order: HashMap<_, _> = world
        .get_resource::<SceneBodies>()
        .map(|bodies| bodies.0.iter().enumerate().map(|(i, &body)| (body, i)).collect())
        .unwrap_or_default();
    found.sort_by_key(|body| (order.get(body).copied().unwrap_or(usize::MAX), *body));
    found
}

fn clock_value(world: &World, quantity: Quantity) -> Option<f64> {
    let clock = world.get_resource::<Clock>()?;
    match quantity {
        Quantity::Dt => Some(clock.dt()),
        // A clock that takes a fixed number of steps a tick has the scale of its scene when it is saved.
        _ => {
            clock.time_scale().or_else(|| world.get_resource::<CurrentScene>().map(|scene| scene.file.clock.time_scale))
        }
    }
}

fn set_clock(world: &mut World, quantity: Quantity, value: f64) -> Result<(), ParameterError> {
    if clock_value(world, quantity) == Some(value) {
        return Ok(());
    }
    let Some(mut clock) = world.get_resource_mut::<Clock>() else { return Ok(()) };
    match quantity {
        Quantity::Dt => clock.set_dt(value)?,
        _ => clock.set_time_scale(value)?,
    }
    Ok(())
}

/// A body and which of its elements, nothing for all.
type Target = (Entity, Option<usize>);

/// What a path means; no target for the clock.
fn resolve(world: &mut World, path: &str) -> Result<(Quantity, Option<Target>), ParameterError> {
    let unknown = |hint: String| ParameterError::Unknown { path: path.into(), hint };
    if let Some(field) = path.strip_prefix("clock.") {
        return match field {
            "dt" if world.contains_resource::<Clock>() => Ok((Quantity::Dt, None)),
            "time_scale" if world.contains_resource::<Clock>() => Ok((Quantity::TimeScale, None)),
            _ => Err(unknown("the clock has `clock.dt` and `clock.time_scale`".into())),
        };
    }
    let bodies = bodies(world);
    let name = |body: Entity| world.get::<Name>(body).map_or("", Name::as_str);
    // A name may hold a dot, so the longest that fits is meant.
    let body =
        bodies.iter().copied().filter(|&body| path.strip_prefix(name(body)).is_some_and(|rest| rest.starts_with('.')));
    let Some(body) = body.max_by_key(|&body| name(body).len()) else {
        let mut names: Vec<_> = bodies.iter().map(|&body| format!("`{}`", name(body))).take(20).collect();
        names.push("`clock`".into());
        return Err(unknown(format!("paths begin with {}", names.join(", "))));
    };
    let name = name(body);
    let rest = &path[name.len() + 1..];
    let (group, rest) = Group::parse(rest);
    let entity = world.entity(body);
    let present = || Quantity::OF_BODIES.into_iter().filter(|quantity| quantity.count(entity) > 0);
    let (index, rest) = match rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
        Some((index, rest)) => {
            let number = index.parse::<usize>();
            let number =
                number.map_err(|_| unknown(format!("`{index}` is no whole number; elements are counted from 0")))?;
            (Some(number), rest)
        }
        None => (None, rest),
    };
    let field = if group == Some(Group::Gravity) { rest } else { rest.strip_prefix('.').unwrap_or("?") };
    let Some(quantity) =
        present().find(|quantity| Some(quantity.group()) == group && quantity.field_in_path() == field)
    else {
        let paths: Vec<_> = present()
            .filter(|quantity| quantity.has_one_for_all(entity))
            .map(|quantity| quantity.path(name, None))
            .collect();
        let near: Vec<_> = paths.iter().filter(|known| looks_like(known, path)).cloned().collect();
        return Err(unknown(if near.is_empty() {
            format!("`{name}` has {}", paths.join(", "))
        } else {
            format!("did you mean {}?", near.join(" or "))
        }));
    };
    let count = quantity.count(entity);
    match index {
        Some(_) if !quantity.group().is_indexed() => Err(unknown(format!("give `{}`", quantity.path(name, None)))),
        Some(index) if index >= count => {
            Err(unknown(format!("`{name}` has {count} {}, counted from 0", quantity.group().name())))
        }
        None if !quantity.has_one_for_all(entity) => {
            let kinds = present().filter(|kind| kind.of_all_springs() == Some(quantity));
            let kinds: Vec<_> = kinds.map(|kind| format!("`{}`", kind.path(name, None))).collect();
            Err(unknown(format!("neighbours at different distances need different ones; give {}", kinds.join(", "))))
        }
        index => Ok((quantity, Some((body, index)))),
    }
}
