//! Where everything of a chart is: pure geometry, before anything is drawn.

use super::{
    scale::LogScale,
    series::{Cost, Series, error},
    shapes::{Place, Rect},
    tracks::{Track, pack},
};
use crate::{
    lab::{Unit, WorkPrecision},
    mechanics::integrators::Method,
    scenes::DOCUMENT_DT,
};

/// The two panels of a chart.
#[derive(Clone, Debug)]
pub struct Plot {
    /// The series, in the order of the legend.
    pub series: Vec<Series>,
    /// Force evaluations, then seconds.
    pub panels: [Panel; 2],
    /// Whether a run has no error at all.
    pub exact: bool,
}

/// Error over one kind of cost.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Which cost.
    pub cost: Cost,
    /// Where errors are drawn.
    pub frame: Rect,
    /// The strip above it, for runs that blew up and for stability limits.
    pub strip: Rect,
    /// The axis of costs.
    pub x: LogScale,
    /// The axis of errors.
    pub y: LogScale,
    /// What stands in the strip.
    pub tracks: Vec<Track>,
    /// Lines of order 1, 2 and 4.
    pub guides: Vec<Guide>,
    /// The scene's own setting.
    pub setting: Option<Place>,
    /// The setting of the document: semi-implicit Euler with [`DOCUMENT_DT`]; not where gaits are judged, of which it does not speak.
    pub document: Option<Place>,
    /// Where a run takes as long as the app takes to show it; in the panel of seconds and if it lies within.
    pub real_time: Option<f64>,
}

/// A line along which the error falls with a power of the cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// The power.
    pub order: u32,
    /// Its upper left end.
    pub from: Place,
    /// Its lower right end.
    pub to: Place,
}

/// The room that panels, strip and captions have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Left edges of the panels.
    pub lefts: [f64; 2],
    /// How wide a panel is.
    pub width: f64,
    /// Where the strip begins.
    pub top: f64,
    /// Where the frames end.
    pub bottom: f64,
}

/// The room at the bottom for runs without any error.
const EXACT_ROOM: f64 = 30.0;
/// A shorter guide line shows no slope.
const SHORTEST_GUIDE: f64 = 90.0;
/// Between a strip and its frame.
const GAP: f64 = 6.0;

impl Plot {
    /// Lays a chart out in `room`.
    pub fn new(chart: &WorkPrecision, room: Room) -> Self {
        let series = Series::all(chart);
        let errors: Vec<f64> = series.iter().flat_map(|series| series.good.iter().filter_map(error)).collect();
        let exact = errors.contains(&0.0);
        let costs = [Cost::Evaluations, Cost::Seconds];
        let scales = [0, 1].map(|i| x_scale(chart, &series, costs[i], room.lefts[i], room.width));
        let tracks = [0, 1].map(|i| {
            let right = room.lefts[i] + room.width;
            pack(Track::all(&series, costs[i], chart.duration, &scales[i]), right)
        });
        let rows = tracks.iter().flatten().map(|track| track.row + 1).max().unwrap_or(1);
        let strip_bottom = room.top + rows as f64 * Track::HEIGHT + 8.0;
        let frame_top = strip_bottom + GAP;
        let y_bottom = if exact { room.bottom - EXACT_ROOM } else { room.bottom };
        let otherwise = [1e-6, 1.0];
        let y = LogScale::new(errors.into_iter().chain([chart.budget]), otherwise, 0.06, y_bottom, frame_top);
        let mut tracks = tracks.into_iter();
        let panels = [0, 1].map(|i| {
            let (left, right) = (room.lefts[i], room.lefts[i] + room.width);
            let mut panel = Panel {
                cost: costs[i],
                frame: Rect { left, top: frame_top, right, bottom: room.bottom },
                strip: Rect { left, top: room.top, right, bottom: strip_bottom },
                x: scales[i],
                y,
                tracks: tracks.next().unwrap_or_default(),
                guides: Vec::new(),
                setting: None,
                document: None,
                real_time: None,
            };
            let wanted = chart.setting;
            let at = |series: &Series, dt| series.at(dt, costs[i]).map(|(cost, error)| panel.place(cost, error));
            let own = |series: &&Series| series.method == wanted.method && series.stick == wanted.stick;
            let document = |series: &&Series| series.method == Method::SemiImplicitEuler && chart.unit == Unit::Length;
            let setting = series.iter().filter(own).find_map(|series| at(series, wanted.dt));
            let document = series.iter().filter(document).find_map(|series| at(series, DOCUMENT_DT));
            (panel.setting, panel.document) = (setting, document);
            if costs[i] == Cost::Seconds && panel.x.shows(chart.real_time) {
                panel.real_time = Some(panel.x.place(chart.real_time));
            }
            panel.guides = panel.guides_from(&series);
            panel
        });
        Self { series, panels, exact }
    }
}

impl Panel {
    /// Where a run of some cost and error is drawn; at the nearest edge if it lies outside.
    pub fn place(&self, cost: f64, error: f64) -> Place {
        let y = if error > 0.0 { self.y.place(error) } else { self.frame.bottom - EXACT_ROOM / 2.0 };
        (self.x.place_within(cost), y.clamp(self.frame.top, self.frame.bottom))
    }

    /// Lines of order 1, 2 and 4 from the corner of the least cost and the largest error, so that a single method that keeps its order
    /// lies on one of them, and all others can be held against their slopes.
    fn guides_from(&self, series: &[Series]) -> Vec<Guide> {
        let points = || series.iter().flat_map(|series| &series.good);
        let costs = points().map(|point| self.cost.of(point)).filter(|cost| cost.is_finite());
        let errors = points().filter_map(error).filter(|error| *error > 0.0);
        let (cost, error) = (costs.fold(f64::INFINITY, f64::min), errors.fold(0.0, f64::max));
        if !(cost.is_finite() && error > 0.0) {
            return Vec::new();
        }
        let (x, y) = (libm::log10(cost), libm::log10(error));
        // Far enough to leave the frame on any axis.
        const DECADES: f64 = 40.0;
        let lines = [1, 2, 4].map(|order: u32| {
            let from = (self.x.place_log(x), self.y.place_log(y));
            let to = (self.x.place_log(x + DECADES), self.y.place_log(y - DECADES * f64::from(order)));
            let frame = Rect { bottom: self.y.place_log(self.y.logs()[0]), ..self.frame };
            frame.clip(from, to).map(|[from, to]| Guide { order, from, to })
        });
        let long = |guide: &Guide| libm::hypot(guide.to.0 - guide.from.0, guide.to.1 - guide.from.1) > SHORTEST_GUIDE;
        lines.into_iter().flatten().filter(long).collect()
    }
}

fn x_scale(chart: &WorkPrecision, series: &[Series], cost: Cost, left: f64, width: f64) -> LogScale {
    let good = series.iter().flat_map(|series| series.good.iter().map(|point| cost.of(point)));
    let others = series.iter().flat_map(|series| {
        let steps = series.blown.iter().map(|point| point.setting.dt).chain(series.edge());
        steps.filter_map(|dt| series.cost_of(dt, cost, chart.duration))
    });
    let median = match cost {
        Cost::Evaluations => None,
        Cost::Seconds => Some(series.iter().flat_map(|series| series.good.iter().map(|point| point.median_seconds))),
    };
    let measured: Vec<f64> = good.chain(others).chain(median.into_iter().flatten()).collect();
    let most = measured.iter().copied().filter(|cost| cost.is_finite()).fold(0.0, f64::max);
    // Real time far away is said, not drawn.
    let real_time = (cost == Cost::Seconds && (most..3.0 * most).contains(&chart.real_time)).then_some(chart.real_time);
    let otherwise = match cost {
        Cost::Evaluations => [1e2, 1e5],
        Cost::Seconds => [1e-4, 1e-1],
    };
    LogScale::new(measured.into_iter().chain(real_time), otherwise, 0.05, left, left + width)
}
