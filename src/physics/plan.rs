//! What physics works out about a body before it steps it, and again when a parameter changes.

use core::hash::{Hash, Hasher};
use std::hash::DefaultHasher;

use bevy::{
    ecs::{prelude::*, query::QueryData},
    log::warn,
    prelude::Name,
};

use crate::{
    body::{
        CoulombFriction, Gravity, Ground, Lattice, MassDamping, Muscles, Particles, Pull, Rules, SpineFriction,
        Springs, Strand, Tearing, TravelingWaves,
    },
    mechanics::{
        BodyParts,
        integrators::{Method, StickRule},
        metrics::inverted_segment,
    },
};

use super::{
    Clock, Frozen, Steer,
    cut::{WavesCut, cut_waves},
    watch::BodyInverted,
};

/// The components of one body, beside its particles, that physics reads.
#[derive(QueryData)]
pub(super) struct Parts {
    springs: &'static Springs,
    muscles: Option<&'static Muscles>,
    strand: Option<&'static Strand>,
    lattice: Option<&'static Lattice>,
    pull: Option<&'static Pull>,
    waves: Option<&'static TravelingWaves>,
    friction: Option<&'static SpineFriction>,
    coulomb: Option<&'static CoulombFriction>,
    gravity: Option<&'static Gravity>,
    ground: Option<&'static Ground>,
    mass_damping: Option<&'static MassDamping>,
    method: &'static Method,
    stick: &'static StickRule,
}

impl PartsItem<'_, '_> {
    /// Borrows the body for mechanics.
    pub(super) fn body<'a>(
        &'a self,
        particles: &'a Particles,
        tearing: Option<&'a Tearing>,
        steer: Option<&Steer>,
    ) -> BodyParts<'a> {
        BodyParts {
            particles,
            springs: self.springs,
            muscles: self.muscles,
            strand: self.strand.copied(),
            lattice: self.lattice.copied(),
            pull: self.pull.copied(),
            tearing,
            waves: self.waves,
            guidance: steer.map(Steer::guidance).unwrap_or_default(),
            friction: self.friction,
            coulomb: self.coulomb,
            // Gravity of zero is none: it must not cost a body its axis.
            gravity: self.gravity.copied().filter(|gravity| gravity.acceleration() > 0.0),
            ground: self.ground,
            mass_damping: self.mass_damping.copied(),
            method: *self.method,
            stick: *self.stick,
        }
    }
}

/// Borrows a body for mechanics as physics steps it; nothing where the entity is none.
pub fn body_parts(entity: EntityRef<'_>) -> Option<BodyParts<'_>> {
    Some(BodyParts {
        particles: entity.get()?,
        springs: entity.get()?,
        muscles: entity.get(),
        strand: entity.get().copied(),
        lattice: entity.get().copied(),
        pull: entity.get().copied(),
        tearing: entity.get(),
        waves: entity.get(),
        guidance: entity.get().map(Steer::guidance).unwrap_or_default(),
        friction: entity.get(),
        coulomb: entity.get(),
        gravity: entity.get::<Gravity>().copied().filter(|gravity| gravity.acceleration() > 0.0),
        ground: entity.get(),
        mass_damping: entity.get().copied(),
        method: entity.get().copied()?,
        stick: entity.get().copied()?,
    })
}

/// What physics has worked out about a body. Brought up to date before every tick.
#[derive(Clone, Component, Debug, Default)]
pub struct Plan {
    /// Equal for bodies that may be stepped side by side; different ones are equal only by a rare accident.
    pub(super) topology: u64,
    pub(super) stability_limit: f64,
    /// The step after which the limit was worked out.
    limited_at: u64,
    /// The dt for which a warning was given last.
    pub(super) warned: Option<f64>,
    /// Why the body cannot be stepped at all.
    pub(super) misfit: Option<String>,
    /// When a segment was inside out last, until it has been whole for long enough to be told of again.
    inverted: Option<f64>,
    /// Whether the least rest length may cut its waves.
    cut: bool,
}

impl Plan {
    /// The largest dt at which the body is sure to be stable with its method and in its present pose: never above the true limit of the
    /// linearised body, but for [two methods](BodyParts::alarm_limit) while springs are stretched. Infinite for a body that cannot oscillate.
    pub fn stability_limit(&self) -> f64 {
        self.stability_limit
    }

    fn limit(&mut self, body: &BodyParts<'_>, clock: &Clock) {
        self.stability_limit = body.alarm_limit(clock.time());
        self.limited_at = clock.step();
    }

    /// The stability limit with four decimals, or four digits where it is small.
    pub fn limit_text(&self) -> String {
        let limit = self.stability_limit;
        if limit < 0.01 { format!("{limit:.3e}") } else { format!("{limit:.4}") }
    }
}

/// The limit of a body that can move across its springs changes with its pose, and is worked out again after so many steps: it costs as much as some
/// twenty of them, and by explicit Euler and RK2 with unevenly damped springs up to some thousand.
const STEPS_PER_LIMIT: u64 = 1024;
/// For a large body, which steps faster than its limit is found, after one step for so many springs.
const SPRINGS_A_STEP: u64 = 64;

/// A body that is not as it was planned.
pub(super) type Changes = Or<(
    Added<Plan>,
    // Steps move particles without marking them as changed, so this tells of edits by others.
    Changed<Particles>,
    Changed<Springs>,
    Changed<SpineFriction>,
    Changed<CoulombFriction>,
    Changed<Muscles>,
    Changed<Strand>,
    Changed<Lattice>,
    Changed<Tearing>,
    Changed<TravelingWaves>,
    Changed<Gravity>,
    Changed<Ground>,
    Changed<MassDamping>,
    Changed<Method>,
    Changed<StickRule>,
)>;

/// What is read of a body to plan it, and to watch it.
type Planned = (
    Entity,
    Option<&'static Name>,
    &'static Particles,
    Parts,
    Option<&'static Tearing>,
    Option<&'static Steer>,
    &'static mut Plan,
);

/// Plans every body that was changed, and warns where its waves come to be cut.
pub(super) fn plan(
    clock: Res<Clock>,
    mut bodies: Query<Planned, (Changes, Without<Rules>)>,
    mut told: MessageWriter<WavesCut>,
) {
    for (entity, name, particles, parts, tearing, steer, mut plan) in &mut bodies {
        let body = parts.body(particles, tearing, steer);
        plan.misfit = misfit(&body);
        if plan.misfit.is_some() {
            continue;
        }
        plan.topology = topology(&body);
        plan.limit(&body, &clock);
        let cut = cut_waves(body.muscles, body.waves).next();
        let was_cut = core::mem::replace(&mut plan.cut, cut.is_some());
        if let Some((path, problem)) = cut.filter(|_| !was_cut) {
            let text = format!("{}: {path}: {problem}", name.map_or("a body", Name::as_str));
            warn!("{text}");
            told.write(WavesCut { body: entity, text });
        }
    }
}

/// Works out the limit again of every body whose pose may have changed it, and warns where dt is above a limit or a strand has come to be inside
/// out: that is looked for after every tick, as most folds last for a part of a cycle.
pub(super) fn watch_limit(
    clock: Res<Clock>,
    mut bodies: Query<Planned, (Without<Frozen>, Without<Rules>)>,
    mut told: MessageWriter<BodyInverted>,
) {
    for (entity, name, particles, parts, tearing, steer, mut plan) in &mut bodies {
        let name = name.map_or("a body", Name::as_str);
        let body = parts.body(particles, tearing, steer);
        // A restart counts from 0 again.
        let between = STEPS_PER_LIMIT.max(body.springs.len() as u64 / SPRINGS_A_STEP);
        let aged = clock.step().checked_sub(plan.limited_at).is_none_or(|steps| steps >= between);
        if aged && plan.misfit.is_none() && !body.on_axis() {
            plan.limit(&body, &clock);
        }
        if let Some(segment) = newly_inverted(&body, &mut plan, clock.time()) {
            let text = format!(
                "{name}: segment {segment} is inside out at step {} (time {:.6}): something squeezes or drives it harder than its springs bear",
                clock.step(),
                clock.time(),
            );
            warn!("{text}");
            told.write(BodyInverted { body: entity, text });
        }
        let dt = clock.dt();
        if dt <= plan.stability_limit {
            plan.warned = None;
        } else if plan.warned != Some(dt) {
            plan.warned = Some(dt);
            warn!(
                "{name}: dt {dt} is above the stability limit {} of {}; expect it to explode, or choose a smaller dt",
                plan.limit_text(),
                body.method.name(),
            );
        }
    }
}

/// How many cycles a strand has to be whole before it is told of again that it is inside out: what folds in and out with its waves is told of once.
const WHOLE_CYCLES: f64 = 4.0;

/// The first segment of a strand that is inside out now, where that has not been told yet.
fn newly_inverted(body: &BodyParts<'_>, plan: &mut Plan, time: f64) -> Option<usize> {
    let strand = body.strand.filter(|_| plan.misfit.is_none())?;
    let Some(segment) = inverted_segment(body.particles, strand) else {
        let cycle = body.waves.and_then(TravelingWaves::longest_period).unwrap_or(0.0);
        // A restart counts from 0 again.
        plan.inverted = plan.inverted.filter(|last| (0.0..=WHOLE_CYCLES * cycle).contains(&(time - last)));
        return None;
    };
    let told = plan.inverted.replace(time).is_some_and(|last| last <= time);
    (!told).then_some(segment)
}

fn topology(body: &BodyParts<'_>) -> u64 {
    let mut hasher = DefaultHasher::new();
    (body.method, body.stick, body.particles.len(), body.springs.ends()).hash(&mut hasher);
    for muscle in body.muscles.into_iter().flat_map(Muscles::iter) {
        (muscle.spring, muscle.wave).hash(&mut hasher);
    }
    if let Some(friction) = body.friction {
        (friction.ratchet(), friction.width(), friction.spine()).hash(&mut hasher);
    }
    (body.strand, body.lattice).hash(&mut hasher);
    for wave in body.waves.into_iter().flat_map(TravelingWaves::iter) {
        (wave.kind, wave.form).hash(&mut hasher);
    }
    body.coulomb.map(CoulombFriction::spine).hash(&mut hasher);
    (body.tearing.is_some(), body.ground.is_some(), body.gravity.is_some(), body.mass_damping.is_some())
        .hash(&mut hasher);
    hasher.finish()
}

/// The first thing that is wrong with a body's components as a whole, if any: components can be put together by hand that were not made for each
/// other.
fn misfit(body: &BodyParts<'_>) -> Option<String> {
    let particles = body.particles.len();
    let out_of_reach = |index: usize| index >= particles;
    if body.springs.ends().iter().flatten().any(|end| out_of_reach(end.index())) {
        return Some(format!("its springs were made for another body; this one has {particles} particles"));
    }
    if body.friction.is_some_and(|friction| friction.spine().iter().any(|particle| out_of_reach(particle.index()))) {
        return Some(format!("its spine was made for another body; this one has {particles} particles"));
    }
    if body.coulomb.is_some_and(|coulomb| !coulomb.fits(particles)) {
        return Some(format!("its Coulomb friction was made for another body; this one has {particles} particles"));
    }
    if body.muscles.is_some_and(|muscles| muscles.iter().any(|muscle| muscle.spring.index() >= body.springs.len())) {
        return Some(format!("its muscles were made for another body; this one has {} springs", body.springs.len()));
    }
    if body.strand.is_some_and(|strand| strand.springs() != body.springs.len() || strand.particles() != particles) {
        return Some(format!(
            "its strand was made for another body; this one has {particles} particles and {} springs",
            body.springs.len()
        ));
    }
    if body.lattice.is_some_and(|lattice| lattice.springs() != body.springs.len() || lattice.particles() != particles) {
        return Some(format!(
            "its lattice was made for another body; this one has {particles} particles and {} springs",
            body.springs.len()
        ));
    }
    if body.tearing.is_some() && body.strand.is_some() {
        return Some("the springs of a strand cannot tear".into());
    }
    if body.waves.is_some() && body.strand.is_none() {
        return Some("its waves need a strand to travel along".into());
    }
    body.refused_by_method().map(str::to_owned)
}
