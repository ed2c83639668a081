//! Where a strand is to go.

use core::f64::consts::{FRAC_PI_3, FRAC_PI_6, TAU};

use bevy::{ecs::prelude::*, math::DVec2, prelude::ReflectComponent, reflect::Reflect};

use crate::{
    body::{
        BodyError, Ground, Guidance, LEAST_REST_FRACTION, Requirement, Strand, TravelingWave, TravelingWaves, WaveKind,
        check,
    },
    mechanics::{
        BodyParts, Timeline, ground_grip,
        metrics::{length_at_rest, section_center},
    },
};

/// How often in a cycle a strand on its way to a target looks where it is.
const LOOKS_A_CYCLE: usize = 12;

/// Where a player sends a strand: straight on, to a side, or to a target; it also stops it and lets it go on. Every body with
/// [`TravelingWaves`] has it, and by itself it changes nothing.
///
/// Animals that crawl or wind are steered by the offset b of their waves; a worm or a caterpillar skids unless it has some side grip, 1 or so. A sidewinder (a
/// lateral and a vertical wave, the one a quarter of a cycle ahead of the other, and no side grip) rolls along to one side of its body, and to the other where the
/// sign of that lead is the other: it nears a target by alternating the sign. On the way from one to the other there is a moment without vertical wave, in
/// which it winds straight on; where it has to turn round it stays there, and turns by a little offset. Where the ground grips under most of its masses it goes
/// straight on as a snake does; steered, it lays its vertical wave down there, which would curl it up, and turns as a snake.
///
/// A strand on its way to a target, or to a side of a ground with patches, looks where it is every twelfth of a cycle, at steps that are multiples of a number of steps, and within a tick where
/// they fall there. What it does is therefore a function of the steps alone, the same at any frame rate and time scale. A command is obeyed at the first step after
/// it. A restart forgets it, and no file has it.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component)]
pub struct Steer {
    course: Course,
    stopped: bool,
    /// Whether the command has not been obeyed yet.
    fresh: bool,
    arrived: bool,
    guidance: Guidance,
    rolling: Rolling,
}

/// Where to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
enum Course {
    /// As its waves are.
    #[default]
    Own,
    /// To a side, from −1 (left) to 1 (right).
    Side(f64),
    /// To a place, x and z.
    Target(DVec2),
}

/// What a sidewinder remembers on its way to a target.
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
struct Rolling {
    /// Where its middle was at the last looks, up to a cycle of them, the latest at the end.
    way: Vec<DVec2>,
    /// Whether it turns round.
    turns: bool,
    /// The side to which it rolls: −1 is left, 1 right, and 0 none yet.
    side: f64,
}

/// What a look decides: the steering b in place of that of the waves, and the factor of the vertical waves.
#[derive(Clone, Copy, Debug)]
struct Wish {
    b: f64,
    lift: f64,
}

impl Steer {
    /// The most by which it sets the steering b, if the waves leave so much. The snake turns by 35° a cycle then, on a circle of 0.8 of its length.
    pub const MOST_TURN: f64 = 0.1;
    /// The middle of a body that is nearer to its target than this part of its length has arrived, and stops.
    pub const ARRIVAL: f64 = 0.2;
    /// The same of a sidewinder, which cannot turn as sharply as that.
    pub const ROLLING_ARRIVAL: f64 = 0.33;

    /// Steers to a side from now on: −1 is as far to the left as it can, 1 to the right, and 0 goes on as the waves are. The amount is cut to that range.
    ///
    /// # Errors
    /// If it is not finite; nothing is changed then.
    pub fn turn(&mut self, side: f64) -> Result<(), BodyError> {
        let side = check(side, Requirement::Finite, || "steer.side".into())?.clamp(-1.0, 1.0);
        self.command(if side == 0.0 { Course::Own } else { Course::Side(side) });
        Ok(())
    }

    /// Sends it to the place with this x and z on the ground, also if it was stopped. It stops there.
    ///
    /// # Errors
    /// If the place is not finite; nothing is changed then.
    pub fn go_to(&mut self, target: DVec2) -> Result<(), BodyError> {
        check(target.x, Requirement::Finite, || "steer.target.x".into())?;
        check(target.y, Requirement::Finite, || "steer.target.z".into())?;
        self.go();
        self.command(Course::Target(target));
        Ok(())
    }

    /// Stops it: its muscles ramp out in a part of their ramp, and the brake of its friction holds it.
    pub fn stop(&mut self) {
        (self.stopped, self.fresh) = (true, true);
    }

    /// Lets it go on after [`stop`](Self::stop): where it was going, if it has not arrived there.
    pub fn go(&mut self) {
        (self.stopped, self.fresh) = (false, true);
    }

    /// Where it goes, as x and z; nothing without a target.
    pub fn target(&self) -> Option<DVec2> {
        match self.course {
            Course::Target(target) => Some(target),
            Course::Own | Course::Side(_) => None,
        }
    }

    /// Whether it has come to its target.
    pub fn has_arrived(&self) -> bool {
        self.arrived
    }

    /// Whether it was told to stop.
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// How its waves are guided.
    pub fn guidance(&self) -> Guidance {
        self.guidance
    }

    fn command(&mut self, course: Course) {
        if course != self.course {
            (self.course, self.fresh, self.arrived) = (course, true, false);
            self.rolling = Rolling::default();
        }
    }

    /// Decides, before a step, if it is time to. Gives back before which step it wants to look again, if it does.
    pub(super) fn look(&mut self, body: &BodyParts<'_>, timeline: Timeline, step: u64) -> Option<u64> {
        if !self.fresh && !self.goes_on_looking(body) {
            return None;
        }
        let walker = Walker::of(body)?;
        let interval = (walker.period / LOOKS_A_CYCLE as f64 / timeline.dt).round().max(1.0) as u64;
        if self.fresh || step.is_multiple_of(interval) {
            self.fresh = false;
            self.decide(&walker, timeline.time_at(step));
        }
        self.goes_on_looking(body).then(|| (step / interval + 1) * interval)
    }

    /// Whether what it does depends on where it comes to.
    fn goes_on_looking(&self, body: &BodyParts<'_>) -> bool {
        let aside = matches!(self.course, Course::Side(_)) && !self.stopped;
        self.is_on_its_way() || (aside && has_patches(body))
    }

    fn is_on_its_way(&self) -> bool {
        self.target().is_some() && !self.stopped && !self.arrived
    }

    fn decide(&mut self, walker: &Walker<'_>, time: f64) {
        let own = Wish { b: walker.waves.steering(), lift: 1.0 };
        let wish = match (self.course, walker.leads_right) {
            (Course::Own, _) => own,
            (Course::Side(side), None) => Wish { b: side * walker.most_turn(), lift: walker.lift },
            (Course::Side(side), Some(leads_right)) => Wish { b: own.b, lift: if leads_right { side } else { -side } },
            (Course::Target(target), _) => self.wish_for(target, walker),
        };
        let goes = !(self.stopped || self.arrived);
        let ramp = walker.waves.ramp() * walker.period;
        let (turn_cycles, rest) = match walker.leads_right {
            Some(_) => (Rolling::TURN_CYCLES, Rolling::REST),
            None => (TURN_CYCLES, REST),
        };
        let Guidance { turn, lift, activity } = self.guidance;
        self.guidance = Guidance {
            turn: turn.turned(wish.b - own.b, time, turn_cycles * walker.period),
            lift: lift.turned(wish.lift, time, LIFT_CYCLES * walker.period),
            activity: if goes { activity.turned(1.0, time, ramp) } else { activity.turned(0.0, time, rest * ramp) },
        };
    }

    /// What a target calls for, or, where it has arrived, to go straight.
    fn wish_for(&mut self, target: DVec2, walker: &Walker<'_>) -> Wish {
        let way = target - walker.center;
        let distance = way.length() / walker.length;
        if let Some(leads_right) = walker.leads_right {
            self.arrived |= distance < Self::ROLLING_ARRIVAL;
            return self.rolling.wish(way, walker, leads_right);
        }
        // Where it came from as a snake says nothing of where it rolls.
        self.rolling = Rolling::default();
        self.arrived |= distance < Self::ARRIVAL;
        let off = angle(walker.ahead, way);
        // A target within the circle on which it turns would be circled for ever: it first leaves it behind.
        let within = off.abs() > FRAC_PI_3 && distance < 2.0 * CIRCLE * libm::sin(off.abs());
        let side = if within { 0.0 } else { (off / FULL_TURN).clamp(-1.0, 1.0) };
        Wish { b: side * walker.most_turn(), lift: walker.lift }
    }
}

/// The angle to its target, in radians, from which on a body turns as far as it can.
const FULL_TURN: f64 = FRAC_PI_6;
/// The radius, in body lengths, of the circle on which a body turns that turns as far as it can; a little above that of the snake, which has the widest.
const CIRCLE: f64 = 0.85;
/// How many cycles a change of b by 1 takes: one by the most that there is, a twelfth of a cycle.
const TURN_CYCLES: f64 = 1.0 / (12.0 * Steer::MOST_TURN);
/// How many cycles a change of the factor of the vertical waves by 1 takes: from one side to the other, half a cycle.
const LIFT_CYCLES: f64 = 0.25;

/// In which part of their ramp the muscles come to rest: quickly, so that a body does not go on for long.
const REST: f64 = 0.25;

impl Rolling {
    /// The same of a sidewinder, of which no more than a third is on the ground and brakes.
    const REST: f64 = 1.0 / 16.0;
    /// By how far, in radians, its course is wrong when it begins to turn round.
    const TURN_FROM: f64 = 25.0 / 360.0 * TAU;
    /// By how far it is wrong when it ends that.
    const TURN_UNTIL: f64 = Self::TURN_FROM / 3.0;
    /// By how far it is wrong when it rolls to the other side.
    const SWITCH: f64 = 15.0 / 360.0 * TAU;
    /// The most that b is while it turns round. With .04 it curls up.
    const MOST_TURN: f64 = 0.03;
    /// How many cycles a change of b by 1 takes.
    const TURN_CYCLES: f64 = 4.0;
    /// By how far its course is wrong from where on it turns as far as it can.
    const FULL_TURN: f64 = 30.0 / 360.0 * TAU;

    /// What the way to its target calls for. Where the body points says little of where a sidewinder goes, so this goes by the way that it came in the last cycle.
    fn wish(&mut self, way: DVec2, walker: &Walker<'_>, leads_right: bool) -> Wish {
        if self.way.len() > LOOKS_A_CYCLE {
            self.way.remove(0);
        }
        self.way.push(walker.center);
        let came = walker.center - self.way[0];
        let knows = self.way.len() > LOOKS_A_CYCLE && came.length() > 0.07 * walker.length;
        let off = angle(if knows { came } else { walker.ahead }, way);
        self.turns = off.abs() > if self.turns { Self::TURN_UNTIL } else { Self::TURN_FROM };
        if self.side == 0.0 || off.abs() > Self::SWITCH {
            self.side = if off > 0.0 { 1.0 } else { -1.0 };
        }
        if self.turns {
            Wish { b: (off / Self::FULL_TURN).clamp(-1.0, 1.0) * Self::MOST_TURN, lift: 0.0 }
        } else {
            Wish { b: 0.0, lift: if leads_right { self.side } else { -self.side } }
        }
    }
}

/// The angle from one direction to another, in radians, positive to the right.
fn angle(from: DVec2, to: DVec2) -> f64 {
    libm::atan2(from.perp_dot(to), from.dot(to))
}

/// What a strand is steered by.
struct Walker<'a> {
    waves: &'a TravelingWaves,
    period: f64,
    /// Its length at rest.
    length: f64,
    /// Its middle from above.
    center: DVec2,
    /// Which way it points.
    ahead: DVec2,
    /// Of a sidewinder where nothing grips, whether it rolls to the right with its waves as they are.
    leads_right: Option<bool>,
    /// The factor of the vertical waves while it is steered by b.
    lift: f64,
}

impl<'a> Walker<'a> {
    fn of(body: &BodyParts<'a>) -> Option<Self> {
        let (strand, waves) = (body.strand?, body.waves?);
        let center = body.particles.center();
        let (leads_right, grips) = (leads_right(waves), grips(body));
        Some(Self {
            waves,
            period: waves.longest_period()?,
            length: length_at_rest(body.springs, strand),
            center: DVec2::new(center.x, center.z),
            ahead: ahead(body, strand),
            leads_right: leads_right.filter(|_| !grips),
            lift: if leads_right.is_some() { 0.0 } else { 1.0 },
        })
    }

    /// The largest b that its waves leave room for.
    fn most_turn(&self) -> f64 {
        let waves: f64 = self.waves.iter().map(|wave| wave.amplitude).sum();
        (1.0 - LEAST_REST_FRACTION - waves).clamp(0.0, Steer::MOST_TURN)
    }
}

fn has_patches(body: &BodyParts<'_>) -> bool {
    matches!(body.ground, Some(Ground::Terrain(terrain)) if !terrain.patches().is_empty())
}

/// Whether most of the masses of a body are where they have a side grip, or are above it: what is lifted comes down there.
fn grips(body: &BodyParts<'_>) -> bool {
    let own = body.friction.map_or(0.0, |friction| friction.grip());
    let Some(ground) = body.ground.filter(|_| body.friction.is_some() && has_patches(body)) else { return own > 0.0 };
    let gripped = body.particles.positions().filter(|&position| ground_grip(ground, position, own) > 0.0).count();
    2 * gripped > body.particles.len()
}

/// Which way a strand points: to its head from the section that is one wave behind it, as both sway alike. Without a lateral wave, from its tail.
fn ahead(body: &BodyParts<'_>, strand: Strand) -> DVec2 {
    let wavelength = body.waves.and_then(|waves| strongest(waves, WaveKind::Lateral)).map(|wave| wave.wavelength);
    let behind = wavelength.map_or(usize::MAX, |wavelength| wavelength.round().max(1.0) as usize);
    let head = strand.segments();
    let along = section_center(body.particles, strand, head)
        - section_center(body.particles, strand, head.saturating_sub(behind));
    DVec2::new(along.x, along.z)
}

fn strongest(waves: &TravelingWaves, kind: WaveKind) -> Option<TravelingWave> {
    let waves = waves.iter().filter(|wave| wave.kind == kind && wave.amplitude > 0.0);
    waves.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
}

/// Whether the waves of a sidewinder roll it to the right; nothing for waves that are none of a sidewinder.
fn leads_right(waves: &TravelingWaves) -> Option<bool> {
    let lead = strongest(waves, WaveKind::Vertical)?.lead - strongest(waves, WaveKind::Lateral)?.lead;
    let sine = libm::sin(TAU * lead);
    (sine.abs() > 0.9).then_some(sine < 0.0)
}
