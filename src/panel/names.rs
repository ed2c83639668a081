//! What the parameters are called, by their paths.

use crate::{body::Requirement, scenes::parameters};

/// A parameter's path, taken apart: `owner.group[index].field`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Path<'a> {
    /// The body's name, or `clock`.
    pub owner: &'a str,
    /// One of the registry's groups, such as `springs`, or nothing.
    pub group: &'a str,
    /// The element, where the path names one.
    pub index: Option<usize>,
    /// The field.
    pub field: &'a str,
}

impl<'a> Path<'a> {
    /// Takes a path apart. A body's name may contain points, and so may the field of a block: `block.faces.stiffness`.
    pub fn parse(path: &'a str) -> Self {
        if let Some((rest, kind)) = path.rsplit_once('.').and_then(|(rest, _)| rest.rsplit_once('.'))
            && ["edges", "faces", "cubes"].contains(&kind)
            && let Some(owner) = rest.strip_suffix(".block").filter(|owner| !owner.is_empty())
        {
            return Self { owner, group: "block", index: None, field: &path[rest.len() + 1..] };
        }
        let (rest, field) = path.rsplit_once('.').unwrap_or(("", path));
        let (before, last) = rest.rsplit_once('.').unwrap_or(("", rest));
        let (group, index) = match last.strip_suffix(']').and_then(|last| last.split_once('[')) {
            Some((group, index)) => (group, index.parse().ok()),
            None => (last, None),
        };
        if !before.is_empty() && parameters::groups().any(|known| known == group) {
            Self { owner: before, group, index, field }
        } else {
            Self { owner: rest, group: "", index: None, field }
        }
    }
}

/// What a parameter is called and what it must be. The registry of parameters has the last word on both range and value.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// Its name with the symbol of the formulas.
    pub label: String,
    /// What a typed value must be.
    pub requirement: Requirement,
    /// The slider spans powers of ten.
    pub logarithmic: bool,
}

impl Name {
    /// The name of the parameter at `path`.
    pub fn of(path: &str) -> Self {
        use Requirement::{Finite, NonNegative, Positive};
        let path = Path::parse(path);
        let (label, requirement) = match path.field {
            "stiffness" if path.group == "bonds" => ("stiffness of bonds", NonNegative),
            "stiffness" if path.group == "collisions" => ("stiffness of collisions", NonNegative),
            "friction" => ("friction of the road", NonNegative),
            "stiffness" => ("stiffness k", NonNegative),
            "damping" => ("damping D", NonNegative),
            "rest_length" => ("rest length L", Positive),
            "mass" => ("mass m", Positive),
            "amplitude" => ("amplitude A", NonNegative),
            "period" => ("period T", Positive),
            "phase" => ("phase φ", Finite),
            "ramp" => ("ramp", NonNegative),
            "wavelength" => ("wavelength λ", Positive),
            "lead" => ("lead ψ", Finite),
            "steering" => ("steering b", Finite),
            "active" => ("muscles work", NonNegative),
            "isotropic" => ("isotropic friction μ", NonNegative),
            "brake" => ("brake", NonNegative),
            "drag" => ("forward drag μ_f", NonNegative),
            "grip" => ("side grip μ_l", NonNegative),
            "ratchet" => ("ratchet", NonNegative),
            "forward" => ("friction forward", NonNegative),
            "backward" => ("friction backward", NonNegative),
            "sideways" => ("friction sideways", NonNegative),
            "rate" => ("damping by mass c", NonNegative),
            "per_step" => ("damping a step λ", NonNegative),
            "tilt" => ("tilt", Finite),
            "edges.stiffness" => ("stiffness k of edges", NonNegative),
            "edges.rest_length" => ("rest length L of edges", Positive),
            "faces.rest_length" => ("rest length L of faces", Positive),
            "cubes.rest_length" => ("rest length L of cubes", Positive),
            "edges.damping" => ("damping D of edges", NonNegative),
            "faces.stiffness" => ("stiffness k of faces", NonNegative),
            "faces.damping" => ("damping D of faces", NonNegative),
            "cubes.stiffness" => ("stiffness k of cubes", NonNegative),
            "cubes.damping" => ("damping D of cubes", NonNegative),
            "gravity" => ("gravity g", NonNegative),
            "dt" => ("step dt", Positive),
            "time_scale" => ("time scale", NonNegative),
            other => (other, Finite),
        };
        let label = match path.index {
            Some(index) => format!("{label} of {} {index}", element(path.group)),
            None => label.into(),
        };
        Self { label, requirement, logarithmic: path.field == "dt" }
    }
}

/// What one element of a group is called.
pub fn element(group: &str) -> &str {
    match group {
        "particles" => "mass",
        other => other.strip_suffix('s').unwrap_or(other),
    }
}
