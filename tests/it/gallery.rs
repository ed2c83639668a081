//! What is written of charts: tables, the page, the folder that keeps them, and the command that fills it.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use tempfile::TempDir;
use wriggle::{
    lab::{COLUMNS, Gallery, WorkPrecision, csv, page},
    mechanics::integrators::Method,
};

use crate::chart::{empty, full, of_order_two, one};

#[test]
fn a_table_reads_back_with_every_bit() {
    let chart = WorkPrecision { scene: "my \"best\", so far".into(), ..full() };
    let table = csv(&chart);
    let mut lines = table.split_terminator("\r\n");
    assert_eq!(lines.next().unwrap(), COLUMNS.join(","));
    let mut rows = 0;
    for (line, point) in lines.zip(&chart.points) {
        let line = line.strip_prefix("\"my \"\"best\"\", so far\",").unwrap();
        let cells: Vec<_> = line.split(',').collect();
        assert_eq!(cells.len(), COLUMNS.len() - 1);
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        assert_eq!((cells[0], cells[1]), (point.setting.method.name(), format!("{:?}", point.setting.stick).as_str()));
        assert_eq!(number(2), point.setting.dt);
        assert_eq!((cells[3].parse(), cells[4].parse()), (Ok(point.steps), Ok(point.evaluations)));
        assert_eq!(cells[5].parse(), Ok(point.runs));
        assert_eq!((number(6), number(7)), (point.seconds, point.median_seconds));
        match point.errors {
            Some(errors) => {
                assert_eq!([8, 9, 10].map(number), [errors.largest, errors.rms, errors.distance]);
                assert_eq!([11, 12].map(|i| cells[i].parse().ok()), [errors.cycle, errors.energy]);
                assert_eq!((cells[13], cells[14].parse(), cells[15]), ("", Ok(chart.is_known(point)), "false"));
            }
            None => assert_eq!(cells[8..], ["", "", "", "", "", "", "", "true"]),
        }
        rows += 1;
    }
    assert_eq!(rows, chart.points.len());
}

#[test]
fn the_page_escapes_what_it_shows_and_needs_nothing_from_elsewhere() {
    let bad = "<script>alert('1')</script> & \"more\"";
    let chart = WorkPrecision {
        scene: "a b\"c".into(),
        title: bad.into(),
        reference: bad.into(),
        machine: bad.into(),
        ..full()
    };
    let html = page(&[chart, empty()], &[]).unwrap();
    assert!(!html.contains("<script") && html.contains("&lt;script&gt;"));
    assert!(html.contains("href=\"./a%20b%22c.csv\""));
    for (at, _) in html.match_indices("http") {
        assert!(html[at..].starts_with("http://www.w3.org/2000/svg\""), "{}", &html[at..at + 60]);
    }
    assert!(!html.contains("src=") && !html.contains("@import") && !html.contains("url("));
    assert_eq!(html.matches("<svg").count(), 2);
    assert_eq!(
        html.matches("blew up</td>").count(),
        full().points.iter().filter(|point| point.errors.is_none()).count()
    );
    assert!(page(&[], &[]).unwrap().contains("No scene has been measured yet"));
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_gallery_knows_what_it_has_measured() {
    let folder = TempDir::new().unwrap();
    let gallery = Gallery::open(folder.path().join("new/charts")).unwrap();
    let chart = one();
    assert!(gallery.finished("garden", "a").is_none());
    gallery.partial("garden", "a").unwrap().push(chart.points[0]).unwrap();
    gallery.keep("a", &chart).unwrap();
    let kept = gallery.finished("garden", "a").unwrap();
    assert_eq!(kept.edges, chart.edges, "infinite limits survive");
    assert_eq!((kept.points.len(), kept.points[0].setting), (1, chart.points[0].setting));
    assert!(gallery.is_drawn("garden") && !gallery.is_drawn("snake"));
    assert!(gallery.finished("garden", "b").is_none() && gallery.finished("snake", "a").is_none());
    let page = gallery.write_page().unwrap();
    assert!(fs::read_to_string(&page).unwrap().contains("<h2>Garden</h2>"));
    // What is whole needs no parts.
    let names = ["garden.csv", "garden.json", "garden.png", "garden.svg", "index.html"];
    assert_eq!(files(page.parent().unwrap()), names);
    let png = fs::read(gallery.file("garden", "png")).unwrap();
    let png = image::load_from_memory(&png).unwrap();
    assert_eq!((png.width(), png.height()), (1600, 900));
    fs::write(gallery.file("garden", "json"), &fs::read(gallery.file("garden", "json")).unwrap()[..200]).unwrap();
    assert!(gallery.finished("garden", "a").is_none(), "half a file is no chart");
    assert!(fs::read_to_string(gallery.write_page().unwrap()).unwrap().contains("No scene"));
}

#[test]
fn a_gallery_says_which_folder_is_wrong() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    for bad in [file.clone(), file.join("below")] {
        let error = Gallery::open(&bad).unwrap_err().to_string();
        assert!(error.starts_with(&bad.display().to_string()) && error.contains("give a folder"), "{error}");
    }
}

#[test]
fn an_interrupted_sweep_goes_on_where_it_stopped() {
    let folder = TempDir::new().unwrap();
    let gallery = Gallery::open(folder.path()).unwrap();
    let points = of_order_two().points;
    let mut partial = gallery.partial("garden", "a").unwrap();
    assert!(partial.is_empty() && partial.known(points[0].setting).is_none());
    points[..2].iter().for_each(|&point| partial.push(point).unwrap());
    // Cut off in the middle of a line.
    let file = gallery.file("garden", "part.jsonl");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, format!("{text}{{\"setting\":{{\"meth")).unwrap();
    let mut partial = gallery.partial("garden", "a").unwrap();
    assert_eq!((partial.len(), partial.known(points[1].setting)), (2, Some(points[1])));
    assert_eq!(partial.known(points[2].setting), None);
    partial.push(points[2]).unwrap();
    assert_eq!(gallery.partial("garden", "a").unwrap().len(), 3, "what comes after the cut is whole");
    assert!(gallery.partial("garden", "b").unwrap().is_empty(), "another problem begins anew");
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wriggle"));
    command.arg("chart").args(arguments).current_dir(folder).env("XDG_CACHE_HOME", folder.join("cache"));
    command.output().unwrap()
}

#[test]
fn the_command_measures_a_scene_once() {
    let folder = TempDir::new().unwrap();
    let creature = "Creature(version: 1, body: Raw(particles: [(position: (0, 0, 0), mass: 1), (position: (1.2, 0, 0), \
                    mass: 1)], springs: [(ends: (0, 1), stiffness: 0.1, damping: 0.1, rest_length: 1)]))";
    fs::write(folder.path().join("pair.creature.ron"), creature).unwrap();
    let arguments = ["pair.creature.ron", "--out", "charts", "--quick"];
    let output = run(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("runs, measured;"));
    // No bar in a pipe, and once what the seconds of a debug build are worth.
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(said.lines().count(), usize::from(cfg!(debug_assertions)), "{said}");
    assert!(!cfg!(debug_assertions) || said.starts_with("warning: this is a debug build"), "{said}");
    let charts = folder.path().join("charts");
    let of = |stem: &str| ["csv", "json", "png", "svg"].map(|suffix| format!("{stem}.{suffix}"));
    let written = [vec!["index.html".to_owned()], of("pair-stiffness").into(), of("pair").into()].concat();
    assert_eq!(files(&charts), written);
    assert!(String::from_utf8_lossy(&output.stdout).contains("cheapest"), "which method stiffness favours is said");
    let stiffness = fs::read_to_string(charts.join("pair-stiffness.csv")).unwrap();
    let table = fs::read_to_string(charts.join("pair.csv")).unwrap();
    for method in Method::ALL {
        assert!(table.contains(&format!("pair,{},", method.name())), "no run of {}", method.name());
    }
    let output = run(folder.path(), &arguments);
    assert!(String::from_utf8_lossy(&output.stdout).contains("runs, measured before;"));
    assert_eq!(fs::read_to_string(charts.join("pair.csv")).unwrap(), table);
    assert_eq!(fs::read_to_string(charts.join("pair-stiffness.csv")).unwrap(), stiffness);
    // What cannot be charted is said, and takes no chart from the others.
    let output = run(folder.path(), &["flat-strip", "pair.creature.ron", "--out", "charts", "--quick"]);
    let (said, written) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    assert!(
        output.status.code() == Some(0) && said.contains("flat-strip") && said.contains("it gets no chart"),
        "{said}"
    );
    assert!(written.contains("pair: ") && written.contains("all charts: "), "{written}");
}

#[test]
fn the_command_says_what_is_wrong_before_it_measures() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("taken"), "").unwrap();
    let cases: [(&[&str], &str); 4] = [
        (&["gardn", "--out", "charts"], "gardn"),
        (&["garden", "--out", "taken"], "taken: is no folder; give a folder that can be written to"),
        (&["garden", "--out", "taken/below"], "taken/below: cannot be written to"),
        (&["garden", "garden", "--out", "charts"], "give `garden` once"),
    ];
    for (arguments, problem) in cases {
        let output = run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && said.contains(problem), "{arguments:?}: {said}");
    }
}
