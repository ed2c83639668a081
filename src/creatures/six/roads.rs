//! Roads as files: forms with numbers, which become particles.

use core::f64::consts::{PI, TAU};

use bevy::math::DVec3;
use serde::{Deserialize, Serialize};

use super::Course;
use crate::{
    body::BodyError,
    creatures::{MOST_PARTICLES, numbers, parse},
    mechanics::six_matrix::Road,
};

/// A road: what `*.road.ron` holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Road", deny_unknown_fields)]
pub struct RoadFile {
    /// The version of the format: 1.
    #[serde(deserialize_with = "parse::version")]
    pub version: u32,
    /// Its form.
    pub form: RoadForm,
}

/// Reads nothing but the version of a road file.
#[derive(Deserialize)]
#[serde(rename = "Road")]
pub struct OnlyVersion {
    #[serde(rename = "version", deserialize_with = "parse::version")]
    _version: u32,
}

impl parse::CurrentVersion for RoadFile {
    type OnlyVersion = OnlyVersion;
}

/// The form of a road, which goes on in rows of particles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum RoadForm {
    /// A straight, level strip.
    Strip(Strip),
    /// Rough Road.
    Rough(Rough),
    /// A ramp that winds upwards.
    Helix(Helix),
    /// Along points.
    Course(Course),
}

/// A straight strip: row r and column c are at `at`, turned by `heading`, and from there r·spacing ahead and (c − (columns − 1)/2)·spacing to the right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strip {
    /// How many rows.
    pub rows: u32,
    /// How many particles in a row.
    pub columns: u32,
    /// From one to the next, in both directions; above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub spacing: f64,
    /// The middle of the first row.
    #[serde(deserialize_with = "numbers::vector")]
    pub at: (f64, f64, f64),
    /// Which way it goes, in degrees about the vertical; positive turns from +x towards +z. Left out: 0.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub heading: f64,
    /// By how much every other row is lower. Left out: 0, flat.
    #[serde(default, deserialize_with = "numbers::finite")]
    pub bump: f64,
}

/// Rough Road (Holopainen and Rönkkö 2007, section 5): rings of particles along an S of two curves, the first half of them down and the others up again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rough {
    /// How its height goes.
    pub height: Height,
    /// What is added to the height of every other ring; −0.5 or 0.5, which print does not tell. The Inchworm from its printed place gets to the end only with −0.5.
    #[serde(deserialize_with = "numbers::finite")]
    pub bump: f64,
    /// The x and z of its middle; (−8, −8). Only these put the printed Inchworm on its start.
    #[serde(deserialize_with = "numbers::pair")]
    pub middle: (f64, f64),
    /// The signs of the cosine and the sine of its plan; (1, 1).
    #[serde(deserialize_with = "numbers::pair")]
    pub signs: (f64, f64),
    /// How many rings; 60.
    pub rings: u32,
    /// How many particles a ring has; 30.
    pub ring: u32,
}

/// The two readings of Rough Road's height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Height {
    /// Down by 11 − α/5 and up by α/6 again. The Roller gets round the first curve only here, and the second is the uphill one.
    #[default]
    Valley,
    /// The same upside down.
    Hill,
}

/// A helix about the vertical: at the angle θ it is at center + (radius·cos θ, rise·θ/2π, radius·sin θ), and it rises to the right.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Helix {
    /// Where its axis begins. Left out: the origin.
    #[serde(default, deserialize_with = "numbers::vector")]
    pub center: (f64, f64, f64),
    /// How far its middle is from the axis, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub radius: f64,
    /// How much it rises in a turn.
    #[serde(deserialize_with = "numbers::finite")]
    pub rise: f64,
    /// How many turns it has, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub turns: f64,
    /// How many particles a row has.
    pub columns: u32,
    /// From one to the next, above zero.
    #[serde(deserialize_with = "numbers::positive")]
    pub spacing: f64,
}

impl Default for Rough {
    fn default() -> Self {
        Self { height: Height::Valley, bump: -0.5, middle: (-8.0, -8.0), signs: (1.0, 1.0), rings: 60, ring: 30 }
    }
}

/// A place on a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The middle of the road there.
    pub middle: DVec3,
    /// Which way it goes, seen from above; of length 1.
    pub ahead: DVec3,
}

impl Station {
    /// To its right; of length 1.
    pub fn right(self) -> DVec3 {
        DVec3::new(-self.ahead.z, 0.0, self.ahead.x)
    }
}

impl RoadForm {
    /// Its particles.
    ///
    /// # Errors
    /// If it has too many of them, or a number or its points allow no road.
    pub fn build(&self) -> Result<Road, BodyError> {
        let (rows, each) = self.counts()?;
        let count = rows.saturating_mul(each);
        check_count(count)?;
        let particles = (0..rows).flat_map(|row| (0..each).map(move |column| self.particle(row, each, column)));
        let mut points: Vec<_> = particles.collect();
        if let Self::Course(course) = self {
            points.extend(course.corners(rows, each).take(MOST_PARTICLES - count + 1));
            check_count(points.len())?;
        }
        // The middle goes on to the end of the last row's stretch, as it begins at the start of the first.
        let line = (0..=rows).map(|row| self.station(row as f64).middle);
        Road::new(points, if rows == 0 { Vec::new() } else { line.collect() })
    }

    /// How many rows it has; none where its numbers allow no road.
    pub fn rows(&self) -> usize {
        self.counts().map_or(0, |(rows, _)| rows)
    }

    /// How many rows it has, and how many particles in each.
    fn counts(&self) -> Result<(usize, usize), BodyError> {
        match self {
            Self::Strip(strip) => Ok((strip.rows as usize, strip.columns as usize)),
            Self::Rough(rough) => Ok((rough.rings as usize, rough.ring as usize)),
            Self::Helix(helix) => {
                let length = TAU * helix.turns * helix.radius.hypot(helix.rise / TAU);
                Ok(((length / helix.spacing).ceil() as usize, helix.columns as usize))
            }
            Self::Course(course) => course.counts(),
        }
    }

    /// Where it is at a row, counted from 0; between rows, in between.
    pub fn station(&self, row: f64) -> Station {
        match self {
            Self::Strip(strip) => {
                let ahead = direction(strip.heading);
                Station { middle: DVec3::from(strip.at) + row * strip.spacing * ahead, ahead }
            }
            Self::Rough(rough) => rough.station(row),
            Self::Helix(helix) => {
                let angle = row * helix.spacing / helix.radius.hypot(helix.rise / TAU);
                let (sin, cos) = libm::sincos(angle);
                let middle = DVec3::from(helix.center)
                    + DVec3::new(helix.radius * cos, helix.rise * angle / TAU, helix.radius * sin);
                Station { middle, ahead: DVec3::new(-sin, 0.0, cos) }
            }
            Self::Course(course) => course.station(row * course.spacing),
        }
    }

    fn particle(&self, row: usize, each: usize, column: usize) -> DVec3 {
        let spacing = match self {
            Self::Strip(strip) => strip.spacing,
            Self::Rough(rough) => return rough.particle(row, column),
            Self::Helix(helix) => helix.spacing,
            Self::Course(course) => match course.ring {
                None => course.spacing,
                Some(_) => return course.on_ring(row, each, column),
            },
        };
        let place = self.station(row as f64);
        let aside = spacing * (column as f64 - 0.5 * (each as f64 - 1.0));
        let lower = match self {
            Self::Strip(strip) => strip.bump * (row % 2) as f64,
            _ => 0.0,
        };
        place.middle + aside * place.right() - lower * DVec3::Y
    }
}

/// Refuses roads of too many particles.
fn check_count(count: usize) -> Result<(), BodyError> {
    if count <= MOST_PARTICLES {
        return Ok(());
    }
    let problem = format!("comes to {count} particles or more; a road has at most {MOST_PARTICLES}");
    Err(BodyError::Inconsistent { path: "form".into(), problem })
}

impl Rough {
    /// The middle without bumps, and the direction in which it goes on over a tenth of a row.
    fn station(&self, row: f64) -> Station {
        let ahead = self.middle_at(row + 0.05) - self.middle_at(row - 0.05);
        Station { middle: self.middle_at(row), ahead: ahead.with_y(0.0).normalize_or(DVec3::Z) }
    }

    fn middle_at(&self, row: f64) -> DVec3 {
        let gamma = PI / 30.0;
        let (cos, sin) = (libm::cos(0.5 * row * gamma), libm::sin(row * gamma));
        let plan = 30.0 * DVec3::new(self.signs.0 * cos, 0.0, self.signs.1 * sin);
        DVec3::new(self.middle.0, self.height(row), self.middle.1) + plan
    }

    fn height(&self, row: f64) -> f64 {
        let valley = if row > 30.0 { row / 6.0 } else { 11.0 - row / 5.0 };
        match self.height {
            Height::Valley => valley,
            Height::Hill => -valley,
        }
    }

    /// p⁰ of particle β of ring α.
    fn particle(&self, row: usize, column: usize) -> DVec3 {
        let bump = self.bump * (row % 2) as f64;
        let (sin, cos) = libm::sincos(2.0 * column as f64 * (PI / 30.0));
        let ring = 8.0 * DVec3::new(self.signs.0 * cos, 0.0, self.signs.1 * sin);
        self.station(row as f64).middle + DVec3::new(0.0, bump, 0.0) + ring
    }
}

/// The direction of a heading in degrees.
fn direction(degrees: f64) -> DVec3 {
    let pose = crate::creatures::Pose { at: DVec3::ZERO, heading: degrees };
    let (cos, sin) = pose.direction();
    DVec3::new(cos, 0.0, sin)
}
