//! What is written in a panel: what lines mean, and the step of each run.

use super::{
    figure::{BUDGET_EDGE, GREY, MARKER, SMALL, places},
    labels::{Placer, around},
    plot::{Panel, Plot},
    scale::short,
    series::Series,
    shapes::{Color, Picture, Place},
    text::{Anchor, Text},
};
use crate::lab::WorkPrecision;

/// An error that means something.
pub(super) struct Level {
    pub(super) y: f64,
    pub(super) color: Color,
    text: String,
    /// Whether all below it is shaded.
    pub(super) band: bool,
}

/// What the scene can afford, and how far the reference can be trusted.
pub(super) fn levels(chart: &WorkPrecision, panel: &Panel) -> Vec<Level> {
    let budget = (chart.budget, "good enough: error below", BUDGET_EDGE, true);
    let reference = (chart.reference_error, "the reference itself is sure to", GREY, false);
    let known = (chart.least_known_error(), "grey: errors not known to a hundredth, below", GREY, false);
    let shown = [budget, reference, known].into_iter().filter(|(error, ..)| panel.y.shows(*error));
    shown
        .map(|(error, text, color, band)| {
            let text = format!("{text} {}", short(error));
            Level { y: panel.y.place(error), text, color, band }
        })
        .collect()
}

/// Where the zone begins in which errors are not known: at the top of the frame where none of its errors are, nowhere where all are.
pub(super) fn unknown(chart: &WorkPrecision, panel: &Panel) -> Option<f64> {
    let [low, high] = panel.y.logs();
    let least = libm::log10(chart.least_known_error());
    (least > low).then(|| panel.y.place_log(least.min(high)))
}

/// What lines and bands mean, written at them.
pub(super) fn meanings(picture: &mut Picture, panel: &Panel, placer: &mut Placer, levels: &[Level]) {
    let frame = panel.frame;
    for level in levels {
        let places = [(frame.right - 8.0, Anchor::End), (frame.left + 8.0, Anchor::Start)];
        let candidates = places.into_iter().flat_map(|(x, anchor)| {
            let text = |y| Text::new(level.text.clone(), (x, y), SMALL).anchored(anchor).colored(level.color);
            [text(level.y + 17.0), text(level.y - 6.0)]
        });
        write(picture, placer.place(candidates, true));
    }
    if let Some(x) = panel.real_time {
        let candidates = [(x - 7.0, Anchor::End), (x + 7.0, Anchor::Start)].into_iter().flat_map(|(x, anchor)| {
            (1..20).map(move |i| Text::new("real time", (x, frame.top + 18.0 * f64::from(i)), SMALL).anchored(anchor))
        });
        write(picture, placer.place(candidates, true));
    }
    for guide in &panel.guides {
        let along = |part: f64| {
            let (from, to) = (guide.from, guide.to);
            (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1))
        };
        let parts = (1..20).map(|i| 1.0 - 0.04 * f64::from(i));
        let text = |part| {
            let (x, y) = along(part);
            let text = Text::new(format!("order {}", guide.order), (x + 6.0, y - 4.0), SMALL).colored(GREY);
            [text.clone(), Text { at: (x - 6.0, y + 13.0), ..text }.anchored(Anchor::End)]
        };
        write(picture, placer.place(parts.flat_map(text), false));
    }
}

/// Writes a text that has found room, on a ground that lets what lies below shine through.
pub(super) fn write(picture: &mut Picture, text: Option<Text>) {
    if let Some(text) = text {
        picture.area(text.bounds().corners(), [0xff; 3], 0.6);
        picture.text(text);
    }
}

/// Writes dt at the first and the last point of each series, then at as many between as have room.
pub(super) fn steps(picture: &mut Picture, plot: &Plot, panel: &Panel, placer: &mut Placer) {
    let label = |series: &Series, i: usize| {
        Text::new(short(series.good[i].setting.dt), (0.0, 0.0), SMALL).colored(series.look().ink())
    };
    let all: Vec<_> = plot.series.iter().map(|series| (series, places(panel, series))).collect();
    let mut label_at = |series: &Series, places: &[Place], i: usize, over_lines| {
        let candidates = around(&label(series, i), places[i], MARKER);
        write(picture, placer.place(candidates, over_lines));
    };
    let ends = |places: &[Place]| [0, places.len() - 1].into_iter().take(places.len().min(2)).collect::<Vec<_>>();
    for (series, places) in all.iter().filter(|(_, places)| !places.is_empty()) {
        ends(places).into_iter().for_each(|i| label_at(series, places, i, true));
    }
    for (series, places) in all.iter().filter(|(_, places)| places.len() > 2) {
        (1..places.len() - 1).for_each(|i| label_at(series, places, i, false));
    }
}
