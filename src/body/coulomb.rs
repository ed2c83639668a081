//! Dry friction that knows where forward is.

use bevy::{ecs::prelude::*, prelude::ReflectComponent, reflect::Reflect};

use super::{BodyError, ParticleId, Particles, Requirement, check, friction::check_spine};

/// Coefficients of dry friction, each zero or more: friction is at most that part of what presses the mass on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
pub struct Coefficients {
    /// Against sliding forward.
    pub forward: f64,
    /// Against sliding backward.
    pub backward: f64,
    /// Against sliding across.
    pub sideways: f64,
}

impl Coefficients {
    fn check(self, path: impl Fn() -> String) -> Result<Self, BodyError> {
        for (field, value) in [("forward", self.forward), ("backward", self.backward), ("sideways", self.sideways)] {
            check(value, Requirement::NonNegative, || format!("{}.{field}", path()))?;
        }
        Ok(self)
    }
}

/// Coulomb friction: a sliding mass is slowed at the same rate at any speed and stops, and a mass at rest stays exactly where it is
/// until the net force leaves the cone of friction.
///
/// A mass that slides with u, a unit vector, is decelerated by N·(μ_s u_s, μ_q u_q): along its forward direction with the forward or the
/// backward coefficient, by the sign of u_s, and across with the sideways one; with three equal coefficients by μN against u (Hu, Nirody,
/// Scott, Shelley, "The mechanics of slithering locomotion", PNAS 106 (2009), equation 1). N is the load, an acceleration: what presses the
/// mass on is m·N. On a body with a [`Ground`](super::Ground), only masses in contact with it feel friction.
///
/// Forward is the direction of the spine at each of its particles, as for [`SpineFriction`](super::SpineFriction), and particles off the spine
/// feel none; without a spine every particle does, and forward is +x.
#[derive(Clone, Component, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct CoulombFriction {
    /// One set a particle, or one for all.
    coefficients: Vec<Coefficients>,
    load: Option<f64>,
    spine: Vec<ParticleId>,
}

impl CoulombFriction {
    /// The load of a body without [`Gravity`](super::Gravity) that is given none: standard gravity in m/s².
    pub const STANDARD_LOAD: f64 = 9.81;

    /// The same coefficients for every particle; forward is +x and the load is the body's gravity.
    ///
    /// # Errors
    /// If a coefficient is negative or not finite.
    pub fn new(coefficients: Coefficients) -> Result<Self, BodyError> {
        let coefficients = vec![coefficients.check(|| "coulomb".into())?];
        Ok(Self { coefficients, load: None, spine: Vec::new() })
    }

    /// Coefficients for each of `particles`, in order; forward is +x and the load is the body's gravity.
    ///
    /// # Errors
    /// If there are not as many as particles, or a coefficient is negative or not finite.
    pub fn for_each(
        coefficients: impl IntoIterator<Item = Coefficients>,
        particles: &Particles,
    ) -> Result<Self, BodyError> {
        let coefficients = coefficients.into_iter().enumerate();
        let coefficients: Vec<_> =
            coefficients.map(|(i, one)| one.check(|| format!("coulomb[{i}]"))).collect::<Result<_, _>>()?;
        if coefficients.len() != particles.len() {
            let problem = format!(
                "has coefficients for {} particle(s), and the body has {}; give each its own",
                coefficients.len(),
                particles.len()
            );
            return Err(BodyError::Inconsistent { path: "coulomb".into(), problem });
        }
        Ok(Self { coefficients, load: None, spine: Vec::new() })
    }

    /// Sets the load N, an acceleration (lengths a squared unit of time). Without this it is the body's gravity, and
    /// [`STANDARD_LOAD`](Self::STANDARD_LOAD) for a body that has none.
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn with_load(mut self, load: f64) -> Result<Self, BodyError> {
        self.load = Some(check(load, Requirement::NonNegative, || "coulomb.load".into())?);
        Ok(self)
    }

    /// Makes forward the direction along `spine`, from tail to head; particles off it feel no friction.
    ///
    /// # Errors
    /// If the spine has fewer than two particles, names one that is not there, or names one twice.
    pub fn with_spine(
        mut self,
        spine: impl IntoIterator<Item = ParticleId>,
        particles: &Particles,
    ) -> Result<Self, BodyError> {
        self.spine = check_spine(spine, particles)?;
        Ok(self)
    }

    /// The coefficients of a particle.
    pub fn coefficients(&self, particle: ParticleId) -> Coefficients {
        match self.coefficients[..] {
            [all] => all,
            ref each => each.get(particle.index()).copied().unwrap_or_default(),
        }
    }

    /// The coefficients: one set a particle, or one for all.
    pub fn sets(&self) -> &[Coefficients] {
        &self.coefficients
    }

    /// Changes one of the [`sets`](Self::sets).
    ///
    /// # Errors
    /// If a coefficient is negative or not finite. A set that is not there is left alone.
    pub fn set(&mut self, index: usize, coefficients: Coefficients) -> Result<(), BodyError> {
        let checked = coefficients.check(|| format!("coulomb[{index}]"))?;
        if let Some(set) = self.coefficients.get_mut(index) {
            *set = checked;
        }
        Ok(())
    }

    /// The load, if it is given.
    pub fn load(&self) -> Option<f64> {
        self.load
    }

    /// The particles of the spine from tail to head; none where forward is +x.
    pub fn spine(&self) -> &[ParticleId] {
        &self.spine
    }

    /// Whether it can act on a body of as many particles.
    pub(crate) fn fits(&self, particles: usize) -> bool {
        (self.coefficients.len() == 1 || self.coefficients.len() == particles)
            && self.spine.iter().all(|particle| particle.index() < particles)
    }
}
