//! The spectrum of blocks, how large their steps may be, and how they bear their weight as a linear solid.

use bevy::{math::DVec3, prelude::*};
use faer::{Mat, Side, prelude::Solve};
use wriggle::{
    body::{MassDamping, Neighbours, Particles, Springs},
    creatures::{JellyPlan, Rotation},
    mechanics::{BodyParts, integrators::Method, stability_bound},
    physics::{Clock, Frozen, body_parts},
};

use crate::{
    jelly::{KINDS, app_of, body, cube, falling, shake},
    support::particles,
};

/// ω_max of 5³ with k = m = 1, for each of the kinds.
const OMEGA: [f64; 4] = [1.902, 3.204, 2.800, 3.804];

const TURNED: Rotation = Rotation { axis: (1.0, 2.0, 3.0), angle: 50.0 };

/// The stiffness matrix, unstretched.
pub(crate) fn stiffness(particles: &Particles, springs: &Springs) -> Mat<f64> {
    let mut matrix = Mat::zeros(3 * particles.len(), 3 * particles.len());
    for spring in springs.iter() {
        let [a, b] = spring.ends.map(|end| end.index());
        let [from, to] = spring.ends.map(|end| particles.position(end).unwrap());
        let along = (to - from).normalize();
        for i in 0..3 {
            for j in 0..3 {
                let value = spring.stiffness * along[i] * along[j];
                matrix[(3 * a + i, 3 * a + j)] += value;
                matrix[(3 * b + i, 3 * b + j)] += value;
                matrix[(3 * a + i, 3 * b + j)] -= value;
                matrix[(3 * b + i, 3 * a + j)] -= value;
            }
        }
    }
    matrix
}

fn eigenvalues(count: u32, kinds: &[Neighbours]) -> Vec<f64> {
    let body = body(cube(count, kinds, 0.0));
    stiffness(&body.particles, &body.springs).self_adjoint_eigenvalues(Side::Lower).unwrap()
}

#[test]
fn the_fastest_modes_and_the_mechanisms_are_those_of_theory() {
    for (kinds, omega) in KINDS.iter().zip(OMEGA) {
        let found = eigenvalues(5, kinds).last().unwrap().sqrt();
        assert!((found - omega).abs() < 6e-4, "{kinds:?}: {found}");
    }
    // 3N² − 6 mechanisms with edges alone, none with faces, three with cubes; six motions are rigid.
    for (kinds, mechanisms) in KINDS.iter().zip([3 * 16 - 6, 0, 3, 0]) {
        let free = eigenvalues(4, kinds).iter().filter(|value| value.abs() < 1e-10).count();
        assert_eq!(free, mechanisms + 6, "{kinds:?}");
    }
    // All springs alike: ω² is below 4k₁ + 8k₂ + 16k₃/3, 4.163².
    for (count, omega) in [(2, 2.828), (3, 3.310), (4, 3.680)] {
        let found = eigenvalues(count, KINDS[3]).last().unwrap().sqrt();
        assert!((found - omega).abs() < 6e-4 && found < 4.163, "{count}: {found}");
    }
}

#[test]
fn the_gauge_is_near_the_true_limit_and_never_above_it() {
    for (kinds, omega) in KINDS.iter().zip(OMEGA) {
        let (mut app, block) = app_of(cube(5, kinds, 0.0), Method::StormerVerlet, 0.1, 1);
        app.update();
        let bound = stability_bound(&body_parts(app.world().entity(block)).unwrap(), 0.0);
        let ratio = bound.rates[0].stiffness.sqrt() / omega;
        assert!((0.9998..1.05).contains(&ratio), "{kinds:?}: {ratio}");
    }
}

/// Whether a free block that trembles stays whole for 3000 steps and 400 units of time.
fn is_stable(plan: &JellyPlan, method: Method, damping: Option<MassDamping>, dt: f64) -> bool {
    worst_length(plan, method, damping, dt) <= 4.0
}

/// So often a block is looked at: less than a period of its slowest swing.
const STEPS_A_LOOK: u64 = 10;

/// The longest that a spring of a free block that trembles becomes, in rest lengths, over 3000 steps and 400 units of time or until it is longer than
/// four.
fn worst_length(plan: &JellyPlan, method: Method, damping: Option<MassDamping>, dt: f64) -> f64 {
    let steps = 3000.max((400.0 / dt) as u64);
    let (mut app, block) = app_of(plan.clone(), method, dt, STEPS_A_LOOK);
    if let Some(damping) = damping {
        app.world_mut().entity_mut(block).insert(damping);
    }
    shake(&mut app, block, 1e-3);
    if plan.neighbours.faces.is_none() && plan.neighbours.cubes.is_none() {
        // Nothing holds edges alone against shear: their layers tremble as a whole.
        let mut particles = app.world_mut().get_mut::<Particles>(block).unwrap();
        for i in (0..particles.len() as u32).map(wriggle::body::ParticleId) {
            let particle = particles.get(i).unwrap();
            let layer = particle.position.y.round() as u32;
            let velocity = DVec3::Y * 1e-3 * (f64::from(layer * 5 % 13) / 13.0 - 0.5);
            particles.set(i, wriggle::body::Particle { velocity, ..particle }).unwrap();
        }
    }
    let springs = app.world().get::<Springs>(block).unwrap().clone();
    let mut worst = 0.0_f64;
    while app.world().resource::<Clock>().step() < steps && worst <= 4.0 {
        app.update();
        if app.world().entity(block).contains::<Frozen>() {
            return f64::INFINITY;
        }
        let places: Vec<DVec3> = particles(&app, block).positions().collect();
        let length = |ends: [wriggle::body::ParticleId; 2]| places[ends[0].index()].distance(places[ends[1].index()]);
        worst = springs.iter().map(|spring| length(spring.ends) / spring.rest_length).fold(worst, f64::max);
    }
    worst
}

/// The largest stable step between two.
fn bisected(mut low: f64, mut high: f64, stable: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..5 {
        let middle = 0.5 * (low + high);
        if stable(middle) { low = middle } else { high = middle }
    }
    low
}

#[test]
fn the_largest_steps_are_two_over_the_fastest_frequency() {
    for (kinds, omega) in KINDS.into_iter().zip(OMEGA) {
        // Turned, but edges alone.
        let rotation = (kinds.len() > 1).then_some(TURNED);
        let plan = JellyPlan { rotation, ..cube(5, kinds, 0.0) };
        let limit = 2.0 / omega;
        let [symplectic, verlet] = [Method::SemiImplicitEuler, Method::StormerVerlet]
            .map(|method| bisected(0.94 * limit, 1.06 * limit, |dt| is_stable(&plan, method, None, dt)));
        assert!((symplectic / limit - 1.0).abs() < 0.04, "{kinds:?}: {symplectic} of {limit}");
        assert!((verlet / limit - 1.0).abs() < 0.04, "{kinds:?}: {verlet} of {limit}");
        assert!((verlet / symplectic - 1.0).abs() < 0.01, "{kinds:?}: {verlet} and {symplectic}");
        assert!(!is_stable(&plan, Method::ExplicitEuler, None, limit / 50.0), "{kinds:?}");
    }
}

#[test]
fn damping_by_step_lowers_the_largest_step() {
    // λ = .5: √(4 − 2λ)/ω.
    let plan = JellyPlan { rotation: Some(TURNED), ..cube(5, KINDS[3], 0.0) };
    let theory = 3.0_f64.sqrt() / OMEGA[3];
    let damping = Some(MassDamping::per_step(0.5).unwrap());
    let found = bisected(0.9 * theory, 1.1 * theory, |dt| is_stable(&plan, Method::DampedVerlet, damping, dt));
    assert!((found / theory - 1.0).abs() < 0.05, "{found} of {theory}");
    // The prototype found .466.
    assert!((found / 0.466 - 1.0).abs() < 0.05, "{found}");
    // What is told before anything explodes is lower by the same.
    let body = body(plan);
    let told = |mass_damping| {
        let parts = BodyParts { mass_damping, ..BodyParts::new(&body.particles, &body.springs, Method::DampedVerlet) };
        parts.stability_limit(0.0)
    };
    let ratio = told(damping) / told(None);
    assert!((ratio - 0.5 * 3.0_f64.sqrt()).abs() < 1e-3, "{ratio}");
}

#[test]
fn damped_strongly_a_block_rattles_within_bounds_above_its_limit() {
    let damping = Some(MassDamping::per_step(0.5).unwrap());
    let plan = cube(5, KINDS[0], 0.0);
    let theory = 3.0_f64.sqrt() / OMEGA[0];
    // Below the limit of the linear block the trembling never grows; above it it grows a hundredfold, and no further.
    let below = worst_length(&plan, Method::DampedVerlet, damping, 0.99 * theory);
    assert!(below < 1.01, "{below}");
    let above = worst_length(&plan, Method::DampedVerlet, damping, 1.03 * theory);
    assert!(above > 1.2 && above < 4.0, "{above}");
}

/// How far the masses of a block at rest are from the solution of K u = f at the most, in the largest length of u. It starts with a tremble of this speed.
fn off_linear(kinds: &[Neighbours], damping: f64, steps: u64, speed: f64) -> f64 {
    let gravity = 1e-4;
    let (mut app, block) =
        falling(cube(4, kinds, 0.0), Method::DampedVerlet, Some(MassDamping::Rate(damping)), 0.25, steps);
    app.world_mut().entity_mut(block).insert(wriggle::body::Gravity::new(gravity).unwrap());
    let start = particles(&app, block).clone();
    shake(&mut app, block, speed);
    app.update();
    let at_rest = particles(&app, block);
    // What stands on the floor is held up; the rest bears the weight.
    let mut matrix = stiffness(&start, app.world().get::<Springs>(block).unwrap());
    let size = matrix.nrows();
    let mut weight = Mat::<f64>::zeros(size, 1);
    for i in 0..at_rest.len() {
        weight[(3 * i + 1, 0)] = -gravity;
        if start.position(wriggle::body::ParticleId(i as u32)).unwrap().y == 0.0 {
            matrix[(3 * i + 1, 3 * i + 1)] += 1e9;
        }
        for k in 0..3 {
            // Nothing holds it sideways, and nothing pushes it.
            matrix[(3 * i + k, 3 * i + k)] += 1e-9;
        }
    }
    let solved = matrix.partial_piv_lu().solve(&weight);
    let change = |i: usize| DVec3::new(solved[(3 * i, 0)], solved[(3 * i + 1, 0)], solved[(3 * i + 2, 0)]);
    let moved: Vec<DVec3> = at_rest.positions().zip(start.positions()).map(|(now, then)| now - then).collect();
    let most = (0..moved.len()).map(|i| change(i).length()).fold(0.0, f64::max);
    (0..moved.len()).map(|i| (moved[i] - change(i)).length()).fold(0.0, f64::max) / most
}

#[test]
fn a_block_at_rest_is_the_solution_of_its_linear_equations() {
    for kinds in [KINDS[1], KINDS[3]] {
        let off = off_linear(kinds, 0.3, 8000, 0.0);
        assert!(off < 0.01, "{kinds:?}: {off}");
    }
}

#[test]
fn without_face_diagonals_a_block_buckles_along_its_mechanisms() {
    // The linear solution is no rest: the weight squeezes springs, which take stiffness away where mechanisms have none, and any tremble grows.
    let off = off_linear(KINDS[2], 0.02, 16000, 1e-5);
    assert!(off > 5.0, "{off}");
}
