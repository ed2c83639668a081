//! The points of a chart as a table for other programs.

use core::fmt::Write;

use super::{Point, WorkPrecision};

/// The names of the columns of [`csv`].
pub const COLUMNS: [&str; 12] = [
    "scene",
    "method",
    "stick",
    "dt",
    "steps",
    "evaluations",
    "seconds",
    "median_seconds",
    "largest_error",
    "rms_error",
    "distance_error",
    "blew_up",
];

/// Writes every point of a chart as CSV (RFC 4180), with as many digits as it takes to read back the same bits. The errors of what blew
/// up are left empty.
pub fn csv(chart: &WorkPrecision) -> String {
    let mut table = COLUMNS.join(",");
    table.push_str("\r\n");
    let scene = quoted(&chart.scene);
    for point in &chart.points {
        let Point { setting, steps, evaluations, seconds, median_seconds, errors } = point;
        let errors = match errors {
            Some(errors) => format!("{:?},{:?},{:?},false", errors.largest, errors.rms, errors.distance),
            None => ",,,true".into(),
        };
        let (method, stick, dt) = (setting.method.name(), setting.stick, setting.dt);
        // Writing to a string cannot fail.
        let _ = write!(
            table,
            "{scene},{method},{stick:?},{dt:?},{steps},{evaluations},{seconds:?},{median_seconds:?},{errors}\r\n"
        );
    }
    table
}

/// A cell, in quotes where it would be taken for more than one.
pub(super) fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\r', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.into() }
}
