//! One parameter as the panel holds it, and the rules by which a typed value is taken or refused.

use core::ops::RangeInclusive;

use super::names::Name;
use crate::{body::Requirement, scenes::parameters::Kind};

/// One live parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Its path, such as `worm.springs[1].stiffness`.
    pub path: String,
    /// What it is called, with the symbol of the formulas.
    pub label: String,
    /// Its value.
    pub value: f64,
    /// Its value when the scene was loaded.
    pub default: f64,
    /// What a typed value must be.
    pub requirement: Requirement,
    /// What the slider spans: the values that are of use.
    pub range: RangeInclusive<f64>,
    /// The slider spans powers of ten.
    pub logarithmic: bool,
    /// Its unit.
    pub unit: String,
    /// What it does.
    pub help: String,
    /// What kind of control it gets.
    pub kind: Kind,
    /// Its single elements are shown.
    pub unfolded: bool,
    /// What is being typed, while a field has the focus.
    pub draft: Option<String>,
    /// Why the last value was not taken.
    pub refusal: Option<String>,
}

impl Setting {
    /// A parameter at `path` with its value, which is the default too, and the range of its slider.
    pub fn new(path: &str, value: f64, range: RangeInclusive<f64>) -> Self {
        let Name { label, requirement, logarithmic } = Name::of(path);
        Self {
            path: path.into(),
            label,
            value,
            default: value,
            requirement,
            range,
            logarithmic,
            unit: String::new(),
            help: String::new(),
            kind: Kind::Number,
            unfolded: false,
            draft: None,
            refusal: None,
        }
    }

    /// The value as it is written in its field.
    pub fn text(&self) -> String {
        number_text(self.value)
    }

    /// The value that `text` means.
    ///
    /// # Errors
    /// Why it is refused, naming the parameter and what would be right, if it is no number or not what the parameter must be.
    pub fn parse(&self, text: &str) -> Result<f64, String> {
        let (text, label, right) = (text.trim(), &self.label, self.requirement);
        let Ok(value) = text.replace('−', "-").parse::<f64>() else {
            let hint = if text.contains(',') { ", with a point before its decimals" } else { "" };
            return Err(format!("{label}: “{text}” is not a number; give {right}{hint}"));
        };
        if right.admits(value) { Ok(value) } else { Err(format!("{label}: {text} is not allowed; give {right}")) }
    }
}

/// A number in at most six significant digits, as short as it goes.
pub fn number_text(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { value.to_string() };
    }
    // Through the exponent form, so that small and large numbers keep six digits too.
    let rounded = format!("{value:.5e}").parse::<f64>().unwrap_or(value);
    if (1e-5..1e9).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}
