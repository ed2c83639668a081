//! From which stiffness on implicit methods win: what the cheapest run of each method that is good enough costs when springs get stiffer.
//!
//! Every stiffness of a scene is multiplied by a factor and every damping by its root, so that each spring keeps its damping ratio. Springs then follow
//! their muscles ever more closely: the motion that is seen comes to a limit (the study says how far the body goes), while the fastest oscillation goes as the root of the factor and dies
//! away within the same number of its periods. It is also the fairest to explicit methods. With damping in proportion to stiffness their step would
//! have to shrink with the factor itself, and with the damping held the stiff oscillation would not die away, and had to be followed.

mod crossing;
mod find;
mod record;
mod table;

use crate::{
    body::{SpringId, Springs},
    lab::{LabError, Problem, Reference, SweepOptions, Truth, machine::machine, sweep::work},
    mechanics::integrators::{Method, StickRule},
};

pub use crossing::{Crossing, crossing, crossing_of};
pub use find::cheapest_run;
pub use record::{StiffRun, StiffScene, StiffnessStudy};
pub use table::{STIFFNESS_COLUMNS, stiffness_csv};

/// The methods that are compared: all but the exact flow, whose step only says when it is looked at, so that it cannot be chosen by its error.
pub fn studied_methods() -> impl Iterator<Item = Method> {
    Method::ALL.into_iter().filter(|method| *method != Method::ExactFlow)
}

/// By how much stiffnesses are multiplied.
pub fn factors(quick: bool) -> &'static [f64] {
    if quick { &[1.0, 10.0, 100.0, 1e3] } else { &[1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5] }
}

/// The problem with every stiffness `factor` times as large, and every damping as many times as its root.
///
/// # Errors
/// If a stiffness is too large for a number then.
pub fn stiffened(problem: &Problem, factor: f64) -> Result<Problem, LabError> {
    let mut stiff = problem.clone();
    for body in &mut stiff.bodies {
        stiffen(&mut body.springs, factor).map_err(|problem| LabError::Unsupported {
            scene: stiff.name.clone(),
            what: format!("stiffnesses {factor} times as large ({problem})"),
        })?;
    }
    Ok(stiff)
}

fn stiffen(springs: &mut Springs, factor: f64) -> Result<(), crate::body::BodyError> {
    for i in 0..springs.len() as u32 {
        if let Some(mut spring) = springs.get(SpringId(i)) {
            spring.stiffness *= factor;
            spring.damping *= factor.sqrt();
            springs.set(SpringId(i), spring)?;
        }
    }
    Ok(())
}

/// Finds the cheapest run of every method that is good enough at every factor; see [`cheapest_run`]. Where the reference cannot be had any more, the study ends and says why.
/// `progress` hears how many of how many searches are done and what comes next.
///
/// # Errors
/// If the problem as it is has no reference.
pub fn stiffness_study(
    problem: &Problem,
    options: &SweepOptions,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> Result<StiffnessStudy, LabError> {
    let find = &mut |_, stiff: &Problem, truth: &Truth, method| {
        Ok(StiffRun { method, run: cheapest_run(stiff, truth, method, options) })
    };
    resumed_stiffness_study(problem, options, find, progress)
}

/// Finds the run of a method, given the factor, the problem with that and its truth.
pub type FindRun<'a, E> = dyn FnMut(f64, &Problem, &Truth, Method) -> Result<StiffRun, E> + 'a;

/// As [`stiffness_study`], with runs by `find`, which may know some of them already.
///
/// # Errors
/// If the problem as it is has no reference, and the first one of `find`.
pub fn resumed_stiffness_study<E: From<LabError>>(
    problem: &Problem,
    options: &SweepOptions,
    find: &mut FindRun<'_, E>,
    progress: &mut dyn FnMut(usize, usize, &str),
) -> Result<StiffnessStudy, E> {
    let factors = factors(options.quick);
    let methods: Vec<_> = studied_methods().collect();
    let all = factors.len() * methods.len();
    let mut study = StiffnessStudy {
        scene: problem.name.clone(),
        title: problem.title.clone(),
        duration: problem.duration,
        budget: problem.budget,
        repeats: options.repeats(),
        scenes: Vec::new(),
        ended: None,
        reference: Reference::WORDS.into(),
        machine: machine(),
    };
    for (i, &factor) in factors.iter().enumerate() {
        let done = i * methods.len();
        progress(done, all, &format!("reference at {factor} times the stiffness"));
        let solved = stiffened(problem, factor).and_then(|stiff| {
            if i > 0 && takes_long(&stiff, options) {
                return Err(LabError::Unsupported {
                    scene: stiff.name,
                    what: format!("stiffnesses × {factor} in reasonable time"),
                });
            }
            let reference = options.cache.reference(&stiff)?;
            let way = way(&stiff, &reference);
            Ok((stiff, Truth::Positions(reference), way))
        });
        let (stiff, truth, way) = match solved {
            Ok(solved) => solved,
            Err(error) if i == 0 => return Err(error.into()),
            Err(error) => {
                study.ended = Some(error.to_string());
                break;
            }
        };
        let runs = methods.iter().enumerate().map(|(j, &method)| {
            progress(done + j, all, &format!("{} at {factor} times the stiffness", method.name()));
            find(factor, &stiff, &truth, method)
        });
        let runs = runs.collect::<Result<Vec<_>, E>>()?;
        study.scenes.push(StiffScene { factor, way, reference_error: truth.error(), runs });
    }
    progress(all, all, "done");
    Ok(study)
}

/// Whether the reference takes longer than half a minute, or in a quick study five seconds: it follows the fastest oscillation in small steps.
fn takes_long(problem: &Problem, options: &SweepOptions) -> bool {
    let method = Method::SemiImplicitEuler;
    let most = if options.quick { 2e5 } else { 1e6 };
    work(problem, method, problem.stability_limit(method, StickRule::EndOfStep)) > most
}

/// The longest way that the centre of mass of a body goes.
fn way(problem: &Problem, reference: &Reference) -> f64 {
    let last = problem.times().len() - 1;
    let ways = problem.bodies.iter().enumerate().map(|(i, body)| {
        let start: Vec<_> = body.particles.positions().collect();
        super::run::center(body, reference.positions(i, last)).distance(super::run::center(body, &start))
    });
    ways.fold(0.0, f64::max)
}
