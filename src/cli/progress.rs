//! How far a long command is.

use std::io::{self, IsTerminal};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar with the given template, shown on a terminal only; its length may become known later.
pub(super) fn progress(template: &str, length: Option<u64>) -> ProgressBar {
    if !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr()).with_style(style)
}

/// A bar for a number of runs that becomes known later, after a name.
pub(super) fn progress_of(name: &str, what: &str) -> ProgressBar {
    progress(&format!("{{prefix}}  {{wide_bar}} {{pos}}/{{len}} {what}  {{msg}}"), None).with_prefix(name.to_owned())
}
