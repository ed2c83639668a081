//! Forces of a strand: its waves, its rest lengths and its springs, four corners at a time.

use crate::body::{
    Epoch, LEAST_REST_FRACTION, ParticleId, Ramp, Strand, TravelingWave, TravelingWaves, Wave, WaveDirection, WaveKind,
};

use super::{
    BodyParts, Model, Real,
    quad::{Point, Quad, point, spring_force},
    wave::{sin_cycles, square_cycles},
};

/// How many springs a section and the segment in front of it have together.
const STRIDE: usize = 18;
/// Where, among them, the diagonals of the section begin.
const SECTION_DIAGONALS: usize = 4;
/// Where the axial springs begin.
const AXIAL: usize = 6;
/// Where the side diagonals begin that lead to the next corner.
const RISING: usize = 10;
/// Where those begin that lead back from it.
const FALLING: usize = 14;

/// Mean axial lengths beyond these, in rest lengths, change the bulge no further.
const BULGE: [f64; 2] = [0.25, 4.0];

/// One wave as the force loop reads it.
#[derive(Clone, Copy, Debug)]
struct WaveRow<R> {
    kind: WaveKind,
    form: Wave,
    amplitude: R,
    frequency: R,
    /// σ/λ.
    wavenumber: R,
    lead: R,
    epoch_time: R,
    epoch_cycles: R,
}

impl<R: Real> WaveRow<R> {
    fn idle(wave: TravelingWave) -> Self {
        let zero = R::splat(0.0);
        Self {
            kind: wave.kind,
            form: wave.form,
            amplitude: zero,
            frequency: zero,
            wavenumber: zero,
            lead: zero,
            epoch_time: zero,
            epoch_cycles: zero,
        }
    }

    fn set_lane(&mut self, lane: usize, wave: TravelingWave, epoch: Epoch) {
        let sign = match wave.direction {
            WaveDirection::HeadToTail => 1.0,
            WaveDirection::TailToHead => -1.0,
        };
        self.amplitude.set_lane(lane, wave.amplitude);
        self.frequency.set_lane(lane, 1.0 / wave.period);
        self.wavenumber.set_lane(lane, sign / wave.wavelength);
        self.lead.set_lane(lane, wave.lead);
        self.epoch_time.set_lane(lane, epoch.time);
        self.epoch_cycles.set_lane(lane, epoch.cycles);
    }

    fn lane(&self, lane: usize) -> WaveRow<f64> {
        WaveRow {
            kind: self.kind,
            form: self.form,
            amplitude: self.amplitude.lane(lane),
            frequency: self.frequency.lane(lane),
            wavenumber: self.wavenumber.lane(lane),
            lead: self.lead.lane(lane),
            epoch_time: self.epoch_time.lane(lane),
            epoch_cycles: self.epoch_cycles.lane(lane),
        }
    }

    /// How much it drives at `cycles` of the first place, `behind` segments behind the head.
    #[inline(always)]
    fn drive(&self, cycles: R, behind: f64) -> R {
        let at = cycles - self.wavenumber * R::splat(behind);
        let wave = match self.form {
            Wave::Sine => sin_cycles(at),
            Wave::Square => square_cycles(at),
        };
        self.amplitude * wave
    }
}

/// A [`Ramp`] as the force loop reads it.
#[derive(Clone, Copy, Debug)]
struct RampRow<R> {
    from: R,
    to: R,
    since: R,
    rate: R,
}

impl<R: Real> RampRow<R> {
    fn steady(value: f64) -> Self {
        let (value, zero) = (R::splat(value), R::splat(0.0));
        Self { from: value, to: value, since: zero, rate: zero }
    }

    fn set_lane(&mut self, lane: usize, Ramp { from, to, since, rate }: Ramp) {
        self.from.set_lane(lane, from);
        self.to.set_lane(lane, to);
        self.since.set_lane(lane, since);
        self.rate.set_lane(lane, rate);
    }

    fn lane(&self, lane: usize) -> RampRow<f64> {
        RampRow {
            from: self.from.lane(lane),
            to: self.to.lane(lane),
            since: self.since.lane(lane),
            rate: self.rate.lane(lane),
        }
    }

    #[inline(always)]
    fn at(&self, time: f64) -> R {
        let (from, to) = (self.from, self.to);
        let least = from.if_below(to, from, to);
        let most = from.if_below(to, to, from);
        let now = from + self.rate * (R::splat(time) - self.since);
        let now = now.if_below(least, least, now);
        most.if_below(now, most, now)
    }
}

/// What the segments of a strand are driven by, before the least rest length.
#[derive(Clone, Copy, Debug)]
struct SegmentDrive<R> {
    long: R,
    lateral: R,
    vertical: R,
}

/// A strand as the force loop reads it; its arrays are in the order of its springs.
#[derive(Clone, Debug)]
pub(super) struct StrandRows<R> {
    strand: Strand,
    stiffness: Vec<R>,
    damping: Vec<R>,
    rest_length: Vec<R>,
    longest: Vec<R>,
    /// 1 over the sum of the axial rest lengths of each segment.
    inverse_length: Vec<R>,
    waves: Vec<WaveRow<R>>,
    has_waves: bool,
    steering: R,
    activity: RampRow<R>,
    guided_turn: RampRow<R>,
    guided_lift: RampRow<R>,
    guided_activity: RampRow<R>,
    /// Scratch: what drives each segment.
    drive: Vec<SegmentDrive<R>>,
    /// Scratch: how long each segment is, in rest lengths.
    stretch: Vec<R>,
}

impl<R: Real> StrandRows<R> {
    /// The rows of a strand without numbers.
    pub(super) fn idle(strand: Strand, waves: Option<&TravelingWaves>) -> Self {
        let zero = R::splat(0.0);
        let springs = || vec![zero; strand.springs()];
        let segments = || vec![zero; strand.segments()];
        Self {
            strand,
            stiffness: springs(),
            damping: springs(),
            rest_length: springs(),
            longest: springs(),
            inverse_length: segments(),
            waves: waves.into_iter().flat_map(TravelingWaves::iter).map(WaveRow::idle).collect(),
            has_waves: waves.is_some(),
            steering: zero,
            activity: RampRow::steady(1.0),
            guided_turn: RampRow::steady(0.0),
            guided_lift: RampRow::steady(1.0),
            guided_activity: RampRow::steady(1.0),
            drive: vec![SegmentDrive { long: zero, lateral: zero, vertical: zero }; strand.segments()],
            stretch: segments(),
        }
    }

    /// Puts the numbers of `body` into a lane. A spring has exploded at so many rest lengths.
    pub(super) fn set_lane(&mut self, lane: usize, body: &BodyParts<'_>, longest: f64) {
        for (i, spring) in body.springs.iter().enumerate().take(self.stiffness.len()) {
            self.stiffness[i].set_lane(lane, spring.stiffness);
            self.damping[i].set_lane(lane, spring.damping);
            self.rest_length[i].set_lane(lane, spring.rest_length);
            self.longest[i].set_lane(lane, longest * spring.rest_length);
        }
        for (segment, inverse) in self.inverse_length.iter_mut().enumerate() {
            let first = STRIDE * segment + AXIAL;
            let sum: f64 = (first..first + 4).map(|i| self.rest_length[i].lane(lane)).sum();
            inverse.set_lane(lane, 1.0 / sum);
        }
        let Some(waves) = body.waves else { return };
        for (row, (wave, &epoch)) in self.waves.iter_mut().zip(waves.iter().zip(waves.epochs())) {
            row.set_lane(lane, wave, epoch);
        }
        self.steering.set_lane(lane, waves.steering());
        self.activity.set_lane(lane, waves.activity());
        self.guided_turn.set_lane(lane, body.guidance.turn);
        self.guided_lift.set_lane(lane, body.guidance.lift);
        self.guided_activity.set_lane(lane, body.guidance.activity);
    }

    /// The strand in one lane.
    pub(super) fn lane(&self, lane: usize) -> StrandRows<f64> {
        let all = |values: &[R]| values.iter().map(|value| value.lane(lane)).collect::<Vec<_>>();
        let drive = |drive: &SegmentDrive<R>| SegmentDrive {
            long: drive.long.lane(lane),
            lateral: drive.lateral.lane(lane),
            vertical: drive.vertical.lane(lane),
        };
        StrandRows {
            strand: self.strand,
            stiffness: all(&self.stiffness),
            damping: all(&self.damping),
            rest_length: all(&self.rest_length),
            longest: all(&self.longest),
            inverse_length: all(&self.inverse_length),
            waves: self.waves.iter().map(|wave| wave.lane(lane)).collect(),
            has_waves: self.has_waves,
            steering: self.steering.lane(lane),
            activity: self.activity.lane(lane),
            guided_turn: self.guided_turn.lane(lane),
            guided_lift: self.guided_lift.lane(lane),
            guided_activity: self.guided_activity.lane(lane),
            drive: self.drive.iter().map(drive).collect(),
            stretch: all(&self.stretch),
        }
    }

    /// The ends of every spring, and how long it must not become, in one lane.
    pub(super) fn springs(&self, lane: usize) -> impl Iterator<Item = ([usize; 2], f64)> + '_ {
        let ends = Strand::ends(self.strand.segments() as u32).map(|ends| ends.map(ParticleId::index));
        ends.zip(self.longest.iter().map(move |longest| longest.lane(lane)))
    }

    /// What drives each segment at `time`: the waves, once a segment.
    #[inline(always)]
    fn drive_segments(&mut self, time: f64) {
        let zero = R::splat(0.0);
        let steering = self.steering + self.guided_turn.at(time);
        for drive in &mut self.drive {
            *drive = SegmentDrive { long: zero, lateral: steering, vertical: zero };
        }
        let segments = self.drive.len();
        for wave in &self.waves {
            let cycles = wave.epoch_cycles + (R::splat(time) - wave.epoch_time) * wave.frequency + wave.lead;
            for (segment, drive) in self.drive.iter_mut().enumerate() {
                let amount = wave.drive(cycles, segments as f64 - segment as f64 - 0.5);
                match wave.kind {
                    WaveKind::Longitudinal => drive.long += amount,
                    WaveKind::Lateral => drive.lateral += amount,
                    WaveKind::Vertical => drive.vertical += amount,
                }
            }
        }
    }

    /// Writes all rest lengths at `time` of the strand that is there.
    #[inline(always)]
    fn drive(&mut self, time: f64, position: &[[R; 3]], rest: &mut [R]) {
        rest.copy_from_slice(&self.rest_length);
        if self.has_waves {
            self.drive_axial(time, rest);
        }
        if self.strand.bulge() {
            self.bulge(position, rest);
        }
        follow_edges(self.strand, rest);
    }

    #[inline(always)]
    fn drive_axial(&mut self, time: f64, rest: &mut [R]) {
        self.drive_segments(time);
        let (one, least) = (R::splat(1.0), R::splat(LEAST_REST_FRACTION));
        let activity = self.activity.at(time) * self.guided_activity.at(time);
        let lift = self.guided_lift.at(time);
        for (segment, &SegmentDrive { long, lateral, vertical }) in self.drive.iter().enumerate() {
            let (left, right, vertical) = (long + lateral, long - lateral, lift * vertical);
            let corners = [left - vertical, right - vertical, right + vertical, left + vertical];
            let first = STRIDE * segment + AXIAL;
            for (rest, corner) in rest[first..first + 4].iter_mut().zip(corners) {
                let factor = one + activity * corner;
                *rest = *rest * factor.if_below(least, least, factor);
            }
        }
    }

    /// Makes the circumference longer where the axial springs are short now.
    #[inline(always)]
    fn bulge(&mut self, position: &[[R; 3]], rest: &mut [R]) {
        let [least, most] = BULGE.map(R::splat);
        for (segment, stretch) in self.stretch.iter_mut().enumerate() {
            let (from, to) = (point(position, 4 * segment), point(position, 4 * segment + 4));
            let lengths = from.length_to(&to);
            let now = (lengths.sum()) * self.inverse_length[segment];
            let now = now.if_below(least, least, now);
            *stretch = most.if_below(now, most, now);
        }
        let last = self.stretch.len() - 1;
        for section in 0..=self.stretch.len() {
            let (behind, ahead) = (self.stretch[section.saturating_sub(1)], self.stretch[section.min(last)]);
            let wider = R::splat(1.0) / (R::splat(0.5) * (behind + ahead)).sqrt();
            for rest in &mut rest[STRIDE * section..STRIDE * section + 4] {
                *rest = *rest * wider;
            }
        }
    }
}

/// Makes all diagonals follow the edges of their faces.
#[inline(always)]
fn follow_edges<R: Real>(strand: Strand, rest: &mut [R]) {
    for section in 0..strand.sections() {
        let first = STRIDE * section;
        let across = (rest[first] * rest[first + 2] + rest[first + 1] * rest[first + 3]).sqrt();
        rest[first + SECTION_DIAGONALS] = across;
        rest[first + SECTION_DIAGONALS + 1] = across;
    }
    for segment in 0..strand.segments() {
        let first = STRIDE * segment;
        let axial = Quad::read(rest, first + AXIAL);
        let (here, next) = (Quad::read(rest, first), Quad::read(rest, first + STRIDE));
        let across = (axial * axial.next() + here * next).sqrt();
        across.write(rest, first + RISING);
        across.write(rest, first + FALLING);
    }
}

impl<R: Real, const D: usize> Model<R, D> {
    /// Writes all rest lengths of a strand at `time`.
    // On its own, and so are its forces: the methods are compiled for many kinds of bodies and processors each, and these need only be for one dimension.
    #[inline(never)]
    pub(super) fn drive_strand(&mut self, time: f64, position: &[[R; D]]) {
        let (Some(rows), Some(position)) = (&mut self.strand, in_space(position)) else { return };
        pulp::Arch::new().dispatch(Drive { rows, time, position, rest: &mut self.rest });
    }

    /// What the springs of a strand and gravity accelerate every particle with; rest lengths are driven already.
    #[inline(never)]
    pub(super) fn strand_forces(&mut self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let Self { strand: Some(rows), rest, inverse_mass, gravity, overstretched, .. } = self else { return };
        let (Some(position), Some(velocity)) = (in_space(position), in_space(velocity)) else { return };
        let (acceleration, _) = acceleration.as_flattened_mut().as_chunks_mut();
        let forces = Forces { rows, rest, inverse_mass, position, velocity, acceleration };
        let too_long = pulp::Arch::new().dispatch(forces);
        *overstretched = too_long.any(*overstretched);
        let Some(gravity) = *gravity else { return };
        let zero = R::splat(0.0);
        for (row, &inverse_mass) in acceleration.iter_mut().zip(&*inverse_mass) {
            row[1] -= zero.if_below(inverse_mass, gravity, zero);
        }
    }
}

/// [`StrandRows::drive`], for the vectors of the processor. A closure would not do: what calls it is not inlined, and compiled for the least of all
/// processors.
struct Drive<'a, R> {
    rows: &'a mut StrandRows<R>,
    time: f64,
    position: &'a [[R; 3]],
    rest: &'a mut [R],
}

impl<R: Real> pulp::NullaryFnOnce for Drive<'_, R> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.rows.drive(self.time, self.position, self.rest);
    }
}

/// [`StrandRows::forces`], likewise.
struct Forces<'a, R> {
    rows: &'a StrandRows<R>,
    rest: &'a [R],
    inverse_mass: &'a [R],
    position: &'a [[R; 3]],
    velocity: &'a [[R; 3]],
    acceleration: &'a mut [[R; 3]],
}

impl<R: Real> pulp::NullaryFnOnce for Forces<'_, R> {
    type Output = Quad<R>;

    #[inline(always)]
    fn call(self) -> Quad<R> {
        self.rows.forces(self.rest, self.inverse_mass, self.position, self.velocity, self.acceleration)
    }
}

/// Vectors with three coordinates, which those of a strand always have.
#[inline(always)]
pub(super) fn in_space<R, const D: usize>(vectors: &[[R; D]]) -> Option<&[[R; 3]]> {
    (D == 3).then_some(vectors.as_flattened().as_chunks().0)
}

/// The positions and the velocities of the masses of a section.
type Masses<R> = (Point<R>, Point<R>);

impl<R: Real> StrandRows<R> {
    /// The forces of the four springs from `first` on, from the masses `a` to the masses `b`.
    #[inline(always)]
    fn pull(&self, rest: &[R], first: usize, a: &Masses<R>, b: &Masses<R>, too_long: &mut Quad<R>) -> [Quad<R>; 3] {
        let (stiffness, damping) = (Quad::read(&self.stiffness, first), Quad::read(&self.damping, first));
        spring_force(a, b, stiffness, damping, Quad::read(rest, first), Quad::read(&self.longest, first), too_long)
    }

    /// The same of the two springs across a section, each from both of its ends.
    #[inline(always)]
    fn pull_across(
        &self,
        rest: &[R],
        first: usize,
        a: &Masses<R>,
        b: &Masses<R>,
        too_long: &mut Quad<R>,
    ) -> [Quad<R>; 3] {
        let (stiffness, damping) = (Quad::twice(&self.stiffness, first), Quad::twice(&self.damping, first));
        spring_force(a, b, stiffness, damping, Quad::twice(rest, first), Quad::twice(&self.longest, first), too_long)
    }

    /// Corner by corner, 1 where a spring is too long, or of no finite length, else 0.
    #[inline(always)]
    pub(super) fn too_long(&self, position: &[[R; 3]]) -> Quad<R> {
        let (zero, one) = (Quad::splat(R::splat(0.0)), Quad::splat(R::splat(1.0)));
        let mut found = zero;
        let mut note = |a: &Point<R>, b: &Point<R>, longest: Quad<R>| {
            found = a.length_to(b).if_below(longest, found, one);
        };
        for section in 0..self.strand.sections() {
            let first = STRIDE * section;
            let here = point(position, 4 * section);
            note(&here, &here.next(), Quad::read(&self.longest, first));
            note(&here, &here.opposite(), Quad::twice(&self.longest, first + SECTION_DIAGONALS));
            if section < self.strand.segments() {
                let next = point(position, 4 * section + 4);
                note(&here, &next, Quad::read(&self.longest, first + AXIAL));
                note(&here, &next.next(), Quad::read(&self.longest, first + RISING));
                note(&here.next(), &next, Quad::read(&self.longest, first + FALLING));
            }
        }
        found
    }

    /// The accelerations by all springs. Gives back, corner by corner, whether a spring was too long.
    #[inline(always)]
    fn forces(
        &self,
        rest: &[R],
        inverse_mass: &[R],
        position: &[[R; 3]],
        velocity: &[[R; 3]],
        acceleration: &mut [[R; 3]],
    ) -> Quad<R> {
        let zero = Quad::splat(R::splat(0.0));
        let mut too_long = zero;
        // The force on the masses of the section that is next, as far as it is known.
        let mut ahead = [zero; 3];
        let mut here = (point(position, 0), point(velocity, 0));
        for section in 0..self.strand.sections() {
            let first = STRIDE * section;
            let mut force = core::mem::replace(&mut ahead, [zero; 3]);
            let around = self.pull(rest, first, &here, &(here.0.next(), here.1.next()), &mut too_long);
            // From each corner to the opposite one, so every diagonal twice, once from each end.
            let opposite = (here.0.opposite(), here.1.opposite());
            let across = self.pull_across(rest, first + SECTION_DIAGONALS, &here, &opposite, &mut too_long);
            for axis in 0..3 {
                force[axis] = force[axis] + across[axis] + around[axis] - around[axis].previous();
            }
            if section < self.strand.segments() {
                let next = (point(position, 4 * section + 4), point(velocity, 4 * section + 4));
                let axial = self.pull(rest, first + AXIAL, &here, &next, &mut too_long);
                let rising = self.pull(rest, first + RISING, &here, &(next.0.next(), next.1.next()), &mut too_long);
                let falling = self.pull(rest, first + FALLING, &(here.0.next(), here.1.next()), &next, &mut too_long);
                for axis in 0..3 {
                    force[axis] = force[axis] + axial[axis] + rising[axis] + falling[axis].previous();
                    ahead[axis] = zero - axial[axis] - rising[axis].previous() - falling[axis];
                }
                here = next;
            }
            let light = Quad::read(inverse_mass, 4 * section);
            for (axis, force) in force.into_iter().enumerate() {
                (force * light).scatter(acceleration, 4 * section, axis);
            }
        }
        too_long
    }
}
