//! The tables of the page.

use core::fmt::Write;

use super::escape;
use crate::lab::{
    Errors, Point, StiffnessStudy, Unit, WorkPrecision,
    chart::{Series, error, short},
    studied_methods,
};

/// What each method needs to be good enough.
pub(super) fn cheapest(body: &mut String, chart: &WorkPrecision) {
    let _ = writeln!(
        body,
        "<table>\n<caption>The fewest force evaluations within the error budget of {}</caption>\n\
         <thead><tr><th>Method</th><th>Largest stable dt</th><th>dt</th><th>Force evaluations</th><th>Seconds</th>\
         <th>Error</th></tr></thead>\n<tbody>",
        short(chart.budget)
    );
    for series in Series::all(chart) {
        let within = series.good.iter().filter(|point| error(point).is_some_and(|error| error <= chart.budget));
        let row = match within.min_by_key(|point| point.evaluations) {
            Some(point) => [
                short(point.setting.dt),
                point.evaluations.to_string(),
                exact(point.seconds),
                error(point).map(|error| exact(error) + mark(chart, point)).unwrap_or_default(),
            ]
            .map(|cell| format!("<td>{cell}</td>"))
            .concat(),
            None => "<td colspan=\"4\" class=\"none\">not at any step that was tried</td>".into(),
        };
        let (name, limit) = (escape(&series.name()), series.limit_text());
        let _ = writeln!(body, "<tr><th>{name}</th><td>{limit}</td>{row}</tr>");
    }
    body.push_str("</tbody>\n</table>\n");
}

/// Seconds of the cheapest good run of every method at every stiffness.
pub(super) fn stiffness(body: &mut String, study: &StiffnessStudy) {
    let cells = |cell: &dyn Fn(usize) -> String| (0..study.scenes.len()).map(cell).collect::<String>();
    let head = cells(&|i| format!("<th>{}</th>", short(study.scenes[i].factor)));
    let _ = writeln!(
        body,
        "<details>\n<summary>Seconds of the cheapest run that is good enough, and its dt</summary>\n<table>\n<thead><tr>\
         <th>Stiffness of every spring, in that of the scene</th>{head}</tr></thead>\n<tbody>"
    );
    for method in studied_methods() {
        let row = cells(&|i| match study.scenes[i].run(method) {
            Some(run) => format!("<td>{}<br>dt {}</td>", exact(run.seconds), short(run.setting.dt)),
            None => "<td>–</td>".into(),
        });
        let _ = writeln!(body, "<tr><th>{}</th>{row}</tr>", escape(method.name()));
    }
    let ways = cells(&|i| format!("<td>{}</td>", short(study.scenes[i].way)));
    let _ = writeln!(body, "<tr><th>way of the centre of mass</th>{ways}</tr>\n</tbody>\n</table>\n</details>");
}

/// Every run.
pub(super) fn all(body: &mut String, chart: &WorkPrecision) {
    let columns = columns(chart);
    let heads: String = columns.iter().map(|(head, _)| format!("<th>{head}</th>")).collect();
    let _ = writeln!(
        body,
        "<details>\n<summary>All {} runs</summary>\n<table>\n<thead><tr><th>Method</th><th>Friction</th><th>dt</th>\
         <th>Steps</th><th>Force evaluations</th><th>Timed runs</th><th>Seconds, shortest</th><th>Seconds, median</th>{heads}</tr></thead>\n<tbody>",
        chart.points.len()
    );
    for point in &chart.points {
        let Point { setting, steps, evaluations, runs, seconds, median_seconds, errors } = point;
        let stick = setting.stick.words();
        let errors = match errors {
            Some(errors) => {
                let cell = |(i, (_, of)): (usize, &Column)| {
                    let mark = if i == 0 { mark(chart, point) } else { "" };
                    format!("<td>{}{mark}</td>", of(errors).map(exact).unwrap_or_default())
                };
                columns.iter().enumerate().map(cell).collect()
            }
            None => format!("<td colspan=\"{}\" class=\"none\">blew up</td>", columns.len()),
        };
        let _ = writeln!(
            body,
            "<tr><th>{}</th><td>{stick}</td><td>{}</td><td>{steps}</td><td>{evaluations}</td><td>{runs}</td><td>{}</td><td>{}</td>{errors}</tr>",
            escape(setting.method.name()),
            setting.dt,
            exact(*seconds),
            exact(*median_seconds),
        );
    }
    body.push_str("</tbody>\n</table>\n</details>\n");
    if chart.points.iter().any(|point| !mark(chart, point).is_empty()) {
        let (least, sure) = (short(chart.least_known_error()), short(chart.reference_error));
        let _ = writeln!(
            body,
            "<p>† Below {least}, a hundred times the {sure} by which the reference differs from what confirms it: not known to a hundredth of itself.</p>"
        );
    }
}

/// A kind of error: what it is called, and its value.
type Column = (&'static str, fn(&Errors) -> Option<f64>);

/// The kinds of errors that a chart has.
fn columns(chart: &WorkPrecision) -> Vec<Column> {
    let [largest, rms, distance] = match chart.unit {
        Unit::Length => ["Largest error, lengths", "RMS error, body lengths", "Error of distance, lengths"],
        Unit::PartOfSpeed => ["Largest error of speed, part", "RMS over bodies, part", "Error of distance, lengths"],
        Unit::PartOfCell => ["Largest error, part of a cell", "RMS error, part of a cell", "Error of height, spacings"],
    };
    let all: [Column; 6] = [
        (largest, |errors| Some(errors.largest)),
        (rms, |errors| Some(errors.rms)),
        (distance, |errors| Some(errors.distance)),
        ("Error of the way in a cycle, lengths", |errors| errors.cycle),
        ("Error of energy, part", |errors| errors.energy),
        ("Deepest below ground, lengths", |errors| errors.penetration),
    ];
    let is_known = |(_, of): &Column| chart.points.iter().filter_map(|point| of(&point.errors?)).next().is_some();
    all.into_iter().enumerate().filter(|(i, column)| *i < 3 || is_known(column)).map(|(_, column)| column).collect()
}

/// What stands at an error that the reference is not sure enough of.
fn mark(chart: &WorkPrecision, point: &Point) -> &'static str {
    if point.largest_error().is_some() && !chart.is_known(point) { " †" } else { "" }
}

/// A measured number in four digits.
fn exact(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.3e}") }
}
