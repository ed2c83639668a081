//! `wriggle shot`: a scene at a time, drawn into a picture without a window.

use std::path::{Path, PathBuf};

use bevy::ecs::message::Messages;
use clap::Args;

use super::{CliError, Outcome, values};
use crate::{
    physics::{BodyFrozen, Clock, PhysicsPlugin, Ticks},
    scenes::{self, ScenesPlugin},
    view::{Quality, Shot},
};

#[derive(Args, Debug)]
pub(super) struct ShotArguments {
    /// A scene or creature by name or file
    scene: String,
    /// When, in simulated time; the nearest step is drawn [default: the moment at which the scene opens, or 0]
    #[arg(long, allow_negative_numbers = true, value_name = "T", value_parser = values::non_negative)]
    at: Option<f64>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    size: (u32, u32),
    /// How much to draw: low or high [default: high on a GPU]
    #[arg(long, value_parser = quality)]
    quality: Option<Quality>,
    /// Where to write the picture
    #[arg(long, value_name = "F.png")]
    out: PathBuf,
}

pub(super) fn shot(arguments: &ShotArguments) -> Result<Outcome, CliError> {
    check_out(&arguments.out)?;
    let scene = scenes::load(&arguments.scene)?;
    let clock = scene.file.clock;
    let steps = match arguments.at {
        Some(at) => {
            let (steps, time) = nearest_steps(at, clock.dt()).map_err(CliError::Usage)?;
            if time != at {
                eprintln!("--at {at}: drawn at {time}, the nearest end of a step of dt {}", clock.dt());
            }
            steps
        }
        None => clock.opening_steps(),
    };
    draw(scene, steps, arguments)
}

/// How many steps of `dt` end nearest to `time`, and when that is.
fn nearest_steps(time: f64, dt: f64) -> Result<(u64, f64), String> {
    let steps = (time / dt).round();
    if steps > values::MOST_STEPS {
        Err(values::too_many_steps("--at", time, dt))
    } else {
        Ok((steps as u64, values::time_of(steps, dt)))
    }
}

/// Draws `scene` after `steps`.
fn draw(scene: scenes::LoadedScene, steps: u64, arguments: &ShotArguments) -> Result<Outcome, CliError> {
    let mut shot = Shot::new(arguments.size, arguments.quality, |app| {
        app.add_plugins((PhysicsPlugin::new(Ticks), ScenesPlugin::new(scene)));
    })?;
    // The first frame opens the scene.
    shot.update();
    let world = shot.world_mut();
    let mut clock = world.resource_mut::<Clock>();
    clock.leap(0);
    clock.set_steps_per_tick(steps);
    world.run_schedule(Ticks);
    // The log has told of it.
    let has_frozen = !world.resource::<Messages<BodyFrozen>>().is_empty();
    shot.picture()?.save(&arguments.out)?;
    Ok(if has_frozen { Outcome::Frozen } else { Outcome::Done })
}

/// Finds out before a picture is drawn whether it can be written.
fn check_out(out: &Path) -> Result<(), CliError> {
    let place = out.display();
    if out.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("png")) {
        return Err(CliError::Usage(format!("--out {place}: give a file that ends in .png")));
    }
    match out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(CliError::Usage(format!("--out {place}: there is no folder {}", folder.display())))
        }
        _ => Ok(()),
    }
}

fn quality(text: &str) -> Result<Quality, String> {
    match text {
        "low" => Ok(Quality::Low),
        "high" => Ok(Quality::High),
        _ => Err("give low or high".into()),
    }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    const MOST: u32 = 8192;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MOST).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| side(width).zip(side(height)))
        .ok_or_else(|| format!("give WIDTHxHEIGHT, such as 1280x720, each from 1 to {MOST}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_step_is_the_one_that_ends_nearest() {
        assert_eq!(nearest_steps(300.0, 0.022), Ok((13_636, 299.992)));
        assert_eq!(nearest_steps(300.01, 0.022), Ok((13_637, 300.014)));
        assert_eq!(nearest_steps(0.9, 0.3), Ok((3, 0.9)));
        assert!(nearest_steps(1e300, 0.022).is_err_and(|text| text.contains("shorter time")));
    }
}
