//! The points of a chart, sorted into one series for each method and stick rule.

use std::collections::BTreeMap;

use super::{Look, scale::short};
use crate::lab::{Edge, Point, Setting, WorkPrecision};
use crate::mechanics::integrators::{Method, StickRule};

/// What a run costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// In evaluations of the forces, which no machine changes.
    Evaluations,
    /// In seconds, the shortest of the timed runs.
    Seconds,
}

impl Cost {
    /// The cost of a run. What costs nothing is drawn at one evaluation or one nanosecond.
    pub fn of(self, point: &Point) -> f64 {
        match self {
            Self::Evaluations => (point.evaluations as f64).max(1.0),
            Self::Seconds => point.seconds.max(1e-9),
        }
    }
}

/// All runs of a method with a stick rule.
#[derive(Clone, Debug)]
pub struct Series {
    /// The method.
    pub method: Method,
    /// When friction acts.
    pub stick: StickRule,
    /// Its stability edge; `None` where it is not known.
    pub limit: Option<Edge>,
    /// Runs that did not blow up, from the largest step down.
    pub good: Vec<Point>,
    /// Runs that did.
    pub blown: Vec<Point>,
}

/// The largest position error of a run; `None` where it blew up or is not finite.
pub fn error(point: &Point) -> Option<f64> {
    point.largest_error()
}

impl Series {
    /// Sorts the points of a chart, in the order of [`Method`].
    pub fn all(chart: &WorkPrecision) -> Vec<Self> {
        let mut sorted = BTreeMap::new();
        for point in &chart.points {
            let Setting { method, stick, dt } = point.setting;
            if !(dt.is_finite() && dt > 0.0) {
                continue;
            }
            let series = sorted.entry((method, stick)).or_insert_with(|| Self {
                method,
                stick,
                limit: chart.edges.iter().find(|edge| edge.method == method).copied(),
                good: Vec::new(),
                blown: Vec::new(),
            });
            if error(point).is_some() { series.good.push(*point) } else { series.blown.push(*point) }
        }
        let mut all: Vec<_> = sorted.into_values().collect();
        for series in &mut all {
            for points in [&mut series.good, &mut series.blown] {
                points.sort_by(|a, b| b.setting.dt.total_cmp(&a.setting.dt));
            }
        }
        all
    }

    /// How it is drawn.
    pub fn look(&self) -> Look {
        Look::of(self.method, self.stick)
    }

    /// What it is called.
    pub fn name(&self) -> String {
        match self.stick {
            StickRule::InStages => self.method.name().into(),
            stick => format!("{}, friction {}", self.method.name(), stick.words()),
        }
    }

    /// The largest stable step in words; `≥` before a bound.
    pub fn limit_text(&self) -> String {
        match self.limit {
            Some(Edge { dt: f64::INFINITY, .. }) => "none".into(),
            Some(Edge { dt, predicted, .. }) if dt.is_finite() => {
                format!("{}{}", if predicted { "" } else { "≥ " }, short(dt))
            }
            _ => "unknown".into(),
        }
    }

    /// What a whole run with a step of `dt` would cost, from the run that did not blow up with the step nearest to it.
    ///
    /// A run that blew up was broken off, so that its own cost would put it among cheap runs.
    pub fn cost_of(&self, dt: f64, cost: Cost, duration: f64) -> Option<f64> {
        let distance = |point: &Point| libm::fabs(libm::log(point.setting.dt / dt));
        let nearest = self.good.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let whole = match nearest {
            Some(point) => cost.of(point) * point.setting.dt / dt,
            None => {
                let point = self.blown.first()?;
                let a_step = match (cost, self.method.about().evaluations) {
                    (Cost::Evaluations, Some(evaluations)) => evaluations as f64,
                    _ => cost.of(point) / (point.steps as f64).max(1.0),
                };
                a_step * duration / dt
            }
        };
        (whole.is_finite() && whole > 0.0).then_some(whole)
    }

    /// The stability limit, where it is a step that can be shown.
    pub fn edge(&self) -> Option<f64> {
        self.limit.map(|edge| edge.dt).filter(|limit| limit.is_finite() && *limit > 0.0)
    }

    /// Cost and error of a setting: as measured, or on the straight line between the two runs around its step.
    pub fn at(&self, dt: f64, cost: Cost) -> Option<(f64, f64)> {
        let place = |point: &Point| Some((cost.of(point), error(point)?));
        if let Some(point) = self.good.iter().find(|point| libm::fabs(point.setting.dt / dt - 1.0) < 1e-9) {
            return place(point);
        }
        let pair = self.good.windows(2).find(|pair| pair[0].setting.dt > dt && dt > pair[1].setting.dt)?;
        let (a, b) = (place(&pair[0])?, place(&pair[1])?);
        let part = libm::log(pair[0].setting.dt / dt) / libm::log(pair[0].setting.dt / pair[1].setting.dt);
        let between = |a: f64, b: f64| a * libm::pow(b / a, part);
        let place = (between(a.0, b.0), between(a.1, b.1));
        (place.0.is_finite() && place.1.is_finite()).then_some(place)
    }
}
