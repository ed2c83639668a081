//! What can be set: how each quantity is read, checked and written.

use core::ops::Range;

use bevy::{ecs::world::EntityRef, prelude::*};

use super::{Kind, Parameter, six::SixQuantity};
use crate::{
    body::{
        BodyError, Coefficients, CoulombFriction, Gravity, Lattice, MassDamping, Muscle, Muscles, Neighbours, Particle,
        ParticleId, Particles, Rules, SpineFriction, Spring, SpringId, Springs, TravelingWave, TravelingWaves,
    },
    creatures::Attitude,
    physics::{Clock, StartState},
};

/// The component that a quantity belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    Clock,
    Springs,
    Particles,
    Muscles,
    /// The waves of a strand, one by one.
    Waves,
    /// All waves of a strand together.
    Gait,
    Friction,
    Coulomb,
    /// Damping by what surrounds a body.
    MassDamping,
    Gravity,
    /// The attitude in which a block starts, and its springs by the neighbours that they join.
    Block,
    Bonds,
    Collisions,
    Muscle,
    Legs,
    Weight,
    Drive,
}

impl Group {
    /// All but the clock.
    pub(super) const OF_BODIES: [Self; 16] = [
        Self::Springs,
        Self::Particles,
        Self::Muscles,
        Self::Waves,
        Self::Gait,
        Self::Friction,
        Self::Coulomb,
        Self::MassDamping,
        Self::Gravity,
        Self::Block,
        Self::Bonds,
        Self::Collisions,
        Self::Muscle,
        Self::Legs,
        Self::Weight,
        Self::Drive,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Clock => "clock",
            Self::Springs => "springs",
            Self::Particles => "particles",
            Self::Muscles => "muscles",
            Self::Waves => "waves",
            Self::Gait => "gait",
            Self::Friction => "friction",
            Self::Coulomb => "coulomb",
            Self::MassDamping => "mass_damping",
            Self::Gravity => "gravity",
            Self::Block => "block",
            Self::Bonds => "bonds",
            Self::Collisions => "collisions",
            Self::Muscle => "muscle",
            Self::Legs => "legs",
            Self::Weight => "weight",
            Self::Drive => "drive",
        }
    }

    /// Whether its elements are counted.
    pub(super) fn is_indexed(self) -> bool {
        matches!(
            self,
            Self::Springs
                | Self::Particles
                | Self::Muscles
                | Self::Waves
                | Self::Coulomb
                | Self::Muscle
                | Self::Legs
                | Self::Weight
                | Self::Drive
        )
    }

    /// Takes the group off the front of the part of a path behind the body's name.
    pub(super) fn parse(path: &str) -> (Option<Self>, &str) {
        let end = path.find(['.', '[']).unwrap_or(path.len());
        (Self::OF_BODIES.into_iter().find(|group| group.name() == &path[..end]), &path[end..])
    }
}

/// A number that can be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Quantity {
    Dt,
    TimeScale,
    Stiffness,
    Damping,
    RestLength,
    Mass,
    Amplitude,
    Period,
    Phase,
    Ramp,
    WaveAmplitude,
    WavePeriod,
    Wavelength,
    Lead,
    Steering,
    GaitRamp,
    Active,
    Drag,
    Grip,
    Isotropic,
    Brake,
    Ratchet,
    Forward,
    Backward,
    Sideways,
    DampingRate,
    DampingPerStep,
    Gravity,
    Tilt,
    /// Of all springs of a block between neighbours of a kind.
    KindStiffness(Neighbours),
    KindDamping(Neighbours),
    KindRestLength(Neighbours),
    /// Of a body of the six-matrix particle system.
    Six(SixQuantity),
}

impl Quantity {
    pub(super) const OF_BODIES: [Self; 55] = [
        Self::Stiffness,
        Self::Damping,
        Self::RestLength,
        Self::Mass,
        Self::Amplitude,
        Self::Period,
        Self::Phase,
        Self::Ramp,
        Self::WaveAmplitude,
        Self::WavePeriod,
        Self::Wavelength,
        Self::Lead,
        Self::Steering,
        Self::GaitRamp,
        Self::Active,
        Self::Drag,
        Self::Grip,
        Self::Isotropic,
        Self::Brake,
        Self::Ratchet,
        Self::Forward,
        Self::Backward,
        Self::Sideways,
        Self::DampingRate,
        Self::DampingPerStep,
        Self::Gravity,
        Self::Tilt,
        Self::KindStiffness(Neighbours::Edges),
        Self::KindDamping(Neighbours::Edges),
        Self::KindRestLength(Neighbours::Edges),
        Self::KindStiffness(Neighbours::Faces),
        Self::KindDamping(Neighbours::Faces),
        Self::KindRestLength(Neighbours::Faces),
        Self::KindStiffness(Neighbours::Cubes),
        Self::KindDamping(Neighbours::Cubes),
        Self::KindRestLength(Neighbours::Cubes),
        Self::Six(SixQuantity::Damping),
        Self::Six(SixQuantity::BondStiffness),
        Self::Six(SixQuantity::CollisionStiffness),
        Self::Six(SixQuantity::Strength),
        Self::Six(SixQuantity::Half),
        Self::Six(SixQuantity::Seek),
        Self::Six(SixQuantity::Push),
        Self::Six(SixQuantity::Grip),
        Self::Six(SixQuantity::Pull),
        Self::Six(SixQuantity::Friction),
        Self::Six(SixQuantity::Speed),
        Self::Six(SixQuantity::Mean),
        Self::Six(SixQuantity::Limit),
        Self::Six(SixQuantity::Lift),
        Self::Six(SixQuantity::Front),
        Self::Six(SixQuantity::Side),
        Self::Six(SixQuantity::Down),
        Self::Six(SixQuantity::Out),
        Self::Six(SixQuantity::Reach),
    ];

    pub(super) fn group(self) -> Group {
        self.facts().0
    }

    pub(super) fn field(self) -> &'static str {
        self.facts().1
    }

    /// The field as it follows the group in a path; gravity is its own group.
    pub(super) fn field_in_path(self) -> &'static str {
        if self == Self::Gravity { "" } else { self.field() }
    }

    pub(super) fn path(self, body: &str, index: Option<usize>) -> String {
        let (group, field) = (self.group().name(), self.field_in_path());
        match index {
            _ if field.is_empty() => format!("{body}.{group}"),
            None => format!("{body}.{group}.{field}"),
            Some(index) => format!("{body}.{group}[{index}].{field}"),
        }
    }

    pub(super) fn parameter(self, path: String, value: f64) -> Parameter {
        let (_, _, _, (least, most), unit, help) = self.facts();
        // A value beyond the usual range gets a slider up to the next power of ten.
        let widen = |value: f64| libm::pow(10.0, libm::ceil(libm::log10(value)));
        let most = if value > most { widen(value) } else { most };
        let least = if value < -1.0 && value < least { -widen(-value) } else { least.min(value) };
        let kind = if self.is_toggle() { Kind::Toggle } else { Kind::Number };
        Parameter { path, value, range: least..=most, unit, help, kind }
    }

    fn is_toggle(self) -> bool {
        matches!(self, Self::Ratchet | Self::Active)
    }

    pub(super) fn admits(self, value: f64) -> bool {
        self.facts().2.admits(value)
            && match self {
                _ if self.is_toggle() => value == 0.0 || value == 1.0,
                Self::TimeScale => value <= Clock::LARGEST_TIME_SCALE,
                _ => true,
            }
    }

    /// What a value must be, in words.
    pub(super) fn requirement(self) -> String {
        match self {
            _ if self.is_toggle() => "0 (off) or 1 (on)".into(),
            Self::TimeScale => format!("a number from 0 to {}", Clock::LARGEST_TIME_SCALE),
            _ => self.facts().2.to_string(),
        }
    }

    /// How many of it a body has.
    pub(super) fn count(self, body: EntityRef) -> usize {
        let has_springs = !body.contains::<Rules>();
        match self.group() {
            _ if matches!(self, Self::Six(_)) => self.read(body).len(),
            Group::Clock => 0,
            Group::Springs => body.get::<Springs>().map_or(0, Springs::len),
            // The particles of the six-matrix system are of unit mass.
            Group::Particles if !has_springs => 0,
            Group::Particles => body.get::<Particles>().map_or(0, Particles::len),
            Group::Muscles => body.get::<Muscles>().map_or(0, Muscles::len),
            Group::Waves => body.get::<TravelingWaves>().map_or(0, TravelingWaves::len),
            Group::Gait => usize::from(body.contains::<TravelingWaves>()),
            // Only muscles that can be told to rest need a brake.
            Group::Friction if self == Self::Brake && !body.contains::<TravelingWaves>() => 0,
            Group::Friction => usize::from(body.contains::<SpineFriction>()),
            Group::Coulomb => body.get::<CoulombFriction>().map_or(0, |friction| friction.sets().len()),
            Group::MassDamping => usize::from(body.get::<MassDamping>().is_some_and(|damping| self.is_of(*damping))),
            Group::Gravity => usize::from(body.contains::<Particles>() && has_springs),
            Group::Bonds | Group::Collisions | Group::Muscle | Group::Legs | Group::Weight | Group::Drive => 0,
            Group::Block if self == Self::Tilt => usize::from(body.contains::<Attitude>()),
            Group::Block => usize::from(self.springs(body).is_some()),
        }
    }

    /// The values of a body, one an element; none where the body has no such thing.
    pub(super) fn read(self, body: EntityRef) -> Vec<f64> {
        if let Self::Six(six) = self {
            return six.read(body);
        }
        if self.count(body) == 0 {
            return Vec::new();
        }
        match self.group() {
            Group::Clock => Vec::new(),
            Group::Springs => body
                .get::<Springs>()
                .map(|springs| springs.iter().map(|mut spring| *self.of_spring(&mut spring)).collect())
                .unwrap_or_default(),
            Group::Particles => {
                body.get::<Particles>().map(|particles| particles.masses().to_vec()).unwrap_or_default()
            }
            Group::Muscles => body
                .get::<Muscles>()
                .map(|muscles| muscles.iter().map(|mut muscle| *self.of_muscle(&mut muscle)).collect())
                .unwrap_or_default(),
            Group::Waves => body
                .get::<TravelingWaves>()
                .map(|waves| waves.iter().map(|mut wave| *self.of_wave(&mut wave)).collect())
                .unwrap_or_default(),
            Group::Gait => body.get::<TravelingWaves>().map(|waves| self.of_gait(waves)).into_iter().collect(),
            Group::Friction => {
                body.get::<SpineFriction>().map(|friction| self.of_friction(friction)).into_iter().collect()
            }
            Group::Coulomb => body
                .get::<CoulombFriction>()
                .map(|friction| friction.sets().iter().map(|&(mut set)| *self.of_coulomb(&mut set)).collect())
                .unwrap_or_default(),
            Group::MassDamping => body
                .get::<MassDamping>()
                .map(|&(MassDamping::Rate(value) | MassDamping::PerStep(value))| value)
                .into_iter()
                .collect(),
            Group::Gravity => vec![body.get::<Gravity>().map_or(0.0, |gravity| gravity.acceleration())],
            Group::Block if self == Self::Tilt => body.get::<Attitude>().map(Attitude::tilt).into_iter().collect(),
            Group::Block => {
                let first = self.springs(body).map(|springs| SpringId(springs.start as u32));
                let first = first.zip(body.get::<Springs>()).and_then(|(first, springs)| springs.get(first));
                first.map(|mut spring| *self.of_spring(&mut spring)).into_iter().collect()
            }
            Group::Bonds | Group::Collisions | Group::Muscle | Group::Legs | Group::Weight | Group::Drive => Vec::new(),
        }
    }

    /// Writes the value to one element of a body or to all, touching only what changes. `time` is when.
    pub(super) fn write(
        self,
        mut body: EntityWorldMut,
        index: Option<usize>,
        value: f64,
        time: f64,
    ) -> Result<(), BodyError> {
        if let Some(springs) = self.springs(body.as_readonly()) {
            return self.write_springs(body, springs, value);
        }
        let values = self.read(body.as_readonly());
        let changed = (0..values.len()).filter(|&i| index.is_none_or(|index| index == i) && values[i] != value);
        for i in changed {
            // Counts come from vectors that are indexed by u32.
            let id = i as u32;
            if let Self::Six(six) = self {
                six.write(&mut body, i, value)?;
                continue;
            }
            match self.group() {
                Group::Clock
                | Group::Bonds
                | Group::Collisions
                | Group::Muscle
                | Group::Legs
                | Group::Weight
                | Group::Drive => {}
                Group::Springs => {
                    if let Some(mut springs) = body.get_mut::<Springs>()
                        && let Some(mut spring) = springs.get(SpringId(id))
                    {
                        *self.of_spring(&mut spring) = value;
                        springs.set(SpringId(id), spring)?;
                    }
                }
                Group::Particles => {
                    if let Some(mut particles) = body.get_mut::<Particles>()
                        && let Some(particle) = particles.get(ParticleId(id))
                    {
                        particles.set(ParticleId(id), Particle { mass: value, ..particle })?;
                    }
                }
                Group::Muscles => {
                    if let Some(mut muscles) = body.get_mut::<Muscles>()
                        && let Some(mut muscle) = muscles.get(i)
                    {
                        *self.of_muscle(&mut muscle) = value;
                        muscles.set(i, muscle, time)?;
                    }
                }
                Group::Waves => {
                    if let Some(mut waves) = body.get_mut::<TravelingWaves>()
                        && let Some(mut wave) = waves.get(i)
                    {
                        *self.of_wave(&mut wave) = value;
                        waves.set(i, wave, time)?;
                    }
                }
                Group::Gait => {
                    if let Some(mut waves) = body.get_mut::<TravelingWaves>() {
                        self.set_gait(&mut waves, value, time)?;
                    }
                }
                Group::Friction => {
                    if let Some(mut friction) = body.get_mut::<SpineFriction>() {
                        *friction = self.with_friction(friction.clone(), value)?;
                    }
                }
                Group::Coulomb => {
                    if let Some(mut friction) = body.get_mut::<CoulombFriction>()
                        && let Some(&(mut set)) = friction.sets().get(i)
                    {
                        *self.of_coulomb(&mut set) = value;
                        friction.set(i, set)?;
                    }
                }
                Group::MassDamping => {
                    let damping = match self {
                        Self::DampingPerStep => MassDamping::per_step(value)?,
                        _ => MassDamping::rate(value)?,
                    };
                    body.insert(damping);
                }
                Group::Gravity => {
                    body.insert(Gravity::new(value)?);
                }
                Group::Block => {
                    let Some(mut attitude) = body.get::<Attitude>().copied() else { continue };
                    attitude.set_tilt(value)?;
                    body.insert(attitude);
                    let Some(mut particles) = body.get_mut::<Particles>() else { continue };
                    attitude.place(&mut particles)?;
                    let start = StartState(particles.clone());
                    body.insert(start);
                }
            }
        }
        Ok(())
    }

    /// What a quantity of neighbours of a kind is called for all springs together; nothing for others.
    pub(super) fn of_all_springs(self) -> Option<Self> {
        match self {
            Self::KindStiffness(_) => Some(Self::Stiffness),
            Self::KindDamping(_) => Some(Self::Damping),
            Self::KindRestLength(_) => Some(Self::RestLength),
            _ => None,
        }
    }

    /// Whether one value can be meant for all elements. The springs of a block to neighbours at different distances have no length in common: one would crumple it.
    pub(super) fn has_one_for_all(self, body: EntityRef) -> bool {
        self != Self::RestLength || !body.contains::<Lattice>()
    }

    /// The springs that a quantity of a block sets, where it has any.
    pub(super) fn springs(self, body: EntityRef) -> Option<Range<usize>> {
        let (Self::KindStiffness(kind) | Self::KindDamping(kind) | Self::KindRestLength(kind)) = self else {
            return None;
        };
        let range = body.get::<Lattice>()?.range(kind);
        body.get::<Springs>().filter(|springs| !range.is_empty() && range.end <= springs.len()).map(|_| range)
    }

    /// Writes the value to springs, touching them only where one changes.
    fn write_springs(self, mut body: EntityWorldMut, range: Range<usize>, value: f64) -> Result<(), BodyError> {
        let Some(mut springs) = body.get_mut::<Springs>() else { return Ok(()) };
        for i in range {
            // Springs are counted in u32.
            let id = SpringId(i as u32);
            let Some(mut spring) = springs.get(id) else { continue };
            let own = self.of_spring(&mut spring);
            if *own != value {
                *own = value;
                springs.set(id, spring)?;
            }
        }
        Ok(())
    }

    fn of_spring(self, spring: &mut Spring) -> &mut f64 {
        match self {
            Self::Damping | Self::KindDamping(_) => &mut spring.damping,
            Self::RestLength | Self::KindRestLength(_) => &mut spring.rest_length,
            _ => &mut spring.stiffness,
        }
    }

    fn of_muscle(self, muscle: &mut Muscle) -> &mut f64 {
        match self {
            Self::Period => &mut muscle.period,
            Self::Phase => &mut muscle.phase,
            Self::Ramp => &mut muscle.ramp,
            _ => &mut muscle.amplitude,
        }
    }

    fn of_wave(self, wave: &mut TravelingWave) -> &mut f64 {
        match self {
            Self::WavePeriod => &mut wave.period,
            Self::Wavelength => &mut wave.wavelength,
            Self::Lead => &mut wave.lead,
            _ => &mut wave.amplitude,
        }
    }

    fn of_coulomb(self, set: &mut Coefficients) -> &mut f64 {
        match self {
            Self::Backward => &mut set.backward,
            Self::Sideways => &mut set.sideways,
            _ => &mut set.forward,
        }
    }

    /// Whether the damping is given in this way.
    fn is_of(self, damping: MassDamping) -> bool {
        matches!(damping, MassDamping::PerStep(_)) == (self == Self::DampingPerStep)
    }

    fn of_gait(self, waves: &TravelingWaves) -> f64 {
        match self {
            Self::GaitRamp => waves.ramp(),
            Self::Active => f64::from(u8::from(waves.is_active())),
            _ => waves.steering(),
        }
    }

    fn set_gait(self, waves: &mut TravelingWaves, value: f64, time: f64) -> Result<(), BodyError> {
        match self {
            Self::GaitRamp => waves.set_ramp(value, time),
            Self::Active => {
                waves.set_active(value != 0.0, time);
                Ok(())
            }
            _ => waves.set_steering(value),
        }
    }

    fn of_friction(self, friction: &SpineFriction) -> f64 {
        match self {
            Self::Grip => friction.grip(),
            Self::Isotropic => friction.isotropic(),
            Self::Brake => friction.brake(),
            Self::Ratchet => f64::from(u8::from(friction.ratchet())),
            _ => friction.drag(),
        }
    }

    fn with_friction(self, friction: SpineFriction, value: f64) -> Result<SpineFriction, BodyError> {
        match self {
            Self::Grip => friction.with_grip(value),
            Self::Isotropic => friction.with_isotropic(value),
            Self::Brake => friction.with_brake(value),
            Self::Ratchet => Ok(friction.with_ratchet(value != 0.0)),
            _ => friction.with_drag(value),
        }
    }
}
