//! Blueprint to body.

use std::borrow::Cow;

use bevy::{
    ecs::{prelude::*, system::EntityCommand},
    math::DVec3,
};

use super::{
    Attitude, Composed, Coulomb, Creature, Friction, GardenWorm, Look, Plan, RawBody, RawParticle, SixBody, StrandPlan,
};
use crate::body::{
    BodyError, Coefficients, CoulombFriction, Lattice, MassDamping, Muscle, Muscles, Particle, ParticleId, Particles,
    SpineFriction, Spring, SpringId, Springs, Strand, Tearing, TravelingWaves,
};

/// Where a creature is put, and which way it looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// What is added to every position, after turning.
    pub at: DVec3,
    /// Degrees about the vertical; positive turns from +x (0) towards +z (90), to the right.
    pub heading: f64,
}

impl Pose {
    /// The cosine and sine of the heading, exact at whole quarter turns: a worm that crawls along an axis stays on it to the last bit.
    pub(super) fn direction(self) -> (f64, f64) {
        let degrees = self.heading % 360.0;
        let quarters = (degrees / 90.0).round();
        let (sin, cos) = libm::sincos((degrees - quarters * 90.0).to_radians());
        let (cos, sin) = match quarters.rem_euclid(4.0) as u8 {
            0 => (cos, sin),
            1 => (-sin, cos),
            2 => (-cos, -sin),
            _ => (sin, -cos),
        };
        // Adding zero makes a plain 0 of −0, which would travel into velocities and from there into hashes.
        (cos + 0.0, sin + 0.0)
    }

    /// Turns about the vertical.
    pub(super) fn turn(self, (x, y, z): (f64, f64, f64)) -> DVec3 {
        let (cos, sin) = self.direction();
        DVec3::new(x * cos - z * sin, y, x * sin + z * cos)
    }
}

/// The components of a body, ready to be put on an entity.
///
/// It is an [`EntityCommand`]: `commands.spawn(Name::new("worm")).queue(body)`, or `body.apply(entity)` with an `EntityWorldMut`.
/// Muscles and friction are only put there if the creature has any.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its masses.
    pub particles: Particles,
    /// Its springs; none where it has `six`.
    pub springs: Springs,
    /// What moves it in place of springs, if it belongs to the six-matrix particle system.
    pub six: Option<SixBody>,
    /// What drives its springs, if anything does.
    pub muscles: Option<Muscles>,
    /// The lattice that it is, if it is one.
    pub strand: Option<Strand>,
    /// The waves that travel along the lattice, if any do.
    pub waves: Option<TravelingWaves>,
    /// The block on a grid that it is, and how it starts, if it is one.
    pub block: Option<(Lattice, Attitude)>,
    /// Friction along its spine, if it feels any.
    pub friction: Option<SpineFriction>,
    /// Dry friction along its spine, if it feels any.
    pub coulomb: Option<CoulombFriction>,
    /// Its damping by what surrounds it, if any.
    pub damping: Option<MassDamping>,
    /// When its springs tear, if they do.
    pub tearing: Option<Tearing>,
    /// How it wants to be drawn.
    pub look: Look,
}

impl EntityCommand for Body {
    type Out = ();

    fn apply(self, mut entity: EntityWorldMut) {
        entity.insert((self.particles, self.look));
        if let Some(SixBody { columns, bonds, collisions, rules }) = self.six {
            entity.insert((columns, bonds, collisions, rules));
            return;
        }
        entity.insert(self.springs);
        if let Some(muscles) = self.muscles {
            entity.insert(muscles);
        }
        if let Some(strand) = self.strand {
            entity.insert(strand);
        }
        if let Some(waves) = self.waves {
            entity.insert(waves);
        }
        if let Some(block) = self.block {
            entity.insert(block);
        }
        if let Some(friction) = self.friction {
            entity.insert(friction);
        }
        if let Some(coulomb) = self.coulomb {
            entity.insert(coulomb);
        }
        if let Some(damping) = self.damping {
            entity.insert(damping);
        }
        if let Some(tearing) = self.tearing {
            entity.insert(tearing);
        }
    }
}

impl Creature {
    /// Builds its body at a place.
    ///
    /// # Errors
    /// Where two places of the blueprint contradict each other: an end that is not a particle, a spine that names a particle twice,
    /// friction without a spine; and where a number is not allowed, which files refuse earlier.
    pub fn body(&self, pose: Pose) -> Result<Body, BodyError> {
        if let Some(composed) = self.body.composed() {
            return self.six_body(&composed, pose);
        }
        if self.road.is_some() {
            let problem = "is for creatures of the six-matrix particle system, and this one has springs, which know no road; leave it out, or give a ground";
            return Err(BodyError::Inconsistent { path: "road".into(), problem: problem.into() });
        }
        let damping = match self.damping {
            None => None,
            Some(MassDamping::Rate(rate)) => Some(MassDamping::rate(rate)?),
            Some(MassDamping::PerStep(part)) => Some(MassDamping::per_step(part)?),
        };
        let tearing = self.tear.map(Tearing::new).transpose()?;
        let (raw, kind) = match &self.body {
            Plan::Raw(raw) => {
                (Cow::Borrowed(raw), Friction { drag: Some(0.0), brake: Some(0.0), ..Friction::default() })
            }
            Plan::GardenWorm(worm) => {
                let drag = Some(GardenWorm::DRAG);
                (Cow::Owned(worm.raw()), Friction { drag, brake: Some(0.0), ..Friction::default() })
            }
            Plan::Strand(strand) => {
                let brake = Some(StrandPlan::BRAKE);
                (Cow::Owned(strand.raw()), Friction { drag: Some(0.0), brake, ..Friction::default() })
            }
            Plan::Jelly(jelly) => {
                if let Some(field) = self.friction.map(|_| "friction").or_else(|| self.coulomb.map(|_| "coulomb")) {
                    let problem = "works along a spine, and a block has none; leave it out";
                    return Err(BodyError::Inconsistent { path: field.into(), problem: problem.into() });
                }
                return Ok(Body { damping, tearing, look: self.look(), ..jelly.body(pose)? });
            }
            // Built above.
            Plan::Inchworm(_) | Plan::Roller(_) | Plan::Composed(_) => Default::default(),
        };
        let particles = particles(&raw, pose)?;
        let springs = springs(&raw, &particles)?;
        let muscles = muscles(&raw, &springs)?;
        let (strand, waves) = match &self.body {
            Plan::Strand(_) if tearing.is_some() => {
                let problem = "the springs of a strand cannot tear; leave it out".into();
                return Err(BodyError::Inconsistent { path: "tear".into(), problem });
            }
            Plan::Strand(_) if self.coulomb.is_some() => {
                let problem =
                    "works along single particles, and the spine of a strand has sections of four; give friction";
                return Err(BodyError::Inconsistent { path: "coulomb".into(), problem: problem.into() });
            }
            Plan::Strand(plan) => (Some(plan.strand(&springs)?), Some(plan.waves()?)),
            _ => (None, None),
        };
        let own = self.friction.unwrap_or_default();
        let own = Friction { drag: own.drag.or(kind.drag), brake: own.brake.or(kind.brake), ..own };
        let friction = match (&self.body, strand) {
            (_, Some(strand)) => Some(SpineFriction::along_sections(
                (0..strand.sections()).map(|section| strand.section(section)),
                &particles,
            )?),
            (Plan::Raw(_), None) if self.friction.is_none() => None,
            _ => Some(SpineFriction::new(spine(&raw, "friction")?, &particles)?),
        };
        let friction = friction.map(|friction| with_rates(friction, own)).transpose()?;
        if friction.is_none() && !raw.spine.is_empty() {
            // The spine is checked even where nothing uses it, so that a mistake in it does not wait for the friction.
            SpineFriction::new(raw.spine.iter().copied().map(ParticleId), &particles)?;
        }
        let coulomb = self.coulomb.map(|coulomb| coulomb_friction(&raw, coulomb, &particles)).transpose()?;
        let look = self.look();
        Ok(Body {
            particles,
            springs,
            muscles,
            strand,
            waves,
            block: None,
            six: None,
            friction,
            coulomb,
            damping,
            tearing,
            look,
        })
    }
}

impl Creature {
    /// A body of the six-matrix particle system, which has no use for what springs have.
    fn six_body(&self, composed: &Composed, pose: Pose) -> Result<Body, BodyError> {
        let unused = [
            ("friction", self.friction.is_some()),
            ("coulomb", self.coulomb.is_some()),
            ("damping", self.damping.is_some()),
            ("tear", self.tear.is_some()),
        ];
        if let Some((field, _)) = unused.iter().find(|(_, given)| *given) {
            let problem =
                "is for creatures with springs; this one has the damping of its groups and the numbers of its rules";
            return Err(BodyError::Inconsistent { path: (*field).into(), problem: problem.into() });
        }
        let places: Vec<_> = composed.rest().iter().map(|x| pose.turn((*x).into()) + pose.at).collect();
        let particles = Particles::new(places.iter().map(|&x| Particle::at(x)))?;
        Ok(Body {
            six: Some(composed.build(&places)?),
            springs: Springs::new([], &particles)?,
            particles,
            muscles: None,
            strand: None,
            waves: None,
            friction: None,
            coulomb: None,
            block: None,
            damping: None,
            tearing: None,
            look: self.look(),
        })
    }
}

fn particles(raw: &RawBody, pose: Pose) -> Result<Particles, BodyError> {
    Particles::new(raw.particles.iter().map(|&RawParticle { position, velocity, mass, pinned }| Particle {
        position: pose.turn(position) + pose.at,
        velocity: pose.turn(velocity),
        mass,
        pinned,
    }))
}

fn springs(raw: &RawBody, particles: &Particles) -> Result<Springs, BodyError> {
    let distance = |(a, b): (u32, u32)| {
        let position = |i: u32| raw.particles.get(i as usize).map(|particle| DVec3::from(particle.position));
        // An end that is not there is reported by the constructor; any length will do until then.
        position(a).zip(position(b)).map_or(1.0, |(a, b)| a.distance(b))
    };
    for (i, spring) in raw.springs.iter().enumerate() {
        if spring.rest_length.is_none() && spring.ends.0 != spring.ends.1 && distance(spring.ends) == 0.0 {
            return Err(BodyError::Inconsistent {
                path: format!("springs[{i}].rest_length"),
                problem: format!(
                    "is left out, and particles {} and {} start in the same place; give a rest_length above 0",
                    spring.ends.0, spring.ends.1
                ),
            });
        }
    }
    Springs::new(
        raw.springs.iter().map(|spring| Spring {
            ends: [ParticleId(spring.ends.0), ParticleId(spring.ends.1)],
            stiffness: spring.stiffness,
            damping: spring.damping,
            rest_length: spring.rest_length.unwrap_or_else(|| distance(spring.ends)),
        }),
        particles,
    )
}

fn muscles(raw: &RawBody, springs: &Springs) -> Result<Option<Muscles>, BodyError> {
    let muscles = (0..).zip(&raw.springs).filter_map(|(i, spring)| {
        spring.muscle.map(|muscle| Muscle {
            spring: SpringId(i),
            wave: muscle.wave,
            amplitude: muscle.amplitude,
            period: muscle.period,
            phase: muscle.phase,
            ramp: muscle.ramp,
        })
    });
    let muscles: Vec<_> = muscles.collect();
    // A file has them at their springs.
    muscles.iter().try_for_each(|muscle| muscle.check_numbers(|| format!("springs[{}].muscle", muscle.spring.0)))?;
    Ok(Some(Muscles::new(muscles, springs)?).filter(|muscles| !muscles.is_empty()))
}

fn with_rates(spine: SpineFriction, friction: Friction) -> Result<SpineFriction, BodyError> {
    spine
        .with_ratchet(friction.ratchet)
        .with_drag(friction.drag.unwrap_or_default())?
        .with_grip(friction.grip)?
        .with_isotropic(friction.isotropic)?
        .with_brake(friction.brake.unwrap_or_default())
}

fn coulomb_friction(raw: &RawBody, coulomb: Coulomb, particles: &Particles) -> Result<CoulombFriction, BodyError> {
    let Coulomb { forward, backward, sideways, load } = coulomb;
    let friction = CoulombFriction::new(Coefficients { forward, backward, sideways })?
        .with_spine(spine(raw, "coulomb")?, particles)?;
    match load {
        Some(load) => friction.with_load(load),
        None => Ok(friction),
    }
}

/// The spine of a body, along which `field` works.
fn spine<'a>(raw: &'a RawBody, field: &str) -> Result<impl Iterator<Item = ParticleId> + use<'a>, BodyError> {
    if raw.spine.is_empty() {
        return Err(no_spine(field));
    }
    Ok(raw.spine.iter().copied().map(ParticleId))
}

fn no_spine(field: &str) -> BodyError {
    let problem =
        "works along a spine of particles, and this body has none; give `spine: [tail, …, head]` in a raw body";
    BodyError::Inconsistent { path: field.into(), problem: problem.into() }
}
