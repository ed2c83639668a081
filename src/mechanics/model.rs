//! A body, or several of equal topology side by side, in the layout that steps work on.

use crate::body::{
    CoulombFriction, Epoch, Gravity, Ground, Guidance, Lattice, MassDamping, Muscle, Muscles, ParticleId, Particles,
    Pull, SpineFriction, Spring, Springs, Strand, Tearing, TravelingWaves, Wave, WaveKind,
};

use super::{
    Real,
    coulomb::Coulomb,
    forces::direction,
    ground::Contact,
    integrators::{Method, StickRule},
    lattice::LatticeRows,
    pull::PullRow,
    strand::{StrandRows, in_space},
    tearing::TearingRows,
};

/// Components of one body, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct BodyParts<'a> {
    /// Its particles.
    pub particles: &'a Particles,
    /// Its springs.
    pub springs: &'a Springs,
    /// Its muscles, if it has any.
    pub muscles: Option<&'a Muscles>,
    /// The lattice that it is, if it is one.
    pub strand: Option<Strand>,
    /// The block on a grid that it is, if it is one.
    pub lattice: Option<Lattice>,
    /// Where a hand pulls at it, if one does.
    pub pull: Option<Pull>,
    /// When its springs tear, if they do.
    pub tearing: Option<&'a Tearing>,
    /// The waves that travel along the lattice, if any do.
    pub waves: Option<&'a TravelingWaves>,
    /// How its waves are guided.
    pub guidance: Guidance,
    /// Its friction, if it has any.
    pub friction: Option<&'a SpineFriction>,
    /// Its dry friction, if it has any.
    pub coulomb: Option<&'a CoulombFriction>,
    /// Its gravity, if it has any.
    pub gravity: Option<Gravity>,
    /// The ground that it stands on, if any.
    pub ground: Option<&'a Ground>,
    /// Its damping by what surrounds it, if any.
    pub mass_damping: Option<MassDamping>,
    /// The method that steps it.
    pub method: Method,
    /// When friction acts in a step of the method.
    pub stick: StickRule,
}

impl<'a> BodyParts<'a> {
    /// A body of particles and springs, and of nothing else.
    pub fn new(particles: &'a Particles, springs: &'a Springs, method: Method) -> Self {
        Self {
            particles,
            springs,
            muscles: None,
            strand: None,
            lattice: None,
            pull: None,
            tearing: None,
            waves: None,
            guidance: Guidance::default(),
            friction: None,
            coulomb: None,
            gravity: None,
            ground: None,
            mass_damping: None,
            method,
            stick: StickRule::InStages,
        }
    }

    /// Why its method cannot step the body at all, if it cannot.
    pub fn refused_by_method(&self) -> Option<&'static str> {
        if self.method != Method::ExactFlow {
            None
        } else if self.tearing.is_some() {
            Some("ExactFlow steps no springs that tear")
        } else if self.friction.is_some_and(|friction| friction.isotropic() > 0.0) {
            Some("ExactFlow knows no isotropic friction")
        } else if self.coulomb.is_some() {
            Some("ExactFlow does not locate the events of Coulomb friction")
        } else if !self.on_axis() {
            Some("it is not on an axis along x: ExactFlow takes no gravity, no ground, and no mass beside the line")
        } else {
            None
        }
    }

    /// Whether the body lies on a line along x and nothing can move it off: no gravity, no ground, every y and z the same and at rest. One
    /// dimension is enough to step it then.
    pub fn on_axis(&self) -> bool {
        let [_, y, z] = self.particles.position_columns();
        let [_, vy, vz] = self.particles.velocity_columns();
        let level = |column: &[f64]| column.iter().all(|value| *value == column[0]);
        let still = |column: &[f64]| column.iter().all(|value| *value == 0.0);
        self.gravity.is_none() && self.ground.is_none() && level(y) && level(z) && still(vy) && still(vz)
    }

    /// What is left of it without friction, contact and gravity and with its muscles at rest.
    pub(crate) fn bare(&self) -> Self {
        Self { muscles: None, waves: None, friction: None, coulomb: None, gravity: None, ground: None, ..*self }
    }

    /// Whether it gains from being stepped side by side with bodies of equal topology.
    pub fn side_by_side(&self) -> bool {
        self.method.side_by_side()
            && self.pull.is_none()
            && !self.is_regular()
            && !(self.stick == StickRule::Located && self.method.locates())
    }

    /// Whether both bodies can be stepped side by side: the same graph of springs, muscles and spine, and the same rules; numbers may differ.
    pub fn same_topology(&self, other: &Self) -> bool {
        fn driven<'a>(muscles: Option<&'a Muscles>) -> impl Iterator<Item = (u32, Wave)> + 'a {
            muscles.into_iter().flat_map(Muscles::iter).map(|muscle| (muscle.spring.0, muscle.wave))
        }
        fn traveling<'a>(waves: Option<&'a TravelingWaves>) -> impl Iterator<Item = (WaveKind, Wave)> + 'a {
            waves.into_iter().flat_map(TravelingWaves::iter).map(|wave| (wave.kind, wave.form))
        }
        fn rule(friction: Option<&SpineFriction>) -> Option<(bool, usize, &[ParticleId])> {
            friction.map(|friction| (friction.ratchet(), friction.width(), friction.spine()))
        }
        (self.method, self.stick) == (other.method, other.stick)
            && self.particles.len() == other.particles.len()
            && self.springs.ends() == other.springs.ends()
            && driven(self.muscles).eq(driven(other.muscles))
            && (self.tearing.is_some(), self.pull.is_some()) == (other.tearing.is_some(), other.pull.is_some())
            && (self.strand, self.lattice) == (other.strand, other.lattice)
            && self.waves.is_some() == other.waves.is_some()
            && traveling(self.waves).eq(traveling(other.waves))
            && rule(self.friction) == rule(other.friction)
            && self.coulomb.map(CoulombFriction::spine) == other.coulomb.map(CoulombFriction::spine)
            && self.ground == other.ground
            && self.gravity.is_some() == other.gravity.is_some()
            && self.mass_damping.is_some() == other.mass_damping.is_some()
    }
}

/// Positions and velocities of the particles, `D` coordinates each.
#[derive(Clone, Debug, Default)]
pub struct State<R, const D: usize> {
    /// Positions.
    pub position: Vec<[R; D]>,
    /// Velocities.
    pub velocity: Vec<[R; D]>,
}

/// One spring as the force loop reads it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpringRow<R> {
    pub(super) ends: [u32; 2],
    pub(super) stiffness: R,
    pub(super) damping: R,
    /// The rest length without muscles.
    pub(super) rest_length: R,
    /// Beyond this length the watch holds the body for exploded.
    pub(super) longest: R,
}

/// One muscle as the force loop reads it.
#[derive(Clone, Copy, Debug)]
pub(super) struct MuscleRow<R> {
    pub(super) spring: u32,
    pub(super) wave: Wave,
    pub(super) amplitude: R,
    pub(super) frequency: R,
    pub(super) phase: R,
    pub(super) ramp: R,
    pub(super) ramp_rate: R,
    pub(super) epoch_time: R,
    pub(super) epoch_cycles: R,
}

impl<R: Real> MuscleRow<R> {
    fn idle(muscle: Muscle) -> Self {
        let zero = R::splat(0.0);
        Self {
            spring: muscle.spring.0,
            wave: muscle.wave,
            amplitude: zero,
            frequency: zero,
            phase: zero,
            ramp: zero,
            ramp_rate: zero,
            epoch_time: zero,
            epoch_cycles: zero,
        }
    }

    fn set_lane(&mut self, lane: usize, muscle: Muscle, epoch: Epoch) {
        self.amplitude.set_lane(lane, muscle.amplitude);
        self.frequency.set_lane(lane, 1.0 / muscle.period);
        self.phase.set_lane(lane, muscle.phase);
        self.ramp.set_lane(lane, muscle.ramp);
        self.ramp_rate.set_lane(lane, if muscle.ramp > 0.0 { 1.0 / muscle.ramp } else { 0.0 });
        self.epoch_time.set_lane(lane, epoch.time);
        self.epoch_cycles.set_lane(lane, epoch.cycles);
    }
}

impl MuscleRow<f64> {
    /// One muscle of a body.
    pub(super) fn of(muscle: Muscle, epoch: Epoch) -> Self {
        let mut row = Self::idle(muscle);
        row.set_lane(0, muscle, epoch);
        row
    }
}

/// A particle of the spine with the sections before and behind its own; at the ends one of them is its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpineRow {
    pub(super) particle: u32,
    /// The number of the section or, where a section is a single particle, that particle.
    pub(super) previous: u32,
    /// As `previous`.
    pub(super) next: u32,
}

impl SpineRow {
    /// The rows of a spine of single particles.
    pub(super) fn along(spine: &[ParticleId]) -> impl Iterator<Item = Self> + '_ {
        (0..spine.len()).map(|i| Self {
            particle: spine[i].0,
            previous: spine[i.saturating_sub(1)].0,
            next: spine[(i + 1).min(spine.len() - 1)].0,
        })
    }
}

/// The sections of a spine that are more than single particles.
#[derive(Clone, Debug)]
pub(super) struct Sections {
    /// Section by section.
    pub(super) particles: Vec<u32>,
    /// How many particles a section has.
    pub(super) width: usize,
}

impl Sections {
    /// The sections of a spine and its rows, one a particle.
    fn of(friction: &SpineFriction) -> (Self, Vec<SpineRow>) {
        let last = (friction.spine().len() / friction.width()).saturating_sub(1);
        let mut rows = Vec::with_capacity(friction.spine().len());
        for (i, section) in friction.sections().enumerate() {
            let (previous, next) = (i.saturating_sub(1) as u32, (i + 1).min(last) as u32);
            rows.extend(section.iter().map(|particle| SpineRow { particle: particle.0, previous, next }));
        }
        let particles = friction.spine().iter().map(|particle| particle.0).collect();
        (Self { particles, width: friction.width() }, rows)
    }
}

/// Friction rates as the friction rules read them.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrictionRow<R> {
    pub(super) ratchet: bool,
    pub(super) has_drag: bool,
    pub(super) has_grip: bool,
    pub(super) has_isotropic: bool,
    pub(super) drag: R,
    pub(super) grip: Fading<R>,
    pub(super) isotropic: Fading<R>,
    /// 1 − e^(−μ_f dt): what drag takes in a step.
    pub(super) drag_loss: R,
}

/// A rate at which something dies away.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fading<R> {
    /// μ.
    pub(super) rate: R,
    /// 1 − e^(−μ dt): what goes in a step.
    pub(super) loss: R,
}

impl<R: Real> Fading<R> {
    /// The same in every lane.
    pub(super) fn splat(rate: f64, dt: f64) -> Self {
        Self { rate: R::splat(rate), loss: R::splat(-libm::expm1(-rate * dt)) }
    }

    pub(super) fn set_lane(&mut self, lane: usize, rate: f64, dt: f64) {
        self.rate.set_lane(lane, rate);
        self.loss.set_lane(lane, -libm::expm1(-rate * dt));
    }

    pub(super) fn lane(&self, lane: usize) -> Fading<f64> {
        Fading { rate: self.rate.lane(lane), loss: self.loss.lane(lane) }
    }
}

/// Damping in proportion to mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct DampingRow<R> {
    /// The rate c.
    pub(super) rate: R,
    /// λ = 1 − e^(−c dt): what it takes of a velocity in a step.
    pub(super) loss: R,
}

/// Everything about a body that a step reads and does not change, for as many bodies as [`Real::LANES`], in `D` dimensions (1 for bodies
/// [on an axis](BodyParts::on_axis), else 3).
#[derive(Clone, Debug)]
pub struct Model<R, const D: usize> {
    pub(super) dt: f64,
    /// 1/m, and 0 for what is pinned.
    pub(super) inverse_mass: Vec<R>,
    pub(super) springs: Vec<SpringRow<R>>,
    pub(super) muscles: Vec<MuscleRow<R>>,
    pub(super) strand: Option<StrandRows<R>>,
    /// A block that [is regular](BodyParts::is_regular); its springs are not among `springs`.
    pub(super) lattice: Option<LatticeRows>,
    pub(super) tearing: Option<TearingRows<R>>,
    pub(super) pull: Option<PullRow>,
    pub(super) spine: Vec<SpineRow>,
    /// Where the sections of the spine are more than single particles.
    pub(super) sections: Option<Sections>,
    pub(super) friction: Option<FrictionRow<R>>,
    pub(super) coulomb: Option<Coulomb<R, D>>,
    pub(super) gravity: Option<R>,
    pub(super) contact: Contact<R, D>,
    pub(super) damping: Option<DampingRow<R>>,
    pub(super) stick: StickRule,
    /// Rest lengths at the time of the last evaluation: scratch of the force loop.
    pub(super) rest: Vec<R>,
    /// 1 in the lanes where an evaluation met a spring longer than its longest, or of no finite length; else 0.
    pub(super) overstretched: R,
    /// How often the forces of the whole body were evaluated since the tick began.
    pub(super) evaluations: R,
    /// 1 in the lanes of bodies for which the method could not take a step; else 0.
    pub(super) refused: R,
}

/// What has exploded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explosion {
    /// The particle that is not finite, or the faster end of the spring.
    pub particle: usize,
    /// The spring that is too long, if it is that.
    pub spring: Option<usize>,
}

/// A spring longer than this many rest lengths has exploded.
pub(super) const LONGEST_STRETCH: f64 = 1.0 + Tearing::EXPLODED;

impl<R: Real, const D: usize> Model<R, D> {
    /// `first` in the first lane, the others in the lanes after it, for steps of `dt`. All have the same
    /// [topology](BodyParts::same_topology); lanes that are left over hold `first` again, and others that find no lane are left out.
    pub fn new<'a>(first: &BodyParts<'a>, others: impl IntoIterator<Item = BodyParts<'a>>, dt: f64) -> Self {
        let mut model = Self::idle(first, dt);
        let mut others = others.into_iter();
        model.set_lane(0, first);
        for lane in 1..R::LANES {
            model.set_lane(lane, &others.next().unwrap_or(*first));
        }
        model
    }

    /// Forgets what was noted and counted in the steps before, of a model that steps a body again.
    pub fn begin_tick(&mut self) {
        let zero = R::splat(0.0);
        (self.overstretched, self.evaluations, self.refused) = (zero, zero, zero);
    }

    /// The topology of `body`, without its numbers.
    fn idle(body: &BodyParts<'_>, dt: f64) -> Self {
        let zero = R::splat(0.0);
        let spring = |spring: Spring| SpringRow {
            ends: [spring.ends[0].0, spring.ends[1].0],
            stiffness: zero,
            damping: zero,
            rest_length: zero,
            longest: zero,
        };
        let (sections, spine) = match body.friction {
            Some(friction) if friction.width() > 1 => {
                let (sections, rows) = Sections::of(friction);
                (Some(sections), rows)
            }
            friction => (None, SpineRow::along(friction.map_or(&[], SpineFriction::spine)).collect()),
        };
        let contact = Contact::new(body.ground, dt);
        // One dimension has no grid, and bodies side by side share no slabs.
        let lattice = if D == 3 && R::LANES == 1 { LatticeRows::of(body) } else { None };
        // A strand has the numbers of its springs in rows of its own.
        let in_rows = body.strand.is_some() && body.tearing.is_none() && body.method.asks_forces_alone();
        let listed = if lattice.is_some() || in_rows { 0 } else { body.springs.len() };
        Self {
            dt,
            inverse_mass: vec![zero; body.particles.len()],
            springs: body.springs.iter().take(listed).map(spring).collect(),
            muscles: body.muscles.into_iter().flat_map(Muscles::iter).map(MuscleRow::idle).collect(),
            strand: body.strand.map(|strand| StrandRows::idle(strand, body.waves)),
            pull: PullRow::of(body, dt),
            tearing: body.tearing.map(|_| TearingRows::idle(body.springs.len())),
            spine,
            sections,
            friction: body.friction.map(|friction| FrictionRow {
                ratchet: friction.ratchet(),
                has_drag: false,
                has_grip: contact.has_patches(),
                has_isotropic: false,
                drag: zero,
                grip: Fading { rate: zero, loss: zero },
                isotropic: Fading { rate: zero, loss: zero },
                drag_loss: zero,
            }),
            coulomb: body.coulomb.map(|coulomb| Coulomb::idle(coulomb, body.particles.len())),
            gravity: body.gravity.map(|_| zero),
            contact,
            damping: body.mass_damping.map(|_| DampingRow { rate: zero, loss: zero }),
            stick: body.stick,
            rest: vec![zero; if lattice.is_some() { 0 } else { body.springs.len() }],
            lattice,
            overstretched: zero,
            evaluations: zero,
            refused: zero,
        }
    }

    /// Puts the numbers of `body` into a lane.
    fn set_lane(&mut self, lane: usize, body: &BodyParts<'_>) {
        for ((row, &mass), &pinned) in
            self.inverse_mass.iter_mut().zip(body.particles.masses()).zip(body.particles.pinned())
        {
            row.set_lane(lane, if pinned { 0.0 } else { 1.0 / mass });
        }
        if let Some(pull) = &self.pull {
            self.inverse_mass[pull.particle].set_lane(lane, 1.0 / (body.particles.masses()[pull.particle] + pull.mass));
        }
        for (row, spring) in self.springs.iter_mut().zip(body.springs.iter()) {
            row.stiffness.set_lane(lane, spring.stiffness);
            row.damping.set_lane(lane, spring.damping);
            row.rest_length.set_lane(lane, spring.rest_length);
            row.longest.set_lane(lane, LONGEST_STRETCH * spring.rest_length);
        }
        self.set_tearing_lane(lane, body);
        let muscles = body.muscles.into_iter().flat_map(|muscles| muscles.iter().zip(muscles.epochs()));
        for (row, (muscle, &epoch)) in self.muscles.iter_mut().zip(muscles) {
            row.set_lane(lane, muscle, epoch);
        }
        if let Some(strand) = &mut self.strand {
            strand.set_lane(lane, body, LONGEST_STRETCH);
        }
        if let (Some(row), Some(friction)) = (&mut self.friction, body.friction) {
            let rests = body.waves.is_some_and(|waves| !(waves.is_active() && body.guidance.is_active()));
            let brake = if rests { friction.brake() } else { 0.0 };
            let (drag, grip) = (friction.drag().max(brake), friction.grip().max(brake));
            row.has_drag |= drag > 0.0;
            row.has_grip |= grip > 0.0;
            row.has_isotropic |= friction.isotropic() > 0.0;
            row.drag.set_lane(lane, drag);
            row.drag_loss.set_lane(lane, -libm::expm1(-drag * self.dt));
            row.grip.set_lane(lane, grip, self.dt);
            self.contact.set_least_grip(lane, brake, self.dt);
            row.isotropic.set_lane(lane, friction.isotropic(), self.dt);
        }
        if let Some(coulomb) = &mut self.coulomb {
            coulomb.set_lane(lane, body);
        }
        if let (Some(row), Some(gravity)) = (&mut self.gravity, body.gravity) {
            row.set_lane(lane, gravity.acceleration());
        }
        if let (Some(row), Some(damping)) = (&mut self.damping, body.mass_damping) {
            let rate = damping.rate_at(self.dt);
            row.rate.set_lane(lane, rate);
            row.loss.set_lane(lane, -libm::expm1(-rate * self.dt));
        }
    }

    /// The strand whose springs are not listed one by one.
    #[inline(always)]
    fn unlisted_strand(&self) -> Option<&StrandRows<R>> {
        self.strand.as_ref().filter(|_| self.springs.is_empty())
    }

    /// Notes springs that are too long, or of no finite length.
    #[inline(always)]
    pub(super) fn note_lengths(&mut self, state: &State<R, D>) {
        if self.lattice.is_some() {
            self.note_lattice(state);
        }
        let mut too_long = self.overstretched;
        if let (Some(rows), Some(position)) = (self.unlisted_strand(), in_space(&state.position)) {
            too_long = rows.too_long(position).any(too_long);
        }
        for spring in &self.springs {
            let [a, b] = spring.ends.map(|end| state.position[end as usize]);
            too_long = direction(a, b).0.if_below(spring.longest, too_long, R::splat(1.0));
        }
        self.overstretched = too_long;
    }

    /// The body in one lane, alone.
    pub(super) fn lane(&self, lane: usize) -> Model<f64, D> {
        let of = |value: &R| value.lane(lane);
        Model {
            dt: self.dt,
            inverse_mass: self.inverse_mass.iter().map(of).collect(),
            springs: (self.springs.iter())
                .map(|row| SpringRow {
                    ends: row.ends,
                    stiffness: of(&row.stiffness),
                    damping: of(&row.damping),
                    rest_length: of(&row.rest_length),
                    longest: of(&row.longest),
                })
                .collect(),
            muscles: (self.muscles.iter())
                .map(|row| MuscleRow {
                    spring: row.spring,
                    wave: row.wave,
                    amplitude: of(&row.amplitude),
                    frequency: of(&row.frequency),
                    phase: of(&row.phase),
                    ramp: of(&row.ramp),
                    ramp_rate: of(&row.ramp_rate),
                    epoch_time: of(&row.epoch_time),
                    epoch_cycles: of(&row.epoch_cycles),
                })
                .collect(),
            strand: self.strand.as_ref().map(|strand| strand.lane(lane)),
            lattice: self.lattice.clone(),
            pull: self.pull,
            tearing: self.tearing.as_ref().map(|rows| rows.lane(lane)),
            spine: self.spine.clone(),
            sections: self.sections.clone(),
            friction: self.friction.as_ref().map(|row| FrictionRow {
                ratchet: row.ratchet,
                has_drag: row.has_drag,
                has_grip: row.has_grip,
                has_isotropic: row.has_isotropic,
                drag: of(&row.drag),
                grip: row.grip.lane(lane),
                isotropic: row.isotropic.lane(lane),
                drag_loss: of(&row.drag_loss),
            }),
            gravity: self.gravity.as_ref().map(of),
            contact: self.contact.lane(lane),
            coulomb: self.coulomb.as_ref().map(|coulomb| coulomb.lane(lane)),
            damping: self.damping.as_ref().map(|row| DampingRow { rate: of(&row.rate), loss: of(&row.loss) }),
            stick: self.stick,
            rest: self.rest.iter().map(of).collect(),
            overstretched: of(&self.overstretched),
            evaluations: of(&self.evaluations),
            refused: of(&self.refused),
        }
    }

    /// Notes what has exploded in `state`: springs that are too long, and particles that are not finite.
    pub fn note(&mut self, state: &State<R, D>) {
        pulp::Arch::new().dispatch(Note { model: self, state });
    }

    /// Whether any evaluation since the model was made, or [its tick began](Self::begin_tick), met, in this lane, a spring longer than ten rest lengths or of no finite length.
    pub fn has_exploded(&self, lane: usize) -> bool {
        self.overstretched.lane(lane) != 0.0
    }

    /// Whether the method could not take a step with the body in this lane, and left it where it was.
    pub fn has_refused(&self, lane: usize) -> bool {
        self.refused.lane(lane) != 0.0
    }

    /// How often the forces of the body in this lane were evaluated since the model was made, or [its tick began](Self::begin_tick).
    pub fn evaluations(&self, lane: usize) -> u64 {
        self.evaluations.lane(lane) as u64
    }

    /// What has exploded first in a lane of `state`: a particle that is not finite, or a spring that is longer than ten rest lengths.
    pub fn explosion(&self, state: &State<R, D>, lane: usize) -> Option<Explosion> {
        let finite = |row: &[R; D]| row.iter().all(|value| value.lane(lane).is_finite());
        let lost = state.position.iter().zip(&state.velocity).position(|(x, v)| !(finite(x) && finite(v)));
        let particle = lost.map(|particle| Explosion { particle, spring: None });
        particle.or_else(|| self.exploded_spring(state, lane))
    }

    fn exploded_spring(&self, state: &State<R, D>, lane: usize) -> Option<Explosion> {
        let too_long = |ends: [usize; 2], longest: f64| {
            let [a, b] = ends.map(|end| state.position[end]);
            let square: f64 = (0..D).map(|axis| b[axis].lane(lane) - a[axis].lane(lane)).map(|d| d * d).sum();
            let length = square.sqrt();
            length.is_nan() || length >= longest
        };
        type Spring = ([usize; 2], f64);
        let first = |springs: &mut dyn Iterator<Item = Spring>| {
            springs.enumerate().find(|&(_, (ends, longest))| too_long(ends, longest)).map(|(i, (ends, _))| (i, ends))
        };
        let (spring, ends) = match (&self.lattice, self.unlisted_strand()) {
            (Some(rows), _) => first(&mut rows.springs()),
            (None, Some(rows)) => first(&mut rows.springs(lane)),
            (None, None) => {
                let listed = |row: &SpringRow<R>| (row.ends.map(|end| end as usize), row.longest.lane(lane));
                first(&mut self.springs.iter().map(listed))
            }
        }?;
        let speed = |end: usize| state.velocity[end].iter().map(|v| v.lane(lane)).map(|v| v * v).sum::<f64>();
        let particle = if speed(ends[1]) > speed(ends[0]) { ends[1] } else { ends[0] };
        Some(Explosion { particle, spring: Some(spring) })
    }
}

/// [`Model::note`], for the vectors of the processor.
struct Note<'a, R, const D: usize> {
    model: &'a mut Model<R, D>,
    state: &'a State<R, D>,
}

impl<R: Real, const D: usize> pulp::NullaryFnOnce for Note<'_, R, D> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { model, state } = self;
        model.note_lengths(state);
        let (one, most) = (R::splat(1.0), R::splat(f64::MAX));
        let mut lost = model.overstretched;
        for value in state.position.iter().chain(&state.velocity).flatten() {
            lost = value.abs().if_below(most, lost, one);
        }
        model.overstretched = lost;
    }
}

impl<R: Real, const D: usize> State<R, D> {
    /// Room for as many particles.
    pub fn new(particles: usize) -> Self {
        Self { position: vec![[R::splat(0.0); D]; particles], velocity: vec![[R::splat(0.0); D]; particles] }
    }

    /// Reads the first `D` coordinates of a body into a lane.
    pub fn set_lane(&mut self, lane: usize, particles: &Particles) {
        let (position, velocity) = (particles.position_columns(), particles.velocity_columns());
        for axis in 0..D {
            for (row, &value) in self.position.iter_mut().zip(&position[axis]) {
                row[axis].set_lane(lane, value);
            }
            for (row, &value) in self.velocity.iter_mut().zip(&velocity[axis]) {
                row[axis].set_lane(lane, value);
            }
        }
    }

    /// Writes a lane back to the body; coordinates beyond `D` stay as they are.
    pub fn write_lane(&self, lane: usize, particles: &mut Particles) {
        let (position, velocity) = particles.state_columns_mut();
        for axis in 0..D {
            for (row, value) in self.position.iter().zip(&mut position[axis]) {
                *value = row[axis].lane(lane);
            }
            for (row, value) in self.velocity.iter().zip(&mut velocity[axis]) {
                *value = row[axis].lane(lane);
            }
        }
    }
}
