//! Two schemes that integrate a smooth piece far more exactly than any method that is charted, and that share nothing but the forces.

use core::cell::Cell;

use differential_equations::{
    methods::{DormandPrince, ExplicitRungeKutta, Ordinary},
    ode::{ODE, OrdinaryNumericalMethod},
    status::Status,
};

use super::piece::Piece;

/// Integrates smooth pieces.
pub(super) trait Scheme<const D: usize> {
    /// Moves a state from one time to another.
    fn advance(&mut self, piece: &Piece<'_, D>, from: f64, y: &[f64], to: f64) -> Result<Vec<f64>, String>;
}

impl<const D: usize> ODE<f64, Vec<f64>> for Piece<'_, D> {
    fn diff(&self, time: f64, y: &Vec<f64>, derivative: &mut Vec<f64>) {
        self.derivative(time, y, derivative);
    }
}

/// DOP853 with step-size control. Source: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", II.5.
pub(super) struct Dop853(ExplicitRungeKutta<Ordinary, DormandPrince, f64, Vec<f64>, 8, 12, 16>);

impl Dop853 {
    /// `size` is a length of the body, by which positions near zero are measured.
    pub(super) fn new(size: f64) -> Self {
        const TOLERANCE: f64 = 1e-12;
        let method = ExplicitRungeKutta::dop853().rtol(TOLERANCE).atol(TOLERANCE * size);
        Self(method.max_steps(usize::MAX))
    }
}

impl<const D: usize> Scheme<D> for Dop853 {
    fn advance(&mut self, piece: &Piece<'_, D>, from: f64, y: &[f64], to: f64) -> Result<Vec<f64>, String> {
        /// More than the stiffest body that can be followed so needs.
        const MOST_STEPS: u32 = 1_000_000;
        let method = &mut self.0;
        // The whole way in one step, if that is exact enough.
        method.h0 = to - from;
        method.init(piece, from, to, &y.to_vec()).map_err(|error| problem(&error))?;
        let mut left = to - method.t();
        let closeness = 1e-14 * to.abs().max(to - from);
        let steps = Cell::new(0);
        while left > closeness {
            if method.h() > left || left - method.h() < closeness {
                method.set_h(left);
            }
            method.step(piece).map_err(|error| problem(&error))?;
            left = to - method.t();
            steps.set(steps.get() + 1);
            if steps.get() > MOST_STEPS || !method.h().is_finite() {
                return Err("its forces are too stiff, or not finite".into());
            }
        }
        match method.status() {
            Status::Error(error) => Err(problem(error)),
            _ => Ok(method.y().clone()),
        }
    }
}

fn problem(error: &differential_equations::error::Error<f64, Vec<f64>>) -> String {
    use differential_equations::error::Error;
    match error {
        Error::Stiffness { .. } => "its forces are too stiff for DOP853".into(),
        Error::StepSize { .. } => "the step of DOP853 has become too small".into(),
        Error::BadInput { msg } => msg.clone(),
        _ => "DOP853 cannot go on".into(),
    }
}

/// Gauss–Legendre collocation with three stages, order 6, in fixed steps, its equations solved by iteration until nothing changes. Source: E. Hairer,
/// S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", II.7, table 7.4.
///
/// The Radau5 of the crate that has DOP853 does not serve: its version 0.7 panics on states whose size is known only when it runs, and at a tolerance of
/// 1e-12 it is 3e-9 off after 10 units of time of x'' = −x.
pub(super) struct Gauss {
    /// The largest step.
    step: f64,
    /// A change of an acceleration that is rounding: forces of stiff springs are differences of large numbers.
    rounding: f64,
    /// Slopes of the stages, and what they become.
    slopes: [Vec<f64>; 3],
    next: [Vec<f64>; 3],
    stage: Vec<f64>,
}

impl Gauss {
    /// `rate` is that of the fastest change of the body, `size` a length of it.
    pub(super) fn new(rate: f64, size: f64) -> Self {
        /// Of the local error 5e-7·(rate·step)⁷ nothing is left then.
        const SMALL: f64 = 0.05;
        let (step, rounding) = (SMALL / rate, 1e-14 * size * rate * rate);
        Self { step, rounding, slopes: Default::default(), next: Default::default(), stage: Vec::new() }
    }

    /// One step.
    fn step<const D: usize>(&mut self, piece: &Piece<'_, D>, time: f64, y: &mut [f64], h: f64) -> Result<(), String> {
        const MOST_ITERATIONS: u32 = 100;
        let root = 15_f64.sqrt();
        let nodes = [0.5 - root / 10.0, 0.5, 0.5 + root / 10.0];
        let weights = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
        let matrix = [
            [5.0 / 36.0, 2.0 / 9.0 - root / 15.0, 5.0 / 36.0 - root / 30.0],
            [5.0 / 36.0 + root / 24.0, 2.0 / 9.0, 5.0 / 36.0 - root / 24.0],
            [5.0 / 36.0 + root / 30.0, 2.0 / 9.0 + root / 15.0, 5.0 / 36.0],
        ];
        for slopes in [&mut self.slopes, &mut self.next] {
            slopes.iter_mut().for_each(|slope| slope.resize(y.len(), 0.0));
        }
        self.stage.resize(y.len(), 0.0);
        piece.derivative(time, y, &mut self.slopes[0]);
        for i in 1..3 {
            let (first, others) = self.slopes.split_at_mut(i);
            others[0].copy_from_slice(&first[0]);
        }
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            for i in 0..3 {
                for (k, stage) in self.stage.iter_mut().enumerate() {
                    *stage = y[k] + h * (0..3).map(|j| matrix[i][j] * self.slopes[j][k]).sum::<f64>();
                }
                piece.derivative(time + nodes[i] * h, &self.stage, &mut self.next[i]);
            }
            let pairs = self.slopes.iter().flatten().zip(self.next.iter().flatten());
            let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let size = self.next.iter().flatten().map(|slope| slope.abs()).fold(0.0, f64::max);
            core::mem::swap(&mut self.slopes, &mut self.next);
            // Rounding errors are all that is left once the change is small and does not shrink any more.
            if change == 0.0 || (change < f64::max(1e-12 * size, self.rounding) && change >= last) {
                for (k, value) in y.iter_mut().enumerate() {
                    *value += h * (0..3).map(|j| weights[j] * self.slopes[j][k]).sum::<f64>();
                }
                return Ok(());
            }
            last = change;
        }
        Err("the iteration of its collocation does not converge".into())
    }
}

impl<const D: usize> Scheme<D> for Gauss {
    fn advance(&mut self, piece: &Piece<'_, D>, from: f64, y: &[f64], to: f64) -> Result<Vec<f64>, String> {
        let mut y = y.to_vec();
        let steps = ((to - from) / self.step).ceil().max(1.0);
        let h = (to - from) / steps;
        for i in 0..steps as u64 {
            self.step(piece, from + i as f64 * h, &mut y, h)?;
        }
        Ok(y)
    }
}
