//! The answers as a page and as text.

use core::fmt::Write;

use super::{Answer, Exercise, Table};
use crate::lab::{
    chart::{ChartError, curves},
    page::{STYLE, escape},
};

const TITLE: &str = "Mass-Spring-Damper model";

/// Writes the answers as one page of HTML that needs nothing but itself.
///
/// # Errors
/// If a figure cannot be drawn.
pub fn html(exercise: &Exercise) -> Result<String, ChartError> {
    let mut body = String::new();
    for answer in &exercise.answers {
        section(&mut body, answer)?;
    }
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Wriggle: {TITLE}</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<h1>{TITLE}</h1>\n<p>Every number was measured for this page, on {}.</p>\n{body}</body>\n</html>\n",
        escape(&exercise.machine)
    ))
}

fn section(body: &mut String, answer: &Answer) -> Result<(), ChartError> {
    // Writing to a string cannot fail.
    let _ = writeln!(body, "<section>\n<h2>{}</h2>", escape(answer.question));
    for paragraph in &answer.paragraphs {
        let _ = writeln!(body, "<p class=\"reading\">{}</p>", escape(paragraph));
    }
    for Table { caption, head, rows } in &answer.tables {
        let cells = |tag: &str, cells: &mut dyn Iterator<Item = &str>| {
            cells.map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect::<String>()
        };
        let _ = writeln!(
            body,
            "<table>\n<caption>{}</caption>\n<thead><tr>{}</tr></thead>\n<tbody>",
            escape(caption),
            cells("th", &mut head.iter().copied())
        );
        for row in rows {
            let _ = writeln!(body, "<tr>{}</tr>", cells("td", &mut row.iter().map(String::as_str)));
        }
        body.push_str("</tbody>\n</table>\n");
    }
    for figure in &answer.figures {
        let picture = curves::svg(figure)?;
        let _ = writeln!(body, "<figure role=\"img\" aria-label=\"{}\">\n{picture}</figure>", escape(&figure.title));
    }
    body.push_str("</section>\n");
    Ok(())
}

/// Writes the answers as text.
pub fn text(exercise: &Exercise) -> String {
    let mut out = format!("{TITLE}\nmeasured on {}\n", exercise.machine);
    for answer in &exercise.answers {
        let _ = write!(out, "\n{}\n", answer.question);
        for paragraph in &answer.paragraphs {
            let _ = write!(out, "\n{}\n", wrapped(paragraph));
        }
        for table in &answer.tables {
            let _ = write!(out, "\n{}\n", wrapped(&table.caption));
            columns(&mut out, table);
        }
    }
    out
}

/// Breaks a text into lines of at most a hundred letters.
fn wrapped(text: &str) -> String {
    let (mut lines, mut length) = (String::new(), 0);
    for word in text.split_whitespace() {
        let letters = word.chars().count();
        if length > 0 && length + 1 + letters > 100 {
            lines.push('\n');
            length = 0;
        } else if length > 0 {
            lines.push(' ');
            length += 1;
        }
        lines.push_str(word);
        length += letters;
    }
    lines
}

fn columns(out: &mut String, table: &Table) {
    let cell = |row: &[String], i: usize| row.get(i).cloned().unwrap_or_default();
    let head: Vec<String> = table.head.iter().map(|&head| head.to_owned()).collect();
    let rows = || core::iter::once(&head).chain(&table.rows);
    let widths: Vec<_> =
        (0..head.len()).map(|i| rows().map(|row| cell(row, i).chars().count()).max().unwrap_or_default()).collect();
    for row in rows() {
        let line: String = widths.iter().enumerate().map(|(i, &width)| format!("  {:<width$}", cell(row, i))).collect();
        let _ = writeln!(out, "{}", line.trim_end());
    }
}
