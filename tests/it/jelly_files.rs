//! What a file of a jelly may not say.

use std::fs;

use wriggle::{
    body::Neighbours,
    creatures::{JellyPlan, Rotation},
    scenes,
};

/// What is said about a jelly with these fields, and more of the creature behind it.
fn error(body: &str, more: &str) -> String {
    let folder = tempfile::TempDir::new().unwrap();
    let file = folder.path().join("bad.creature.ron");
    fs::write(&file, format!("Creature(version: 1,\n  body: Jelly({body}){more})")).unwrap();
    match scenes::load(file.to_str().unwrap()) {
        Ok(_) => panic!("Jelly({body}){more} is read"),
        Err(error) => error.to_string(),
    }
}

fn says(error: &str, all: &[&str]) {
    assert!(all.iter().all(|what| error.contains(what)), "{error}");
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    for size in ["(0, 3, 3)", "(3, 0, 3)"] {
        says(&error(&format!("size: {size}"), ""), &[".ron:2:", "size", size, "1 or more"]);
    }
    says(&error("size: (3, 3, -2)", ""), &["size", "(3, 3, -2)", "whole numbers from 1"]);
    says(&error("size: (3, 3)", ""), &["size"]);
    says(&error("size: (2.5, 5, 5)", ""), &[".ron:2:", "size", "(2.5, 5, 5)", "whole numbers from 1"]);
    says(&error("size: (5, 5, inf)", ""), &["size", "(5, 5, inf)", "whole numbers from 1"]);
    // Before anything is allocated, with what it would take.
    let bytes = JellyPlan::BYTES_A_PARTICLE * 2_000_000_000;
    says(
        &error("size: (2000, 1000, 1000)", ""),
        &["2000000000 particles", &format!("{bytes} bytes ("), " GB)", "at most 4000000 particles"],
    );
    says(&error("size: (4294967295, 4294967295, 4294967295)", ""), &["bytes", "at most 4000000 particles"]);
}

#[test]
fn neighbours_that_do_not_exist_are_refused() {
    let spring = "(stiffness: 1)";
    says(&error(&format!("size: (3, 3, 3), neighbours: (corners: {spring})"), ""), &["corners", "edges", "cubes"]);
    says(
        &error(&format!("size: (3, 1, 3), neighbours: (edges: {spring}, cubes: {spring})"), ""),
        &["neighbours.cubes", "3 × 1 × 3", "no such neighbours"],
    );
    says(&error("size: (3, 3, 3), neighbours: (edges: (stiffness: -1))", ""), &["stiffness", "-1", "0 or more"]);
    says(&error("size: (3, 3, 3), neighbours: (edges: (damping: 1))", ""), &["stiffness", "missing"]);
}

#[test]
fn attitudes_and_options_that_cannot_be_are_refused() {
    says(&error("size: (3, 3, 3), rotation: (axis: (0, 0, 0), angle: 5)", ""), &["axis", "direction"]);
    says(&error("size: (3, 3, 3), drop: -1", ""), &["drop", "0 or more"]);
    says(&error("size: (3, 3, 3), drop: 1e17", ""), &[".ron:2:", "drop", "1e17 is not allowed", "from 0 to 1e9"]);
    says(&error("size: (3, 3, 3)", ", tear: 9"), &["tear", "9 is not allowed", "below 9"]);
    says(&error("size: (3, 3, 3), tilt: inf", ""), &["tilt", "finite"]);
    says(&error("size: (3, 3, 3), mass: 0", ""), &["mass", "above 0"]);
    says(&error("size: (3, 3, 3)", ", tear: 0"), &["tear", "above 0"]);
    says(&error("size: (3, 3, 3)", ", friction: (drag: 1)"), &["friction", "spine"]);
    says(&error("size: (3, 3, 3)", ", coulomb: (forward: 1, backward: 1)"), &["coulomb", "spine"]);
}

#[test]
fn an_axis_turns_a_block_however_long_it_is() {
    let turned = |length: f64| {
        let rotation = Some(Rotation { axis: (length, 2.0 * length, 3.0 * length), angle: 50.0 });
        let plan = JellyPlan { rotation, ..crate::jelly::cube(3, &Neighbours::ALL, 0.0) };
        crate::jelly::body(plan).particles.positions().collect::<Vec<_>>()
    };
    let plain = turned(1.0);
    for length in [1e200, 1e-200, 5e-324] {
        for (at, place) in turned(length).into_iter().zip(&plain) {
            assert!((at - *place).length() < 1e-12, "{length:e}: {at}, not {place}");
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_grid_for_which_there_is_no_memory_is_refused_before_it_is_taken() {
    let folder = tempfile::TempDir::new().unwrap();
    let file = folder.path().join("huge.creature.ron");
    let spring = "(stiffness: 1)";
    let body = format!("size: (158, 158, 158), neighbours: (edges: {spring}, faces: {spring}, cubes: {spring})");
    fs::write(&file, format!("Creature(version: 1,\n  body: Jelly({body}))")).unwrap();
    let shell = "ulimit -v 2500000; exec \"$0\" run \"$1\" --for 1";
    let arguments = ["-c", shell, env!("CARGO_BIN_EXE_wriggle"), file.to_str().unwrap()];
    let output = std::process::Command::new("sh").args(arguments).output().unwrap();
    let problem = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code().is_some_and(|code| code != 0), "{:?}: {problem}", output.status);
    says(&problem, &["huge.creature.ron:2", "size", "3944312 particles", "bytes (5.5 GB)", "are available"]);
}
