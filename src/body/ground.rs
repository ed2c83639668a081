//! The ground that a body stands on.

use std::sync::Arc;

use bevy::{
    ecs::prelude::*,
    prelude::ReflectComponent,
    reflect::{Reflect, TypePath},
};
use serde::{Deserialize, Serialize};

use super::{BodyError, Requirement, check};

/// The ground that a body stands on: no particle of the body gets below it, and friction acts only on masses that touch it.
/// A body without this component meets no ground, and its friction always acts.
#[derive(Clone, Component, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[reflect(Component)]
pub enum Ground {
    /// The plane y = 0.
    Flat,
    /// What surfaces make together.
    Terrain(Arc<Terrain>),
}

impl Ground {
    /// A mass nearer to the ground than this touches it, and friction acts on it.
    pub const CONTACT_DISTANCE: f64 = 0.05;
}

/// A ground of one or more surfaces: solid is what is below any of them. Cheap to share between bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, TypePath)]
#[serde(try_from = "TerrainFields", into = "TerrainFields")]
pub struct Terrain {
    surfaces: Vec<Surface>,
    patches: Vec<Patch>,
    bounce: f64,
}

impl Terrain {
    /// The ground of these surfaces, without patches and without bounce.
    ///
    /// # Errors
    /// If there is no surface, or a surface has a number that is not allowed.
    pub fn new(surfaces: impl IntoIterator<Item = Surface>) -> Result<Self, BodyError> {
        let surfaces: Vec<_> = surfaces.into_iter().collect();
        if surfaces.is_empty() {
            return Err(BodyError::Inconsistent {
                path: "surfaces".into(),
                problem: "there is none; give one or more, such as Floor(height: 0), or ground: None".into(),
            });
        }
        surfaces.iter().enumerate().try_for_each(|(index, surface)| surface.check(&format!("surfaces[{index}]")))?;
        Ok(Self { surfaces, patches: Vec::new(), bounce: 0.0 })
    }

    /// Lays patches of another side grip on it; where two overlap, the later one counts.
    ///
    /// # Errors
    /// If a patch has a number that is not allowed.
    pub fn with_patches(mut self, patches: impl IntoIterator<Item = Patch>) -> Result<Self, BodyError> {
        self.patches = patches.into_iter().collect();
        self.patches.iter().enumerate().try_for_each(|(index, patch)| patch.check(&format!("patches[{index}]")))?;
        Ok(self)
    }

    /// Sets the coefficient of restitution e: the part of the speed of impact with which a mass leaves, from 0 to 1.
    ///
    /// # Errors
    /// If it is not from 0 to 1.
    pub fn with_bounce(mut self, bounce: f64) -> Result<Self, BodyError> {
        check(bounce, Requirement::NonNegative, || "bounce".into())?;
        if bounce > 1.0 {
            let problem = format!("{bounce} is not allowed; give a number from 0 to 1");
            return Err(BodyError::Inconsistent { path: "bounce".into(), problem });
        }
        self.bounce = bounce;
        Ok(self)
    }

    /// Its surfaces, one or more.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Its patches.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The coefficient of restitution e.
    pub fn bounce(&self) -> f64 {
        self.bounce
    }
}

/// A surface by its signed distance φ, above zero outside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Surface {
    /// The level plane at a height: φ = y − height.
    Floor {
        /// Its y.
        height: f64,
    },
    /// Any plane: φ = n·(x − point), with the unit vector n along `normal`. A wall is a plane whose normal is level.
    Plane {
        /// A point on it.
        point: (f64, f64, f64),
        /// Where its free side is; of any length above zero.
        normal: (f64, f64, f64),
    },
    /// A floor at y = 0 that ends in a rounded edge and falls upright towards +x: for x ≤ edge φ = y; beyond it, down to y = −radius,
    /// |(x − edge, y + radius)| − radius; below that x − edge − radius. Only masses are tested, so an edge of a body, of length l, cuts the round by up to
    /// radius − √(radius² − l²/4): choose a radius of two lengths or more.
    Cliff {
        /// Where, in x, the floor ends and the round begins.
        edge: f64,
        /// Radius of the round, above zero.
        radius: f64,
        /// How far below the floor the lower ground is, above zero. Left out: there is none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        drop: Option<f64>,
    },
    /// A floor at y = 0 with a smooth hill on it, height·(1 − d²/radius²)³ at the distance d < radius from its centre:
    /// φ = (y − f)/√(1 + |∇f|²) with that height f, the distance to first order.
    Hill {
        /// The x and z of its top.
        center: (f64, f64),
        /// Where it ends, above zero.
        radius: f64,
        /// The height of its top; below zero it is a hollow.
        height: f64,
    },
    /// A ball: φ = |x − center| − radius.
    Ball {
        /// Its centre.
        center: (f64, f64, f64),
        /// Its radius, above zero.
        radius: f64,
    },
}

impl Surface {
    fn check(&self, path: &str) -> Result<(), BodyError> {
        let finite = |field: &str, values: &[f64]| {
            values
                .iter()
                .try_for_each(|&value| check(value, Requirement::Finite, || format!("{path}.{field}")).map(|_| ()))
        };
        let positive =
            |field: &str, value: f64| check(value, Requirement::Positive, || format!("{path}.{field}")).map(|_| ());
        match *self {
            Self::Floor { height } => finite("height", &[height]),
            Self::Plane { point, normal } => {
                finite("point", &[point.0, point.1, point.2])?;
                finite("normal", &[normal.0, normal.1, normal.2])?;
                if normal == (0.0, 0.0, 0.0) {
                    let problem = "(0, 0, 0) points nowhere; give the direction of the free side".into();
                    return Err(BodyError::Inconsistent { path: format!("{path}.normal"), problem });
                }
                Ok(())
            }
            Self::Cliff { edge, radius, drop } => {
                finite("edge", &[edge])?;
                positive("radius", radius)?;
                drop.map_or(Ok(()), |drop| positive("drop", drop))
            }
            Self::Hill { center, radius, height } => {
                finite("center", &[center.0, center.1])?;
                finite("height", &[height])?;
                positive("radius", radius)
            }
            Self::Ball { center, radius } => {
                finite("center", &[center.0, center.1, center.2])?;
                positive("radius", radius)
            }
        }
    }
}

/// A part of the ground, seen from above, where the side grip is another: sand, grass. It changes nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Patch {
    /// A disc.
    Disc {
        /// The x and z of its middle.
        center: (f64, f64),
        /// Its radius, above zero.
        radius: f64,
        /// The side grip of the masses that stand on it, zero or more.
        grip: f64,
    },
    /// A rectangle along the axes.
    Box {
        /// Its least x and z.
        from: (f64, f64),
        /// Its largest x and z.
        to: (f64, f64),
        /// The side grip of the masses that stand on it, zero or more.
        grip: f64,
    },
}

impl Patch {
    /// The side grip of the masses that stand on it.
    pub fn grip(&self) -> f64 {
        match *self {
            Self::Disc { grip, .. } | Self::Box { grip, .. } => grip,
        }
    }

    fn check(&self, path: &str) -> Result<(), BodyError> {
        check(self.grip(), Requirement::NonNegative, || format!("{path}.grip"))?;
        let (field, values) = match *self {
            Self::Disc { center, radius, .. } => {
                check(radius, Requirement::Positive, || format!("{path}.radius"))?;
                ("center", [center.0, center.1, 0.0, 0.0])
            }
            Self::Box { from, to, .. } if from.0 > to.0 || from.1 > to.1 => {
                return Err(BodyError::Inconsistent {
                    path: format!("{path}.to"),
                    problem: format!(
                        "{to:?} is not beyond from: {from:?}; give the least x and z as from, the largest as to"
                    ),
                });
            }
            Self::Box { from, to, .. } => ("from", [from.0, from.1, to.0, to.1]),
        };
        values
            .into_iter()
            .try_for_each(|value| check(value, Requirement::Finite, || format!("{path}.{field}")).map(|_| ()))
    }
}

/// A terrain as it is written.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename = "Terrain", deny_unknown_fields)]
struct TerrainFields {
    #[serde(default)]
    surfaces: Vec<Surface>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    patches: Vec<Patch>,
    #[serde(default)]
    bounce: f64,
}

impl TryFrom<TerrainFields> for Terrain {
    type Error = BodyError;

    fn try_from(fields: TerrainFields) -> Result<Self, BodyError> {
        Self::new(fields.surfaces)?.with_patches(fields.patches)?.with_bounce(fields.bounce)
    }
}

impl From<Terrain> for TerrainFields {
    fn from(Terrain { surfaces, patches, bounce }: Terrain) -> Self {
        Self { surfaces, patches, bounce }
    }
}
