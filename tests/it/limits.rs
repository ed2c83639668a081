//! How large a step may be: closed forms, eigenvalues, the step's own growth and the cheap bound against each other.

use bevy::math::DVec3;
use wriggle::{
    body::{Gravity, MassDamping, Particle, ParticleId, Particles, Spring, Springs, Tearing},
    lab::{
        Problem,
        limits::{growth, limits, linearised_limit, predicted_limit, scene_limit},
    },
    mechanics::{
        BodyParts,
        integrators::{Method, StickRule},
    },
};

use crate::support::Worm;

fn parts<'a>((particles, springs): &'a (Particles, Springs), method: Method) -> BodyParts<'a> {
    BodyParts::new(particles, springs, method)
}

/// A mass of 1 on a pinned spring of stiffness 1.
fn oscillator(ratio: f64) -> (Particles, Springs) {
    let pinned = Particle { pinned: true, ..Particle::at(DVec3::ZERO) };
    let particles = Particles::new([pinned, Particle::at(DVec3::X)]).unwrap();
    let ends = [ParticleId(0), ParticleId(1)];
    let spring = Spring { ends, stiffness: 1.0, damping: 2.0 * ratio, rest_length: 1.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    (particles, springs)
}

/// The damping ratios of [`closed_forms`].
pub(crate) const RATIOS: [f64; 6] = [0.0, 0.1, 0.5, 1.0, 2.0, 5.0];

/// The largest ω·dt of one oscillator by damping ratio, by the closed forms.
pub(crate) fn closed_forms(method: Method) -> Option<[f64; 6]> {
    let kicks = [2.0, 1.80998, 1.23607, 0.82843, 0.47214, 0.19804];
    Some(match method.name() {
        "ExplicitEuler" => [0.0, 0.2, 1.0, 2.0, 0.53590, 0.20204],
        "SemiImplicitEuler" | "StormerVerlet" | "DampedVerlet" => kicks,
        "Leapfrog" => [2.0; 6],
        "RungeKutta2" => [0.0, 1.04975, 2.0, 2.0, 0.53590, 0.20204],
        "RungeKutta4" => [2.82843, 2.95085, 2.62254, 2.78529, 0.74632, 0.28137],
        "Xpbd" | "ImplicitMidpoint" | "ImplicitEuler" => [f64::INFINITY; 6],
        _ => return None,
    })
}

/// Within 2 %, and within 0.02 of the time of the fastest rate where the limit is 0.
pub(crate) fn agree(found: f64, expected: f64, rate: f64) -> bool {
    // What no step makes unstable grows by rounding alone, over thousands of oscillations in a step.
    if expected.is_infinite() {
        return found * rate > 1000.0;
    }
    found == expected || if expected == 0.0 { found * rate <= 0.02 } else { (found / expected - 1.0).abs() <= 0.02 }
}

#[test]
fn one_oscillator_has_the_limit_of_the_closed_form_by_every_method() {
    for method in Method::ALL {
        let Some(expected) = closed_forms(method) else { continue };
        for (ratio, expected) in RATIOS.into_iter().zip(expected) {
            let body = oscillator(ratio);
            let body = parts(&body, method);
            let found = linearised_limit(&body).unwrap();
            assert!(agree(found, expected, 1.0), "{method:?}, ζ {ratio}: found {found}, closed form {expected}");
            if let Some(predicted) = predicted_limit(&body) {
                let near = predicted == expected || (predicted / expected - 1.0).abs() < 1e-5;
                assert!(near, "{method:?}, ζ {ratio}: predicted {predicted}, closed form {expected}");
            }
        }
    }
}

#[test]
fn damped_verlet_with_a_fixed_part_is_stable_up_to_its_closed_form() {
    for (part, expected) in [(0.05, 1.97484), (0.1, 1.94936), (0.5, 1.73205)] {
        let body = oscillator(0.0);
        let mass_damping = Some(MassDamping::per_step(part).unwrap());
        let body = BodyParts { mass_damping, ..parts(&body, Method::DampedVerlet) };
        for limit in [predicted_limit(&body), linearised_limit(&body)] {
            assert!((limit.unwrap() / expected - 1.0).abs() < 3e-4, "λ {part}: {limit:?}, expected {expected}");
        }
    }
    // As a rate, λ = 1 − e^(−ch) shrinks with the step: θ² = 4 − 2λ(θ) where c = ω.
    let body = oscillator(0.0);
    let body = BodyParts { mass_damping: Some(MassDamping::rate(1.0).unwrap()), ..parts(&body, Method::DampedVerlet) };
    let theta = linearised_limit(&body).unwrap();
    assert!((theta * theta - 4.0 - 2.0 * libm::expm1(-theta)).abs() < 1e-3, "{theta}");
    assert!((predicted_limit(&body).unwrap() / theta - 1.0).abs() < 1e-3);
}

#[test]
fn predicted_and_linearised_limits_of_the_worm_agree() {
    for method in Method::ALL {
        for damping in [0.0, 0.05, 0.9, 3.0, 12.0] {
            for (front, mass_damping) in [(1.0, None), (6.0, None), (1.0, Some(0.4)), (6.0, Some(3.0))] {
                let mut body = Worm { damping, method, ..Worm::GARDEN }.body();
                let id = wriggle::body::SpringId(1);
                let spring = body.springs.get(id).unwrap();
                // Only the stiffness: damping no longer goes with it.
                body.springs.set(id, Spring { stiffness: front * spring.stiffness, ..spring }).unwrap();
                let mass_damping = mass_damping.map(|rate| MassDamping::rate(rate).unwrap());
                let body = BodyParts { mass_damping, ..body.parts() };
                let Some(predicted) = predicted_limit(&body) else { continue };
                let (a, b) = (1.5, 1.5 * front);
                let rate = f64::sqrt(a + b + f64::sqrt(a * a + b * b - a * b));
                let found = linearised_limit(&body).unwrap();
                assert!(
                    agree(found, predicted, rate),
                    "{method:?}, D {damping}, front × {front}, {mass_damping:?}: {predicted} and {found}"
                );
            }
        }
    }
}

/// Positions at rest and the springs between them.
type Shape = (Vec<DVec3>, Vec<[u32; 2]>);

fn body_of(positions: Vec<DVec3>, edges: &[[u32; 2]], spring: impl Fn(usize) -> (f64, f64)) -> (Particles, Springs) {
    let particles = Particles::new(
        positions
            .iter()
            .enumerate()
            .map(|(i, &position)| Particle { mass: 1.0 + 0.3 * (i % 3) as f64, ..Particle::at(position) }),
    )
    .unwrap();
    let springs = Springs::new(
        edges.iter().enumerate().map(|(i, &[a, b])| {
            let (stiffness, damping) = spring(i);
            let rest_length = positions[a as usize].distance(positions[b as usize]);
            Spring { ends: [ParticleId(a), ParticleId(b)], stiffness, damping, rest_length }
        }),
        &particles,
    )
    .unwrap();
    (particles, springs)
}

/// The corners of an n³ block and the edges between all that are at most √3 apart.
fn block(n: u32) -> Shape {
    let at = |i: u32| DVec3::new(f64::from(i % n), f64::from(i / n % n), f64::from(i / n / n));
    let positions: Vec<_> = (0..n * n * n).map(at).collect();
    let pairs = (0..n * n * n).flat_map(|a| (a + 1..n * n * n).map(move |b| [a, b]));
    let edges = pairs.filter(|&[a, b]| at(a).distance(at(b)) < 1.8).collect();
    (positions, edges)
}

/// A triangulated net in the plane, its nodes shaken.
fn net(side: u32) -> Shape {
    let mut seed = 7_u32;
    let mut shake = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        0.5 * (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5)
    };
    let positions: Vec<_> = (0..side * side)
        .map(|i| DVec3::new(f64::from(i % side) + shake(), 0.0, f64::from(i / side) + shake()))
        .collect();
    let edges = (0..side * side).flat_map(|i| {
        let (x, z) = (i % side, i / side);
        let right = (x + 1 < side).then_some([i, i + 1]);
        let up = (z + 1 < side).then_some([i, i + side]);
        let across = (x + 1 < side && z + 1 < side).then_some([i, i + side + 1]);
        [right, up, across].into_iter().flatten()
    });
    (positions.clone(), edges.collect())
}

fn chain(count: u32) -> Shape {
    ((0..count).map(|i| DVec3::X * f64::from(i)).collect(), (0..count - 1).map(|i| [i, i + 1]).collect())
}

/// How the springs of a body are damped.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Damped {
    /// D = βk.
    InProportion(f64),
    /// Every third spring not at all, the others as it comes.
    Unevenly,
}

const EVERY_DAMPING: [Damped; 4] =
    [Damped::InProportion(0.0), Damped::InProportion(0.05), Damped::InProportion(2.0), Damped::Unevenly];

/// A shape with unequal springs, stretched from its rest lengths.
fn body_in(shape: &Shape, damped: Damped, stretch: f64) -> (Particles, Springs) {
    let (positions, edges) = shape;
    let mut body = body_of(positions.clone(), edges, |i| {
        let stiffness = 1.0 + (i % 4) as f64;
        match damped {
            Damped::InProportion(ratio) => (stiffness, ratio * stiffness),
            Damped::Unevenly => (stiffness, [0.0, 0.3, 2.0][i % 3]),
        }
    });
    for (i, &position) in positions.iter().enumerate() {
        let id = ParticleId(i as u32);
        let particle = body.0.get(id).unwrap();
        body.0.set(id, Particle { position: position * stretch, ..particle }).unwrap();
    }
    body
}

/// What is wrong with the bounds of a body: those above the true limit, or below half of it.
fn wrong_bounds(name: &str, shape: &Shape, damped: Damped, stretch: f64) -> Vec<(Method, String, f64)> {
    let body = body_in(shape, damped, stretch);
    let wrong = Method::ALL.into_iter().filter_map(|method| {
        let body = parts(&body, method);
        let (truth, bound) = (predicted_limit(&body)?, body.stability_limit(0.0));
        let part = if bound == truth { 1.0 } else { bound / truth };
        let text =
            format!("{}: {name}, {damped:?}, stretch {stretch}: {bound:.5} is {part:.4} of {truth:.5}", method.name());
        (!(0.5..=1.0 + 1e-8).contains(&part)).then_some((method, text, part))
    });
    wrong.collect()
}

fn shapes() -> [(&'static str, Shape); 5] {
    [
        ("chain of 2", chain(2)),
        ("chain of 3", chain(3)),
        ("chain of 20", chain(20)),
        ("net", net(4)),
        ("block of 2", block(2)),
    ]
}

/// Everything that is wrong with the bounds of these shapes in these poses.
fn all_wrong_bounds(stretches: &[f64]) -> Vec<(Method, Damped, f64, String)> {
    let mut wrong = Vec::new();
    let mut look = |name: &str, shape: &Shape, damped, stretch| {
        let found = wrong_bounds(name, shape, damped, stretch);
        wrong.extend(found.into_iter().map(|(method, text, part)| (method, damped, part, text)));
    };
    for (name, shape) in shapes() {
        for damped in EVERY_DAMPING {
            stretches.iter().for_each(|&stretch| look(name, &shape, damped, stretch));
        }
    }
    let block = block(3);
    look("block of 3", &block, Damped::InProportion(0.0), stretches[0]);
    wrong
}

fn assert_none(wrong: Vec<(Method, Damped, f64, String)>) {
    let text: Vec<_> = wrong.iter().map(|(.., text)| text.as_str()).collect();
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), text.join("\n"));
}

#[test]
fn in_every_pose_the_bound_is_never_above_the_limit_and_at_least_half_of_it() {
    assert_none(all_wrong_bounds(&[1.0, 1.2, 1.5, 2.0]));
}

#[test]
fn of_a_block_under_tension_the_step_itself_is_stable_up_to_the_bound_and_grows_at_twice_that() {
    // All springs are taut, and all masses in equilibrium: eight of them between pinned ones.
    let (positions, edges) = block(4);
    let is_inside = |position: DVec3| position.to_array().iter().all(|x| (1.0..=2.0).contains(x));
    for damped in EVERY_DAMPING {
        let mut body = body_of(positions.clone(), &edges, |i| match damped {
            Damped::InProportion(ratio) => (1.0, ratio),
            Damped::Unevenly => (1.0, [0.0, 0.3, 2.0][i % 3]),
        });
        for (i, &position) in positions.iter().enumerate() {
            let id = ParticleId(i as u32);
            let particle = body.0.get(id).unwrap();
            let pinned = !is_inside(position);
            body.0.set(id, Particle { position: 1.3 * position, pinned, ..particle }).unwrap();
        }
        for method in Method::ALL {
            let body = parts(&body, method);
            let bound = body.stability_limit(0.0);
            if bound.is_infinite() {
                continue;
            }
            let found = linearised_limit(&body).unwrap();
            let near = bound <= found * (1.0 + 2e-4) && bound >= 0.5 * found;
            // A step is found to grow by more than what rounding and the square of a disturbance may add.
            let both_none = bound == 0.0 && found < 0.005;
            assert!(bound == found || near || both_none, "{method:?}, {damped:?}: bound {bound}, found {found}");
        }
    }
}

#[test]
fn the_alarm_of_unevenly_damped_springs_is_their_limit_at_rest_however_taut_they_are() {
    for method in [Method::ExplicitEuler, Method::RungeKutta2] {
        let limits = [1.0, 1.2, 1.5].map(|stretch| {
            let body = body_in(&block(2), Damped::Unevenly, stretch);
            let body = parts(&body, method);
            (body.stability_limit(0.0), body.alarm_limit(0.0))
        });
        let (rest, _) = limits[0];
        assert!(rest > 0.01, "{method:?}: {rest}");
        // Stretched alike, springs keep their lines.
        for (_, alarm) in limits {
            assert!((alarm / rest - 1.0).abs() < 1e-6, "{method:?}: {limits:?}");
        }
        assert!(limits[1..].iter().all(|(limit, _)| *limit < 0.9 * rest), "{method:?}: {limits:?}");
    }
}

#[test]
fn what_is_damped_in_proportion_and_not_stretched_has_a_bound_by_every_method() {
    for (name, shape) in shapes() {
        for ratio in [0.05, 2.0] {
            let body = body_in(&shape, Damped::InProportion(ratio), 1.0);
            for method in Method::ALL {
                let limit = parts(&body, method).stability_limit(0.0);
                assert!(limit > 0.0, "{method:?}, {name}, D = {ratio} k: {limit}");
            }
        }
    }
}

#[test]
fn disturbances_die_at_the_bound_by_the_step_itself_and_grow_above_the_prediction() {
    for (name, shape) in [("chain of 3", chain(3)), ("net", net(4)), ("block of 2", block(2))] {
        for damped in [Damped::InProportion(0.05), Damped::Unevenly] {
            let body = body_in(&shape, damped, 1.0);
            for method in Method::ALL {
                let body = parts(&body, method);
                let (bound, predicted) = (body.stability_limit(0.0), predicted_limit(&body));
                if bound > 0.0 && bound.is_finite() {
                    let at = growth(&body, bound * (1.0 - 1e-6)).unwrap();
                    assert!(at <= 1.0 + 1e-7, "{method:?}, {name}, {damped:?}: {at} at the bound {bound}");
                }
                if let Some(predicted) = predicted.filter(|predicted| predicted.is_finite()) {
                    let (below, above) = (growth(&body, 0.98 * predicted), growth(&body, 1.02 * predicted));
                    let (below, above) = (below.unwrap(), above.unwrap());
                    assert!(
                        below <= 1.0 + 1e-7 && above > 1.0 + 1e-6,
                        "{method:?}, {name}, {damped:?}: {below} below {predicted}, {above} above"
                    );
                }
            }
        }
    }
}

#[test]
fn without_friction_a_worm_explodes_where_its_step_begins_to_grow() {
    let mut body = Worm { drag: 0.0, ratchet: false, ..Worm::GARDEN }.body();
    for method in Method::ALL {
        body.method = method;
        let linearised = linearised_limit(&body.parts()).unwrap();
        if linearised.is_infinite() {
            // Steps of half a cycle see the muscles as they are not; what that does is no matter of growth.
            continue;
        }
        let explodes = scene_limit(&body.parts(), linearised).unwrap();
        // By explicit Euler the muscles drive it far from its pose before its step grows by itself.
        let least = if method == Method::ExplicitEuler { 0.85 } else { 0.94 };
        // Leapfrog's springs pass through zero and flip before its oscillation goes on to grow.
        let most = if method == Method::Leapfrog { 1.08 } else { 1.06 };
        let near = explodes == linearised || (least..most).contains(&(explodes / linearised));
        assert!(near, "{method:?}: explodes at {explodes}, grows from {linearised}");
    }
}

#[test]
fn the_limits_of_the_garden_agree_or_have_a_reason() {
    let rows = limits(&wriggle::scenes::load("garden").unwrap(), &|_, _| {}).unwrap();
    assert_eq!(rows.len(), Method::ALL.len());
    for row in rows {
        let (Some(linearised), Some(explodes)) = (row.linearised, row.explodes) else { panic!("{row:?}") };
        assert!(row.predicted.is_none_or(|predicted| agree(linearised, predicted, 2.1)), "{row:?}");
        // Its modes are damped one by one, so the bound is never above; drag, which it counts, lowers it.
        assert!(row.bound <= linearised * 1.0002 && row.bound >= 0.5 * linearised, "{row:?}");
        let near = explodes == linearised || (explodes / linearised - 1.0).abs() <= 0.06;
        assert_eq!(row.reason.is_none(), near, "{row:?}");
    }
}

/// That a limit is predicted and found within 2 %, with a bound between half of it and all.
fn assert_known(name: &str, body: &BodyParts<'_>) {
    let (predicted, linearised) = (predicted_limit(body).unwrap(), linearised_limit(body).unwrap());
    let (bound, method) = (body.stability_limit(0.0), body.method);
    let near = (linearised / predicted - 1.0).abs() <= 0.02;
    assert!(near, "{name}, {method:?}: predicted {predicted}, found {linearised}");
    let is_bound = bound <= predicted && bound >= 0.5 * linearised;
    assert!(is_bound, "{name}, {method:?}: bound {bound}, found {linearised}");
}

#[test]
fn limits_that_disagree_in_a_stretched_pose_say_so() {
    // Across a taut string nothing is damped.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("string.creature.ron");
    let text = "Creature(version: 1, body: Raw(
        particles: [(position: (-1, 0, 0), pinned: true), (position: (0, 0, 0)), (position: (1, 0.1, 0), pinned: true)],
        springs: [(ends: (0, 1), stiffness: 1, damping: 0.3, rest_length: 0.7), (ends: (1, 2), stiffness: 1, damping: 0.3, rest_length: 0.7)]))";
    std::fs::write(&path, text).unwrap();
    let rows = limits(&wriggle::scenes::load(path.to_str().unwrap()).unwrap(), &|_, _| {}).unwrap();
    let disagree = |predicted: f64, found: f64| predicted != found && (predicted - found).abs() > 0.02 * predicted;
    let mut said = 0;
    for row in rows {
        let Some((predicted, found)) = row.predicted.zip(row.linearised) else { continue };
        let reason = row.reason.is_some_and(|reason| reason.starts_with("its springs are not at their rest lengths"));
        assert_eq!(reason, disagree(predicted, found), "{row:?}");
        said += usize::from(reason);
    }
    assert!(said > 0);
}

#[test]
fn what_gravity_can_move_off_its_axis_has_the_limits_of_space() {
    // Nothing damps a turn, which a taut spring resists.
    let (particles, springs) = body_in(&chain(2), Damped::InProportion(0.3), 1.2);
    let on_axis = BodyParts::new(&particles, &springs, Method::ExplicitEuler);
    let in_space = BodyParts { gravity: Some(Gravity::new(1.0).unwrap()), ..on_axis };
    for (body, grows) in [(on_axis, false), (in_space, true)] {
        let limits = [predicted_limit(&body).unwrap(), linearised_limit(&body).unwrap(), body.stability_limit(0.0)];
        assert!(limits.iter().all(|limit| (*limit < 0.005) == grows), "{limits:?}");
    }
}

#[test]
fn what_is_torn_and_flies_apart_has_not_exploded() {
    // Two masses that leave each other with half of the energy that their spring would hold squeezed to no length.
    let mass = |x: f64| Particle { velocity: DVec3::X * (x - 0.5), ..Particle::at(DVec3::X * x) };
    let particles = Particles::new([mass(0.0), mass(1.0)]).unwrap();
    let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness: 1.0, damping: 0.0, rest_length: 1.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    let tearing = Tearing::new(0.1).unwrap();
    let whole = BodyParts::new(&particles, &springs, Method::SemiImplicitEuler);
    let linearised = linearised_limit(&whole).unwrap();
    assert_eq!(scene_limit(&BodyParts { tearing: Some(&tearing), ..whole }, linearised), Some(f64::INFINITY));
    assert!(scene_limit(&whole, linearised).unwrap().is_finite());
}

#[test]
fn limits_of_a_worm_whose_rest_lengths_follow_its_pose_are_predicted() {
    for (name, method) in [("worm", Method::ExplicitEuler), ("caterpillar", Method::Leapfrog)] {
        let problem = Problem::of(&wriggle::scenes::load(name).unwrap()).unwrap();
        assert_known(name, &problem.bodies[0].parts(method, StickRule::InStages));
    }
}

#[test]
fn limits_of_a_block_too_large_for_its_eigenvalues_are_predicted() {
    // 648 coordinates.
    let (particles, springs) = body_of(block(6).0, &block(6).1, |_| (1.0, 0.2));
    assert_known("block", &BodyParts::new(&particles, &springs, Method::SemiImplicitEuler));
    // Where damping does not go with stiffness its stiffest direction does not decide.
    let (particles, springs) = body_of(block(6).0, &block(6).1, |i| (1.0, 0.1 * (i % 3) as f64));
    assert_eq!(predicted_limit(&BodyParts::new(&particles, &springs, Method::RungeKutta4)), None);
}

#[test]
fn limits_of_a_block_that_hardly_anything_damps_are_predicted() {
    let (particles, springs) = body_of(block(3).0, &block(3).1, |_| (1.0, 0.0));
    for method in [Method::ExplicitEuler, Method::RungeKutta2, Method::Leapfrog] {
        let mass_damping = MassDamping::rate(0.02).ok();
        assert_known("block", &BodyParts { mass_damping, ..BodyParts::new(&particles, &springs, method) });
    }
}

#[test]
fn a_cloud_of_masses_without_springs_is_limited_by_its_damping_alone() {
    for masses in [30, 200] {
        let places = (0..masses).map(|i| Particle::at(DVec3::new(f64::from(i), f64::from(i % 7), f64::from(i % 3))));
        let particles = Particles::new(places).unwrap();
        let springs = Springs::new([], &particles).unwrap();
        let body = BodyParts::new(&particles, &springs, Method::ExplicitEuler);
        assert_eq!(linearised_limit(&body), Some(f64::INFINITY));
        // v' = −cv: stable up to 2/c.
        let body = BodyParts { mass_damping: Some(MassDamping::rate(4.0).unwrap()), ..body };
        for limit in [predicted_limit(&body), linearised_limit(&body)] {
            assert!((limit.unwrap() / 0.5 - 1.0).abs() < 1e-3, "{masses}: {limit:?}");
        }
    }
}

#[test]
fn what_each_step_takes_counts_as_damping() {
    let (particles, springs) = body_in(&block(2), Damped::InProportion(0.0), 1.0);
    for method in Method::ALL {
        let body = BodyParts {
            mass_damping: Some(MassDamping::per_step(0.01).unwrap()),
            ..BodyParts::new(&particles, &springs, method)
        };
        let Some(predicted) = predicted_limit(&body).filter(|limit| limit.is_finite()) else { continue };
        let (bound, linearised) = (body.stability_limit(0.0), linearised_limit(&body).unwrap());
        assert!((linearised / predicted - 1.0).abs() <= 0.02, "{method:?}: {predicted} and {linearised}");
        assert!(bound <= predicted && bound >= 0.5 * predicted, "{method:?}: bound {bound}, predicted {predicted}");
    }
}
