//! A study of stiffness as a table for other programs.

use core::fmt::Write;

use crate::lab::table::quoted;

use super::StiffnessStudy;

/// The names of the columns of [`stiffness_csv`].
pub const STIFFNESS_COLUMNS: [&str; 9] =
    ["scene", "factor", "method", "dt", "steps", "evaluations", "seconds", "median_seconds", "largest_error"];

/// Writes the cheapest good run of every method at every factor as CSV (RFC 4180), with as many digits as it takes to read back the same bits. Where
/// no run is good enough, its cells are left empty.
pub fn stiffness_csv(study: &StiffnessStudy) -> String {
    let mut table = STIFFNESS_COLUMNS.join(",");
    table.push_str("\r\n");
    let name = quoted(&study.scene);
    for scene in &study.scenes {
        for run in &scene.runs {
            let cells = match run.run {
                Some(point) => format!(
                    "{:?},{},{},{:?},{:?},{}",
                    point.setting.dt,
                    point.steps,
                    point.evaluations,
                    point.seconds,
                    point.median_seconds,
                    point.errors.map(|errors| format!("{:?}", errors.largest)).unwrap_or_default()
                ),
                None => ",,,,,".into(),
            };
            // Writing to a string cannot fail.
            let _ = write!(table, "{name},{:?},{},{cells}\r\n", scene.factor, run.method.name());
        }
    }
    table
}
