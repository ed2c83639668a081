//! Whether what a scene gives is for the creatures that it has: creatures with springs know no road, those of the six-matrix particle system no ground,
//! gravity or method. What would do nothing is refused, so that nobody waits for it to do something.

use super::{FileError, LoadedScene, load::scene_conflict};
use crate::{creatures::FARTHEST, physics::Clock};

/// Finds the first thing that does nothing.
pub(super) fn check(scene: &LoadedScene) -> Result<(), FileError> {
    check_moment(scene)?;
    check_places(scene)?;
    let six: Vec<_> = scene.creatures.iter().map(|(_, creature)| creature.body.composed().is_some()).collect();
    for (i, (placement, six)) in scene.file.creatures.iter().zip(&six).enumerate() {
        let name = &placement.name;
        let wrong =
            |field: &str, problem: String| Err(scene_conflict(scene, format!("creatures[{i}].{field}"), problem));
        if !six && placement.road.is_some() {
            return wrong(
                "road",
                format!("`{name}` has springs, which know no road; leave it out, or give the scene a ground"),
            );
        }
        if !six && placement.on_road.is_some() {
            return wrong("on_road", format!("`{name}` has springs, which know no road; give `at` instead"));
        }
        match (placement.on_road, scene.road_of(placement)) {
            (Some(_), None) => {
                return wrong("on_road", format!("`{name}` has no road to stand on; give road: \"NAME\""));
            }
            (Some(place), Some((form, _))) if !(0.0..=form.rows() as f64).contains(&place.row) => {
                let (row, rows) = (place.row, form.rows());
                return wrong("on_road", format!("the road of `{name}` has no row {row}; give one from 0 to {rows}"));
            }
            _ => {}
        }
        if *six && placement.method.is_some() {
            return wrong(
                "method",
                format!("`{name}` moves by the six-matrix particle system, which is one method; leave it out"),
            );
        }
    }
    check_common(scene, &six)
}

/// Creatures must stand where numbers still tell the lengths of their springs.
fn check_places(scene: &LoadedScene) -> Result<(), FileError> {
    for (i, placement) in scene.file.creatures.iter().enumerate() {
        let (x, y, z) = placement.at;
        if let Some(far) = [x, y, z].into_iter().find(|coordinate| coordinate.abs() > FARTHEST) {
            let problem = format!(
                "{far:e} is too far away for the springs of `{}`; give {FARTHEST:e} at the most",
                placement.name
            );
            return Err(scene_conflict(scene, format!("creatures[{i}].at"), problem));
        }
    }
    Ok(())
}

/// What the scene gives to all of its creatures must be for one of them at least.
fn check_common(scene: &LoadedScene, six: &[bool]) -> Result<(), FileError> {
    let file = &scene.file;
    let wrong = |field: &str, problem: &str| Err(scene_conflict(scene, field.into(), problem.into()));
    if file.road.is_some() {
        if !six.contains(&true) {
            return wrong(
                "road",
                "all creatures of this scene have springs, which know no road; leave it out, or give a ground",
            );
        }
        let takes_it = |(placement, six): (&super::Placement, &bool)| *six && placement.road.is_none();
        if !file.creatures.iter().zip(six).any(takes_it) {
            return wrong(
                "road",
                "no creature takes it, as each has a road of its own; leave it out, or leave out one of theirs",
            );
        }
    }
    if six.is_empty() || six.contains(&false) {
        return Ok(());
    }
    let all = "all creatures of this scene move by the six-matrix particle system";
    if file.ground.is_some() {
        return wrong("ground", &format!("{all}, which knows no ground; leave it out, or give a road"));
    }
    if file.gravity != 0.0 {
        return wrong("gravity", &format!("{all}, where weight is a rule of a creature; leave it out"));
    }
    if file.method != Default::default() {
        return wrong("method", &format!("{all}, which is one method; leave it out"));
    }
    if file.stick != Default::default() {
        return wrong("stick", &format!("{all}, which has no such friction; leave it out"));
    }
    Ok(())
}

/// The moment at which a scene opens is one that a tick can take it to.
fn check_moment(scene: &LoadedScene) -> Result<(), FileError> {
    let Some(moment) = scene.file.clock.opens_at else { return Ok(()) };
    let (dt, most) = (scene.file.clock.dt(), Clock::MOST_STEPS_A_TICK);
    if (moment / dt).round() <= most as f64 {
        return Ok(());
    }
    let problem = format!("{moment} is more than {most} steps of {dt} away; give {} or less", dt * most as f64);
    Err(scene_conflict(scene, "clock.opens_at".into(), problem))
}
