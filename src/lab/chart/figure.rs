//! Draws the panels of a chart.

use super::{
    axes,
    labels::Placer,
    look::{regular, star},
    plot::{Panel, Plot},
    series::{Cost, Series, error},
    shapes::{Color, Picture, Place, Rect},
    text::{Anchor, Text},
    tracks::Track,
    words,
};
use crate::lab::{Unit, WorkPrecision};

/// The radius of a marker.
pub(super) const MARKER: f64 = 5.5;
/// The radius of the star of the scene's setting.
pub(super) const STAR: f64 = 13.0;
/// The radius of the circle of the document's setting.
pub(super) const CIRCLE: f64 = 12.0;
/// The em of what is written at marks and lines.
pub(super) const SMALL: f64 = 12.5;

pub(super) const BLACK: Color = [0; 3];
pub(super) const GREY: Color = [0x66; 3];
pub(super) const BUDGET: Color = [0xdf, 0xef, 0xe6];
/// What lies over errors that are not known.
pub(super) const UNKNOWN: Color = [0x9a; 3];
pub(super) const UNKNOWN_ALPHA: f64 = 0.3;
pub(super) const BUDGET_EDGE: Color = [0x3d, 0x7a, 0x5c];
pub(super) const GUIDE: Color = [0x9a; 3];
pub(super) const STAR_FILL: Color = [0xf0, 0xe4, 0x42];

/// Draws a panel; the first one has the axis of errors.
pub(super) fn draw(picture: &mut Picture, chart: &WorkPrecision, plot: &Plot, panel: &Panel, first: bool) {
    let mut placer = Placer::new(panel.frame);
    let levels = words::levels(chart, panel);
    if let Some(budget) = levels.iter().find(|level| level.band) {
        picture.area(Rect { top: budget.y, ..panel.frame }.corners(), BUDGET, 1.0);
    }
    if let Some(top) = words::unknown(chart, panel) {
        picture.area(Rect { top, ..panel.frame }.corners(), UNKNOWN, UNKNOWN_ALPHA);
    }
    grid(picture, chart.unit, plot, panel, first);
    strip(picture, plot, panel, first);
    for level in &levels {
        picture.line([(panel.frame.left, level.y), (panel.frame.right, level.y)], level.color, 1.5);
    }
    for guide in &panel.guides {
        picture.dashed(&[guide.from, guide.to], &[9.0, 6.0], GUIDE, 1.3);
        placer.take_line(&[guide.from, guide.to]);
    }
    if let Some(x) = panel.real_time {
        picture.line([(x, panel.frame.top), (x, panel.frame.bottom)], GREY, 2.2);
        placer.take(Rect { left: x - 3.0, right: x + 3.0, ..panel.frame });
    }
    axes::border(picture, panel.frame);

    let series = || plot.series.iter().map(|series| (series, places(panel, series)));
    for (series, places) in series() {
        picture.dashed(&places, series.look().dashes, series.look().color, 1.9);
        placer.take_line(&places);
        places.iter().for_each(|&place| placer.take(Rect::around(place, MARKER + 1.0)));
    }
    for (series, places) in series() {
        if panel.cost == Cost::Seconds {
            medians(picture, panel, &mut placer, series, &places);
        }
        places.iter().for_each(|&place| series.look().mark(picture, place, MARKER));
    }
    // Over all others, and under its own mark.
    highlights(picture, panel, &mut placer);
    let own = |series: &&Series| (series.method, series.stick) == (chart.setting.method, chart.setting.stick);
    if let (Some(place), Some(series)) = (panel.setting, plot.series.iter().find(own))
        && places(panel, series).contains(&place)
    {
        series.look().mark(picture, place, MARKER);
    }
    words::meanings(picture, panel, &mut placer, &levels);
    words::steps(picture, plot, panel, &mut placer);
}

pub(super) fn places(panel: &Panel, series: &Series) -> Vec<Place> {
    let runs = series.good.iter().filter_map(|point| Some((panel.cost.of(point), error(point)?)));
    runs.map(|(cost, error)| panel.place(cost, error)).collect()
}

fn grid(picture: &mut Picture, unit: Unit, plot: &Plot, panel: &Panel, first: bool) {
    let frame = panel.frame;
    let title = match panel.cost {
        Cost::Evaluations => "force evaluations",
        Cost::Seconds => "seconds: shortest run, bar to the median",
    };
    axes::across(picture, frame, &panel.x, title);
    let error = match unit {
        Unit::Length => "error: largest distance from the reference, in lengths",
        Unit::PartOfSpeed => "error: of the speed of a gait, as a part of it",
        Unit::PartOfCell => "error: of shape, height or volume, as a part of a cell",
    };
    let title = first.then_some(error);
    axes::upwards(picture, frame, &panel.y, title);
    if plot.exact && first {
        let y = panel.place(1.0, 0.0).1;
        picture.text(Text::new("0", (frame.left - 9.0, y + 5.0), axes::TICK_SIZE).anchored(Anchor::End));
    }
}

fn strip(picture: &mut Picture, plot: &Plot, panel: &Panel, first: bool) {
    let strip = panel.strip;
    picture.area(strip.corners(), [0xf6; 3], 1.0);
    if first {
        let middle = (strip.top + strip.bottom) / 2.0;
        for (text, y) in [("blew up ×", middle - 3.0), ("limit of dt |", middle + 13.0)] {
            picture.text(Text::new(text, (strip.left - 9.0, y), SMALL).anchored(Anchor::End));
        }
    }
    for track in &panel.tracks {
        let y = strip.top + 4.0 + (track.row as f64 + 0.5) * Track::HEIGHT;
        let look = plot.series[track.series].look();
        let all = || track.crosses.iter().chain(&track.edge).copied();
        let (left, right) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        picture.dashed(&[(left, y), (right, y)], look.dashes, look.color, 1.0);
        look.mark(picture, (left - 15.0, y), MARKER - 1.0);
        for &x in &track.crosses {
            cross(picture, (x, y), look.color);
        }
        if let Some(x) = track.edge {
            picture.line([(x, y - 8.0), (x, y + 8.0)], look.color, 2.2);
            let at = (x + Track::LABEL_GAP - 5.0, y + 4.5);
            picture.text(Text::new(track.label.clone(), at, Track::LABEL_SIZE).colored(look.ink()));
        }
    }
}

pub(super) fn cross(picture: &mut Picture, (x, y): Place, color: Color) {
    const ARM: f64 = 5.0;
    picture.line([(x - ARM, y - ARM), (x + ARM, y + ARM)], color, 2.2);
    picture.line([(x - ARM, y + ARM), (x + ARM, y - ARM)], color, 2.2);
}

fn medians(picture: &mut Picture, panel: &Panel, placer: &mut Placer, series: &Series, places: &[Place]) {
    for (point, &(x, y)) in series.good.iter().zip(places) {
        let end = panel.place(point.median_seconds, 1.0).0;
        if point.median_seconds > point.seconds && end > x {
            picture.line([(x, y), (end, y)], series.look().color, 1.2);
            picture.line([(end, y - 4.0), (end, y + 4.0)], series.look().color, 1.2);
            placer.take(Rect { left: x, top: y - 4.0, right: end + 1.0, bottom: y + 4.0 });
        }
    }
}

fn highlights(picture: &mut Picture, panel: &Panel, placer: &mut Placer) {
    if let Some(place) = panel.setting {
        draw_star(picture, place);
        placer.take(Rect::around(place, STAR));
    }
    if let Some(place) = panel.document {
        // Where both are the same, the circle goes around the star.
        let radius = if panel.setting == Some(place) { STAR + 4.0 } else { CIRCLE };
        draw_circle(picture, place, radius);
        placer.take(Rect::around(place, radius));
    }
}

pub(super) fn draw_star(picture: &mut Picture, place: Place) {
    picture.area(star(place, STAR + 3.0), BLACK, 1.0);
    picture.area(star(place, STAR), STAR_FILL, 1.0);
}

pub(super) fn draw_circle(picture: &mut Picture, (x, y): Place, radius: f64) {
    let mut ring: Vec<_> = regular(48, 0.0, radius).into_iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    ring.push(ring[0]);
    picture.line(ring, BLACK, 2.0);
}
