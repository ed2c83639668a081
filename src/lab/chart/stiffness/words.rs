//! What is written in a figure of stiffness and around it.

use super::plot::StiffnessPlot;
use crate::{
    lab::{
        Crossing, StiffnessStudy,
        chart::{
            figure::{BUDGET_EDGE, GREY, GUIDE, MARKER, SMALL},
            labels::{Placer, around},
            legend::{self, LEFT, MARGIN, SAMPLE},
            scale::short,
            shapes::{Picture, Place},
            text::{Anchor, Text},
            words::write,
        },
        crossing, crossing_of,
    },
    mechanics::integrators::Method,
};

/// From which stiffness on implicit methods win, in a sentence.
pub fn verdict(study: &StiffnessStudy) -> String {
    let names = |methods: &[Method]| methods.iter().map(|method| method.name()).collect::<Vec<_>>().join(", then ");
    let verdict = match crossing(study) {
        Crossing::Always(methods) => {
            format!("At every stiffness that was tried an implicit method is the cheapest: {}.", names(&methods))
        }
        Crossing::From(factor, methods) => {
            format!(
                "From {} times the stiffness on an implicit method is the cheapest: {}.",
                near(factor),
                names(&methods)
            )
        }
        Crossing::Never => match study.scenes.last().and_then(|last| Some((last, last.cheapest(|_| true)?))) {
            Some((last, (method, _))) => format!(
                "Up to {} times the stiffness no implicit method wins: the cheapest there is {}.",
                short(last.factor),
                method.name()
            ),
            None => "No method is good enough at any step that was tried.".into(),
        },
    };
    let each = Method::ALL.into_iter().filter(|method| method.is_implicit());
    let each: Vec<_> = each
        .filter_map(|method| match crossing_of(study, method) {
            Crossing::Always(_) => Some(format!("{} everywhere", method.name())),
            Crossing::From(factor, _) => Some(format!("{} from {}", method.name(), near(factor))),
            Crossing::Never => None,
        })
        .collect();
    match each.len() {
        0 | 1 => verdict,
        _ => format!("{verdict} Cheaper than every explicit method are: {}.", each.join(", ")),
    }
}

/// A factor in two digits: two factors that were tried are too far apart for more.
fn near(factor: f64) -> String {
    format!("{factor:.1e}").parse().map_or_else(|_| short(factor), short)
}

/// What stands below the figure, in lines.
pub(super) fn caption(study: &StiffnessStudy) -> Vec<String> {
    // The first, the last and what is near the middle: enough to see whether the motion has come to its limit.
    let count = study.scenes.len();
    let mut shown = vec![0, count / 2, count.saturating_sub(1)];
    shown.dedup();
    let ways = shown.into_iter().filter_map(|i| study.scenes.get(i));
    let ways: Vec<_> = ways.map(|scene| format!("{} at {}", short(scene.way), short(scene.factor))).collect();
    let apart = study.scenes.iter().map(|scene| scene.reference_error).fold(0.0, f64::max);
    let ended = study.ended.as_ref().map_or_else(String::new, |why| format!(" It ends here: {why}."));
    legend::lines(&[
        verdict(study),
        format!(
            "Good enough: nowhere further from the reference than {} at dt, 0.9 dt and 0.8 dt, with dt at most half of the stability limit. Every damping \
             is multiplied by the root of the factor, so that springs keep their damping ratios. The exact flow, which has no step to choose, is left out. The centre of mass goes so many lengths: {}.",
            short(study.budget),
            ways.join(", ")
        ),
        format!(
            "Reference: {}; the two differ by {} at most.{ended}",
            study.reference.trim_end_matches('.'),
            short(apart)
        ),
        study.machine.clone(),
    ])
}

/// Writes what lines mean, then dt at the first and the last run of each series, and at as many between as have room.
pub(super) fn inside(
    picture: &mut Picture,
    study: &StiffnessStudy,
    plot: &StiffnessPlot,
    places: &[Vec<Place>],
    placer: &mut Placer,
) {
    let frame = plot.frame;
    if let (Some(x), Crossing::From(factor, methods)) = (plot.crossing, crossing(study)) {
        let name = methods.first().map_or("", |method| method.name());
        let text = format!("from {} on {name} is the cheapest", near(factor));
        let sides = [(x + 8.0, Anchor::Start), (x - 8.0, Anchor::End)];
        let rows = (1..40).map(|i| frame.top + 18.0 * f64::from(i));
        let candidates = rows.flat_map(|y| {
            sides.map(|(x, anchor)| Text::new(text.clone(), (x, y), 15.0).anchored(anchor).colored(BUDGET_EDGE))
        });
        write(picture, placer.place(candidates, true));
    }
    if let Some([from, to]) = plot.guide {
        let along = |part: f64| (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
        let candidates = (1..20).flat_map(|i| {
            let (x, y) = along(1.0 - 0.04 * f64::from(i));
            let text = Text::new("cost as the root of stiffness", (x + 8.0, y + 15.0), SMALL).colored(GREY);
            [text.clone(), Text { at: (x - 8.0, y - 6.0), ..text }.anchored(Anchor::End)]
        });
        write(picture, placer.place(candidates, false));
    }
    let mut label = |series: usize, i: usize, over_lines| {
        let series_at = &plot.series[series];
        let text = Text::new(short(series_at.runs[i].1.setting.dt), (0.0, 0.0), SMALL);
        let text = text.colored(series_at.look().ink());
        write(picture, placer.place(around(&text, places[series][i], MARKER), over_lines));
    };
    let filled = || places.iter().enumerate().filter(|(_, places)| !places.is_empty());
    for (series, places) in filled() {
        label(series, 0, true);
        if places.len() > 1 {
            label(series, places.len() - 1, true);
        }
    }
    for (series, places) in filled() {
        (1..places.len().saturating_sub(1)).for_each(|i| label(series, i, false));
    }
}

/// Writes title, caption and legend.
pub(super) fn draw(picture: &mut Picture, study: &StiffnessStudy, plot: &StiffnessPlot) {
    let subtitle = format!(
        "Every mark is the cheapest run of {} units of time that is good enough, with its step dt written at it. Lower is cheaper.",
        short(study.duration)
    );
    let title = format!("{}: what stiffness costs", study.title);
    legend::around(picture, &title, &subtitle, &caption(study));
    const ROW: f64 = 25.0;
    const SIZE: f64 = 14.0;
    let right = Picture::WIDTH - MARGIN;
    let mut y = plot.frame.top + 0.5 * ROW;
    let mut row = |picture: &mut Picture, text: &str, at_end: &str| {
        let here = y;
        let baseline = here + 0.35 * SIZE;
        picture.text(Text::new(text, (LEFT + SAMPLE + 10.0, baseline), SIZE));
        picture.text(Text::new(at_end, (right, baseline), SIZE).anchored(Anchor::End));
        y += ROW;
        here
    };
    row(picture, "method", "good enough");
    for series in &plot.series {
        let y = row(picture, series.method.name(), &series.where_good);
        let look = series.look();
        picture.dashed(&[(LEFT, y), (LEFT + SAMPLE, y)], look.dashes, look.color, 1.9);
        look.mark(picture, (LEFT + SAMPLE / 2.0, y), MARKER);
    }
    let y = row(picture, "cost as the root of stiffness", "");
    picture.dashed(&[(LEFT, y + 4.0), (LEFT + SAMPLE, y - 4.0)], &[9.0, 6.0], GUIDE, 1.3);
    if plot.crossing.is_some() {
        let y = row(picture, "implicit methods win from here on", "");
        let middle = LEFT + SAMPLE / 2.0;
        picture.line([(middle, y - 8.0), (middle, y + 8.0)], BUDGET_EDGE, 2.2);
    }
}
