//! Live parameters (stub: those that tests of the panel need).
use core::ops::RangeInclusive;

use bevy::prelude::*;

use crate::{
    body::{BodyError, Muscles, Particles, SpineFriction, SpringId, Springs},
    mechanics::integrators::Method,
    physics::Clock,
};

/// One parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its path.
    pub path: String,
    /// Its value.
    pub value: f64,
    /// Useful values.
    pub range: RangeInclusive<f64>,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub help: &'static str,
    /// How it is shown.
    pub kind: Kind,
}

/// How a parameter is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// 0 or 1.
    Toggle,
}

/// Why a parameter is not set.
pub type ParameterError = BodyError;

/// Every parameter.
pub fn list(world: &mut World) -> Vec<Parameter> {
    let mut all = Vec::new();
    let mut add = |path: String, value: f64, range, unit, kind| {
        all.push(Parameter { path, value, range, unit, help: "what it is", kind })
    };
    if let Some(clock) = world.get_resource::<Clock>() {
        add("clock.dt".into(), clock.dt(), 1e-4..=1.0, "time", Kind::Number);
        add("clock.time_scale".into(), clock.time_scale().unwrap_or(1.0), 0.0..=30.0, "time/s", Kind::Number);
    }
    let mut bodies = world.query::<(&Name, &Particles, &Springs, Option<&Muscles>, Option<&SpineFriction>)>();
    for (name, particles, springs, muscles, friction) in bodies.iter(world) {
        let mut group = |path: &str, field: &str, unit, range: RangeInclusive<f64>, values: Vec<f64>| {
            for (index, value) in values.iter().enumerate() {
                if index == 0 {
                    add(format!("{name}.{path}.{field}"), *value, range.clone(), unit, Kind::Number);
                }
                add(format!("{name}.{path}[{index}].{field}"), *value, range.clone(), unit, Kind::Number);
            }
        };
        group("springs", "stiffness", "force/length", 0.0..=10.0, springs.iter().map(|s| s.stiffness).collect());
        group("springs", "damping", "force·time/length", 0.0..=10.0, springs.iter().map(|s| s.damping).collect());
        group("springs", "rest_length", "length", 0.1..=4.0, springs.iter().map(|s| s.rest_length).collect());
        group("particles", "mass", "mass", 0.1..=10.0, particles.masses().to_vec());
        if let Some(muscles) = muscles {
            group("muscles", "amplitude", "of L", 0.0..=0.8, muscles.iter().map(|m| m.amplitude).collect());
            group("muscles", "period", "time", 0.5..=30.0, muscles.iter().map(|m| m.period).collect());
            group("muscles", "phase", "cycles", -1.0..=1.0, muscles.iter().map(|m| m.phase).collect());
            group("muscles", "ramp", "cycles", 0.0..=5.0, muscles.iter().map(|m| m.ramp).collect());
        }
        if let Some(friction) = friction {
            add(format!("{name}.friction.drag"), friction.drag(), 0.0..=5.0, "1/time", Kind::Number);
            add(format!("{name}.friction.grip"), friction.grip(), 0.0..=20.0, "1/time", Kind::Number);
            add(format!("{name}.friction.ratchet"), friction.ratchet().into(), 0.0..=1.0, "0 or 1", Kind::Toggle);
        }
    }
    all
}

/// Sets a parameter.
///
/// # Errors
/// If it is not possible.
pub fn set(world: &mut World, path: &str, value: f64) -> Result<(), ParameterError> {
    match path {
        "clock.dt" => world.resource_mut::<Clock>().set_dt(value),
        "clock.time_scale" => world.resource_mut::<Clock>().set_time_scale(value),
        path => {
            let index =
                path.split_once("springs[").and_then(|(_, rest)| rest.split_once("].stiffness")?.0.parse().ok());
            let mut bodies = world.query::<&mut Springs>();
            for mut springs in bodies.iter_mut(world) {
                for id in
                    (0..springs.len() as u32).filter(|&id| index.is_none_or(|index: u32| index == id)).map(SpringId)
                {
                    if let (true, Some(mut spring)) = (path.ends_with("stiffness"), springs.get(id)) {
                        spring.stiffness = value;
                        springs.set(id, spring)?;
                    }
                }
            }
            Ok(())
        }
    }
}

/// Gives every body the method.
pub fn set_method(world: &mut World, method: Method) {
    for mut old in world.query::<&mut Method>().iter_mut(world) {
        old.set_if_neq(method);
    }
}

/// The method of the scene.
pub fn method(world: &mut World) -> Method {
    world.query::<&Method>().iter(world).next().copied().unwrap_or_default()
}
