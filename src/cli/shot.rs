//! `wriggle shot`: a scene at a time, drawn into a picture without a window.

use std::path::PathBuf;

use clap::Args;

use super::{CliError, Outcome, values};
use crate::scenes;

#[derive(Args, Debug)]
pub(super) struct ShotArguments {
    /// A scene or creature by name or file
    scene: String,
    /// When, in simulated time; a whole number of dt
    #[arg(long, value_name = "T", default_value = "0", value_parser = values::non_negative)]
    at: f64,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    size: (u32, u32),
    /// Where to write the picture
    #[arg(long, value_name = "F.png")]
    out: PathBuf,
}

pub(super) fn shot(arguments: &ShotArguments) -> Result<Outcome, CliError> {
    let scene = scenes::load(&arguments.scene)?;
    let steps = values::steps_of_flag("--at", arguments.at, scene.file.clock.dt()).map_err(CliError::Usage)?;
    draw(scene, steps, arguments.size, &arguments.out)
}

/// Draws `scene` after `steps`.
fn draw(scene: scenes::LoadedScene, steps: u64, size: (u32, u32), out: &std::path::Path) -> Result<Outcome, CliError> {
    let _ = (scene, steps, size);
    Err(CliError::Usage(format!("{}: this build draws no pictures", out.display())))
}

fn size(text: &str) -> Result<(u32, u32), String> {
    const MOST: u32 = 8192;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MOST).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| side(width).zip(side(height)))
        .ok_or_else(|| format!("give WIDTHxHEIGHT, such as 1280x720, each from 1 to {MOST}"))
}
