//! Creature and scene files: the canonical forms, their defaults, where they are found, and what is said about bad ones.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bevy::math::DVec3;
use tempfile::TempDir;
use wriggle::{
    body::{Ground, Muscle, ParticleId, SpringId, Wave},
    creatures::{
        Creature, GardenWorm, Look, Pose,
        library::{self, CREATURE, SCENE, Source},
    },
    mechanics::integrators::Method,
    scenes::{self, Budget, Camera, Props, StepSize},
};

/// The canonical creature: the garden worm whose motion is known to twelve digits.
pub const RAW: &str = r#"Creature(version: 1,
  body: Raw(
    particles: [(position: (0, 0, 0), mass: 1), (position: (1, 0, 0), mass: 1), (position: (2, 0, 0), mass: 1)],  // velocity: (0, 0, 0), pinned: false
    springs: [(ends: (0, 1), stiffness: 1.5, damping: 0.9, rest_length: 1, muscle: (wave: Sine, amplitude: 0.25, period: 2, phase: 0, ramp: 0)),
              (ends: (1, 2), stiffness: 1.5, damping: 0.9, rest_length: 1, muscle: (wave: Sine, amplitude: 0.25, period: 2, phase: 0.25, ramp: 0))],
    spine: [0, 1, 2]),                                              // tail to head
  friction: (ratchet: true, drag: 0, grip: 0))                      // rates of animals.md §2
"#;

const SCENE_TEXT: &str = r#"Scene(version: 1, title: "Garden", gravity: 0, ground: None,
  creatures: [(name: "worm", creature: "garden-worm", at: (0, 0, 0), heading: 0)],
  props: Garden(seed: 7), camera: Orbit(target: (0, 0, 0), distance: 12, pitch: 25, yaw: 30),
  clock: (dt: 0.0005, time_scale: 3), method: SemiImplicitEuler, budget: Pixels(1))
"#;

/// A folder with one file in it.
fn file(name: &str, text: impl AsRef<[u8]>) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    (folder, path)
}

fn name(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// What is said about a creature file.
fn creature_problem(text: impl AsRef<[u8]>) -> String {
    let (_folder, path) = file("bad.creature.ron", text);
    scenes::load(name(&path)).expect_err("this file is bad").to_string()
}

/// What is said about a scene file.
fn scene_problem(text: impl AsRef<[u8]>) -> String {
    let (_folder, path) = file("bad.scene.ron", text);
    scenes::load(name(&path)).expect_err("this file is bad").to_string()
}

#[track_caller]
fn assert_says(problem: &str, words: &[&str]) {
    for word in words {
        assert!(problem.contains(word), "`{word}` is missing in: {problem}");
    }
}

fn read(text: &str) -> Creature {
    let (_folder, path) = file("a.creature.ron", text);
    library::read_creature(&Source::Disk(path)).unwrap()
}

#[test]
fn the_canonical_creature_is_read() {
    let body = read(RAW).body(Pose::default()).unwrap();
    assert_eq!(body.particles.positions().collect::<Vec<_>>(), [DVec3::ZERO, DVec3::X, DVec3::X * 2.0]);
    assert_eq!(body.particles.masses(), [1.0; 3]);
    assert_eq!(body.springs.ends(), [[ParticleId(0), ParticleId(1)], [ParticleId(1), ParticleId(2)]]);
    let muscles = body.muscles.unwrap();
    let last = Muscle { spring: SpringId(1), wave: Wave::Sine, amplitude: 0.25, period: 2.0, phase: 0.25, ramp: 0.0 };
    assert_eq!(muscles.get(1), Some(last));
    let friction = body.friction.unwrap();
    assert_eq!((friction.ratchet(), friction.drag(), friction.grip()), (true, 0.0, 0.0));
    assert_eq!(friction.spine(), [ParticleId(0), ParticleId(1), ParticleId(2)]);
    assert_eq!(body.look, Look::Plain);
}

#[test]
fn the_canonical_scene_is_read() {
    let (_folder, path) = file("my.scene.ron", SCENE_TEXT);
    let file = scenes::load(name(&path)).unwrap().file;
    assert_eq!((file.title.as_str(), file.gravity, file.ground), ("Garden", 0.0, None));
    assert_eq!(file.props, Props::Garden { seed: 7 });
    assert_eq!(file.camera, Camera::Orbit { target: (0.0, 0.0, 0.0), distance: 12.0, pitch: 25.0, yaw: 30.0 });
    assert_eq!((file.clock.step, file.clock.time_scale), (StepSize::Dt(0.0005), 3.0));
    assert_eq!((file.method, file.budget), (Method::SemiImplicitEuler, Budget::Pixels(1.0)));
}

#[test]
fn fields_with_defaults_may_be_left_out() {
    let short = read("Creature(version: 1, body: GardenWorm())").body(Pose::default()).unwrap();
    let shipped = library::find(CREATURE, "garden-worm", None).unwrap();
    assert_eq!(short, library::read_creature(&shipped).unwrap().body(Pose::default()).unwrap());
    assert_eq!(short, Creature::from(GardenWorm::default()).body(Pose::default()).unwrap());
    assert_eq!(short.friction.unwrap().drag(), 0.5);

    let raw = "Creature(version: 1, body: Raw(
        particles: [(position: (0, 0, 0)), (position: (0, 3, 4))], springs: [(ends: (0, 1), stiffness: 2)]))";
    let raw = read(raw).body(Pose::default()).unwrap();
    assert_eq!(raw.springs.get(SpringId(0)).unwrap().rest_length, 5.0);
    assert_eq!((raw.particles.masses(), raw.muscles, raw.friction), (&[1.0, 1.0][..], None, None));

    let scene = "Scene(version: 1, title: \"Small\", creatures: [])";
    let (_folder, path) = file("small.scene.ron", scene);
    let scene = scenes::load(name(&path)).unwrap().file;
    assert_eq!((scene.clock.dt(), scene.method, scene.props), (0.0005, Method::SemiImplicitEuler, Props::None));
}

#[test]
fn substeps_divide_what_a_tick_shows() {
    let text = SCENE_TEXT.replace("dt: 0.0005, time_scale: 3", "substeps: 4, time_scale: 2");
    let (_folder, path) = file("substeps.scene.ron", text);
    assert_eq!(scenes::load(name(&path)).unwrap().file.clock.dt(), 2.0 / 256.0);
}

#[test]
fn headings_turn_right_and_quarter_turns_are_exact() {
    let head = |heading| {
        let worm = Creature::from(GardenWorm::default());
        worm.body(Pose { at: DVec3::new(5.0, 1.0, -3.0), heading }).unwrap().particles.position(ParticleId(2)).unwrap()
    };
    for (heading, expected) in [
        (0.0, DVec3::new(7.0, 1.0, -3.0)),
        (90.0, DVec3::new(5.0, 1.0, -1.0)),
        (180.0, DVec3::new(3.0, 1.0, -3.0)),
        (-90.0, DVec3::new(5.0, 1.0, -5.0)),
        (3600.0, DVec3::new(7.0, 1.0, -3.0)),
        (-540.0, DVec3::new(3.0, 1.0, -3.0)),
    ] {
        assert_eq!(head(heading), expected, "heading {heading}");
    }
    let slant = head(30.0) - DVec3::new(5.0, 1.0, -3.0);
    assert!(slant.distance(DVec3::new(3_f64.sqrt(), 0.0, 1.0)) < 1e-15, "{slant}");
}

#[test]
fn bad_syntax_is_reported_with_line_and_column() {
    assert_says(
        &creature_problem(RAW.replace("mass: 1)]", "mass: 1)")),
        &["bad.creature.ron:4:5", "a bracket before `springs` is still open"],
    );
    assert_says(
        &creature_problem(format!("{RAW} more")),
        &["bad.creature.ron:8:2", "all brackets are closed before this"],
    );
    assert_says(
        &scene_problem("Scene(version: 1, title: \"x"),
        &["bad.scene.ron:1:", "a text begins here and does not end"],
    );
}

#[test]
fn bad_values_are_reported_with_line_column_field_and_what_is_right() {
    for (good, bad, words) in [
        (
            "(1, 2), stiffness: 1.5",
            "(1, 2), stiffness: -2",
            &[":5:", "springs[1].stiffness: -2 is not allowed", "0 or more"][..],
        ),
        ("damping: 0.9, rest", "damping: NaN, rest", &[":4:", "springs[0].damping: NaN", "0 or more"]),
        ("rest_length: 1", "rest_length: 0", &[":4:", "springs[0].rest_length: 0", "above 0"]),
        ("(1, 0, 0), mass: 1", "(1, 0, 0), mass: -1", &[":3:", "particles[1].mass: -1", "0 or more"]),
        ("(2, 0, 0)", "(2, inf, 0)", &[":3:", "particles[2].position", "inf is not allowed", "finite"]),
        ("period: 2", "period: 0", &[":4:", "springs[0].muscle", "period: 0", "above 0"]),
        ("wave: Sine", "wave: Saw", &[":4:", "springs[0].muscle", "Saw", "Sine", "Square"]),
        ("wave: Sine", "wave: 3", &[":4:", "springs[0].muscle", "expected `Sine` or `Square`"]),
        ("wave: Sine", "wave: (period: 2)", &[":4:", "springs[0].muscle", "expected `Sine` or `Square`"]),
        ("drag: 0", "drag: -1", &[":7:", "friction", "drag: -1", "0 or more"]),
        (
            "stiffness: 1.5, damping",
            "stifness: 1.5, damping",
            &[":4:", "springs[0].stifness", "`stifness`", "`stiffness`"],
        ),
        ("stiffness: 1.5, damping", "damping", &[":4:", "springs[0]", "`stiffness` is missing"]),
        ("mass: 1)]", "mass: 1, mass: 2)]", &[":3:", "particles[2]", "`mass` is given twice"]),
        ("ends: (0, 1)", "ends: (0, -1)", &[":4:", "springs[0].ends"]),
        ("ends: (0, 1)", "ends: (0, 1, 2)", &[":4:", "springs[0].ends"]),
        ("body: Raw", "body: Snail", &[":2:", "body", "Snail", "Raw", "GardenWorm"]),
        (
            "friction: (ratchet: true",
            "friction: (ratchet: 1",
            &[":7:", "friction.ratchet: `1` is not", "true or false"],
        ),
    ] {
        assert!(RAW.contains(good));
        let problem = creature_problem(RAW.replacen(good, bad, 1));
        assert_says(&problem, words);
        assert_says(&problem, &["bad.creature.ron:"]);
    }
    let worm = "Creature(version: 1, body: GardenWorm(amplitude: -0.1))";
    assert_says(&creature_problem(worm), &[":1:", "amplitude: -0.1 is not allowed", "0 or more"]);
}

#[test]
fn bad_values_of_a_scene_are_reported_too() {
    for (good, bad, words) in [
        ("gravity: 0", "gravity: -9.81", &[":1:", "gravity: -9.81 is not allowed", "0 or more"][..]),
        ("dt: 0.0005", "dt: 0", &[":4:", "clock", "dt: 0 is not allowed", "above 0"]),
        ("dt: 0.0005", "substeps: 0", &[":4:", "substeps: 0 is not allowed", "above 0"]),
        ("dt: 0.0005", "dt: 0.0005, substeps: 4", &[":4:", "clock: dt and substeps are both given"]),
        ("time_scale: 3", "time_scale: 1e9", &[":4:", "time_scale: 1000000000 is not allowed", "from 0 to 1000"]),
        ("pitch: 25", "pitch: 100", &[":3:", "pitch", "100 is not allowed", "from -90 to 90"]),
        ("distance: 12", "distance: 0", &[":3:", "distance", "above 0"]),
        ("SemiImplicitEuler", "Newmark", &[":4:", "method", "Newmark", "RungeKutta4"]),
        ("Pixels(1)", "Pixels(0)", &[":4:", "budget", "above 0"]),
        ("ground: None", "ground: Hilly", &[":1:", "ground", "Hilly", "Flat"]),
        ("ground: None", "ground: 0", &[":1:", "ground: expected `Flat` or `Terrain`"]),
        ("Pixels(1)", "1", &[":4:", "budget: expected `Pixels`", " or "]),
        ("title: \"Garden\", ", "", &["`title` is missing"]),
        ("heading: 0", "facing: 0", &[":2:", "creatures[0].facing", "`heading`"]),
    ] {
        assert!(SCENE_TEXT.contains(good));
        assert_says(&scene_problem(SCENE_TEXT.replacen(good, bad, 1)), words);
    }
}

#[test]
fn what_would_be_right_is_said_of_values_of_another_form() {
    for (good, bad, says) in [
        (
            "stiffness: 1.5",
            "stiffness: 1,5",
            "springs[0]: `1,5` is no number; write decimals with a point, not a comma: 1.5",
        ),
        ("phase: 0,", "phase: -0,25,", "springs[0].muscle: `-0,25` is no number; write decimals"),
        ("drag: 0", "drag: 0,5", "friction: `0,5` is no number; write decimals with a point, not a comma: 0.5"),
        ("grip: 0)", "grip: 0), gravity: 0,5", ":7:59: `0,5` is no number"),
        ("[0, 1, 2]", "[0, -1]", ":6:17: spine[1]: -1 is not allowed; give a whole number, 0 or more"),
        ("[0, 1, 2]", "[0,1.5]", "spine: 1.5 is no whole number; give one without a point"),
        ("[0, 1, 2]", "[0,2e0]", "spine[1]: `2e0` is not allowed; give a whole number"),
        ("[0, 1, 2]", "[0 1]", ":6:15: spine: a comma or a closing bracket belongs here, and not `1`"),
        ("[0, 1, 2]", "[0; 1]", "spine: a comma or a closing bracket belongs here, and not `;`"),
        ("[0, 1, 2]", "[0, \"B\"]", "spine[1]: `\"B\"` is not allowed; give a whole number"),
        ("[0, 1, 2]", "(0, 1, 2)", "spine: `(` is not allowed; give a list in square brackets"),
        (
            "ends: (0, 1)",
            "ends: (0, 99999999999)",
            "ends[1]: 99999999999 is too large; give a whole number from 0 to 4294967295",
        ),
        ("ends: (0, 1)", "ends: (0, 1, 2)", "springs[0].ends: give 2 values; here is one more, `2`"),
        ("ends: (0, 1)", "ends: (0)", "springs[0].ends: give 2 values; here is 1"),
        (
            "ends: (0, 1)",
            "ends: [0, 1]",
            "springs[0].ends: `[` is not allowed; give what belongs here in round brackets",
        ),
        ("(1, 0, 0)", "(1, 0, 0, 0)", "particles[1].position: give 3 values; here is one more, `0`\n"),
        ("(1, 0, 0)", "(1,5, 0, 0)", "here is one more, `0` (decimals are written with a point, not a comma)"),
        ("(1, 0, 0)", "(1, 0)", "particles[1].position: give 3 values; here are 2"),
        ("(1, 0, 0)", "(1, 0 0)", "position: a comma or a closing bracket belongs here, and not `0`"),
        ("mass: 1)", "mass: one)", "particles[0].mass: `one` is not allowed; give a number"),
        ("mass: 1)", "mass: 1.2.3)", "particles[0].mass: `1.2.3` is not allowed; give a number"),
        ("mass: 1)", "mass: )", "particles[0].mass: `)` is not allowed; give a number"),
        ("mass: 1)", "mass: 1kg)", "particles[0]: a comma or a closing bracket belongs here, and not `kg`"),
        ("mass: 1)", "mass = 1)", "particles[0]: a name and its value have a colon between them"),
        (
            "mass: 1)",
            "\"mass\": 1)",
            "particles[0]: `\"mass\"` is not allowed; give the name of a field, without quotes",
        ),
        ("version: 1", "version: 1.0", ":1:20: 1.0 is no whole number"),
        ("version: 1", "version: \"1\"", "version: `\"1\"` is not allowed; give a whole number"),
        ("grip: 0)", "grip: 0), damping: Rate(0,5)", "damping.Rate: give 1 value; here is one more, `5` (decimals"),
        ("grip: 0)", "grip: 0), road: 3", "road: `3` is not allowed; give a text in quotes"),
        (
            "(ratchet: true, drag: 0, grip: 0)",
            "none",
            "friction: `none` is not allowed; give what belongs here in round",
        ),
        ("grip: 0))", "grip: 0)", "the file ends here, and a bracket is still open"),
        (
            "Creature(",
            "Creatur(",
            ":1:1: `Creatur` is not allowed; a creature file begins like `Creature(version: 1, body: …)`",
        ),
    ] {
        assert!(RAW.contains(good), "{good}");
        // The end of the message can be asked for, too.
        let problem = creature_problem(RAW.replacen(good, bad, 1)) + "\n";
        assert!(problem.contains(says), "{bad}: `{says}` is missing in: {problem}");
    }
    let jelly = "Creature(version: 1, body: Jelly(size: (2.5, 5, 5), neighbours: (edges: (stiffness: 9))))";
    assert_says(&creature_problem(jelly), &["size: (2.5, 5, 5) is not allowed; give whole numbers from 1"]);
    for (good, bad, says) in [
        ("seed: 7", "seed: -3", "seed: -3 is not allowed; give a whole number, 0 or more"),
        ("seed: 7", "seed: 99999999999999999999", "99999999999999999999 is too large; give a smaller whole number"),
        ("dt: 0.0005", "substeps: 2.5", "2.5 is no whole number"),
        ("gravity: 0", "gravity: 9,81", "`9,81` is no number; write decimals with a point, not a comma: 9.81"),
    ] {
        assert!(SCENE_TEXT.contains(good), "{good}");
        assert_says(&scene_problem(SCENE_TEXT.replacen(good, bad, 1)), &[says]);
    }
}

#[test]
fn a_file_of_another_kind_is_told_how_its_name_ends() {
    let (_folder, path) = file("plain.ron", RAW);
    let problem = scenes::load(name(&path)).unwrap_err().to_string();
    let says = "plain.ron:1:1: holds a creature, where a scene is looked for; the name of a creature file ends in .creature.ron";
    assert_says(&problem, &[says]);
    assert_says(
        &creature_problem(SCENE_TEXT),
        &["holds a scene, where a creature is looked for", " ends in .scene.ron"],
    );
}

#[test]
fn a_creature_whose_name_cannot_begin_a_path_is_warned_of() {
    for (stem, becomes) in [("clock", "clock-"), ("a,b", "a-b")] {
        let (_folder, path) = file(&format!("{stem}.creature.ron"), RAW);
        let scene = scenes::load(name(&path)).unwrap();
        assert_eq!(scene.file.creatures[0].name, becomes);
        assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
        let says = format!("`{stem}` cannot be a name, so its parameter paths begin with `{becomes}`");
        assert_says(&scene.warnings[0], &[&says, name(&path)]);
    }
}

#[test]
fn places_that_contradict_each_other_are_named() {
    for (good, bad, words) in [
        ("ends: (1, 2)", "ends: (1, 3)", &["springs[1].ends: there is no particle 3; this body has 3"][..]),
        ("ends: (1, 2)", "ends: (1, 1)", &["springs[1].ends: joins particle 1 to itself", "two different"]),
        ("[0, 1, 2])", "[0, 1, 7])", &["spine[2]: there is no particle 7"]),
        ("[0, 1, 2])", "[0, 1, 0])", &["spine[2]: names particle 0 a second time"]),
        ("[0, 1, 2])", "[])", &["friction: works along a spine", "give `spine:"]),
        // Only a pinned particle may have none.
        ("mass: 1)", "mass: 0)", &["particles[0].mass: 0 is not allowed", "above 0"]),
        (
            "mass: 1)",
            "mass: 1e-320)",
            &["particles[0].mass: 1e-320 is so small that its inverse is infinite", "larger"],
        ),
        ("period: 2", "period: 1e-320", &["springs[0].muscle.period: 1e-320 is so small", "larger period"]),
        ("mass: 1)", "velocity: (1, 0, 0), pinned: true)", &["particles[0].velocity: a pinned particle never moves"]),
    ] {
        assert!(RAW.contains(good));
        let text = RAW.replacen(good, bad, 1);
        let problem = creature_problem(&text);
        assert_says(&problem, words);
        // Friction, which misses the spine, is on the line behind it.
        let line = 1 + text.lines().position(|line| line.contains(bad)).unwrap();
        let line = if words[0].starts_with("friction") { line + 1 } else { line };
        assert_says(&problem, &[&format!("bad.creature.ron:{line}: ")]);
    }
    let here = "Creature(version: 1, body: Raw(particles: [(position: (0, 0, 0)), (position: (0, 0, 0))],
        springs: [(ends: (0, 1), stiffness: 1)]))";
    assert_says(&creature_problem(here), &["springs[0].rest_length: is left out", "same place", "give a rest_length"]);
}

#[test]
fn a_pinned_particle_needs_no_mass() {
    let creature = RAW.replacen("mass: 1)", "mass: 0, pinned: true)", 1);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("held.creature.ron");
    std::fs::write(&file, creature).unwrap();
    assert!(wriggle::scenes::load(file.to_str().unwrap()).is_ok());
}

#[test]
fn conflicts_of_a_scene_are_named() {
    let two = "creatures: [(name: \"worm\", creature: \"garden-worm\"), (name: \"worm\", creature: \"garden-worm\")],";
    let mut lines: Vec<_> = SCENE_TEXT.lines().collect();
    lines[1] = two;
    assert_says(&scene_problem(lines.join("\n")), &["creatures[1].name: `worm` is the name of creatures[0] already"]);

    let named = |name: &str| SCENE_TEXT.replace("name: \"worm\"", &format!("name: \"{name}\""));
    assert_says(&scene_problem(named("clock")), &["creatures[0].name: `clock` cannot be a name"]);
    assert_says(&scene_problem(named("a,b")), &["creatures[0].name: `a,b` cannot be a name; `a-b` can"]);

    let low = SCENE_TEXT.replace("ground: None", "ground: Flat").replace("at: (0, 0, 0)", "at: (0, -0.5, 0)");
    assert_says(
        &scene_problem(low),
        &["creatures[0].at: puts particle 0 of `worm` 0.5 below the ground", "at: (0, 0, 0)"],
    );

    let set =
        |path: &str, value: &str| SCENE_TEXT.replace("budget: Pixels(1)", &format!("set: {{\"{path}\": {value}}}"));
    assert_says(
        &scene_problem(set("worm.springs.stifness", "2")),
        &["set: ", "worm.springs.stifness", "did you mean worm.springs.stiffness"],
    );
    assert_says(&scene_problem(set("snail.springs.stiffness", "2")), &["set: ", "paths begin with `worm`, `clock`"]);
    assert_says(
        &scene_problem(set("worm.particles[3].mass", "2")),
        &["set: ", "`worm` has 3 particles, counted from 0"],
    );
    assert_says(
        &scene_problem(set("worm.particles.mass", "0")),
        &["set: worm.particles.mass: 0 is not allowed; give a finite number above 0"],
    );

    // Each entry by its own line, also where its path has numbers in it; none may stand twice.
    let many = |second: &str| {
        let entries = format!("set: {{\n\"worm.friction.drag\": 1,\n{second}}}");
        scene_problem(SCENE_TEXT.replace("budget: Pixels(1)", &entries))
    };
    let line = 2 + SCENE_TEXT.lines().position(|line| line.contains("budget")).unwrap() + 1;
    for (second, problem) in [
        ("\"worm.springs[0].stifness\": 2", "set: "),
        ("\"worm.particles[3].mass\": 2", "`worm` has 3 particles"),
        ("\"worm.friction.drag\": 2", "`worm.friction.drag` is given twice; give it once"),
    ] {
        assert_says(&many(second), &[&format!(":{line}:"), problem]);
    }

    let unknown = SCENE_TEXT.replace("\"garden-worm\"", "\"garden-wurm\"");
    assert_says(
        &scene_problem(unknown),
        &["no creature `garden-wurm`", "did you mean garden-worm?", "assets/creatures/garden-wurm.creature.ron"],
    );
}

#[test]
fn other_versions_are_refused_whatever_else_they_hold() {
    assert_says(
        &creature_problem("Creature(version: 2, body: Raw(particles: []))"),
        &[":1:", "version 2 is not known", "version: 1"],
    );
    assert_says(&creature_problem("Creature(legs: 6,\n  version: 3)"), &[":2:", "version 3 is not known"]);
    assert_says(&scene_problem("Scene(weather: Rain, version: 7)"), &["version 7 is not known", "version: 1"]);
    assert_says(&creature_problem("Creature(body: GardenWorm())"), &["`version` is missing"]);
}

#[test]
fn files_that_are_no_text_are_refused() {
    assert_says(&creature_problem(""), &["bad.creature.ron: is empty", "Creature(version: 1"]);
    assert_says(&scene_problem(" \n\n"), &["bad.scene.ron: is empty", "Scene(version: 1"]);
    assert_says(&scene_problem(b"Scene(\n\xff\xfe"), &["bad.scene.ron: line 2 is no text in UTF-8"]);
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("folder.scene.ron");
    fs::create_dir(&path).unwrap();
    assert_says(&scenes::load(name(&path)).unwrap_err().to_string(), &["folder.scene.ron: is a folder", ".scene.ron"]);
    let nowhere = folder.path().join("nowhere.creature.ron");
    assert_says(
        &scenes::load(name(&nowhere)).unwrap_err().to_string(),
        &["no creature", "nowhere.creature.ron", "looked for"],
    );
    // A mark that some editors put in front is no part of the text.
    assert_eq!(read(&format!("\u{feff}{RAW}")), read(RAW));
}

#[test]
fn huge_files_are_refused_before_they_are_read() {
    let (_folder, path) = file("huge.creature.ron", "");
    fs::File::options().write(true).open(&path).unwrap().set_len(64 * 1024 * 1024 + 1).unwrap();
    assert_says(&scenes::load(name(&path)).unwrap_err().to_string(), &["has 65 MiB", "at most 64 MiB"]);
}

#[test]
fn more_than_four_million_particles_together_are_refused_before_a_body_is_built() {
    let folder = TempDir::new().unwrap();
    // 2001 creatures of 2000 particles: a small scene that asks for much.
    let particles = "(position:(0,0,0)),".repeat(2000);
    let creature = format!("Creature(version: 1, body: Raw(particles: [{particles}]))");
    fs::write(folder.path().join("heap.creature.ron"), creature).unwrap();
    let scene = |count: usize| {
        let placements: String = (0..count).map(|i| format!("(name: \"{i}\", creature: \"heap\"),")).collect();
        let path = folder.path().join("heaps.scene.ron");
        fs::write(&path, format!("Scene(version: 1, title: \"Heaps\", creatures: [{placements}])")).unwrap();
        scenes::load(name(&path))
    };
    assert_says(&scene(2001).unwrap_err().to_string(), &["creatures: have 4002000 particles", "at most 4000000"]);
    assert!(scene(20).is_ok());
}

#[test]
fn amplitudes_that_the_least_rest_length_cuts_are_warned_of() {
    let (_folder, path) = file("wide.creature.ron", RAW.replacen("amplitude: 0.25", "amplitude: 0.9", 1));
    let scene = scenes::load(name(&path)).unwrap();
    assert_eq!(scene.warnings.len(), 1);
    let line = 1 + RAW.lines().position(|line| line.contains("amplitude")).unwrap();
    assert_says(
        &scene.warnings[0],
        &[&format!("wide.creature.ron:{line}: springs[0].muscle.amplitude: 0.9 is above 0.8")],
    );
    assert!(scenes::load("garden").unwrap().warnings.is_empty());
}

#[test]
fn a_creature_alone_has_the_ground_and_gravity_that_it_asks_for() {
    let (_folder, path) = file("crawler.creature.ron", RAW);
    let scene = scenes::load(name(&path)).unwrap().file;
    assert_eq!((scene.ground, scene.gravity, scene.creatures[0].name.as_str()), (None, 0.0, "crawler"));

    let grounded = RAW.replace("grip: 0))", "grip: 0), ground: Flat, gravity: 0.05)");
    let (_folder, path) = file("crawler.creature.ron", &grounded);
    let scene = scenes::load(name(&path)).unwrap().file;
    assert_eq!((scene.ground, scene.gravity), (Some(Ground::Flat), 0.05));

    let sunk = grounded.replacen("(1, 0, 0)", "(1, -0.25, 0)", 1);
    assert_says(&creature_problem(sunk), &["particles[1].position: is 0.25 below the ground"]);
}

const STRAND: &str = r#"Creature(version: 1,
  body: Strand(segments: 6, stiffness: 0.5, damping: 3.5,
    waves: [(kind: Lateral, amplitude: 0.3, period: 60, wavelength: 10)]),
  friction: (grip: 10), ground: Flat, gravity: 0.02)
"#;

#[test]
fn a_bad_strand_is_refused_with_its_line_and_field() {
    for (from, to, words) in [
        (
            "segments: 6",
            "segments: 1",
            &["bad.creature.ron:2", "segments: ", "1 is not allowed; a strand has from 2"][..],
        ),
        ("wavelength: 10", "wavelength: 0", &["bad.creature.ron:3", "waves[0].wavelength: ", "0 is not allowed"]),
        ("kind: Lateral", "kind: Sideways", &["bad.creature.ron:3", "waves[0]", "Lateral"]),
        ("damping: 3.5", "damping: -1", &["damping: -1 is not allowed"]),
        ("ground: Flat", "ground: Terrain(surfaces: [])", &["ground", "surfaces: there is none; give one or more"]),
        (
            "(grip: 10)",
            "(grip: 10), coulomb: (forward: 1, backward: 2)",
            &["coulomb: works along single particles", "give friction"],
        ),
    ] {
        let text = STRAND.replacen(from, to, 1);
        assert_ne!(text, STRAND);
        assert_says(&creature_problem(text), words);
    }
}

#[test]
fn waves_that_the_least_rest_length_cuts_are_warned_of() {
    let (_folder, path) = file("wide.creature.ron", STRAND.replacen("amplitude: 0.3", "amplitude: 0.9", 1));
    let scene = scenes::load(name(&path)).unwrap();
    assert_eq!(scene.warnings.len(), 1);
    let line = 1 + STRAND.lines().position(|line| line.contains("waves")).unwrap();
    assert_says(&scene.warnings[0], &[&format!("wide.creature.ron:{line}: waves:"), "0.9 together, above 0.8"]);
}

#[test]
fn waves_that_a_scene_sets_are_warned_of_as_they_are_then() {
    let folder = TempDir::new().unwrap();
    let wide = STRAND.replacen("amplitude: 0.3", "amplitude: 0.9", 1);
    fs::write(folder.path().join("wide.creature.ron"), wide).unwrap();
    let path = folder.path().join("set.scene.ron");
    let warnings = |set: &str| {
        let text = format!(
            "Scene(version: 1, title: \"Set\", ground: Flat,\n\
             creatures: [(name: \"worm\", creature: \"worm\"), (name: \"wide\", creature: \"wide\", at: (0, 0, 9))],\n\
             clock: (dt: 0.03, time_scale: 6),\n\
             set: {{ {set} }})"
        );
        fs::write(&path, text).unwrap();
        scenes::load(name(&path)).unwrap().warnings
    };
    let calm = "\"wide.waves[0].amplitude\": 0.3";
    assert_eq!(warnings(calm), [""; 0]);
    let both = warnings("\"worm.waves[0].amplitude\": 0.95, \"worm.gait.steering\": 0.4");
    assert_eq!(both.len(), 2, "{both:?}");
    assert_says(&both[0], &["set.scene.ron:4: set: worm.waves: ", "come to 1.35 together, above 0.8"]);
    assert_says(&both[1], &["wide.creature.ron:3: waves: ", "0.9 together"]);
    let hasty = warnings(&format!("{calm}, \"clock.dt\": 0.7"));
    assert_eq!(hasty.len(), 1, "{hasty:?}");
    assert_says(&hasty[0], &["worm.creature.ron:", "waves[0].period: 12 is less than 20 steps of 0.7"]);
}

#[test]
fn waves_that_are_shorter_than_steps_are_warned_of() {
    let (_folder, path) = file("hasty.creature.ron", STRAND.replacen("period: 60", "period: 1e-3", 1));
    let scene = scenes::load(name(&path)).unwrap();
    assert_eq!(scene.warnings.len(), 1);
    assert_says(&scene.warnings[0], &["hasty.creature.ron:3: waves[0].period: 0.001 is less than 20 steps of 0.0005"]);
}

#[test]
fn an_animal_inside_the_ground_is_refused() {
    let scene = |ground: &str, at: &str| {
        SCENE_TEXT
            .replacen("ground: None", &format!("ground: {ground}"), 1)
            .replacen("garden-worm", "worm", 1)
            .replacen("at: (0, 0, 0)", &format!("at: {at}"), 1)
    };
    let problem = scene_problem(scene("Flat", "(0, -0.5, 0)"));
    assert_says(
        &problem,
        &["creatures[0].at: puts particle 0 of `worm` 0.5 below the ground", "give at: (0, 0, 0) or higher"],
    );
    let hill = "Terrain(surfaces: [Hill(center: (5, 0), radius: 4, height: 1)])";
    assert_says(&scene_problem(scene(hill, "(0, 0, 0)")), &["creatures[0].at: puts particle", "below the ground"]);
    let wall = "Terrain(surfaces: [Floor(height: 0), Plane(point: (8, 0, 0), normal: (-1, 0, 0))])";
    assert_says(&scene_problem(scene(wall, "(0, 0, 0)")), &["creatures[0].at: puts particle", "2 below the ground"]);
    assert_says(&scene_problem(scene("Terrain(surfaces: [])", "(0, 0, 0)")), &["surfaces: there is none"]);
}

#[test]
fn what_a_scene_names_and_is_nowhere_is_reported_with_its_place() {
    let problem = scene_problem(SCENE_TEXT.replacen("garden-worm", "garden-wurm", 1));
    let line = 1 + SCENE_TEXT.lines().position(|line| line.contains("garden-worm")).unwrap();
    assert_says(
        &problem,
        &[
            &format!(".scene.ron:{line}: creatures[0].creature: there is no creature `garden-wurm`"),
            "did you mean garden-worm?",
        ],
    );
    let seeds = scene_problem(SCENE_TEXT.replacen("Garden(seed: 7)", "Garden(seed: 7, weeds: 3)", 1));
    assert_says(&seeds, &["weeds", "seed"]);
    let far = scene_problem(SCENE_TEXT.replacen("at: (0, 0, 0)", "at: (0, 0, -1e308)", 1));
    assert_says(&far, &[".scene.ron:2: creatures[0].at: -1e308 is too far away", "1e9 at the most"]);
    let road =
        "Scene(version: 1, title: \"t\",\n  road: \"nowhere\",\n  creatures: [(name: \"a\", creature: \"roller\")])";
    assert_says(&scene_problem(road), &[".scene.ron:2: road: there is no road `nowhere`"]);
}

#[test]
fn creatures_are_looked_for_beside_their_scene_first() {
    let (folder, path) = file("my.scene.ron", SCENE_TEXT);
    let worm = folder.path().join("garden-worm.creature.ron");
    fs::write(&worm, "Creature(version: 1, body: GardenWorm(stiffness: 7))").unwrap();
    assert!(scenes::load(name(&path)).unwrap().files().contains(&worm));
    fs::remove_file(&worm).unwrap();
    assert!(!scenes::load(name(&path)).unwrap().files().contains(&worm));
}

#[test]
fn every_example_in_the_reference_of_files_is_good() {
    let text = include_str!("../../assets/FILES.md");
    let mut seen = [0; 3];
    for block in text.split("```ron\n").skip(1) {
        let block = &block[..block.find("```").unwrap()];
        let begins = |head: &str| block.lines().any(|line| line.starts_with(head));
        let folder = TempDir::new().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::write(&path, text).unwrap();
            path
        };
        let path = if begins("Road(") {
            write("way.road.ron", block);
            let on_it = r#"(name: "r", creature: "roller", on_road: (row: 3))"#;
            let scene =
                format!("Scene(version: 1, title: \"t\", road: \"way\", creatures: [{on_it}], clock: (dt: 0.01))");
            seen[2] += 1;
            write("on-it.scene.ron", &scene)
        } else if begins("Scene(") {
            seen[1] += 1;
            write("x.scene.ron", block)
        } else {
            assert!(begins("Creature("), "{block}");
            seen[0] += 1;
            write("x.creature.ron", block)
        };
        let scene = scenes::load(name(&path)).unwrap_or_else(|error| panic!("{error} in\n{block}"));
        assert_eq!(scene.warnings, [""; 0], "{block}");
    }
    assert!(seen.iter().all(|count| *count > 2), "{seen:?}");
}

#[test]
fn shipped_files_are_good_and_listed() {
    let scenes = library::list(SCENE);
    assert!(scenes.contains_key("garden"));
    for scene in scenes.keys() {
        let scene = scenes::load(scene).unwrap();
        assert!(!scene.file.title.is_empty() && scene.warnings.is_empty());
    }
    let document = scenes::load("document").unwrap().file;
    assert_eq!((document.clock.dt(), document.method), (0.0005, Method::SemiImplicitEuler));
    let creatures = library::list(CREATURE);
    assert!(creatures.contains_key("garden-worm"));
    for creature in creatures.keys() {
        scenes::load(creature).unwrap();
    }
}
