//! Forces of a strand: its waves, its rest lengths and its springs, four corners at a time.

use crate::body::{
    Activity, Epoch, LEAST_REST_FRACTION, Strand, TravelingWave, TravelingWaves, Wave, WaveDirection, WaveKind,
};

use super::{
    BodyParts, Model, Real,
    quad::{Quad, point, spring_force},
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

/// What the segments of a strand are driven by, before the least rest length.
#[derive(Clone, Copy, Debug)]
struct Drive<R> {
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
    activity_from: R,
    activity_to: R,
    activity_since: R,
    activity_rate: R,
    /// Scratch: what drives each segment.
    drive: Vec<Drive<R>>,
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
            activity_from: zero,
            activity_to: zero,
            activity_since: zero,
            activity_rate: zero,
            drive: vec![Drive { long: zero, lateral: zero, vertical: zero }; strand.segments()],
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
        let Activity { from, to, since, rate } = waves.activity();
        self.steering.set_lane(lane, waves.steering());
        self.activity_from.set_lane(lane, from);
        self.activity_to.set_lane(lane, to);
        self.activity_since.set_lane(lane, since);
        self.activity_rate.set_lane(lane, rate);
    }

    /// The strand in one lane.
    pub(super) fn lane(&self, lane: usize) -> StrandRows<f64> {
        let all = |values: &[R]| values.iter().map(|value| value.lane(lane)).collect::<Vec<_>>();
        let drive = |drive: &Drive<R>| Drive {
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
            activity_from: self.activity_from.lane(lane),
            activity_to: self.activity_to.lane(lane),
            activity_since: self.activity_since.lane(lane),
            activity_rate: self.activity_rate.lane(lane),
            drive: self.drive.iter().map(drive).collect(),
            stretch: all(&self.stretch),
        }
    }

    /// ρ.
    #[inline(always)]
    fn activity(&self, time: f64) -> R {
        let (from, to) = (self.activity_from, self.activity_to);
        let least = from.if_below(to, from, to);
        let most = from.if_below(to, to, from);
        let now = from + self.activity_rate * (R::splat(time) - self.activity_since);
        let now = now.if_below(least, least, now);
        most.if_below(now, most, now)
    }

    /// What drives each segment at `time`: the waves, once a segment.
    #[inline(always)]
    fn drive_segments(&mut self, time: f64) {
        let zero = R::splat(0.0);
        for drive in &mut self.drive {
            *drive = Drive { long: zero, lateral: self.steering, vertical: zero };
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
        let activity = self.activity(time);
        for (segment, &Drive { long, lateral, vertical }) in self.drive.iter().enumerate() {
            let (left, right) = (long + lateral, long - lateral);
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
        pulp::Arch::new().dispatch(|| rows.drive(time, position, &mut self.rest));
    }

    /// What the springs of a strand and gravity accelerate every particle with; rest lengths are driven already.
    #[inline(never)]
    pub(super) fn strand_forces(&mut self, position: &[[R; D]], velocity: &[[R; D]], acceleration: &mut [[R; D]]) {
        let Self { strand: Some(rows), rest, inverse_mass, gravity, overstretched, .. } = self else { return };
        let (Some(position), Some(velocity)) = (in_space(position), in_space(velocity)) else { return };
        let (acceleration, _) = acceleration.as_flattened_mut().as_chunks_mut();
        let too_long = pulp::Arch::new().dispatch(|| rows.forces(rest, inverse_mass, position, velocity, acceleration));
        *overstretched = too_long.any(*overstretched);
        let Some(gravity) = *gravity else { return };
        let zero = R::splat(0.0);
        for (row, &inverse_mass) in acceleration.iter_mut().zip(&*inverse_mass) {
            row[1] -= zero.if_below(inverse_mass, gravity, zero);
        }
    }
}

/// Vectors with three coordinates, which those of a strand always have.
#[inline(always)]
fn in_space<R, const D: usize>(vectors: &[[R; D]]) -> Option<&[[R; 3]]> {
    (D == 3).then_some(vectors.as_flattened().as_chunks().0)
}

impl<R: Real> StrandRows<R> {
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
            let mut pull = |from: usize, a: &_, b: &_, pair: bool| {
                let read = |values: &[R]| if pair { Quad::twice(values, from) } else { Quad::read(values, from) };
                let (stiffness, damping) = (read(&self.stiffness), read(&self.damping));
                spring_force(a, b, stiffness, damping, read(rest), read(&self.longest), &mut too_long)
            };
            let around = pull(first, &here, &(here.0.next(), here.1.next()), false);
            // From each corner to the opposite one, so every diagonal twice, once from each end.
            let opposite = (here.0.opposite(), here.1.opposite());
            let across = pull(first + SECTION_DIAGONALS, &here, &opposite, true);
            for axis in 0..3 {
                force[axis] = force[axis] + across[axis] + around[axis] - around[axis].previous();
            }
            if section < self.strand.segments() {
                let next = (point(position, 4 * section + 4), point(velocity, 4 * section + 4));
                let axial = pull(first + AXIAL, &here, &next, false);
                let rising = pull(first + RISING, &here, &(next.0.next(), next.1.next()), false);
                let falling = pull(first + FALLING, &(here.0.next(), here.1.next()), &next, false);
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
