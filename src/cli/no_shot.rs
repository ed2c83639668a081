//! `wriggle shot` in a build without the renderer.

use clap::Args;

use super::{CliError, Outcome};

#[derive(Args, Debug)]
pub(super) struct ShotArguments {
    /// Whatever the command takes where there is a renderer
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    _all: Vec<String>,
}

/// Says what is missing.
pub(super) fn shot(_: &ShotArguments) -> Result<Outcome, CliError> {
    Err(CliError::Usage(
        "this build has no window and no renderer (it was made without the feature `window`), so it draws no pictures; \
         build it without --no-default-features, or with --features window"
            .into(),
    ))
}
