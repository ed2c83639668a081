//! What a scene asks of a method: its bodies and how long they are followed, without anything that is only drawn.

use bevy::{ecs::prelude::*, math::DVec3, prelude::Name};

use crate::{
    body::{
        CoulombFriction, Gravity, Ground, Guidance, Lattice, MassDamping, Muscles, Particles, SpineFriction, Springs,
        Strand, Tearing, TravelingWaves, longest_period,
    },
    creatures::FileError,
    mechanics::{
        BodyParts,
        integrators::{Method, StickRule},
    },
    physics::Clock,
    scenes::{self, Budget, LoadedScene, SceneBodies},
};

use super::{LabError, Setting, Unit, hash::Fnv};

/// How many gait cycles a problem lasts.
const CYCLES: f64 = 10.0;
/// How long a problem lasts where nothing has a cycle.
const WITHOUT_MUSCLES: f64 = 20.0;
/// How many shared times there are.
const SAMPLES: usize = 1000;

/// One body of a problem: its components, as they are at time 0.
#[derive(Clone, Debug)]
pub struct ProblemBody {
    /// Its name in the scene.
    pub name: String,
    /// Its particles at the start.
    pub particles: Particles,
    /// Its springs.
    pub springs: Springs,
    /// Its muscles, if it has any.
    pub muscles: Option<Muscles>,
    /// The lattice that it is, if it is one.
    pub strand: Option<Strand>,
    /// The block on a grid that it is, if it is one.
    pub lattice: Option<Lattice>,
    /// When its springs tear, if they do.
    pub tearing: Option<Tearing>,
    /// The waves that travel along the lattice, if any do.
    pub waves: Option<TravelingWaves>,
    /// Its friction, if it has any.
    pub friction: Option<SpineFriction>,
    /// Its Coulomb friction, if it feels any.
    pub coulomb: Option<CoulombFriction>,
    /// Its gravity, if it has any.
    pub gravity: Option<Gravity>,
    /// The ground that it stands on, if any.
    pub ground: Option<Ground>,
    /// Its damping by what surrounds it, if any.
    pub mass_damping: Option<MassDamping>,
}

impl ProblemBody {
    /// The bodies of a scene with the parameters that its file sets, and the scene's clock.
    pub(super) fn all(scene: &LoadedScene) -> Result<(Vec<Self>, Clock), FileError> {
        let mut world = World::new();
        scenes::open(&mut world, scene.clone())?;
        let entities = world.resource::<SceneBodies>().0.clone();
        let bodies = entities.into_iter().filter_map(|entity| Self::of(world.get_entity(entity).ok()?)).collect();
        Ok((bodies, world.resource::<Clock>().clone()))
    }

    fn of(entity: EntityRef<'_>) -> Option<Self> {
        Some(Self {
            name: entity.get::<Name>().map_or("body", Name::as_str).to_owned(),
            particles: entity.get::<Particles>()?.clone(),
            springs: entity.get::<Springs>()?.clone(),
            muscles: entity.get::<Muscles>().filter(|muscles| !muscles.is_empty()).cloned(),
            strand: entity.get::<Strand>().copied(),
            lattice: entity.get::<Lattice>().copied(),
            tearing: entity.get::<Tearing>().cloned(),
            waves: entity.get::<TravelingWaves>().cloned(),
            friction: entity.get::<SpineFriction>().cloned(),
            coulomb: entity.get::<CoulombFriction>().cloned(),
            // Gravity of zero is none: it must not cost a body its axis.
            gravity: entity.get::<Gravity>().copied().filter(|gravity| gravity.acceleration() > 0.0),
            ground: entity.get::<Ground>().cloned(),
            mass_damping: entity.get::<MassDamping>().copied(),
        })
    }

    /// Borrows the body for mechanics.
    pub fn parts(&self, method: Method, stick: StickRule) -> BodyParts<'_> {
        BodyParts {
            particles: &self.particles,
            springs: &self.springs,
            muscles: self.muscles.as_ref(),
            strand: self.strand,
            lattice: self.lattice,
            pull: None,
            tearing: self.tearing.as_ref(),
            waves: self.waves.as_ref(),
            guidance: Guidance::default(),
            friction: self.friction.as_ref(),
            coulomb: self.coulomb.as_ref(),
            gravity: self.gravity,
            ground: self.ground.as_ref(),
            mass_damping: self.mass_damping,
            method,
            stick,
        }
    }

    /// The largest stable step of a method in the pose that the body starts in.
    pub fn stability_limit(&self, method: Method, stick: StickRule) -> f64 {
        self.parts(method, stick).stability_limit(0.0)
    }

    /// The longest period of a muscle or a wave; nothing where it has none.
    pub fn period(&self) -> Option<f64> {
        longest_period(self.muscles.as_ref(), self.waves.as_ref())
    }

    /// The length of the body: the largest distance between two of its particles at the start; 1 where all are in one place.
    pub fn length(&self) -> f64 {
        let positions: Vec<_> = self.particles.positions().collect();
        let from = |(i, a): (usize, &DVec3)| positions[i..].iter().map(|b| a.distance(*b)).fold(0.0, f64::max);
        let length = positions.iter().enumerate().map(from).fold(0.0, f64::max);
        if length > 0.0 { length } else { 1.0 }
    }

    fn hash(&self, hash: &mut Fnv) {
        let particles = &self.particles;
        hash.whole(particles.len() as u64);
        for columns in [particles.position_columns(), particles.velocity_columns()] {
            columns.iter().for_each(|column| hash.numbers(column));
        }
        // What is pinned never moves, whatever its mass is.
        for (&mass, &pinned) in particles.masses().iter().zip(particles.pinned()) {
            hash.number(if pinned { f64::INFINITY } else { mass });
        }
        hash.whole(self.springs.len() as u64);
        for spring in self.springs.iter() {
            spring.ends.iter().for_each(|end| hash.whole(u64::from(end.0)));
            hash.numbers(&[spring.stiffness, spring.damping, spring.rest_length]);
        }
        let muscles = self.muscles.iter().flat_map(|muscles| muscles.iter().zip(muscles.epochs()));
        hash.whole(self.muscles.as_ref().map_or(0, Muscles::len) as u64);
        for (muscle, epoch) in muscles {
            hash.whole(u64::from(muscle.spring.0));
            hash.whole(muscle.wave as u64);
            hash.numbers(&[muscle.amplitude, muscle.period, muscle.phase, muscle.ramp, epoch.time, epoch.cycles]);
        }
        let spine = self.friction.as_ref().map_or(&[][..], SpineFriction::spine);
        hash.whole(spine.len() as u64);
        spine.iter().for_each(|particle| hash.whole(u64::from(particle.0)));
        if let Some(friction) = &self.friction {
            hash.whole(u64::from(friction.ratchet()));
            hash.numbers(&[friction.drag(), friction.grip(), friction.isotropic()]);
        }
        hash.number(self.gravity.map_or(0.0, Gravity::acceleration));
        // What only some bodies have, by its debug form, which has every digit.
        let Self { strand, lattice, waves, coulomb, ground, .. } = self;
        hash.bytes(format!("{strand:?} {lattice:?} {waves:?} {coulomb:?} {ground:?}").as_bytes());
        hash.number(self.tearing.as_ref().map_or(f64::INFINITY, Tearing::strain));
        hash.number(self.mass_damping.map_or(0.0, |damping| damping.rate_at(1.0)));
    }
}

/// A scene as a problem for methods of integration.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The scene's name.
    pub name: String,
    /// The scene's title.
    pub title: String,
    /// The bodies in the order of the scene. Damping that is given for a step has the rate that it has at the scene's own step, so that the physics does
    /// not change with the step.
    pub bodies: Vec<ProblemBody>,
    /// The scene's own method and step.
    pub setting: Setting,
    /// How much simulated time the app shows in a second.
    pub time_scale: f64,
    /// The error that the scene can afford, in its unit.
    pub budget: f64,
    /// What an error is.
    pub unit: Unit,
    /// The longest period of a muscle, or nothing where no muscle is.
    pub period: Option<f64>,
    /// How long it is followed: as long as its budget of shapes says, or else ten of the longest period, or 20 units of time where no muscle is; less where
    /// it is `shortened`.
    pub duration: f64,
    /// Whether it is followed for a shorter time, since no step is small enough to tell how it goes on: see [`Truth::as_far_as_known`](super::Truth::as_far_as_known).
    pub shortened: bool,
}

impl Problem {
    /// The problem of a scene as its file has it, with the parameters that the file sets.
    ///
    /// # Errors
    /// If a body cannot be built, which loading the scene has found out before, or has no springs.
    pub fn of(scene: &LoadedScene) -> Result<Self, LabError> {
        let (mut bodies, clock) = ProblemBody::all(scene)?;
        if bodies.len() < scene.file.creatures.len() {
            let what = "the six-matrix particle system, which knows one step and no method".into();
            return Err(LabError::Unsupported { scene: scene.source.stem(), what });
        }
        let dt = clock.dt();
        for body in &mut bodies {
            body.mass_damping = body.mass_damping.map(|damping| MassDamping::Rate(damping.rate_at(dt)));
        }
        let file = &scene.file;
        let (budget, unit) = match file.budget {
            Budget::Pixels(_) => (file.budget_length().unwrap_or(f64::INFINITY), Unit::Length),
            Budget::GaitSpeed(part) => (part, Unit::PartOfSpeed),
            Budget::Shape { part, .. } => (part, Unit::PartOfCell),
        };
        let mut problem = Self {
            name: scene.source.stem(),
            title: file.title.clone(),
            bodies,
            setting: Setting { method: file.method, stick: file.stick, dt },
            time_scale: clock.time_scale().unwrap_or(file.clock.time_scale),
            budget,
            unit,
            period: None,
            duration: 0.0,
            shortened: false,
        };
        problem.set_duration();
        if let Budget::Shape { until, .. } = file.budget {
            problem.duration = until;
        }
        Ok(problem)
    }

    /// A problem of bodies that no scene has, with a budget of one length.
    pub fn new(name: impl Into<String>, bodies: Vec<ProblemBody>, setting: Setting) -> Self {
        let name = name.into();
        let title = name.clone();
        let mut problem = Self {
            name,
            title,
            bodies,
            setting,
            time_scale: 1.0,
            budget: 1.0,
            unit: Unit::Length,
            period: None,
            duration: 0.0,
            shortened: false,
        };
        problem.set_duration();
        problem
    }

    fn set_duration(&mut self) {
        self.period = self.bodies.iter().filter_map(ProblemBody::period).reduce(f64::max);
        self.duration = self.period.map_or(WITHOUT_MUSCLES, |period| CYCLES * period);
    }

    /// The same over shorter times, whole cycles of the longest period, from the longest down to two cycles; none where nothing has a cycle.
    pub(super) fn shorter(&self) -> impl Iterator<Item = Self> {
        const FEWER: [f64; 6] = [8.0, 6.0, 5.0, 4.0, 3.0, 2.0];
        let durations = self.period.into_iter().flat_map(|period| FEWER.map(|cycles| cycles * period));
        let shorter = durations.filter(|duration| *duration < self.duration);
        shorter.map(|duration| Self { duration, shortened: true, ..self.clone() })
    }

    /// The time between two shared times.
    pub fn spacing(&self) -> f64 {
        self.duration / SAMPLES as f64
    }

    /// The shared times, at which every run is compared with the reference: a thousand, evenly, the last at the end and none at the start.
    pub fn times(&self) -> Vec<f64> {
        (1..=SAMPLES).map(|i| self.duration * (i as f64 / SAMPLES as f64)).collect()
    }

    /// How many shared times a cycle of the longest muscle lasts; nothing where that is no whole number, or where no muscle is.
    pub(super) fn samples_a_cycle(&self) -> Option<usize> {
        let samples = self.period? / self.spacing();
        let whole = libm::rint(samples);
        (whole >= 1.0 && libm::fabs(samples - whole) < 1e-6).then_some(whole as usize)
    }

    /// Whether a method can step every body.
    pub(super) fn can_be_stepped_by(&self, method: Method) -> bool {
        self.bodies.iter().all(|body| body.parts(method, StickRule::InStages).refused_by_method().is_none())
    }

    /// The largest step of a method that is stable for every body; infinite where none is unstable.
    pub fn stability_limit(&self, method: Method, stick: StickRule) -> f64 {
        self.bodies.iter().map(|body| body.stability_limit(method, stick)).fold(f64::INFINITY, f64::min)
    }

    /// A hash of the physics: of all that the exact motion depends on, and of nothing else.
    pub fn hash(&self) -> u128 {
        let mut hash = Fnv::new();
        hash.number(self.duration);
        hash.whole(SAMPLES as u64);
        hash.whole(self.bodies.len() as u64);
        self.bodies.iter().for_each(|body| body.hash(&mut hash));
        hash.finish()
    }
}
