//! What is chosen for a scene: the cheapest method and step that are good enough.

use std::fs;

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, Muscle, Muscles, Particle, ParticleId, Particles, Spring, SpringId, Springs, Wave},
    creatures::library,
    lab::{
        Cache, Candidate, GaitSpeeds, LabError, Problem, ProblemBody, Reference, Search, Setting, Truth, Unit,
        cheapest, choose, frontier, measure,
    },
    mechanics::integrators::Method,
    scenes,
};

use crate::{
    lab::{SETTING, worm},
    support::Worm,
};

/// A candidate of a made-up study, told apart from others by its step.
fn candidate(dt: f64, error: Option<f64>, cost: f64) -> Candidate {
    Candidate { setting: Setting { dt, ..SETTING }, error, cost }
}

#[test]
fn the_cheapest_candidate_within_the_budget_is_chosen() {
    let cheap_but_bad = candidate(8.0, Some(1.1), 10.0);
    let cheap_but_blown = candidate(7.0, None, 5.0);
    let dear = candidate(1.0, Some(0.01), 100.0);
    let good = candidate(4.0, Some(0.9), 20.0);
    let as_cheap_and_better = candidate(3.0, Some(0.5), 20.0);
    let beaten = candidate(2.0, Some(0.6), 30.0);
    let all = [cheap_but_bad, dear, good, cheap_but_blown, beaten, as_cheap_and_better];
    assert_eq!(cheapest(&all, 1.0), Some(as_cheap_and_better));
    assert_eq!(cheapest(&all, 0.1), Some(dear));
    assert_eq!(cheapest(&all, 2.0), Some(cheap_but_bad));
    assert_eq!(cheapest(&all, 1e-3), None);
    assert_eq!(frontier(&all), [cheap_but_bad, as_cheap_and_better, dear]);
}

#[test]
fn the_choice_for_the_exact_worm_keeps_its_promises() {
    let mut problem = worm(Worm::EXACT.body());
    (problem.budget, problem.duration) = (1e-2, 6.0);
    let reference = Reference::solve(&problem).unwrap();
    let mut heard = Vec::new();
    let truth = Truth::Positions(reference);
    let found = choose(&problem, &truth, Search::Cheapest, &mut |done, total, _| heard.push((done, total))).unwrap();
    let Candidate { setting, error, cost } = found.choice;
    assert!(error.unwrap() <= 1e-2 && cost > 0.0, "{found:?}");
    assert!(setting.dt <= 0.5 * problem.stability_limit(setting.method, setting.stick));
    for part in [1.0, 0.9, 0.8] {
        let errors = measure(&problem, &truth, Setting { dt: part * setting.dt, ..setting }, 1).errors.unwrap();
        assert!(errors.largest <= error.unwrap());
    }
    // An order of one: the step of its method that is good enough is known, and dearer.
    let document = found.document.unwrap();
    assert!(document.error.unwrap() < 1.2e-3 && (document.cost - 12_000.0).abs() < 1.0, "{found:?}");
    assert!(cost < 600.0, "{found:?}");
    assert_eq!(heard.last(), Some(&(Method::ALL.len(), Method::ALL.len())));
    // What nothing can keep is said.
    (problem.budget, problem.duration) = (0.0, 0.1);
    let truth = Truth::of(&problem, &Cache::none()).unwrap();
    let error = choose(&problem, &truth, Search::Cheapest, &mut |_, _, _| {}).unwrap_err();
    assert!(error.to_string().contains("worm: no method keeps the error within"), "{error}");
}

#[test]
fn the_command_prints_its_choice_and_keeps_the_reference() {
    let folder = tempfile::tempdir().unwrap();
    // A worm so quick that all of its ten cycles are a few hundred steps.
    let text = r#"Creature(version: 1,
      body: Raw(
        particles: [(position: (0, 0, 0), mass: 1), (position: (1, 0, 0), mass: 1)],
        springs: [(ends: (0, 1), stiffness: 90000, damping: 180, rest_length: 1,
                   muscle: (wave: Sine, amplitude: 0.25, period: 0.005, phase: 0, ramp: 0))],
        spine: [0, 1]),
      friction: (ratchet: true, drag: 1, grip: 0))"#;
    fs::write(folder.path().join("quick.creature.ron"), text).unwrap();
    let wriggle = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_wriggle"));
        command.args(arguments).current_dir(folder.path()).env("WRIGGLE_CACHE", folder.path().join("kept"));
        command.output().unwrap()
    };
    let output = wriggle(&["choose", "quick.creature.ron", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let budget = found["budget"].as_f64().unwrap();
    let chosen = &found["choice"];
    assert!(chosen["error"].as_f64().unwrap() <= budget);
    assert!(found["frontier"].as_array().unwrap().contains(chosen));
    let costs: Vec<_> = found["frontier"].as_array().unwrap().iter().map(|row| row["cost"].as_f64().unwrap()).collect();
    assert!(costs.is_sorted() && costs.len() > 3, "{costs:?}");
    assert_eq!(found["document"]["setting"]["dt"], 0.0005);
    assert_eq!(fs::read_dir(folder.path().join("kept")).unwrap().count(), 1);
    let output = wriggle(&["choose", "quick.creature.ron"]);
    let text = String::from_utf8(output.stdout).unwrap();
    // Two methods may cost about the same time, and the other may win now.
    let methods = found["frontier"].as_array().unwrap().iter().map(|row| row["setting"]["method"].as_str().unwrap());
    let said = text.split("cheapest within the budget").nth(1).unwrap_or_default();
    assert!(methods.into_iter().any(|method| said.contains(method)), "{text}");
    // Without the frontier the choice is the same.
    let output = wriggle(&["choose", "quick.creature.ron", "--cheapest"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("cheapest within the budget") && !text.contains("frontier"), "{text}");
    // A scene that is not there is the same error as everywhere.
    let said = |command| String::from_utf8(wriggle(&[command, "gardn"]).stderr).unwrap();
    assert_eq!(wriggle(&["choose", "gardn"]).status.code(), Some(2));
    assert_eq!(said("choose"), said("run"));
}

#[test]
fn gaits_are_chosen_by_their_speed() {
    let problem = Problem::of(&scenes::load("two-masses").unwrap()).unwrap();
    let truth = Truth::of(&problem, &Cache::none()).unwrap();
    let found = choose(&problem, &truth, Search::Frontier, &mut |_, _, _| {}).unwrap();
    assert_eq!((found.unit, found.budget, found.document), (Unit::PartOfSpeed, 0.01, None));
    assert!(found.choice.error.unwrap() <= 0.01, "{found:?}");
    // What tells the truth is not judged by it.
    assert!(found.frontier.iter().all(|candidate| candidate.setting.method != GaitSpeeds::METHOD), "{found:?}");
}

/// A double pendulum that is let go from a level line, with a muscle that hardly does anything but give it a cycle of 10 units of time.
fn double_pendulum() -> Problem {
    let at = |x: f64| Particle::at(DVec3::X * x);
    let particles = Particles::new([Particle { pinned: true, ..at(0.0) }, at(1.0), at(2.0)]).unwrap();
    let spring = |a| Spring { ends: [a, a + 1].map(ParticleId), stiffness: 100.0, damping: 0.0, rest_length: 1.0 };
    let springs = Springs::new([0, 1].map(spring), &particles).unwrap();
    let muscle = Muscle { spring: SpringId(0), wave: Wave::Sine, amplitude: 1e-3, period: 10.0, phase: 0.0, ramp: 0.0 };
    let body = ProblemBody {
        muscles: Some(Muscles::new([muscle], &springs).unwrap()),
        friction: None,
        gravity: Some(Gravity::new(1.0).unwrap()),
        particles,
        springs,
        ..worm(Worm::EXACT.body()).bodies.remove(0)
    };
    let problem = Problem::new("pendulum", vec![body], SETTING);
    Problem { unit: Unit::PartOfSpeed, budget: 0.01, ..problem }
}

#[test]
fn what_is_chaotic_is_judged_for_as_long_as_its_motion_is_known() {
    let cache = Cache::none();
    let problem = double_pendulum();
    // Errors of a thousand-millionth become all there is before that.
    assert_eq!(problem.duration, 100.0);
    let unknown = Truth::of(&problem, &cache).unwrap_err().to_string();
    assert!(unknown.contains("pendulum: ") && unknown.contains("speeds change by"), "{unknown}");
    let (shorter, truth) = Truth::as_far_as_known(problem.clone(), &cache).unwrap();
    let cycles = shorter.duration / 10.0;
    assert!(shorter.shortened && (2.0..=8.0).contains(&cycles) && cycles.fract() == 0.0, "{cycles} cycles");
    assert!(truth.error() <= 0.25 * 0.01, "{}", truth.error());
    // Low orders need steps for that that nobody waits for; for a half of the speed they do not.
    let easy = Problem { budget: 0.5, ..shorter.clone() };
    let found = choose(&easy, &truth, Search::Cheapest, &mut |_, _, _| {}).unwrap();
    assert!((found.duration, found.shortened) == (shorter.duration, true) && found.choice.error.unwrap() <= 0.5);
    // What is known to the end is not cut short, and what no cycle is known of is said.
    let calm = Problem { budget: 0.01, ..Problem::of(&scenes::load("two-masses").unwrap()).unwrap() };
    let (whole, _) = Truth::as_far_as_known(calm.clone(), &cache).unwrap();
    assert_eq!((whole.duration, whole.shortened), (calm.duration, false));
    let hopeless = Problem { budget: 1e-15, ..problem };
    let whole = Truth::of(&hopeless, &cache).unwrap_err();
    assert_eq!(Truth::as_far_as_known(hopeless, &cache).unwrap_err().to_string(), whole.to_string());
}

/// Whether the setting of a scene is good enough, and not 1.5 times as dear as the cheapest.
fn is_well_chosen(name: &str) {
    let problem = Problem::of(&scenes::load(name).unwrap()).unwrap();
    let unit = problem.unit;
    let (problem, truth) = match Truth::as_far_as_known(problem, &Cache::none()) {
        // What is budgeted in pixels and has no reference keeps the step of its document.
        Err(LabError::Unsupported { .. }) if unit == Unit::Length => return,
        known => known.unwrap(),
    };
    let found = choose(&problem, &truth, Search::Cheapest, &mut |_, _, _| {}).unwrap();
    let Candidate { setting, error, cost } = found.own;
    assert!(error.is_some_and(|error| error <= found.budget), "{name}: {error:?} of {}", found.budget);
    let Candidate { setting: cheapest, cost: mut least, .. } = found.choice;
    if cfg!(debug_assertions) && cheapest.method.about().evaluations.is_none() {
        // The time of a step that is not optimised says nothing; its evaluations are counted.
        least = least.max(measure(&problem, &truth, cheapest, 1).evaluations as f64);
    }
    assert!(cost <= 1.5 * least, "{name}: {cost}, and {:?} costs {least}", found.choice);
    let limit = problem.stability_limit(setting.method, setting.stick);
    assert!(setting.dt <= 0.5 * limit, "{name}: {} of {limit}", setting.dt);
}

/// What the bodies of a scene are.
#[derive(Clone, Copy, PartialEq)]
enum Made {
    OfStrands,
    OfBlocks,
    Otherwise,
}

/// The shipped scenes whose settings are chosen. The document's preset is what the document says, and a race is about what is not chosen.
fn chosen(made: Made) -> impl Iterator<Item = String> {
    library::list(library::SCENE).into_keys().filter(move |name| {
        let scene = scenes::load(name).unwrap();
        // The six-matrix particle system has one step and no method.
        let Ok(problem) = Problem::of(&scene) else { return false };
        let own = match problem.unit {
            Unit::PartOfCell => Made::OfBlocks,
            _ if problem.bodies.iter().any(|body| body.strand.is_some()) => Made::OfStrands,
            _ => Made::Otherwise,
        };
        name != "document" && scene.file.truth.is_none() && own == made
    })
}

#[test]
fn shipped_scenes_are_stepped_no_finer_and_no_coarser_than_they_need() {
    chosen(Made::Otherwise).for_each(|name| is_well_chosen(&name));
}

#[test]
fn shipped_blocks_are_stepped_no_finer_and_no_coarser_than_they_need() {
    let blocks: Vec<_> = chosen(Made::OfBlocks).collect();
    assert_eq!(blocks, ["jelly", "jelly-lab", "jelly-template"]);
    blocks.iter().for_each(|name| is_well_chosen(name));
}

#[test]
#[ignore = "takes minutes: cargo test --release --test it -- --ignored no_coarser"]
fn shipped_strands_are_stepped_no_finer_and_no_coarser_than_they_need() {
    chosen(Made::OfStrands).for_each(|name| is_well_chosen(&name));
}
