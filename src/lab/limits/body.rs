//! The bodies of a scene as they are at its start.

use bevy::{ecs::prelude::*, prelude::Name};

use crate::{
    body::{CoulombFriction, Gravity, Ground, MassDamping, Muscles, Particles, SpineFriction, Springs},
    creatures::FileError,
    mechanics::{
        BodyParts,
        integrators::{Method, StickRule},
    },
    scenes::{self, LoadedScene, SceneBodies},
};

/// The components of one body.
#[derive(Clone, Debug)]
pub(super) struct LimitBody {
    pub(super) name: String,
    particles: Particles,
    springs: Springs,
    muscles: Option<Muscles>,
    friction: Option<SpineFriction>,
    coulomb: Option<CoulombFriction>,
    gravity: Option<Gravity>,
    ground: Option<Ground>,
    mass_damping: Option<MassDamping>,
    stick: StickRule,
}

impl LimitBody {
    /// The bodies of a scene with the parameters that its file sets; those that are alike once, under all of their names.
    pub(super) fn distinct(scene: &LoadedScene) -> Result<Vec<Self>, FileError> {
        let mut world = World::new();
        scenes::open(&mut world, scene.clone())?;
        let entities = world.resource::<SceneBodies>().0.clone();
        let mut all: Vec<Self> = Vec::new();
        for body in entities.into_iter().filter_map(|entity| Self::of(world.get_entity(entity).ok()?)) {
            match all.iter_mut().find(|other| other.is_like(&body)) {
                Some(other) => {
                    other.name.push_str(", ");
                    other.name.push_str(&body.name);
                }
                None => all.push(body),
            }
        }
        Ok(all)
    }

    fn of(entity: EntityRef<'_>) -> Option<Self> {
        Some(Self {
            name: entity.get::<Name>().map_or("body", Name::as_str).to_owned(),
            particles: entity.get::<Particles>()?.clone(),
            springs: entity.get::<Springs>()?.clone(),
            muscles: entity.get::<Muscles>().cloned(),
            friction: entity.get::<SpineFriction>().cloned(),
            coulomb: entity.get::<CoulombFriction>().cloned(),
            gravity: entity.get::<Gravity>().copied().filter(|gravity| gravity.acceleration() > 0.0),
            ground: entity.get::<Ground>().copied(),
            mass_damping: entity.get::<MassDamping>().copied(),
            stick: entity.get::<StickRule>().copied().unwrap_or_default(),
        })
    }

    /// Borrows the body for mechanics.
    pub(super) fn parts(&self, method: Method) -> BodyParts<'_> {
        BodyParts {
            particles: &self.particles,
            springs: &self.springs,
            muscles: self.muscles.as_ref(),
            friction: self.friction.as_ref(),
            coulomb: self.coulomb.as_ref(),
            gravity: self.gravity,
            ground: self.ground,
            mass_damping: self.mass_damping,
            method,
            stick: self.stick,
        }
    }

    /// Whether the other differs only in where it is.
    fn is_like(&self, other: &Self) -> bool {
        let placed = |body: &Self| {
            let positions: Vec<_> = body.particles.positions().collect();
            positions.iter().map(|&position| position - positions[0]).collect::<Vec<_>>()
        };
        self.particles.masses() == other.particles.masses()
            && self.particles.pinned() == other.particles.pinned()
            && placed(self) == placed(other)
            && self.springs == other.springs
            && self.muscles == other.muscles
            && self.friction == other.friction
            && self.coulomb == other.coulomb
            && (self.gravity, self.ground, self.mass_damping) == (other.gravity, other.ground, other.mass_damping)
    }
}
