//! Roads, creatures and scenes that do not fit each other: what is said of them, and where.

use std::fs;

use tempfile::TempDir;
use wriggle::{
    mechanics::six_matrix::Road,
    physics::{Clock, Frozen},
    scenes::{self, SceneBodies},
};

use crate::support::{particles, stepping_app};

/// What is said about a scene file with these lines after its first, and beside it files of these names.
fn said(rest: &str, beside: &[(&str, &str)]) -> String {
    let folder = TempDir::new().unwrap();
    for (name, text) in beside {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join("bad.scene.ron");
    fs::write(&path, format!("Scene(version: 1, title: \"\",\n{rest})")).unwrap();
    scenes::load(path.to_str().unwrap()).unwrap_err().to_string()
}

#[test]
fn what_does_nothing_in_a_scene_is_refused_with_its_line() {
    let worm = r#"(name: "w", creature: "garden-worm")"#;
    let roller = r#"(name: "r", creature: "roller")"#;
    for (rest, parts) in [
        (
            format!("creatures: [{roller},\n(name: \"w\", creature: \"garden-worm\",\n  road: \"rough-road\")]"),
            [":4: creatures[1].road: ", "`w` has springs, which know no road; leave it out"],
        ),
        (
            "creatures: [\n(name: \"w\", creature: \"worm\", on_road: (row: 3))]".into(),
            [":3: creatures[0].on_road: ", "`w` has springs, which know no road; give `at`"],
        ),
        (
            format!("road: \"rough-road\",\ncreatures: [{worm}]"),
            [":2: road: ", "all creatures of this scene have springs, which know no road; leave it out"],
        ),
        (
            "creatures: [(name: \"r\", creature: \"roller\", road: \"helix\")],\nroad: \"rough-road\"".into(),
            [":3: road: ", "no creature takes it"],
        ),
        (
            "creatures: [(name: \"r\", creature: \"roller\",\non_road: (\nrow: 3))]".into(),
            [":3: creatures[0].on_road: ", "`r` has no road to stand on; give road: \"NAME\""],
        ),
        (
            "road: \"rough-road\", creatures: [\n(name: \"r\", creature: \"roller\", on_road: (row: 3, aside: 500))]"
                .into(),
            [":3: creatures[0].on_road: ", "no road is below `r` there; give another row, or less aside"],
        ),
        (
            "road: \"rough-road\", creatures: [\n(name: \"r\", creature: \"roller\", on_road: (row: 60.5))]".into(),
            [":3: creatures[0].on_road: ", "the road of `r` has no row 60.5; give one from 0 to 60"],
        ),
        (
            "road: \"helix\", creatures: [\n(name: \"r\", creature: \"roller\", on_road: (row: -1))]".into(),
            [":3: creatures[0].on_road: ", "the road of `r` has no row -1; give one from 0 to "],
        ),
        (
            "creatures: [\n\n(name: \"r\", creature: \"roller\", method: RungeKutta4)]".into(),
            [":4: creatures[0].method: ", "is one method; leave it out"],
        ),
        (format!("creatures: [{roller}],\nmethod: RungeKutta4"), [":3: method: ", "is one method; leave it out"]),
        (format!("creatures: [{roller}],\nstick: Located"), [":3: stick: ", "leave it out"]),
        (
            format!("gravity: 1,\ncreatures: [{roller}]"),
            [":2: gravity: ", "weight is a rule of a creature; leave it out"],
        ),
        (format!("ground: Flat,\ncreatures: [{roller}]"), [":2: ground: ", "leave it out, or give a road"]),
        (
            format!("creatures: [{roller}],\nclock: (dt: 0.01,\nopens_at: 1001)"),
            [":4: clock.opens_at: ", "1001 is more than 100000 steps of 0.01 away; give 1000 or less"],
        ),
        (format!("creatures: [{roller}],\nclock: (dt: 0.01, opens_at: -1)"), ["clock.opens_at: ", "-1 is not allowed"]),
    ] {
        let said = said(&rest, &[]);
        assert!(parts.iter().all(|part| said.contains(part)), "{rest}\n{said}");
    }
    // What is for one of them at least is no mistake.
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("good.scene.ron");
    for rest in [
        format!("road: \"rough-road\", gravity: 1, ground: Flat, method: RungeKutta4, creatures: [{roller}, {worm}]"),
        format!("road: \"rough-road\", creatures: [{roller}, (name: \"i\", creature: \"inchworm\", road: \"helix\")]"),
        format!("creatures: [{roller}], clock: (dt: 0.01, opens_at: 1000)"),
        "gravity: 1, creatures: []".into(),
    ] {
        fs::write(&path, format!("Scene(version: 1, title: \"\", {rest})")).unwrap();
        assert!(
            scenes::load(path.to_str().unwrap()).is_ok(),
            "{rest}: {:?}",
            scenes::load(path.to_str().unwrap()).err()
        );
    }
}

#[test]
fn files_of_roads_and_creatures_are_told_with_their_line() {
    let scene = |creature: &str| format!("creatures: [(name: \"x\", creature: \"{creature}\")]");
    for (file, text, parts) in [
        (
            "x.creature.ron",
            "Creature(version: 1,\nbody: GardenWorm(),\nroad: \"rough-road\")",
            ["x.creature.ron:3: road: ", "has springs, which know no road; leave it out"],
        ),
        (
            "x.creature.ron",
            "Creature(version: 1,\nbody: Composed(groups: [\n(name: \"a\", shape: Row(count: 3, from: (0, 0, 0), step: (1, 0, 0)))],\nrules: [\nGravity(on: [\"b\"])]))",
            ["x.creature.ron:5: rules[0].on: ", "there is no group `b`; there are `a`"],
        ),
        (
            "x.creature.ron",
            "Creature(version: 1, body: Raw(\nparticles: [(position: (0, 0, 0))],\nsprings: [\n(ends: (0, 1), stiffness: 1)]))",
            ["x.creature.ron:4: springs[0].ends: ", "there is no particle 1"],
        ),
        (
            "x.creature.ron",
            "Creature(version: 1,\nbody: Roller(table: (\nleft_side: (0, 2))))",
            // The path is that of the rule that the kind comes to, which the file does not write out.
            ["x.creature.ron:2: rules[1].table.left_side: ", "(0, 2) is not allowed"],
        ),
    ] {
        let said = said(&scene("x"), &[(file, text)]);
        assert!(parts.iter().all(|part| said.contains(part)), "{text}\n{said}");
    }
    let road = "Road(version: 1, form: Course(\npoints: [(0, 0, 0)],\nwidth: 9, spacing: 1))";
    let scene = r#"creatures: [(name: "r", creature: "roller", road: "nowhere")]"#;
    let said_of_road = said(scene, &[("nowhere.road.ron", road)]);
    for part in ["nowhere.road.ron:2: form.points: ", "two or more"] {
        assert!(said_of_road.contains(part), "{said_of_road}");
    }
    let misspelt = said(r#"creatures: [(name: "r", creature: "roller", road: "rough-raod")]"#, &[]);
    assert!(misspelt.contains("did you mean rough-road"), "{misspelt}");
}

#[test]
fn roads_of_one_particle_and_of_none_are_files_too() {
    let strip =
        |rows: u32| format!("Road(version: 1, form: Strip(rows: {rows}, columns: 1, spacing: 1, at: (0, 2, 0)))");
    let scene = |place: &str| {
        format!(r#"road: "x", creatures: [(name: "i", creature: "inchworm"), (name: "r", creature: "roller"{place})]"#)
    };
    let on_none = said(&scene(", on_road: (row: 0)"), &[("x.road.ron", &strip(0))]);
    assert!(on_none.contains("creatures[1].on_road: no road is below `r` there"), "{on_none}");
    // Whatever stands on one stone, or over none, goes on until it has fallen.
    for (rows, place) in [(1, ", on_road: (row: 0)"), (1, ""), (0, "")] {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("x.road.ron"), strip(rows)).unwrap();
        let path = folder.path().join("bare.scene.ron");
        fs::write(&path, format!("Scene(version: 1, title: \"\", clock: (dt: 0.01), {})", scene(place))).unwrap();
        let mut app = stepping_app(1.0, 1);
        scenes::open(app.world_mut(), scenes::load(path.to_str().unwrap()).unwrap()).unwrap();
        app.world_mut().resource_mut::<Clock>().set_steps_per_tick(600);
        app.update();
        let bodies = app.world().resource::<SceneBodies>().0.clone();
        assert_eq!(app.world().get::<Road>(bodies[0]).unwrap().points().len(), rows as usize);
        for body in &bodies {
            assert!(app.world().get::<Frozen>(*body).is_none(), "{rows} {place}");
            assert!(particles(&app, *body).positions().all(|x| x.is_finite()));
        }
        let height = particles(&app, bodies[1]).center().y;
        assert!(height < -50.0, "{rows} {place}: a roller that nothing holds is at {height}");
    }
}

#[test]
fn a_step_to_which_the_numbers_of_a_creature_do_not_belong_is_warned_of() {
    let warnings = |clock: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("slow.scene.ron");
        let roller = r#"(name: "r", creature: "roller"), (name: "i", creature: "inchworm")"#;
        std::fs::write(&path, format!("Scene(version: 1, title: \"t\", creatures: [{roller}],\n{clock})")).unwrap();
        wriggle::scenes::load(path.to_str().unwrap()).unwrap().warnings
    };
    assert_eq!(warnings("clock: (dt: 0.01)"), [""; 0]);
    let fine = warnings("clock: (dt: 0.001)");
    assert!(
        fine.len() == 1 && fine[0].contains(".ron:2: clock: steps are of 0.001, and the forces of `r`"),
        "{fine:?}"
    );
    let left_out = warnings("");
    assert!(left_out.len() == 1 && left_out[0].contains("belong to dt: 0.01"), "{left_out:?}");
}

#[test]
fn numbers_of_rough_road_are_refused_with_their_line() {
    let road = |field: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("x.road.ron"), format!("Road(version: 1, form: Rough(\n{field}))")).unwrap();
        let path = folder.path().join("x.scene.ron");
        let scene = "Scene(version: 1, title: \"t\", road: \"x\", creatures: [(name: \"r\", creature: \"roller\")])";
        std::fs::write(&path, scene).unwrap();
        wriggle::scenes::load(path.to_str().unwrap()).unwrap_err().to_string()
    };
    for field in ["middle", "signs"] {
        let error = road(&format!("{field}: (inf, 0)"));
        assert!(error.contains("x.road.ron:2:") && error.contains(field), "{error}");
    }
}
