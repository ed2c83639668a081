//! What a file of a jelly may not say.

use std::fs;

use wriggle::{creatures::JellyPlan, scenes};

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
    says(&error("size: (3, 3, 3), tilt: inf", ""), &["tilt", "finite"]);
    says(&error("size: (3, 3, 3), mass: 0", ""), &["mass", "above 0"]);
    says(&error("size: (3, 3, 3)", ", tear: 0"), &["tear", "above 0"]);
    says(&error("size: (3, 3, 3)", ", friction: (drag: 1)"), &["friction", "spine"]);
    says(&error("size: (3, 3, 3)", ", coulomb: (forward: 1, backward: 1)"), &["coulomb", "spine"]);
}
