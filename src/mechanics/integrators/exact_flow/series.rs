//! The Taylor series of a body's motion over one segment.

use core::f64::consts::TAU;

use crate::{
    body::{LEAST_REST_FRACTION, Wave},
    mechanics::{Model, State, kinks::half_cycles, model::MuscleRow, pull::PullRow, sin_cycles},
};

use super::Slide;

/// At most so many terms. The segment is short enough for (‖A‖τ)^k/k! to vanish long before.
const TERMS: usize = 40;

/// Coefficients of τ⁰, τ¹, …
pub(super) type Polynomial = [f64; TERMS];

/// The motion of all masses as polynomials of the time τ since the segment began.
#[derive(Clone, Debug)]
pub(super) struct Series {
    terms: usize,
    pub(super) position: Vec<Polynomial>,
    pub(super) velocity: Vec<Polynomial>,
    /// What a mass would be accelerated with if friction let it.
    pub(super) push: Vec<Polynomial>,
    /// ρ·amplitude·wave of each muscle.
    drive: Vec<Polynomial>,
    /// Which muscle drives a spring.
    muscle_of: Vec<Option<usize>>,
}

/// What is constant in a segment beside how masses slide.
#[derive(Clone, Copy)]
pub(super) struct Signs<'a> {
    /// +1 where the second end of a spring is at the greater x, else −1.
    pub(super) side: &'a [f64],
    /// Whether the least rest length of a spring holds.
    pub(super) clamped: &'a [bool],
    /// +1 or −1 where a hand pulls with all that it may, along x or against it; else 0.
    pub(super) capped: f64,
}

/// ‖A‖, bounded by sums over neighbours and a hand, and the fastest muscle: the scale of time on which anything changes.
pub(super) fn fastest_rate<const D: usize>(model: &Model<f64, D>) -> f64 {
    let mut rows = vec![(0.0, model.damping.map_or(0.0, |damping| damping.rate)); model.inverse_mass.len()];
    for spring in &model.springs {
        for end in spring.ends.map(|end| end as usize) {
            rows[end].0 += 2.0 * spring.stiffness * model.inverse_mass[end];
            rows[end].1 += 2.0 * spring.damping * model.inverse_mass[end];
        }
    }
    if let Some(pull) = &model.pull {
        let ([by_x, by_v], row) = (pull.slopes(), &mut rows[pull.particle]);
        row.0 += by_x * model.inverse_mass[pull.particle];
        row.1 += by_v * model.inverse_mass[pull.particle];
    }
    let drag = model.friction.map_or(0.0, |friction| friction.drag);
    let bodies = rows.iter().map(|(stiffness, damping)| stiffness.sqrt() + damping + drag);
    let muscles = model.muscles.iter().map(|muscle| TAU * muscle.frequency);
    bodies.chain(muscles).fold(1e-3, f64::max)
}

impl Series {
    pub(super) fn new(particles: usize) -> Self {
        let zeros = vec![[0.0; TERMS]; particles];
        Self {
            terms: 0,
            position: zeros.clone(),
            velocity: zeros.clone(),
            push: zeros,
            drive: Vec::new(),
            muscle_of: Vec::new(),
        }
    }

    /// How many terms the last segment took.
    pub(super) fn terms(&self) -> usize {
        self.terms
    }

    /// Begins a segment: the muscles' series, and where the masses are.
    pub(super) fn begin<const D: usize>(&mut self, model: &Model<f64, D>, state: &State<f64, D>, time: f64) {
        if self.muscle_of.len() != model.springs.len() {
            self.muscle_of = vec![None; model.springs.len()];
            for (index, muscle) in model.muscles.iter().enumerate() {
                self.muscle_of[muscle.spring as usize] = Some(index);
            }
            self.drive = vec![[0.0; TERMS]; model.muscles.len()];
        }
        for (drive, muscle) in self.drive.iter_mut().zip(&model.muscles) {
            *drive = drive_series(muscle, time);
        }
        for (series, x) in self.position.iter_mut().zip(&state.position) {
            series[0] = x[0];
        }
        self.restart_velocities(state);
    }

    pub(super) fn restart_velocities<const D: usize>(&mut self, state: &State<f64, D>) {
        for (series, v) in self.velocity.iter_mut().zip(&state.velocity) {
            series[0] = v[0];
        }
    }

    /// 1 + ρ·amplitude·wave − the least fraction of a rest length, at the beginning of the segment.
    pub(super) fn above_least(&self, muscle: usize) -> f64 {
        1.0 + self.drive[muscle][0] - LEAST_REST_FRACTION
    }

    /// The same as a polynomial.
    pub(super) fn above_least_series(&self, muscle: usize) -> Polynomial {
        let mut series = self.drive[muscle];
        series[0] = self.above_least(muscle);
        series
    }

    /// One coefficient of a spring's rest length.
    fn rest<const D: usize>(&self, model: &Model<f64, D>, spring: usize, clamped: &[bool], k: usize) -> f64 {
        let own = model.springs[spring].rest_length;
        let constant = if k == 0 { 1.0 } else { 0.0 };
        match self.muscle_of[spring] {
            Some(_) if clamped[spring] => own * constant * LEAST_REST_FRACTION,
            Some(muscle) => own * (constant + self.drive[muscle][k]),
            None => own * constant,
        }
    }

    /// One coefficient of a spring's length, and of its force.
    fn force<const D: usize>(&self, model: &Model<f64, D>, s: usize, signs: Signs<'_>, k: usize) -> f64 {
        let (side, clamped) = (signs.side[s], signs.clamped);
        let spring = &model.springs[s];
        let [a, b] = spring.ends.map(|end| end as usize);
        let length = side * (self.position[b][k] - self.position[a][k]);
        let speed = side * (self.velocity[b][k] - self.velocity[a][k]);
        side * (spring.stiffness * (self.rest(model, s, clamped, k) - length) - spring.damping * speed)
    }

    /// One coefficient of the force of a hand without its cap.
    fn grip(&self, pull: &PullRow, k: usize) -> f64 {
        pull.along_x(k, self.position[pull.particle][k], self.velocity[pull.particle][k])
    }

    /// How far the force of a hand without its cap is above the cap on a side, as a polynomial.
    pub(super) fn above_most(&self, pull: &PullRow, side: f64) -> Polynomial {
        let mut series = core::array::from_fn(|k| if k < self.terms { side * self.grip(pull, k) } else { 0.0 });
        series[0] -= pull.most();
        series
    }

    /// One coefficient of the force of a hand.
    fn pull(&self, pull: &PullRow, capped: f64, k: usize) -> f64 {
        match (capped == 0.0, k) {
            (true, _) => self.grip(pull, k),
            (false, 0) => capped * pull.most(),
            (false, _) => 0.0,
        }
    }

    /// What springs and a hand accelerate a mass with at the beginning of the segment.
    pub(super) fn push<const D: usize>(&self, model: &Model<f64, D>, mass: usize, signs: Signs<'_>) -> f64 {
        let mut push = -model.damping.map_or(0.0, |damping| damping.rate) * self.velocity[mass][0];
        if let Some(pull) = model.pull.filter(|pull| pull.particle == mass) {
            push += self.pull(&pull, signs.capped, 0) * model.inverse_mass[mass];
        }
        for (s, spring) in model.springs.iter().enumerate() {
            let [a, b] = spring.ends.map(|end| end as usize);
            if a == mass || b == mass {
                let force = self.force(model, s, signs, 0) * model.inverse_mass[mass];
                push += if b == mass { force } else { -force };
            }
        }
        push
    }

    /// All coefficients that matter over `length`.
    pub(super) fn extend<const D: usize>(
        &mut self,
        model: &Model<f64, D>,
        slide: &[Slide],
        signs: Signs<'_>,
        length: f64,
    ) {
        let thickness = model.damping.map_or(0.0, |damping| damping.rate);
        let drag = model.friction.map_or(0.0, |friction| friction.drag);
        let (mut power, mut small) = (1.0, 0);
        self.terms = TERMS;
        for k in 0..TERMS - 1 {
            for (mass, &slide) in slide.iter().enumerate() {
                let moves = if model.inverse_mass[mass] > 0.0 { thickness } else { 0.0 };
                let brake = if slide == Slide::Forward { drag } else { 0.0 };
                self.push[mass][k] = -(moves + brake) * self.velocity[mass][k];
            }
            for (s, spring) in model.springs.iter().enumerate() {
                let [a, b] = spring.ends.map(|end| end as usize);
                let force = self.force(model, s, signs, k);
                self.push[a][k] -= force * model.inverse_mass[a];
                self.push[b][k] += force * model.inverse_mass[b];
            }
            if let Some(pull) = &model.pull {
                self.push[pull.particle][k] += self.pull(pull, signs.capped, k) * model.inverse_mass[pull.particle];
            }
            let next = 1.0 / (k + 1) as f64;
            power *= length;
            let (mut largest, mut scale) = (0.0_f64, 0.0_f64);
            for (mass, &slide) in slide.iter().enumerate() {
                let goes = if slide == Slide::Stuck { 0.0 } else { self.push[mass][k] };
                self.position[mass][k + 1] = self.velocity[mass][k] * next;
                self.velocity[mass][k + 1] = goes * next;
                scale = scale.max(self.velocity[mass][0].abs()).max(self.push[mass][0].abs() * length);
                largest = largest.max(self.velocity[mass][k + 1].abs()).max(self.push[mass][k].abs() * length);
            }
            // A sine's even or odd terms may vanish: two small ones in a row, and the muscles' as well.
            let drives = self.drive.iter().map(|drive| drive[k + 1].abs()).fold(0.0, f64::max);
            small = if largest * power <= 1e-17 * scale && drives * power <= 1e-18 { small + 1 } else { 0 };
            if small == 3 {
                self.terms = k + 1;
                return;
            }
        }
        for mass in 0..self.push.len() {
            self.push[mass][TERMS - 1] = 0.0;
        }
    }

    /// A polynomial of this segment at τ.
    pub(super) fn value(&self, of: &Polynomial, at: f64) -> f64 {
        of[..self.terms].iter().rev().fold(0.0, |sum, coefficient| sum * at + coefficient)
    }

    /// Its derivative at τ.
    pub(super) fn slope(&self, of: &Polynomial, at: f64) -> f64 {
        (1..self.terms).rev().fold(0.0, |sum, k| sum * at + k as f64 * of[k])
    }

    /// No value on 0…`length` is farther from that at 0 than this.
    pub(super) fn reach(&self, of: &Polynomial, length: f64) -> f64 {
        of[1..self.terms].iter().rev().fold(0.0, |sum, coefficient| (sum + coefficient.abs()) * length)
    }

    /// Where the masses are at τ.
    pub(super) fn write<const D: usize>(&self, state: &mut State<f64, D>, at: f64) {
        for (mass, (x, v)) in state.position.iter_mut().zip(&mut state.velocity).enumerate() {
            x[0] = self.value(&self.position[mass], at);
            v[0] = self.value(&self.velocity[mass], at);
        }
    }

    /// The way from one mass to another as a polynomial.
    pub(super) fn way(&self, from: u32, to: u32) -> Polynomial {
        core::array::from_fn(|k| self.position[to as usize][k] - self.position[from as usize][k])
    }
}

/// ρ·amplitude·wave of a muscle around `time`.
fn drive_series(muscle: &MuscleRow<f64>, time: f64) -> Polynomial {
    let cycles = muscle.epoch_cycles + (time - muscle.epoch_time) * muscle.frequency;
    let at = cycles - muscle.phase;
    let mut wave = [0.0; TERMS];
    match muscle.wave {
        Wave::Square => wave[0] = if half_cycles(at) % 2.0 == 0.0 { muscle.amplitude } else { -muscle.amplitude },
        Wave::Sine => {
            let (sine, cosine) = (sin_cycles(at), sin_cycles(at + 0.25));
            let mut scale = muscle.amplitude;
            for (k, term) in wave.iter_mut().enumerate() {
                *term = scale * [sine, cosine, -sine, -cosine][k % 4];
                scale *= TAU * muscle.frequency / (k + 1) as f64;
            }
        }
    }
    if cycles < muscle.ramp {
        let (now, rise) = (cycles * muscle.ramp_rate, muscle.frequency * muscle.ramp_rate);
        return core::array::from_fn(|k| now * wave[k] + if k > 0 { rise * wave[k - 1] } else { 0.0 });
    }
    wave
}
