//! Values of flags, and times in whole steps.

use crate::{body::Requirement, mechanics::integrators::Method};

/// A time or a step, above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, Requirement::Positive)
}

/// A time from the start, zero or more.
pub(super) fn non_negative(text: &str) -> Result<f64, String> {
    number(text, Requirement::NonNegative)
}

fn number(text: &str, requirement: Requirement) -> Result<f64, String> {
    let value = text.parse().map_err(|_| format!("give {requirement}"))?;
    if requirement.admits(value) { Ok(value) } else { Err(format!("give {requirement}")) }
}

/// A method by its name.
pub(super) fn method(text: &str) -> Result<Method, String> {
    Method::ALL
        .into_iter()
        .find(|method| method.name().eq_ignore_ascii_case(text))
        .ok_or_else(|| format!("the methods are {}", Method::ALL.map(Method::name).join(", ")))
}

/// `PATH=VALUE`; a toggle may be `true` or `false`.
pub(super) fn assignment(text: &str) -> Result<(String, f64), String> {
    let (path, value) = text.split_once('=').ok_or("give PATH=VALUE, such as worm.springs.stiffness=2")?;
    let value = value.trim();
    let number = match value {
        "true" => 1.0,
        "false" => 0.0,
        value => value.parse().map_err(|_| format!("`{value}` is no number"))?,
    };
    Ok((path.trim().into(), number))
}

/// How many steps of `dt` make up `time`, if they are whole.
///
/// Decimal fractions such as 20/0.0005 miss a whole number by a rounding error, so a relative 1e-9 is let through.
pub(super) fn whole_steps(time: f64, dt: f64) -> Option<u64> {
    const MOST: f64 = (1_u64 << 53) as f64;
    let steps = time / dt;
    let whole = steps.round();
    let tolerance = (1e-9 * whole.max(1.0)).min(1e-3);
    (whole <= MOST && (steps - whole).abs() <= tolerance).then_some(whole as u64)
}

/// More steps than anyone waits for.
pub(super) const MOST_STEPS: f64 = 1e12;

/// As [`whole_steps`], with a message that has the flag and the nearest times that fit.
pub(super) fn steps_of_flag(flag: &str, time: f64, dt: f64) -> Result<u64, String> {
    whole_steps(time, dt).ok_or_else(|| {
        let below = (time / dt).floor();
        if below > MOST_STEPS {
            return too_many_steps(flag, time, dt);
        }
        let (before, after) = (time_of(below, dt), time_of(below + 1.0, dt));
        format!("{flag} {time} is no whole number of steps of dt {dt}; the nearest that are: {before} and {after}")
    })
}

/// Says that a time takes too many steps.
pub(super) fn too_many_steps(flag: &str, time: f64, dt: f64) -> String {
    let steps = (time / dt).floor();
    format!("{flag} {time:e} is {steps:e} steps of dt {dt:e}; give a shorter time or a larger dt")
}

/// When so many steps have ended. Without the rounding errors of a product: the nearest number of twelve digits is taken for the same time.
pub(super) fn time_of(steps: f64, dt: f64) -> f64 {
    let time = steps * dt;
    format!("{time:.11e}").parse().unwrap_or(time)
}
