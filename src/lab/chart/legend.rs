//! The legend beside the panels, and the words above and below them.

use super::{
    figure::{self, MARKER},
    plot::{Plot, Room},
    scale::short,
    shapes::{Picture, Place, Rect},
    text::{Anchor, Text, wrap},
};
use crate::{
    lab::{Unit, WorkPrecision},
    mechanics::integrators::Method,
    scenes::DOCUMENT_DT,
};

const CAPTION_SIZE: f64 = 13.0;
const CAPTION_LINE: f64 = 18.0;
pub(super) const MARGIN: f64 = 28.0;
/// Where the legend is.
pub(super) const LEFT: f64 = 1254.0;
/// How wide the sample of a line is.
pub(super) const SAMPLE: f64 = 44.0;

/// The room that is left for the panels by a caption of so many lines.
pub(super) fn room(caption: &[String]) -> Room {
    let (left, gap) = (108.0, 38.0);
    let width = (LEFT - 30.0 - left - gap) / 2.0;
    Room { lefts: [left, left + width + gap], width, top: 92.0, bottom: bottom(caption) }
}

/// Where frames end above a caption of so many lines.
pub(super) fn bottom(caption: &[String]) -> f64 {
    Picture::HEIGHT - MARGIN - CAPTION_LINE * caption.len() as f64 - 64.0
}

/// What stands below a chart, in lines.
pub(super) fn caption(chart: &WorkPrecision) -> Vec<String> {
    let good = || chart.points.iter().filter(|point| point.largest_error().is_some());
    let unknown = match good().filter(|point| !chart.is_known(point)).count() {
        0 => String::new(),
        count => format!(
            " {count} of {} errors are below a hundred times that, on grey: they are not known to a hundredth of themselves.",
            good().count()
        ),
    };
    lines(&[
        format!(
            "Friction acts in the stages of a method unless its name says “at end”. Arithmetic in f64. Real time, in which the app \
             shows these {} units of time: {} s.",
            short(chart.duration),
            short(chart.real_time)
        ),
        format!(
            "Reference: {}; the two differ by {}.{unknown}",
            chart.reference.trim_end_matches('.'),
            short(chart.reference_error)
        ),
        chart.machine.clone(),
    ])
}

/// Sentences as lines of a caption.
pub(super) fn lines(sentences: &[String]) -> Vec<String> {
    // An SVG may be shown in a wider font than the bundled one.
    let width = 0.87 * (Picture::WIDTH - 2.0 * MARGIN);
    let mut lines: Vec<_> = sentences.iter().flat_map(|text| wrap(text, CAPTION_SIZE, width)).collect();
    lines.truncate(6);
    lines
}

/// Draws the words around the panels.
pub(super) fn draw(picture: &mut Picture, chart: &WorkPrecision, plot: &Plot, caption: &[String]) {
    let subtitle = format!(
        "Every mark is a run of {} units of time with one step dt, written at it. Lower is nearer to the truth, further left is cheaper.",
        short(chart.duration)
    );
    around(picture, &format!("{}: what accuracy costs", chart.title), &subtitle, caption);
    legend(picture, chart, plot);
}

/// Draws a title, what is to be known to read a picture, and its caption.
pub(super) fn around(picture: &mut Picture, title: &str, subtitle: &str, caption: &[String]) {
    let title = wrap(title, 26.0, Picture::WIDTH - 2.0 * MARGIN);
    if let Some(line) = title.first() {
        picture.text(Text::new(line.clone(), (MARGIN, 42.0), 26.0).colored(figure::BLACK));
    }
    picture.text(Text::new(subtitle, (MARGIN, 70.0), 15.0));
    let below = Picture::HEIGHT - MARGIN - CAPTION_LINE * caption.len() as f64;
    for (i, line) in caption.iter().enumerate() {
        let y = below + CAPTION_LINE * (i as f64 + 0.8);
        picture.text(Text::new(line.clone(), (MARGIN, y), CAPTION_SIZE).colored(figure::GREY));
    }
}

fn legend(picture: &mut Picture, chart: &WorkPrecision, plot: &Plot) {
    let (top, bottom) = (plot.panels[0].strip.top, plot.panels[0].frame.bottom);
    let signs = signs(chart, plot);
    let rows = plot.series.len() + signs.len() + 2;
    let height = ((bottom - top) / rows as f64).min(25.0);
    let right = Picture::WIDTH - MARGIN;
    let size = (0.72 * height).clamp(12.0, 14.0);
    let mut y = top + 0.5 * height;
    let mut row = |picture: &mut Picture, text: &str, limit: &str, draw: &dyn Fn(&mut Picture, f64)| {
        draw(picture, y);
        picture.text(Text::new(text, (LEFT + SAMPLE + 10.0, y + 0.35 * size), size));
        if !limit.is_empty() {
            picture.text(Text::new(limit, (right, y + 0.35 * size), size).anchored(Anchor::End));
        }
        y += height;
    };
    row(picture, "method", "limit of dt", &|_, _| ());
    for series in &plot.series {
        let look = series.look();
        row(picture, &series.name(), &series.limit_text(), &|picture, y| {
            picture.dashed(&[(LEFT, y), (LEFT + SAMPLE, y)], look.dashes, look.color, 1.9);
            look.mark(picture, (LEFT + SAMPLE / 2.0, y), MARKER);
        });
    }
    row(picture, "", "", &|picture, y| picture.line([(LEFT, y), (right, y)], [0xc8; 3], 1.0));
    for (text, draw) in signs {
        row(picture, &text, "", &draw);
    }
}

type Sign = Box<dyn Fn(&mut Picture, f64)>;

/// What else is in the panels.
fn signs(chart: &WorkPrecision, plot: &Plot) -> Vec<(String, Sign)> {
    let middle = LEFT + SAMPLE / 2.0;
    let seconds = &plot.panels[1];
    let setting = |what: &str, method: Method, dt: f64, place: Option<Place>| match place {
        Some(_) => format!("{what}: {} {}", method.name(), short(dt)),
        None => format!("{what}: dt {} was not measured", short(dt)),
    };
    let own = setting("this scene", chart.setting.method, chart.setting.dt, seconds.setting);
    let document = setting("document", Method::SemiImplicitEuler, DOCUMENT_DT, seconds.document);
    let mut signs: Vec<(String, Sign)> =
        vec![(own, Box::new(move |picture, y| figure::draw_star(picture, (middle, y))))];
    if chart.unit == Unit::Length {
        let circle: Sign = Box::new(move |picture, y| figure::draw_circle(picture, (middle, y), figure::CIRCLE - 3.0));
        signs.push((document, circle));
    }
    let others: [(String, Sign); 4] = [
        (
            "blew up, at the cost of a whole run".into(),
            Box::new(move |picture, y| figure::cross(picture, (middle, y), figure::GREY)),
        ),
        (
            if chart.edges.iter().all(|edge| edge.predicted) {
                "largest stable step (linear)".into()
            } else {
                "largest stable step (≥: a bound)".into()
            },
            Box::new(move |picture, y| picture.line([(middle, y - 8.0), (middle, y + 8.0)], figure::GREY, 2.2)),
        ),
        (
            "slopes of order 1, 2 and 4".into(),
            Box::new(move |picture, y| {
                picture.dashed(&[(LEFT, y - 4.0), (LEFT + SAMPLE, y + 4.0)], &[9.0, 6.0], figure::GUIDE, 1.3);
            }),
        ),
        (
            format!("error budget: below {}", short(chart.budget)),
            Box::new(move |picture, y| {
                let band = Rect { left: LEFT, top: y - 6.0, right: LEFT + SAMPLE, bottom: y + 6.0 };
                picture.area(band.corners(), figure::BUDGET, 1.0);
            }),
        ),
    ];
    signs.extend(others);
    if chart.points.iter().any(|point| point.largest_error().is_some() && !chart.is_known(point)) {
        let grey: Sign = Box::new(move |picture, y| {
            let zone = Rect { left: LEFT, top: y - 6.0, right: LEFT + SAMPLE, bottom: y + 6.0 };
            picture.area(zone.corners(), figure::UNKNOWN, figure::UNKNOWN_ALPHA);
        });
        signs.push(("not known to a hundredth".into(), grey));
    }
    let real_time = chart.real_time;
    if seconds.real_time.is_some() {
        let line: Sign =
            Box::new(move |picture, y| picture.line([(middle, y - 8.0), (middle, y + 8.0)], figure::GREY, 2.2));
        signs.push((format!("real time: {} s", short(real_time)), line));
    } else if real_time.is_finite() && real_time > 0.0 {
        let [low, high] = seconds.x.logs();
        let log = libm::log10(real_time);
        let (factor, side) = if log > high { (log - high, "right") } else { (low - log, "left") };
        let text = format!("real time, {} s: {}× further {side}", short(real_time), short_factor(factor));
        signs.push((text, Box::new(|_, _| ())));
    }
    signs
}

/// A power of ten in two digits, as a plain number where that is readable.
fn short_factor(log: f64) -> String {
    let unit = libm::pow(10.0, log.floor() - 1.0);
    short(libm::rint(libm::pow(10.0, log) / unit) * unit)
}
