//! From which stiffness on implicit methods win: the study, its crossing, and how it is drawn.

use std::fs;

use tempfile::TempDir;
use wriggle::{
    lab::{
        Cache, Crossing, Gallery, LabError, Point, Problem, STIFFNESS_COLUMNS, StiffRun, StiffScene, StiffnessStudy,
        StudiedRun, SweepOptions, Truth,
        chart::{Look, Shape, stiffness},
        crossing, factors, page, resumed_stiffness_study, stiffened, stiffness_csv, stiffness_study, studied_methods,
    },
    mechanics::integrators::{Method, StickRule},
    scenes,
};

use crate::chart::{check_texts, marks, one, point};

const SCENE: StiffScene = StiffScene { factor: 1.0, way: 6.0, reference_error: 1e-13, runs: Vec::new() };

/// A study at 1, 10, … 10⁴ in which a run of a method takes as long as `seconds` says, or in which none is good enough.
fn study(seconds: impl Fn(Method, f64) -> Option<f64>) -> StiffnessStudy {
    let run = |method, factor: f64| {
        let known = point(method, StickRule::InStages, 0.1 / factor.sqrt(), 2, Some(0.005));
        let run = seconds(method, factor).map(|seconds| Point { seconds, median_seconds: 1.1 * seconds, ..known });
        StiffRun { method, run }
    };
    let scenes = [1.0, 10.0, 100.0, 1e3, 1e4].map(|factor| StiffScene {
        factor,
        runs: Method::ALL.into_iter().map(|method| run(method, factor)).collect(),
        ..SCENE
    });
    StiffnessStudy {
        scene: "garden".into(),
        title: "Garden".into(),
        duration: 60.0,
        budget: 0.0117,
        repeats: 20,
        scenes: scenes.into(),
        ended: None,
        reference: "DOP853 with located events".into(),
        machine: "a machine".into(),
    }
}

/// Runge–Kutta 2 whose cost grows as the root of the stiffness, and the implicit midpoint rule whose cost does not: they cross at 900.
fn crossing_at_900() -> StiffnessStudy {
    study(|method, factor| match method {
        Method::RungeKutta2 => Some(1e-4 * factor.sqrt()),
        Method::ImplicitMidpoint => Some(3e-3),
        _ => None,
    })
}

/// Every method, as a study of the garden could be.
fn full() -> StiffnessStudy {
    study(|method, factor| {
        let place = Method::ALL.iter().position(|other| *other == method).unwrap() as f64;
        match method {
            Method::Xpbd if factor > 10.0 => None,
            Method::ImplicitMidpoint | Method::ImplicitEuler | Method::Xpbd => Some(1e-3 * (1.0 + place)),
            _ => Some(2e-4 * (1.0 + place) * factor.sqrt().max(3.0)),
        }
    })
}

#[test]
fn a_root_and_a_constant_cross_where_they_must() {
    let crossed = crossing_at_900();
    let Crossing::From(factor, methods) = crossing(&crossed) else { panic!("{:?}", crossing(&crossed)) };
    assert!((factor / 900.0 - 1.0).abs() < 1e-12 && methods == [Method::ImplicitMidpoint], "{factor} {methods:?}");
    assert_eq!(
        stiffness::verdict(&crossed),
        "From 900 times the stiffness on an implicit method is the cheapest: ImplicitMidpoint."
    );
    let flat = |seconds: f64| {
        study(move |method, _| match method {
            Method::RungeKutta4 => Some(1e-3),
            Method::ImplicitEuler => Some(seconds),
            _ => None,
        })
    };
    assert_eq!(crossing(&flat(2e-3)), Crossing::Never);
    assert_eq!(
        stiffness::verdict(&flat(2e-3)),
        "Up to 10000 times the stiffness no implicit method wins: the cheapest there is RungeKutta4."
    );
    assert_eq!(crossing(&flat(5e-4)), Crossing::Always(vec![Method::ImplicitEuler]));
    // What wins in between and loses again has not won; what nothing else can do is won where it can be done.
    let between = study(|method, factor| match method {
        Method::RungeKutta4 => Some(1e-3),
        Method::Xpbd => Some(if factor == 10.0 { 1e-4 } else { 1e-2 }),
        _ => None,
    });
    assert_eq!(crossing(&between), Crossing::Never);
    let alone = study(|method, factor| match method {
        Method::RungeKutta4 => (factor < 500.0).then_some(1e-3),
        Method::ImplicitMidpoint => Some(1e-2),
        Method::ImplicitEuler => (factor > 5e3).then_some(5e-3),
        _ => None,
    });
    let winners = vec![Method::ImplicitMidpoint, Method::ImplicitEuler];
    assert_eq!(crossing(&alone), Crossing::From(1e3, winners));
    assert_eq!(
        stiffness::verdict(&alone),
        "From 1000 times the stiffness on an implicit method is the cheapest: ImplicitMidpoint, then ImplicitEuler. Cheaper \
         than every explicit method are: ImplicitMidpoint from 1000, ImplicitEuler from 10000."
    );
    assert_eq!(stiffness::verdict(&study(|_, _| None)), "No method is good enough at any step that was tried.");
}

#[test]
fn what_costs_a_root_is_drawn_with_slope_one_half_and_the_crossing_where_it_is() {
    let study = crossing_at_900();
    let plot = stiffness::plot(&study);
    let decade = [plot.x.place(10.0) - plot.x.place(1.0), plot.y.place(1.0) - plot.y.place(0.1)];
    assert!(decade[0] > 0.0 && decade[1] < 0.0, "stiffer is further right, dearer is higher");
    let svg = stiffness::svg(&study).unwrap();
    for (method, slope) in [(Method::RungeKutta2, 0.5), (Method::ImplicitMidpoint, 0.0)] {
        let look = Look::of(method, StickRule::InStages);
        let drawn: Vec<_> = marks(&svg, look.color).into_iter().filter(|place| place.0 < plot.frame.right).collect();
        assert_eq!(drawn.len(), 5, "{method:?}");
        for (place, scene) in drawn.iter().zip(&study.scenes) {
            let known = plot.place(scene.factor, scene.run(method).unwrap());
            assert!(libm::hypot(place.0 - known.0, place.1 - known.1) < 0.5, "{place:?} {known:?}");
            let up = (place.1 - drawn[0].1) / decade[1];
            let along = (place.0 - drawn[0].0) / decade[0];
            assert!((up - slope * along).abs() < 5e-3, "{method:?}: {up} decades up and {along} along");
        }
    }
    let [from, to] = plot.guide.unwrap();
    let slope = (to.1 - from.1) / decade[1] / ((to.0 - from.0) / decade[0]);
    assert!((slope - 0.5).abs() < 1e-9, "{slope}");
    let x = plot.crossing.unwrap();
    assert!((x - plot.x.place(900.0)).abs() < 1e-6);
    let picture = stiffness::picture(&study);
    let upright = |shape: &&Shape| {
        matches!(shape, Shape::Line { points, width: 2.2, .. }
        if points[..] == [(x, plot.frame.top), (x, plot.frame.bottom)])
    };
    assert_eq!(picture.shapes.iter().filter(upright).count(), 1);
    let says = |text: &str| picture.texts().any(|drawn| drawn.text.contains(text));
    assert!(says("from 900 on ImplicitMidpoint is the cheapest") && says("From 900 times the stiffness"));
    assert!(says("everywhere") && says("nowhere"));
}

#[test]
fn no_text_of_a_figure_of_stiffness_lies_over_another() {
    let nothing = StiffnessStudy { scenes: Vec::new(), ended: Some("of this".into()), ..full() };
    for study in [full(), crossing_at_900(), study(|_, _| None), nothing] {
        check_texts(&stiffness::picture(&study));
    }
    let absurd = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300];
    let study = study(|method, factor| Some(absurd[(method as usize + factor as usize) % absurd.len()]));
    for shape in stiffness::picture(&study).shapes {
        let places = match shape {
            Shape::Line { points, .. } | Shape::Area { points, .. } => points,
            Shape::Text(text) => vec![text.at],
        };
        assert!(places.iter().all(|(x, y)| x.abs() < 1e5 && y.abs() < 1e5), "{places:?}");
    }
}

#[test]
fn a_table_of_stiffness_reads_back_with_every_bit() {
    let study = StiffnessStudy { scene: "a, b".into(), ..full() };
    let table = stiffness_csv(&study);
    let mut lines = table.split_terminator("\r\n");
    assert_eq!(lines.next().unwrap(), STIFFNESS_COLUMNS.join(","));
    for scene in &study.scenes {
        for StiffRun { method, run } in &scene.runs {
            let line = lines.next().unwrap().strip_prefix("\"a, b\",").unwrap();
            let cells: Vec<_> = line.split(',').collect();
            assert_eq!((cells[0].parse(), cells[1]), (Ok(scene.factor), method.name()));
            let Some(run) = run else {
                assert_eq!(cells[2..], ["", "", "", "", "", ""]);
                continue;
            };
            let number = |i: usize| cells[i].parse::<f64>().unwrap();
            assert_eq!([2, 5, 6, 7].map(number), [run.setting.dt, run.seconds, run.median_seconds, 0.005]);
            assert_eq!((cells[3].parse(), cells[4].parse()), (Ok(run.steps), Ok(run.evaluations)));
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn a_study_stands_on_the_page_of_its_scene_and_is_kept() {
    let html = page(&[one()], &[crossing_at_900()]).unwrap();
    assert_eq!(html.matches("<svg").count(), 2);
    assert!(html.contains("<figcaption>From 900 times the stiffness") && html.contains("./garden-stiffness.csv"));
    let elsewhere = StiffnessStudy { scene: "snake".into(), ..crossing_at_900() };
    assert_eq!(page(&[one()], &[elsewhere]).unwrap().matches("<svg").count(), 1);

    let folder = TempDir::new().unwrap();
    let gallery = Gallery::open(folder.path()).unwrap();
    gallery.keep("a", &one()).unwrap();
    gallery.keep_study("b", &crossing_at_900()).unwrap();
    assert!(gallery.finished_study("garden", "b").is_some() && gallery.is_study_drawn("garden"));
    assert!(gallery.finished_study("garden", "a").is_none() && gallery.finished("garden", "a").is_some());
    let html = fs::read_to_string(gallery.write_page().unwrap()).unwrap();
    assert_eq!((html.matches("<h2>").count(), html.matches("<svg").count()), (1, 2), "a study is no chart of its own");
}

#[test]
fn an_interrupted_study_goes_on_where_it_stopped() {
    let folder = TempDir::new().unwrap();
    let gallery = Gallery::open(folder.path()).unwrap();
    let mut problem = Problem::of(&scenes::load("garden").unwrap()).unwrap();
    problem.duration = 0.5;
    let options = SweepOptions { quick: true, cache: Cache::none() };
    // How many runs are found before it ends, or is interrupted after so many.
    let study = |most: usize| {
        let mut partial = gallery.partial_study("garden", "a").unwrap();
        let mut found = 0;
        let mut find = |factor, _: &Problem, _: &Truth, method| {
            if let Some(run) = partial.known(factor, method) {
                return Ok(run);
            }
            if found == most {
                return Err(LabError::NothingFits { scene: "interrupted".into(), budget: 0.0 });
            }
            found += 1;
            // Some methods find nothing, which is known then, too.
            let seconds = factor * (1 + method as usize) as f64;
            let known = point(method, StickRule::InStages, 0.1, 2, Some(0.005));
            let run = (method != Method::Xpbd).then_some(Point { seconds, ..known });
            partial.push(StudiedRun { factor, run: StiffRun { method, run } }).unwrap();
            Ok(StiffRun { method, run })
        };
        let study = resumed_stiffness_study(&problem, &options, &mut find, &mut |_, _, _| {});
        (study, found)
    };
    let all = factors(true).len() * studied_methods().count();
    let (interrupted, found) = study(all - 3);
    assert!(interrupted.is_err() && found == all - 3);
    let file = gallery.file("garden-stiffness", "part.jsonl");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, &text[..text.len() - 9]).unwrap();
    let (whole, found) = study(usize::MAX);
    assert_eq!(found, 4, "those that were missing and the one that was cut off");
    let whole = whole.unwrap();
    let runs = || whole.scenes.iter().flat_map(|scene| scene.runs.iter().map(move |run| (scene.factor, run)));
    assert_eq!(runs().count(), all);
    for (factor, StiffRun { method, run }) in runs() {
        assert_eq!(
            run.map(|run| run.seconds),
            (*method != Method::Xpbd).then_some(factor * (1 + *method as usize) as f64)
        );
    }
    assert!(gallery.partial_study("garden", "b").unwrap().is_empty(), "another problem begins anew");
    gallery.keep_study("a", &whole).unwrap();
    assert!(!file.exists() && gallery.finished_study("garden", "a").is_some());
}

#[test]
fn stiffer_springs_keep_their_damping_ratio_and_the_way_that_the_worm_goes() {
    let problem = Problem::of(&scenes::load("garden").unwrap()).unwrap();
    let stiff = stiffened(&problem, 100.0).unwrap();
    assert!(stiff.hash() != problem.hash() && stiff.budget == problem.budget);
    for method in [Method::ExplicitEuler, Method::SemiImplicitEuler, Method::RungeKutta4] {
        let limit = |problem: &Problem| problem.stability_limit(method, StickRule::EndOfStep);
        let ratio = limit(&problem) / limit(&stiff);
        // Drag is not multiplied.
        assert!((9.0..11.0).contains(&ratio), "{method:?}: a step smaller by {ratio}");
    }
    let error = stiffened(&problem, f64::MAX).unwrap_err();
    assert!(matches!(error, LabError::Unsupported { .. }) && error.to_string().contains("stiffness"), "{error}");
}

#[test]
fn explicit_methods_pay_the_root_of_stiffness_and_implicit_ones_nothing() {
    let mut problem = Problem::of(&scenes::load("garden").unwrap()).unwrap();
    (problem.duration, problem.budget) = (6.0, 0.1);
    let options = SweepOptions { quick: true, cache: Cache::none() };
    let mut heard = Vec::new();
    let study = stiffness_study(&problem, &options, &mut |done, all, _| heard.push((done, all))).unwrap();
    let tried: Vec<_> = study.scenes.iter().map(|scene| scene.factor).collect();
    assert_eq!((tried.as_slice(), study.ended.as_ref()), (factors(true), None));
    let all = factors(true).len() * studied_methods().count();
    assert_eq!(heard.last(), Some(&(all, all)));
    for scene in &study.scenes {
        assert!(scene.reference_error < 1e-9, "{:e} at {}", scene.reference_error, scene.factor);
        for run in scene.runs.iter().filter_map(|run| run.run) {
            assert!(run.errors.unwrap().largest <= problem.budget && run.seconds > 0.0);
        }
    }
    let steps = |method| [2, 3].map(|i| study.scenes[i].run(method).unwrap().steps as f64);
    for method in [Method::SemiImplicitEuler, Method::StormerVerlet, Method::RungeKutta2, Method::RungeKutta4] {
        let [soft, stiff] = steps(method);
        assert!((stiff / soft / 10_f64.sqrt() - 1.0).abs() < 0.2, "{method:?}: {soft} steps, then {stiff}");
    }
}
