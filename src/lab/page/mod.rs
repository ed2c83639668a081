//! One page with the charts of all scenes. It needs nothing but itself.

mod tables;

use core::fmt::Write;

use super::{
    StiffnessStudy, WorkPrecision,
    chart::{self, ChartError, short, stiffness},
    study_stem,
};

pub(super) const STYLE: &str = include_str!("style.css");
const READING: &str = include_str!("reading.html");

/// Writes the page of all `charts` as HTML, each with the study of stiffness of its scene if there is one, with their pictures inside and links to the
/// files `NAME.csv`, `NAME.json` and `NAME.png` beside it.
///
/// # Errors
/// If a chart cannot be drawn.
pub fn page(charts: &[WorkPrecision], studies: &[StiffnessStudy]) -> Result<String, ChartError> {
    let mut body = String::new();
    if charts.len() > 1 {
        let links =
            charts.iter().enumerate().map(|(i, chart)| format!("<a href=\"#scene-{i}\">{}</a>", escape(&chart.title)));
        let _ = writeln!(body, "<nav>{}</nav>", links.collect::<Vec<_>>().join(" "));
    }
    body.push_str(READING);
    if charts.is_empty() {
        body.push_str("<p>No scene has been measured yet.</p>\n");
    }
    for (i, chart) in charts.iter().enumerate() {
        section(&mut body, i, chart, studies.iter().find(|study| study.scene == chart.scene))?;
    }
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Wriggle: what accuracy costs</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<h1>What accuracy costs</h1>\n{body}</body>\n</html>\n"
    ))
}

fn section(
    body: &mut String,
    i: usize,
    chart: &WorkPrecision,
    study: Option<&StiffnessStudy>,
) -> Result<(), ChartError> {
    let title = escape(&chart.title);
    let picture = chart::svg(chart)?;
    let alternative = format!("Error over cost of every method in the scene {title}");
    // Writing to a string cannot fail.
    let _ = writeln!(body, "<section id=\"scene-{i}\">\n<h2>{title}</h2>");
    let _ = writeln!(
        body,
        "<figure role=\"img\" aria-label=\"{alternative}\">\n{picture}<figcaption>{}</figcaption></figure>",
        caption(chart)
    );
    tables::cheapest(body, chart);
    tables::all(body, chart);
    links(body, &chart.scene);
    if let Some(study) = study {
        let picture = stiffness::svg(study)?;
        let alternative = format!("Cost of being good enough over the stiffness of springs in the scene {title}");
        let _ = writeln!(
            body,
            "<h3>What stiffness costs</h3>\n<figure role=\"img\" aria-label=\"{alternative}\">\n{picture}\
             <figcaption>{}</figcaption></figure>",
            escape(&stiffness::verdict(study))
        );
        tables::stiffness(body, study);
        links(body, &study_stem(&study.scene));
    }
    body.push_str("</section>\n");
    Ok(())
}

/// Links to the files of a chart.
fn links(body: &mut String, stem: &str) {
    let file = percent(stem);
    let link = |(suffix, what): (&str, &str)| format!("<a href=\"{file}.{suffix}\">{what}</a>");
    let all = [("csv", "points as CSV"), ("json", "everything as JSON"), ("png", "picture as PNG"), ("svg", "as SVG")];
    // Writing to a string cannot fail.
    let _ = writeln!(body, "<p class=\"files\">{}</p>", all.map(link).join(" · "));
}

fn caption(chart: &WorkPrecision) -> String {
    format!(
        "{} units of time, shown by the app in {} s. Error budget: {}. Reference: {}; the two differ by {}. {}. Arithmetic in f64.",
        short(chart.duration),
        short(chart.real_time),
        short(chart.budget),
        escape(chart.reference.trim_end_matches('.')),
        short(chart.reference_error),
        escape(chart.machine.trim_end_matches('.')),
    )
}

/// Text as it may stand in an element or in an attribute.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// The name of a file beside the page as it may stand in a link.
fn percent(name: &str) -> String {
    let mut link = String::from("./");
    for &byte in name.as_bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte) {
            link.push(char::from(byte));
        } else {
            let _ = write!(link, "%{byte:02X}");
        }
    }
    link
}
