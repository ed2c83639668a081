//! Where everything of a figure of stiffness is.

use crate::{
    lab::{
        Crossing, Point, StiffnessStudy,
        chart::{Cost, Look, scale::LogScale, scale::short, shapes::Place, shapes::Rect},
        crossing, studied_methods,
    },
    mechanics::integrators::{Method, StickRule},
};

/// Seconds over the factor of stiffness.
#[derive(Clone, Debug)]
pub struct StiffnessPlot {
    /// One for each method, in the order of the legend.
    pub series: Vec<StiffnessSeries>,
    /// Where it is drawn.
    pub frame: Rect,
    /// The axis of factors.
    pub x: LogScale,
    /// The axis of seconds.
    pub y: LogScale,
    /// A line along which the cost grows as the root of the stiffness, as it does where the stability limit is what bounds a step.
    pub guide: Option<[Place; 2]>,
    /// Where implicit methods become the cheapest, if they do between two factors.
    pub crossing: Option<f64>,
}

/// The cheapest good runs of a method.
#[derive(Clone, Debug)]
pub struct StiffnessSeries {
    /// The method.
    pub method: Method,
    /// Factor and run, from the scene's own stiffness upwards.
    pub runs: Vec<(f64, Point)>,
    /// At which factors, in words.
    pub where_good: String,
}

impl StiffnessSeries {
    fn of(study: &StiffnessStudy, method: Method) -> Self {
        let sound = |seconds: f64| seconds.is_finite() && seconds >= 0.0;
        let run = |i: usize| {
            let scene = study.scenes.get(i)?;
            Some((scene.factor, *scene.run(method).filter(|point| sound(point.seconds))?))
        };
        let count = study.scenes.len();
        let runs: Vec<_> = (0..count).filter_map(run).collect();
        let ends = runs.first().zip(runs.last());
        let where_good = match ends {
            None => "nowhere".into(),
            Some(_) if runs.len() == count => "everywhere".into(),
            Some((first, last)) if first.0 == last.0 => format!("at {}", short(first.0)),
            Some((first, last)) => format!("{} to {}", short(first.0), short(last.0)),
        };
        Self { method, runs, where_good }
    }

    /// How it is drawn.
    pub fn look(&self) -> Look {
        Look::of(self.method, StickRule::InStages)
    }
}

impl StiffnessPlot {
    /// Lays a study out in `frame`.
    pub fn new(study: &StiffnessStudy, frame: Rect) -> Self {
        let series: Vec<_> = studied_methods().map(|method| StiffnessSeries::of(study, method)).collect();
        let factors = study.scenes.iter().map(|scene| scene.factor);
        let x = LogScale::new(factors, [1.0, 1e3], 0.04, frame.left, frame.right);
        let costs = series.iter().flat_map(|series| series.runs.iter().map(|(_, run)| Cost::Seconds.of(run)));
        let y = LogScale::new(costs, [1e-4, 1e-1], 0.06, frame.bottom, frame.top);
        let crossing = match crossing(study) {
            Crossing::From(factor, _) if x.shows(factor) => Some(x.place(factor)),
            _ => None,
        };
        let mut plot = Self { series, frame, x, y, guide: None, crossing };
        plot.guide = plot.guide_below(study);
        plot
    }

    /// Where a run is drawn; at the nearest edge if it lies outside.
    pub fn place(&self, factor: f64, run: &Point) -> Place {
        (self.x.place_within(factor), self.y.place_within(Cost::Seconds.of(run)))
    }

    /// The line of slope ½ a little below the cheapest method that is not implicit, at the stiffest.
    fn guide_below(&self, study: &StiffnessStudy) -> Option<[Place; 2]> {
        /// Far enough below not to lie on it.
        const BELOW: f64 = 0.6;
        /// Far enough to leave the frame on any axis.
        const DECADES: f64 = 40.0;
        let last = study.scenes.last()?;
        let (_, seconds) = last.cheapest(|method| !method.is_implicit())?;
        let (x, y) = (libm::log10(last.factor), libm::log10(BELOW * seconds));
        let at = |along: f64| (self.x.place_log(x + along), self.y.place_log(y + 0.5 * along));
        let ends = [at(-DECADES), at(DECADES)];
        if !ends.iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
            return None;
        }
        self.frame.clip(ends[0], ends[1])
    }
}
