//! How blocks fall and keep their shape, as the budget of a scene asks for it.

use std::fs;

use wriggle::{
    body::{Gravity, Ground, Neighbours},
    creatures::{Creature, JellyPlan, NeighboursPlan, Pose, SpringPlan},
    lab::{Cache, LabError, Problem, ProblemBody, Search, Setting, Shapes, Truth, Unit, choose, measure},
    mechanics::integrators::{Method, StickRule},
    scenes::{self, Budget},
};

use crate::jelly::cube;

const SETTING: Setting = Setting { method: Method::SemiImplicitEuler, stick: StickRule::InStages, dt: 0.1 };

/// A block alone, followed for 20 units of time.
fn problem(plan: JellyPlan) -> Problem {
    let body = Creature::from(plan).body(Pose::default()).unwrap();
    let body = ProblemBody {
        name: "block".into(),
        lattice: body.block.map(|(lattice, _)| lattice),
        particles: body.particles,
        springs: body.springs,
        muscles: None,
        strand: None,
        tearing: None,
        waves: None,
        friction: None,
        coulomb: None,
        gravity: None,
        ground: None,
        mass_damping: None,
    };
    Problem { unit: Unit::PartOfCell, ..Problem::new("block", vec![body], SETTING) }
}

/// A scene with blocks of 3³ that fall by a little, as its file has it.
fn scene(budget: &str, dt: f64) -> Result<scenes::LoadedScene, scenes::FileError> {
    let folder = tempfile::tempdir().unwrap();
    let block = "Creature(version: 1, body: Jelly(size: (3, 3, 3), tilt: 20, drop: 0.1, neighbours: (edges: (stiffness: 1), faces: (stiffness: 1))),
      damping: Rate(0.1), ground: Flat, gravity: 0.01)";
    fs::write(folder.path().join("block.creature.ron"), block).unwrap();
    let file = folder.path().join("small.scene.ron");
    let text = format!(
        "Scene(version: 1, title: \"Small\", gravity: 0.01, ground: Flat, creatures: [(name: \"block\", creature: \"block\")],
           clock: (dt: {dt}, time_scale: 40), method: StormerVerlet, budget: {budget})"
    );
    fs::write(&file, text).unwrap();
    scenes::load(file.to_str().unwrap())
}

#[test]
fn the_height_of_a_falling_block_is_compared_in_spacings() {
    let mut problem = problem(JellyPlan { tilt: 10.0, drop: 50.0, ..cube(3, &Neighbours::ALL, 0.0) });
    problem.bodies[0].gravity = Gravity::new(0.01).ok();
    let shapes = Shapes::solve(&problem).unwrap();
    // Runge–Kutta knows a parabola; semi-implicit Euler falls behind it by g·t·dt/2.
    assert!(shapes.error() < 1e-6, "{:e}", shapes.error());
    let errors = measure(&problem, &Truth::Shapes(shapes), SETTING, 1).errors.unwrap();
    let behind = 0.5 * 0.01 * 20.0 * 0.1;
    assert!((errors.largest - behind).abs() < 1e-7 && (errors.distance - behind).abs() < 1e-9, "{errors:?}");
    // Of three measures the height is wrong, and grows evenly.
    assert!((errors.rms - behind / 3.0).abs() < 0.01 * behind, "{errors:?}");
}

#[test]
fn the_shape_and_the_volume_of_a_block_are_compared() {
    let still = |factor: f64| {
        let spring = SpringPlan { stiffness: 0.0, damping: 0.0 };
        let neighbours = NeighboursPlan::alike(&[Neighbours::Edges], spring);
        let mut problem = problem(JellyPlan { neighbours, ..cube(2, &[], 0.0) });
        let particles = &mut problem.bodies[0].particles;
        for i in 0..8 {
            let mut particle = particles.get(wriggle::body::ParticleId(i)).unwrap();
            particle.position = particle.position * factor - 0.5 * (factor - 1.0) * bevy::math::DVec3::Y;
            particles.set(wriggle::body::ParticleId(i), particle).unwrap();
        }
        problem
    };
    let truth = Truth::Shapes(Shapes::solve(&still(1.0)).unwrap());
    assert_eq!(measure(&still(1.0), &truth, SETTING, 1).errors.unwrap().largest, 0.0);
    let errors = measure(&still(1.1), &truth, SETTING, 1).errors.unwrap();
    // Every mass is 0.1 · √¾ from where it was, and the middle where it was.
    let (shape, volume) = (0.1 * 0.75_f64.sqrt(), 1.1_f64.powi(3) - 1.0);
    assert!((errors.largest - volume).abs() < 1e-9, "{errors:?}");
    assert!((errors.rms - ((shape * shape + volume * volume) / 3.0).sqrt()).abs() < 1e-7, "{errors:?}");
    assert!(errors.distance < 1e-12, "{errors:?}");
    // A block that is turned inside out is not one that is as large.
    assert!(measure(&still(-1.0), &truth, SETTING, 1).errors.unwrap().largest > 1.9);
}

#[test]
fn a_budget_of_shapes_is_read_and_chooses() {
    let loaded = scene("Shape(part: 0.01, until: 300)", 0.3).unwrap();
    assert_eq!(loaded.file.budget, Budget::Shape { part: 0.01, until: 300.0 });
    let problem = Problem::of(&loaded).unwrap();
    assert_eq!((problem.unit, problem.budget, problem.duration), (Unit::PartOfCell, 0.01, 300.0));
    let truth = Truth::of(&problem, &Cache::none()).unwrap();
    // Half the step changes little, though masses hit the ground: the block is damped.
    assert!(truth.error() < 1e-4, "{:e}", truth.error());
    let found = choose(&problem, &truth, Search::Cheapest, &mut |_, _, _| {}).unwrap();
    assert!(found.choice.error.unwrap() <= 0.01 && found.document.is_none(), "{found:?}");
    assert!(found.choice.setting.method != Shapes::METHOD);
    let step = |dt| measure(&problem, &truth, Setting { dt, ..SETTING }, 1).errors.unwrap().largest;
    let (coarse, fine) = (step(0.2), step(0.05));
    assert!(coarse > 2.0 * fine && fine > 0.0, "{coarse:e} and {fine:e}");
    assert!(measure(&problem, &truth, Setting { dt: 1.0, ..SETTING }, 1).errors.is_none(), "blows up");
    for (bad, words) in
        [("part: 0, until: 9", "above 0"), ("part: 0.01, until: -1", "above 0"), ("part: 0.01", "until")]
    {
        let problem = scene(&format!("Shape({bad})"), 0.3).unwrap_err().to_string();
        assert!(problem.contains(words), "{bad}: {problem}");
    }
}

#[test]
fn what_has_no_shape_to_be_told_is_refused_by_name() {
    let truth_of = |problem: &Problem| Truth::of(problem, &Cache::none()).unwrap_err();
    // A bounce amid nothing that damps it, told to a thousand millionth.
    let mut problem = Problem::of(&scene("Shape(part: 1e-12, until: 50)", 0.3).unwrap()).unwrap();
    let error = truth_of(&problem).to_string();
    assert!(error.contains("small: there is no reference solution of blocks whose shapes change by"), "{error}");
    assert!(Cache::none().reference(&problem).unwrap_err().to_string().contains("a shape within"));
    problem.bodies[0].lattice = None;
    let error = truth_of(&problem);
    assert!(matches!(error, LabError::Unsupported { .. }) && error.to_string().contains("`block`, which is no block"));
}

#[test]
fn shapes_are_kept_and_those_of_another_problem_are_others() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::at(folder.path());
    let mut problem = problem(JellyPlan { tilt: 10.0, drop: 0.2, ..cube(2, &Neighbours::ALL, 0.0) });
    (problem.bodies[0].gravity, problem.bodies[0].ground) = (Gravity::new(0.01).ok(), Some(Ground::Flat));
    let found = cache.shapes(&problem).unwrap();
    let files = || fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>();
    let [file] = &files()[..] else { panic!("{:?}", files()) };
    assert_eq!((Shapes::solve(&problem).unwrap(), cache.shapes(&problem).unwrap()), (found.clone(), found.clone()));
    // Files of another kind, cut off or damaged count as none.
    let whole = fs::read(file).unwrap();
    for damaged in [whole[..whole.len() - 8].to_vec(), whole.iter().map(|byte| byte ^ 1).collect()] {
        fs::write(file, damaged).unwrap();
        assert_eq!(cache.shapes(&problem).unwrap(), found);
        assert_eq!(fs::read(file).unwrap(), whole);
    }
    problem.bodies[0].ground = None;
    assert_ne!(cache.shapes(&problem).unwrap(), found);
    assert_eq!(files().len(), 2);
}
