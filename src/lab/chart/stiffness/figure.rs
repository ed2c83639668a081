//! Draws the frame of a figure of stiffness and what is in it.

use super::{plot::StiffnessPlot, words};
use crate::lab::{
    StiffnessStudy,
    chart::{
        axes,
        figure::{BUDGET_EDGE, GUIDE, MARKER},
        labels::Placer,
        shapes::{Picture, Place, Rect},
    },
};

pub(super) fn draw(picture: &mut Picture, study: &StiffnessStudy, plot: &StiffnessPlot) {
    let frame = plot.frame;
    let mut placer = Placer::new(frame);
    axes::across(picture, frame, &plot.x, "stiffness of every spring, in that of the scene");
    let title = format!("seconds of the cheapest good run: shortest of {}", study.repeats);
    axes::upwards(picture, frame, &plot.y, Some(&title));
    if let Some(guide) = plot.guide {
        picture.dashed(&guide, &[9.0, 6.0], GUIDE, 1.3);
        placer.take_line(&guide);
    }
    if let Some(x) = plot.crossing {
        picture.line([(x, frame.top), (x, frame.bottom)], BUDGET_EDGE, 2.2);
        placer.take(Rect { left: x - 3.0, right: x + 3.0, ..frame });
    }
    axes::border(picture, frame);
    let all: Vec<Vec<Place>> = plot
        .series
        .iter()
        .map(|series| series.runs.iter().map(|(factor, run)| plot.place(*factor, run)).collect())
        .collect();
    for (series, places) in plot.series.iter().zip(&all) {
        picture.dashed(places, series.look().dashes, series.look().color, 1.9);
        placer.take_line(places);
        places.iter().for_each(|&place| placer.take(Rect::around(place, MARKER + 1.0)));
    }
    for (series, places) in plot.series.iter().zip(&all) {
        places.iter().for_each(|&place| series.look().mark(picture, place, MARKER));
    }
    words::inside(picture, study, plot, &all, &mut placer);
}
