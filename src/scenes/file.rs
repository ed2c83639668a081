//! A scene file as data.

use core::fmt;
use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize, de};

use crate::{
    body::Ground,
    creatures::{CurrentVersion, numbers, version},
    mechanics::integrators::{Method, StickRule},
    physics::Clock,
};

/// The step of the document, "0.5 milliseconds", which it takes with semi-implicit Euler. The default of every scene.
pub const DOCUMENT_DT: f64 = 0.0005;

/// How high the camera's picture is, as an angle in degrees.
pub const FIELD_OF_VIEW: f64 = 42.0;

/// A scene: what `*.scene.ron` holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Scene", deny_unknown_fields)]
pub struct SceneFile {
    /// The version of the format: 1.
    #[serde(deserialize_with = "version")]
    pub version: u32,
    /// Its title, for people.
    pub title: String,
    /// Gravity towards −y, zero or more. Left out: 0, none.
    #[serde(default, deserialize_with = "numbers::non_negative")]
    pub gravity: f64,
    /// What its creatures stand on. Left out: nothing.
    #[serde(default)]
    pub ground: Option<Ground>,
    /// The name or file of the road that creatures of the six-matrix particle system move on. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub road: Option<String>,
    /// Its creatures.
    pub creatures: Vec<Placement>,
    /// What stands around. Left out: nothing.
    #[serde(default)]
    pub props: Props,
    /// Where the camera starts. Left out: [`Camera::default`].
    #[serde(default)]
    pub camera: Camera,
    /// Its clock. Left out: [`SceneClock::default`].
    #[serde(default)]
    pub clock: SceneClock,
    /// The method of integration. Left out: semi-implicit Euler.
    #[serde(default)]
    pub method: Method,
    /// When friction acts in a step of the method. Left out: in its stages.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stick: StickRule,
    /// The name of the creature that the others are measured against: a race. Each of the others is shown over the ghost of this one. Left out: no
    /// race.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth: Option<String>,
    /// How much error it can afford. Left out: one pixel.
    #[serde(default)]
    pub budget: Budget,
    /// Parameters that differ from those of its creatures, by path, such as `"worm.springs.stiffness": 2`. Left out: none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", deserialize_with = "each_once")]
    pub set: BTreeMap<String, f64>,
}

impl SceneFile {
    /// The error that it can afford, in lengths: a pixel is one of 1080 rows of what its camera shows at the distance of its target. Nothing where the
    /// budget is none of lengths.
    pub fn budget_length(&self) -> Option<f64> {
        /// The height of the screen in pixels.
        const HEIGHT: f64 = 1080.0;
        let Camera::Orbit { distance, .. } = self.camera;
        match self.budget {
            Budget::Pixels(pixels) => {
                Some(pixels * 2.0 * distance * libm::tan(0.5 * FIELD_OF_VIEW.to_radians()) / HEIGHT)
            }
            Budget::GaitSpeed(_) | Budget::Shape { .. } => None,
        }
    }
}

/// Reads nothing but the version of a scene file.
#[derive(Deserialize)]
#[serde(rename = "Scene")]
pub(crate) struct OnlyVersion {
    #[serde(rename = "version", deserialize_with = "version")]
    _version: u32,
}

impl CurrentVersion for SceneFile {
    type OnlyVersion = OnlyVersion;
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A creature in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// What it is called in this scene; its parameter paths begin with it. No two creatures share a name.
    pub name: String,
    /// The name or file of its blueprint.
    pub creature: String,
    /// Where it is put. Left out: the origin.
    #[serde(default, deserialize_with = "numbers::vector")]
    pub at: (f64, f64, f64),
    /// Which way it looks, in degrees about the vertical; positive turns from +x towards +z. Left out: 0, along +x.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub heading: f64,
    /// Where on its road it is put, for creatures of the six-matrix particle system: just touching it; `heading` then turns it from the way that the road goes,
    /// and `at` moves it from there. Left out: it stands where its own numbers put it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on_road: Option<OnRoad>,
    /// Its own road. Left out: that of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub road: Option<String>,
    /// Its own method. Left out: that of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
}

/// A place on a road.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnRoad {
    /// The row of the road over which its middle is, counted from 0; also between rows.
    #[serde(deserialize_with = "numbers::finite")]
    pub row: f64,
    /// How far to the right of the road's middle. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub aside: f64,
}

/// What stands around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Props {
    /// Nothing.
    #[default]
    None,
    /// The garden; see [`garden`](super::garden) for its lay.
    Garden {
        /// The seed of everything random in it.
        seed: u64,
    },
}

/// Where the camera starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Camera {
    /// Looks at a target from around it.
    Orbit {
        /// What it looks at.
        #[serde(deserialize_with = "numbers::vector")]
        target: (f64, f64, f64),
        /// How far it is from the target, above zero.
        #[serde(deserialize_with = "numbers::positive")]
        distance: f64,
        /// Degrees above the horizon, from −90 to 90.
        #[serde(deserialize_with = "pitch")]
        pitch: f64,
        /// Degrees about the vertical; at 0 it stands at +z of the target.
        #[serde(deserialize_with = "numbers::finite")]
        yaw: f64,
    },
}

impl Default for Camera {
    /// Twelve lengths from the origin, 25 degrees above the horizon and turned by 30.
    fn default() -> Self {
        Self::Orbit { target: (0.0, 0.0, 0.0), distance: 12.0, pitch: 25.0, yaw: 30.0 }
    }
}

/// How much error a scene can afford.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Budget {
    /// As many pixels on a screen that shows it from where its camera starts, above zero.
    Pixels(#[serde(deserialize_with = "numbers::positive")] f64),
    /// The speed of its gaits, distance a cycle, may be wrong by this part of it, above zero: for strands, which grip and slip with so many masses that no
    /// two steps lead to the same place after many cycles.
    GaitSpeed(#[serde(deserialize_with = "numbers::positive")] f64),
    /// How its blocks fall, land, wobble and keep their shape may be wrong by a part: for blocks on a grid, whose masses meet the ground at moments that no
    /// reference locates.
    ///
    /// Three measures of each block are compared at 200 even times: its shape error and the height of its centre of mass, in spacings of its grid, and its
    /// volume over that of the undeformed grid. The largest difference in any of them is what counts, so that a part of 0.01 is a hundredth of the edge
    /// of a cell, or of the volume.
    Shape {
        /// The part, above zero.
        #[serde(deserialize_with = "numbers::positive")]
        part: f64,
        /// Until when they are compared, in simulated time, above zero: until all of them are at rest.
        #[serde(deserialize_with = "numbers::positive")]
        until: f64,
    },
}

impl Default for Budget {
    /// One pixel.
    fn default() -> Self {
        Self::Pixels(1.0)
    }
}

/// The clock of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ClockFields", into = "ClockFields")]
pub struct SceneClock {
    /// How its step is given.
    pub step: StepSize,
    /// How much simulated time passes in a second, from 0 to [`Clock::LARGEST_TIME_SCALE`].
    pub time_scale: f64,
    /// The moment, in simulated time, that it shows when it is opened: it is stepped to there at once, and stands still until it is told to go on. Nothing: it
    /// begins at 0 and goes.
    pub opens_at: Option<f64>,
}

/// How a scene gives its step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepSize {
    /// As dt, above zero.
    Dt(f64),
    /// As a number of steps in each of the 64 ticks of a second, above zero.
    Substeps(u32),
}

impl SceneClock {
    /// How many ticks a second has.
    pub const TICKS_PER_SECOND: f64 = 64.0;

    /// How many steps there are to the moment that the scene shows when it is opened, to the nearest one; 0 where it begins at 0.
    pub fn opening_steps(self) -> u64 {
        (self.opens_at.unwrap_or(0.0) / self.dt()).round().min(Clock::MOST_STEPS_A_TICK as f64) as u64
    }

    /// The step dt.
    pub fn dt(self) -> f64 {
        match self.step {
            StepSize::Dt(dt) => dt,
            StepSize::Substeps(substeps) => self.time_scale / (Self::TICKS_PER_SECOND * f64::from(substeps)),
        }
    }
}

impl Default for SceneClock {
    /// The document's step, and one unit of time a second.
    fn default() -> Self {
        Self { step: StepSize::Dt(DOCUMENT_DT), time_scale: 1.0, opens_at: None }
    }
}

/// The clock as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Clock", deny_unknown_fields)]
struct ClockFields {
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_positive")]
    dt: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "substeps")]
    substeps: Option<u32>,
    #[serde(default = "real_time", deserialize_with = "time_scale")]
    time_scale: f64,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "numbers::optional_non_negative")]
    opens_at: Option<f64>,
}

impl TryFrom<ClockFields> for SceneClock {
    type Error = &'static str;

    fn try_from(fields: ClockFields) -> Result<Self, Self::Error> {
        let step = match (fields.dt, fields.substeps) {
            (Some(_), Some(_)) => return Err("dt and substeps are both given; give one of them"),
            (None, Some(_)) if fields.time_scale == 0.0 => {
                return Err("substeps divide what a tick shows, which is nothing at time_scale: 0; give dt");
            }
            (None, Some(substeps)) => StepSize::Substeps(substeps),
            (dt, None) => StepSize::Dt(dt.unwrap_or(DOCUMENT_DT)),
        };
        Ok(Self { step, time_scale: fields.time_scale, opens_at: fields.opens_at })
    }
}

impl From<SceneClock> for ClockFields {
    fn from(clock: SceneClock) -> Self {
        let (dt, substeps) = match clock.step {
            StepSize::Dt(dt) => (Some(dt), None),
            StepSize::Substeps(substeps) => (None, Some(substeps)),
        };
        Self { dt, substeps, time_scale: clock.time_scale, opens_at: clock.opens_at }
    }
}

fn real_time() -> f64 {
    1.0
}

fn time_scale<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    between(deserializer, 0.0, Clock::LARGEST_TIME_SCALE)
}

fn pitch<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    between(deserializer, -90.0, 90.0)
}

fn between<'de, D: Deserializer<'de>>(deserializer: D, least: f64, most: f64) -> Result<f64, D::Error> {
    let value = f64::deserialize(deserializer)?;
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(de::Error::custom(format_args!("{value} is not allowed; give a number from {least} to {most}")))
    }
}

fn substeps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    match Option::<u32>::deserialize(deserializer)? {
        Some(0) => Err(de::Error::custom("0 is not allowed; give a whole number above 0")),
        substeps => Ok(substeps),
    }
}

/// A map in which no key stands twice: one of the two values would be lost.
fn each_once<'de, D: Deserializer<'de>>(deserializer: D) -> Result<BTreeMap<String, f64>, D::Error> {
    struct EachOnce;

    impl<'de> de::Visitor<'de> for EachOnce {
        type Value = BTreeMap<String, f64>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a map of parameters and numbers")
        }

        fn visit_map<A: de::MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut found = BTreeMap::new();
            while let Some((key, value)) = map.next_entry::<String, f64>()? {
                if found.contains_key(&key) {
                    return Err(de::Error::custom(format_args!("`{key}` is given twice; give it once")));
                }
                found.insert(key, value);
            }
            Ok(found)
        }
    }

    deserializer.deserialize_map(EachOnce)
}
