//! The points of a chart as a table for other programs.

use core::fmt::Write;

use super::{Errors, Point, WorkPrecision};

/// The names of the columns of [`csv`].
pub const COLUMNS: [&str; 17] = [
    "scene",
    "method",
    "stick",
    "dt",
    "steps",
    "evaluations",
    "runs",
    "seconds",
    "median_seconds",
    "largest_error",
    "rms_error",
    "distance_error",
    "cycle_error",
    "energy_error",
    "penetration",
    "known",
    "blew_up",
];

/// Writes every point of a chart as CSV (RFC 4180), with as many digits as it takes to read back the same bits. The errors of what blew
/// up are left empty, as are those that a scene has not. `known` is false where the largest error is below a hundred times what the reference is sure to.
pub fn csv(chart: &WorkPrecision) -> String {
    let mut table = COLUMNS.join(",");
    table.push_str("\r\n");
    let scene = quoted(&chart.scene);
    for point in &chart.points {
        let Point { setting, steps, evaluations, runs, seconds, median_seconds, errors } = point;
        let errors = match errors {
            Some(Errors { largest, rms, distance, cycle, energy, penetration }) => {
                let [cycle, energy, penetration] = [cycle, energy, penetration].map(optional);
                let known = chart.is_known(point);
                format!("{largest:?},{rms:?},{distance:?},{cycle},{energy},{penetration},{known},false")
            }
            None => ",,,,,,,true".into(),
        };
        let (method, stick, dt) = (setting.method.name(), setting.stick, setting.dt);
        // Writing to a string cannot fail.
        let _ = write!(
            table,
            "{scene},{method},{stick:?},{dt:?},{steps},{evaluations},{runs},{seconds:?},{median_seconds:?},{errors}\r\n"
        );
    }
    table
}

fn optional(value: &Option<f64>) -> String {
    value.map(|value| format!("{value:?}")).unwrap_or_default()
}

/// A cell, in quotes where it would be taken for more than one.
pub(super) fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\r', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.into() }
}
