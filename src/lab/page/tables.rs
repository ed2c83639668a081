//! The tables of the page.

use core::fmt::Write;

use super::escape;
use crate::{
    lab::{
        Point, StiffnessStudy, WorkPrecision,
        chart::{Series, error, short},
        studied_methods,
    },
    mechanics::integrators::StickRule,
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
                error(point).map(exact).unwrap_or_default(),
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
    let _ = writeln!(
        body,
        "<details>\n<summary>All {} runs</summary>\n<table>\n<thead><tr><th>Method</th><th>Friction</th><th>dt</th>\
         <th>Steps</th><th>Force evaluations</th><th>Seconds, shortest</th><th>Seconds, median</th><th>Largest error</th>\
         <th>RMS error</th><th>Error of distance</th></tr></thead>\n<tbody>",
        chart.points.len()
    );
    for point in &chart.points {
        let Point { setting, steps, evaluations, seconds, median_seconds, errors } = point;
        let stick = match setting.stick {
            StickRule::InStages => "in stages",
            StickRule::EndOfStep => "at end",
            StickRule::Located => "located",
        };
        let errors = match errors {
            Some(errors) => {
                [errors.largest, errors.rms, errors.distance].map(|error| format!("<td>{}</td>", exact(error))).concat()
            }
            None => "<td colspan=\"3\" class=\"none\">blew up</td>".into(),
        };
        let _ = writeln!(
            body,
            "<tr><th>{}</th><td>{stick}</td><td>{}</td><td>{steps}</td><td>{evaluations}</td><td>{}</td><td>{}</td>{errors}</tr>",
            escape(setting.method.name()),
            setting.dt,
            exact(*seconds),
            exact(*median_seconds),
        );
    }
    body.push_str("</tbody>\n</table>\n</details>\n");
}

/// A measured number in four digits.
fn exact(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.3e}") }
}
