//! The program from outside: exit codes, what it prints, and what it writes.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use serde_json::Value;
use tempfile::TempDir;

fn wriggle(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wriggle")).args(arguments).output().unwrap()
}

fn in_folder(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wriggle")).args(arguments).current_dir(folder).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

pub fn json(arguments: &[&str]) -> Value {
    let output = wriggle(&[arguments, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn json_has_every_field() {
    let result = json(&["run", "document", "--for", "6", "--threads", "2"]);
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<std::collections::BTreeSet<_>>();
    let fields = "scene method dt time steps wall_seconds force_evaluations spring_updates hash threads bodies";
    assert_eq!(keys(&result), fields.split(' ').map(String::from).collect());
    let fields = "name particles springs start center distance status";
    assert_eq!(keys(&result["bodies"][0]), fields.split(' ').map(String::from).collect());
    assert_eq!((result["scene"].as_str(), result["method"].as_str()), (Some("document"), Some("SemiImplicitEuler")));
    assert_eq!((result["dt"].as_f64(), result["time"].as_f64()), (Some(0.0005), Some(6.0)));
    assert_eq!((result["steps"].as_u64(), result["force_evaluations"].as_u64()), (Some(12_000), Some(12_000)));
    assert_eq!((result["spring_updates"].as_u64(), result["threads"].as_u64()), (Some(24_000), Some(2)));
    let hash = result["hash"].as_str().unwrap();
    assert!(hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{hash}");
    let body = &result["bodies"][0];
    assert_eq!((body["name"].as_str(), body["status"].as_str()), (Some("worm"), Some("running")));
    assert_eq!(body["start"], serde_json::json!([1.0, 0.0, 0.0]));
    let moved = body["center"][0].as_f64().unwrap() - 1.0;
    assert!(moved > 0.1 && (body["distance"].as_f64().unwrap() - moved).abs() < 1e-15, "{body}");
}

#[test]
fn flags_change_the_run() {
    let plain = json(&["run", "document", "--for", "3"]);
    let set = json(&["run", "document", "--for", "3", "--set", "worm.springs.stiffness=2", "--set", "worm.gravity=0"]);
    assert_ne!(plain["hash"], set["hash"]);
    let other = json(&["run", "document", "--for", "3", "--dt", "0.01", "--method", "RungeKutta4"]);
    assert_eq!((other["method"].as_str(), other["steps"].as_u64()), (Some("RungeKutta4"), Some(300)));
    assert_eq!(other["force_evaluations"].as_u64(), Some(1200));
    assert_eq!(json(&["run", "document", "--dt", "0.05"])["time"].as_f64(), Some(60.0));
    // The time scale is how fast it is watched, and no step.
    let watched = json(&["run", "document", "--for", "3", "--dt", "0.05", "--set", "clock.time_scale=5"]);
    assert_eq!(watched["hash"], json(&["run", "document", "--for", "3", "--dt", "0.05"])["hash"]);
    assert_eq!(json(&["run", "document", "--for", "0"])["steps"].as_u64(), Some(0));
}

#[test]
fn a_recording_has_every_bit_and_ends_with_the_hashed_state() {
    let folder = TempDir::new().unwrap();
    let output = in_folder(
        folder.path(),
        &["run", "four-worms", "--for", "1.5", "--record", "r.csv", "--every", "0.3", "--json"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = fs::read_to_string(folder.path().join("r.csv")).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("time,body,particle,x,y,z,vx,vy,vz"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 6 * 4 * 3);
    assert_eq!(rows[0], ["0", "plain", "0", "0", "0", "-3", "0", "0", "0"]);
    assert_eq!(rows[71][..3], ["1.5", "stiff", "2"]);
    // FNV-1a 64 of the last rows: all positions, then all velocities.
    let last = &rows[60..];
    let numbers = |columns: std::ops::Range<usize>| {
        last.iter().flat_map(move |row| row[columns.clone()].iter().map(|cell| cell.parse::<f64>().unwrap()))
    };
    let mut hash = 0xcbf29ce484222325_u64;
    for byte in numbers(3..6).chain(numbers(6..9)).flat_map(f64::to_le_bytes) {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x100000001b3);
    }
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["hash"].as_str().unwrap(), format!("{hash:016x}"));
    // Recording changes nothing.
    assert_eq!(json(&["run", "four-worms", "--for", "1.5"])["hash"], result["hash"]);
}

#[test]
fn a_recording_goes_to_standard_output_and_takes_every_step() {
    let output = wriggle(&["run", "document", "--for", "0.005", "--record", "-"]);
    assert_eq!(stdout(&output).lines().count(), 1 + 11 * 3);
    assert!(stderr(&output).contains("document: 10 steps"), "{}", stderr(&output));
}

#[test]
fn bad_input_exits_with_2_and_says_what_is_right() {
    for (arguments, words) in [
        (&["run", "document", "--for", "1.0003"][..], &["--for 1.0003", "1 and 1.0005"][..]),
        (&["run", "document", "--for", "-1"], &["-1"]),
        (&["run", "document", "--for=-1"], &["--for", "0 or more"]),
        (&["run", "document", "--for", "1e300"], &["--for", "give a shorter time"]),
        (&["run", "document", "--dt", "0"], &["--dt", "above 0"]),
        (&["run", "document", "--dt", "fast"], &["--dt", "above 0"]),
        (&["run", "document", "--method", "Newmark"], &["Newmark", "SemiImplicitEuler", "RungeKutta4"]),
        (&["run", "document", "--set", "worm.springs.stiffness"], &["PATH=VALUE"]),
        (&["run", "document", "--set", "worm.springs.stiffness=x"], &["`x` is no number"]),
        (&["run", "document", "--set", "worm.springs.stiffness=-1"], &["worm.springs.stiffness: -1", "0 or more"]),
        (&["run", "document", "--set", "worm.springs.stifness=1"], &["did you mean worm.springs.stiffness"]),
        (&["run", "document", "--every", "1"], &["--record"]),
        (&["run", "document", "--record", "-", "--every", "0.0007"], &["--every 0.0007", "0.0005 and 0.001"]),
        (&["run", "document", "--record", "-", "--json"], &["--json and --record -"]),
        (&["run", "document", "--for", "1", "--record", "/nowhere/r.csv"], &["/nowhere/r.csv"]),
        (&["run", "document", "--threads", "0"], &["--threads"]),
        (&["run", "document", "--threads", "-1"], &["--threads", "-1 is not in 1..=1024"]),
        (
            &["run", "document", "--dt", "0.1", "--set", "clock.dt=0.2"],
            &["--dt and --set clock.dt", "give one of them"],
        ),
        (&["run", "document", "--set", "worm.particles.mass=1e-320"], &["particles[0].mass: 1e-320", "larger mass"]),
        (&["run", "snake", "--method", "ExactFlow"], &["`snake` cannot", "not on an axis", "give another method"]),
        (&["run", "document", "--record", "my.creature.ron"], &["my.creature.ron", "ends in .csv"]),
        (&["run", "gardn"], &["no scene `gardn`", "did you mean garden?", "assets/scenes/gardn.scene.ron"]),
        (&["run", "snak"], &["no scene `snak`", "did you mean snake"]),
        (&["run", "nowhere.creature.ron"], &["no creature `nowhere.creature.ron`"]),
        (&["run"], &["SCENE"]),
        (&["list", "--paths", "gardn"], &["did you mean garden?"]),
        (&["gardn"], &["did you mean garden?"]),
    ] {
        let output = wriggle(arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        for word in words {
            assert!(said.contains(word), "{arguments:?}: `{word}` is missing in: {said}");
        }
    }
}

#[test]
fn a_bad_file_is_reported_with_its_place() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("bad.creature.ron"), "Creature(version: 1,\n  body: GardenWorm(mass: 0))").unwrap();
    let output = in_folder(folder.path(), &["run", "bad.creature.ron"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).starts_with("error: bad.creature.ron:2:"), "{}", stderr(&output));
    assert!(stderr(&output).contains("mass: 0 is not allowed; give a finite number above 0"), "{}", stderr(&output));
}

#[cfg(not(feature = "window"))]
#[test]
fn a_build_that_cannot_draw_says_so() {
    for arguments in [&["shot", "garden", "--at", "3", "--out", "a.png"][..], &["shot"]] {
        let output = wriggle(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = stderr(&output);
        for word in ["no window and no renderer", "the feature `window`"] {
            assert!(said.contains(word), "{arguments:?}: `{word}` is missing in: {said}");
        }
    }
}

#[test]
fn a_frozen_body_is_said_and_exits_with_1() {
    let output = wriggle(&["run", "four-worms", "--dt", "2", "--for", "200", "--method", "ExplicitEuler", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("stability limit of `plain`") && said.contains("plain: particle"), "{said}");
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((result["steps"].as_u64(), result["bodies"][0]["status"].as_str()), (Some(100), Some("frozen")));
    let frozen = &result["bodies"][0]["frozen"];
    let (step, time) = (frozen["step"].as_u64().unwrap(), frozen["time"].as_f64().unwrap());
    assert!(said.contains(&format!("exploded at step {step} ")) && time == 2.0 * step as f64, "{frozen} of {said}");
    assert!(said.contains(frozen["reason"].as_str().unwrap()), "{frozen} of {said}");
}

#[test]
fn files_are_found_as_given_then_under_assets_then_embedded() {
    let folder = TempDir::new().unwrap();
    let title = |file: &str, stiffness: u32| {
        let path = folder.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, format!("Creature(version: 1, body: GardenWorm(stiffness: {stiffness}))")).unwrap();
    };
    let stiffness = || {
        let output = in_folder(folder.path(), &["list", "--paths", "garden-worm"]);
        let table = stdout(&output);
        let line = table.lines().find(|line| line.starts_with("garden-worm.springs.stiffness")).expect("a stiffness");
        line.split_whitespace().nth(1).unwrap().to_owned()
    };
    assert_eq!(stiffness(), "1.5");
    title("assets/creatures/garden-worm.creature.ron", 8);
    assert_eq!(stiffness(), "8");
    title("garden-worm.creature.ron", 9);
    assert_eq!(stiffness(), "9");
    // A folder of the same name is no file.
    fs::create_dir(folder.path().join("document")).unwrap();
    assert_eq!(in_folder(folder.path(), &["run", "document", "--for", "0"]).status.code(), Some(0));
}

#[test]
fn list_names_scenes_creatures_methods_and_paths() {
    let all = stdout(&wriggle(&["list"]));
    for word in ["garden  ", "Garden", "four-worms  ", "garden-worm", "SemiImplicitEuler", "RungeKutta4"] {
        assert!(all.contains(word), "`{word}` is missing in {all}");
    }
    let paths = stdout(&wriggle(&["list", "--paths", "document"]));
    for word in ["worm.springs[1].stiffness", "worm.muscles.amplitude", "clock.dt", "0.0005", "0 to 10", "force/length"]
    {
        assert!(paths.contains(word), "`{word}` is missing in {paths}");
    }
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let mut run = Command::new(env!("CARGO_BIN_EXE_wriggle"))
        .args(["run", "document", "--record", "-"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(run.stdout.take());
    let output = run.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

#[test]
fn play_without_a_display_runs_the_garden_headless() {
    let output = Command::new(env!("CARGO_BIN_EXE_wriggle"))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    if cfg!(all(feature = "window", not(all(unix, not(target_os = "macos"))))) {
        return;
    }
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
    let said = stdout(&output);
    assert!(said.contains("t =  0.0") && said.contains("t = 60.0") && said.contains("before its door"), "{said}");
}

#[test]
fn what_is_asked_for_runs_where_nothing_can_be_drawn() {
    let output = Command::new(env!("CARGO_BIN_EXE_wriggle"))
        .arg("two-masses")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    if cfg!(all(feature = "window", not(all(unix, not(target_os = "macos"))))) {
        return;
    }
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("running two-masses without a picture"), "{}", stderr(&output));
    assert!(stdout(&output).contains("two-masses"), "{}", stdout(&output));
}

#[test]
fn the_number_of_threads_changes_no_bits() {
    use core::fmt::Write;
    // Worms that all differ, half of them off the axis, so that lanes, single bodies and both dimensions take part.
    let folder = tempfile::tempdir().unwrap();
    let (mut creatures, mut set) = (String::new(), String::new());
    for i in 0..64 {
        let heading = [0, 17][i % 2];
        writeln!(creatures, "(name: \"w{i}\", creature: \"garden-worm\", at: (0, 0, {i}), heading: {heading}),")
            .unwrap();
        writeln!(set, "\"w{i}.springs.stiffness\": {},", 1.0 + 0.01 * i as f64).unwrap();
    }
    let scene = format!(
        "Scene(version: 1, title: \"Crowd\", creatures: [{creatures}], clock: (dt: 0.005, time_scale: 3), set: {{{set}}})"
    );
    std::fs::write(folder.path().join("crowd.scene.ron"), scene).unwrap();
    let run = |threads: &str| {
        let file = folder.path().join("crowd.scene.ron");
        let result = json(&["run", file.to_str().unwrap(), "--for", "60", "--threads", threads]);
        assert_eq!(result["threads"].to_string(), threads, "the pool has the size that was asked for");
        assert_eq!(result["bodies"].as_array().unwrap().len(), 64);
        assert!(result["bodies"][63]["distance"].as_f64().unwrap() > 5.0);
        result["hash"].as_str().unwrap().to_owned()
    };
    let hashes = ["1", "2", "8"].map(run);
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}

#[test]
fn the_gaits_of_strands_are_reported_and_do_not_depend_on_threads() {
    let run = |threads: &str| json(&["run", "meadow", "--for", "126", "--dt", "0.05", "--threads", threads]);
    let [one, two] = ["1", "2"].map(run);
    assert_eq!(one["hash"], two["hash"]);
    let snake = &one["bodies"][1];
    assert_eq!(snake["name"], "snake");
    let gait = |field: &str| snake["gait"][field].as_f64().unwrap();
    assert_eq!(gait("cycles"), 2.0);
    assert!((gait("body_lengths") - gait("distance") / 14.0).abs() < 1e-12);
    // It has hardly begun to bend.
    assert!((0.1..0.7).contains(&gait("body_lengths")), "{snake}");
    assert!(gait("slip") < 0.1 && gait("smallest_cell") > 0.8, "{snake}");
    let garden = json(&["run", "garden", "--for", "6"]);
    assert!(garden["bodies"][0].get("gait").is_none());
}

#[test]
fn a_tangle_is_told_of_in_words() {
    let folder = TempDir::new().unwrap();
    let run = |arguments: &[&str]| {
        let output = in_folder(folder.path(), &[&["run", "--dt", "0.03", "--for", "30"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (stdout(&output), stderr(&output))
    };
    let cut = "waves: their amplitudes and the steering come to";
    let (calm, said) = run(&["worm"]);
    assert!(calm.contains(", smallest cell 0.") && said.is_empty(), "{calm}{said}");
    let (wild, said) = run(&["worm", "--set", "worm.waves[0].amplitude=0.95", "--set", "worm.gait.steering=0.4"]);
    assert!(wild.contains(", smallest cell -") && wild.contains("(inside out)"), "{wild}");
    assert_eq!(said.matches(cut).count(), 1, "{said}");
    assert_eq!(said.matches("is inside out at step").count(), 1, "{said}");
    // What the file says already is said once, with its line.
    let creature =
        include_str!("../../assets/creatures/worm.creature.ron").replacen("amplitude: 0.3", "amplitude: 0.9", 1);
    fs::write(folder.path().join("wide.creature.ron"), creature).unwrap();
    let (_, said) = run(&["wide.creature.ron"]);
    assert_eq!((said.matches(cut).count(), said.matches("wide.creature.ron:").count()), (1, 1), "{said}");
    // So do the commands that run nothing.
    let listed = in_folder(folder.path(), &["list", "--paths", "wide.creature.ron"]);
    assert!(stderr(&listed).starts_with("warning: ") && stderr(&listed).contains("wide.creature.ron:"));
}

#[test]
fn limits_begin_with_the_warnings_of_their_scenes() {
    let folder = TempDir::new().unwrap();
    let creature =
        include_str!("../../assets/creatures/raw-worm.creature.ron").replacen("amplitude: 0.25", "amplitude: 0.9", 1);
    fs::write(folder.path().join("wide.creature.ron"), creature).unwrap();
    let said = stderr(&in_folder(folder.path(), &["limits", "wide.creature.ron"]));
    assert_eq!(said.matches("warning: ").count(), 1, "{said}");
    assert!(said.contains("wide.creature.ron:") && said.contains("muscle.amplitude: 0.9 is above 0.8"), "{said}");
}

#[test]
fn waves_that_are_quicker_than_steps_have_no_gait() {
    let folder = TempDir::new().unwrap();
    for period in ["1e-300", "1e-3"] {
        let creature = include_str!("../../assets/creatures/worm.creature.ron").replacen(
            "period: 12",
            &format!("period: {period}"),
            1,
        );
        fs::write(folder.path().join("quick.creature.ron"), creature).unwrap();
        let output = in_folder(folder.path(), &["run", "quick.creature.ron", "--dt", "0.02", "--for", "6"]);
        let (text, said) = (stdout(&output), stderr(&output));
        assert!(output.status.code() == Some(0) && said.contains("waves[0].period: "), "{period}: {text}{said}");
        assert!(!text.contains("NaN") && !text.contains("a cycle"), "{period}: {text}");
    }
}

#[test]
fn the_creature_of_the_readme_crawls() {
    let readme = include_str!("../../README.md");
    let creature = readme.split("```ron").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ant.creature.ron");
    std::fs::write(&file, creature).unwrap();
    let result = json(&["run", file.to_str().unwrap(), "--for", "40"]);
    let ant = &result["bodies"][0];
    assert_eq!((ant["name"].as_str(), ant["status"].as_str()), (Some("ant"), Some("running")));
    assert!(ant["center"][0].as_f64().unwrap() > 2.0, "{ant}");
}

#[test]
fn limits_prints_every_method_of_a_scene_as_a_table_and_as_json() {
    let rows = json(&["limits", "garden"]);
    let rows = rows.as_array().unwrap();
    let row = |method: &str| rows.iter().find(|row| row["method"] == method).unwrap();
    let euler = row("SemiImplicitEuler");
    assert!((euler["predicted"].as_f64().unwrap() - 0.5175).abs() < 5e-5, "{euler}");
    assert_eq!((euler["scene"].as_str(), euler["body"].as_str()), (Some("garden"), Some("worm")));
    assert_eq!(row("Xpbd")["bound"].as_str(), Some("none"));
    let table = stdout(&wriggle(&["limits", "garden"]));
    for word in ["predicted", "bound", "linearised", "explodes", "SemiImplicitEuler", "0.5175", "none"] {
        assert!(table.contains(word), "`{word}` is missing in {table}");
    }
    assert_eq!(wriggle(&["limits", "gardn"]).status.code(), Some(2));
}
