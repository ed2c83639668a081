//! Where methods fail: each failure with its expected size, and its cure.

use core::f64::consts::{PI, TAU};

use bevy::math::DVec3;
use wriggle::{
    body::{
        Coefficients, CoulombFriction, Gravity, Ground, LEAST_REST_FRACTION, Muscle, Muscles, Particle, ParticleId,
        Particles, Spring, SpringId, Springs, Surface, Terrain, Wave,
    },
    lab::limits::{linearised_limit, predicted_limit},
    mechanics::{BodyParts, elastic_energy, integrators::Method, kinetic_energy, rest_length},
    physics::Clock,
};

use crate::support::{Row, Worm, bits, follow, in_space, particles, stepping_app};

/// A mass of 1 at `length` from a pinned one, on a spring of stiffness 1 and rest length 1.
pub(crate) fn oscillator(length: f64, muscle: Option<Muscle>) -> Row {
    let pinned = Particle { pinned: true, ..Particle::at(DVec3::ZERO) };
    let particles = Particles::new([pinned, Particle::at(DVec3::X * length)]).unwrap();
    let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness: 1.0, damping: 0.0, rest_length: 1.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    let muscles = Muscles::new(muscle, &springs).unwrap();
    Row { particles, springs, muscles }
}

fn energy(body: &BodyParts<'_>, time: f64) -> f64 {
    kinetic_energy(body.particles) + elastic_energy(body, time)
}

fn x(body: &BodyParts<'_>, particle: u32) -> f64 {
    body.particles.position(ParticleId(particle)).unwrap().x
}

#[test]
fn explicit_euler_multiplies_the_energy_in_every_step_and_semi_implicit_euler_keeps_it_within_bounds() {
    let (theta, steps, start) = (0.1_f64, 200, 0.5 * 0.3 * 0.3);
    let row = oscillator(1.3, None);
    let mut last = 0.0;
    row.run(Method::ExplicitEuler, theta, steps, |time, body| last = energy(&body, time) / start);
    let expected = libm::pow(1.0 + theta * theta, steps as f64);
    assert!((last / expected - 1.0).abs() < 1e-9 && expected > 7.0, "× {last}, expected × {expected}");
    row.run(Method::SemiImplicitEuler, theta, 20_000, |time, body| {
        let part = energy(&body, time) / start;
        assert!((1.0 / (1.0 + theta / 2.0)..=1.0 / (1.0 - theta / 2.0)).contains(&part), "× {part} at {time}");
    });
}

#[test]
fn a_spring_through_zero_length_flips_its_force_and_stays_finite() {
    // Let go at 2.5 rest lengths, the mass passes the pin at 1.118 = √(1.5² − 1²) units a time. The force jumps there from +1 to −1, and the
    // step in which it does is wrong by up to 2·dt in velocity.
    let (speed, dt) = (f64::sqrt(1.25), 0.01);
    let jump = |length: f64, phase: f64| {
        let mut row = oscillator(length, None);
        row.particles.set(ParticleId(1), Particle::at(DVec3::X * (length + phase))).unwrap();
        let start = energy(&row.parts(Method::RungeKutta4), 0.0);
        let (mut worst, mut crossed) = (0.0_f64, false);
        row.run(Method::RungeKutta4, dt, 600, |time, body| {
            crossed |= x(&body, 1) < 0.0;
            worst = worst.max((energy(&body, time) - start).abs());
        });
        (worst, crossed)
    };
    let through = (0..10).map(|i| jump(2.5, 0.002 * f64::from(i)).0).fold(0.0, f64::max);
    assert!(jump(2.5, 0.0).1 && (0.1..1.1).contains(&(through / (2.0 * speed * dt))), "{through}");
    let (short, crossed) = jump(1.9, 0.0);
    assert!(!crossed && short < 1e-9, "{short}");
    // No length at all has no direction, and pulls nowhere.
    let row = oscillator(0.0, None);
    row.run(Method::RungeKutta4, dt, 10, |_, body| assert_eq!(x(&body, 1), 0.0));
}

fn muscle(wave: Wave, amplitude: f64, period: f64) -> Muscle {
    Muscle { spring: SpringId(0), wave, amplitude, period, phase: 0.0, ramp: 0.0 }
}

#[test]
fn a_rest_length_that_is_driven_below_nothing_is_held_at_a_fifth() {
    let row = oscillator(1.0, Some(muscle(Wave::Sine, 1.5, 40.0)));
    let (mut held, mut least) = (0, f64::INFINITY);
    const SAMPLES: u32 = 40_000;
    for i in 0..SAMPLES {
        let time = 40.0 * f64::from(i) / f64::from(SAMPLES);
        let length = rest_length(&row.springs, Some(&row.muscles), SpringId(0), time);
        // Without the clamp it would be −0.5 at its shortest.
        let free = 1.0 + 1.5 * libm::sin(TAU * time / 40.0);
        assert!((length - free.max(LEAST_REST_FRACTION)).abs() < 1e-12);
        held += u32::from(free < LEAST_REST_FRACTION);
        least = least.min(length);
    }
    assert_eq!(least, 0.2);
    let expected = 0.5 - libm::asin(0.8 / 1.5) / PI;
    assert!((f64::from(held) / f64::from(SAMPLES) - expected).abs() < 1e-4, "{held}");
    // Damped, the mass follows the rest length and never comes to its pin.
    let mut row = row;
    let spring = row.springs.get(SpringId(0)).unwrap();
    row.springs.set(SpringId(0), Spring { damping: 1.0, ..spring }).unwrap();
    row.run(Method::SemiImplicitEuler, 0.01, 8000, |time, body| {
        assert!((0.1..4.0).contains(&x(&body, 1)), "{} at {time}", x(&body, 1));
    });
}

/// A mass of 1 on a damped spring (k = D = 1) whose rest length goes down to −0.5 and is never less than `least`, by leapfrog with centred damping from
/// rest at 1: how far from its pin it is at most over the two units of time before 30, while the rest length is at its shortest.
fn driven(least: f64, dt: f64) -> f64 {
    let (mut x, mut v, mut most) = (1.0_f64, 0.0_f64, 0.0_f64);
    for step in 0..(30.0 / dt).round() as u64 {
        let time = (step as f64 + 0.5) * dt;
        x += 0.5 * dt * v;
        let rest = (1.0 + 1.5 * libm::sin(TAU * time / 40.0)).max(least);
        let pull = if x == 0.0 { 0.0 } else { -x.signum() * (x.abs() - rest) };
        v = (v * (1.0 - 0.5 * dt) + dt * pull) / (1.0 + 0.5 * dt);
        x += 0.5 * dt * v;
        if time > 28.0 {
            most = most.max(x.abs());
        }
    }
    most
}

#[test]
fn a_rest_length_below_nothing_makes_a_mass_chatter_at_every_step_and_held_at_a_fifth_keeps_the_order() {
    const STEPS: [f64; 4] = [0.02, 0.01, 0.005, 0.0025];
    // Without the clamp the spring pulls as hard towards its pin from either side, and the mass goes to and fro through it by a hundredth, whatever the step:
    // an error of second order would be 64 times smaller at the last of them.
    let chatter = STEPS.map(|dt| driven(f64::NEG_INFINITY, dt));
    assert!(chatter.iter().all(|x| (0.005..0.02).contains(x)), "{chatter:?}");
    assert!(chatter[3] > 0.8 * chatter[0], "{chatter:?}");
    // With it ours comes to where it must, four times nearer at half the step, and does not go to and fro.
    let mut row = oscillator(1.0, Some(muscle(Wave::Sine, 1.5, 40.0)));
    let spring = row.springs.get(SpringId(0)).unwrap();
    row.springs.set(SpringId(0), Spring { damping: 1.0, ..spring }).unwrap();
    let ends = STEPS.map(|dt| {
        let mut last = 0.0;
        row.run(Method::Leapfrog, dt, (30.0 / dt).round() as u64, |time, body| {
            last = x(&body, 1);
            assert!(last > 0.1, "{last} at {time}");
        });
        last
    });
    let apart = [0, 1, 2].map(|i| (ends[i + 1] - ends[i]).abs());
    for pair in apart.windows(2) {
        let observed = libm::log2(pair[0] / pair[1]);
        assert!((observed - 2.0).abs() < 0.1, "order {observed} in {ends:?}");
    }
}

/// Where the mass on a spring that is switched between 1.3 and 0.7 every unit of time is after `switches` units, exactly.
fn switched(switches: u32) -> f64 {
    let (sin, cos) = libm::sincos(1.0);
    let (mut x, mut v) = (1.0, 0.0);
    for i in 0..switches {
        let rest = if i % 2 == 0 { 1.3 } else { 0.7 };
        (x, v) = (rest + (x - rest) * cos + v * sin, v * cos - (x - rest) * sin);
    }
    x
}

#[test]
fn a_square_wave_leaves_order_one_to_what_looks_at_a_switch_and_more_to_what_does_not() {
    let row = oscillator(1.0, Some(muscle(Wave::Square, 0.3, 2.0)));
    let error = |method, steps_a_unit: u32| {
        let mut last = 0.0;
        row.run(method, 1.0 / f64::from(steps_a_unit), u64::from(7 * steps_a_unit), |_, body| last = x(&body, 1));
        (last - switched(7)).abs()
    };
    for (method, order) in [(Method::RungeKutta4, 1.0), (Method::StormerVerlet, 2.0)] {
        let errors = [64, 128, 256].map(|steps| error(method, steps));
        for pair in errors.windows(2) {
            let observed = (pair[0] / pair[1]).log2();
            assert!((observed - order).abs() < 0.15, "{method:?}: order {observed} in {errors:?}");
        }
    }
    assert!(error(Method::StormerVerlet, 128) < 0.1 * error(Method::RungeKutta4, 128));
}

#[test]
fn a_long_body_driven_at_a_standing_wave_answers_with_one_over_two_zeta() {
    const COUNT: u32 = 12;
    let (stiffness, angle) = (100.0, PI / (2.0 * f64::from(COUNT)));
    let omega = 2.0 * f64::sqrt(stiffness) * libm::sin(angle);
    let gain = |zeta: f64, frequency: f64| {
        let particles = Particles::new((0..COUNT).map(|i| Particle::at(DVec3::X * f64::from(i)))).unwrap();
        let spring = |i| Spring {
            ends: [ParticleId(i), ParticleId(i + 1)],
            stiffness,
            damping: 2.0 * zeta * stiffness / omega,
            rest_length: 1.0,
        };
        let springs = Springs::new((0..COUNT - 1).map(spring), &particles).unwrap();
        let shape = |i: u32| libm::sin(2.0 * angle * f64::from(i + 1));
        let drive = |i| Muscle {
            spring: SpringId(i),
            amplitude: 0.01 * shape(i),
            ..muscle(Wave::Sine, 0.0, TAU / (frequency * omega))
        };
        let muscles = Muscles::new((0..COUNT - 1).map(drive), &springs).unwrap();
        let row = Row { particles, springs, muscles };
        let (dt, settled) = (TAU / (omega * 100.0), 7.0 / (zeta * omega));
        let steps = ((settled + TAU / (frequency * omega)) / dt) as u64;
        let mut most = 0.0_f64;
        row.run(Method::RungeKutta4, dt, steps, |time, body| {
            if time > settled {
                most = most.max((x(&body, 6) - x(&body, 5) - 1.0).abs());
            }
        });
        most / (0.01 * shape(5))
    };
    for zeta in [0.05, 0.1] {
        let found = gain(zeta, 1.0);
        assert!((found * 2.0 * zeta - 1.0).abs() < 0.02, "× {found} at ζ {zeta}");
    }
    // Driven at a quarter of that frequency it follows.
    let found = gain(0.1, 0.25);
    assert!((found - 1.0 / (1.0 - 1.0 / 16.0)).abs() < 0.01, "× {found}");
}

/// In how many ways an n³ lattice can move without a spring changing length, beside moving as a whole.
fn mechanisms(n: i32, squared_lengths: &[i32]) -> usize {
    let at = |i: i32| [i % n, i / n % n, i / n / n];
    let count = n * n * n;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for a in 0..count {
        for b in a + 1..count {
            let d: Vec<i32> = (0..3).map(|axis| at(b)[axis] - at(a)[axis]).collect();
            if squared_lengths.contains(&d.iter().map(|d| d * d).sum()) && d.iter().all(|d| d.abs() <= 1) {
                let mut row = vec![0.0; 3 * count as usize];
                for axis in 0..3 {
                    row[3 * a as usize + axis] = -f64::from(d[axis]);
                    row[3 * b as usize + axis] = f64::from(d[axis]);
                }
                rows.push(row);
            }
        }
    }
    let mut rank = 0;
    for column in 0..3 * count as usize {
        let Some(best) = (rank..rows.len()).max_by(|&i, &j| rows[i][column].abs().total_cmp(&rows[j][column].abs()))
        else {
            break;
        };
        if rows[best][column].abs() < 1e-9 {
            continue;
        }
        rows.swap(rank, best);
        let pivot = rows[rank].clone();
        for row in &mut rows[rank + 1..] {
            let factor = row[column] / pivot[column];
            if factor != 0.0 {
                row.iter_mut().zip(&pivot).for_each(|(value, pivot)| *value -= factor * pivot);
            }
        }
        rank += 1;
    }
    3 * count as usize - 6 - rank
}

#[test]
fn a_lattice_of_axial_springs_alone_has_mechanisms_and_face_diagonals_take_them() {
    for n in [2, 3, 4] {
        let expected = (3 * n * n - 6) as usize;
        assert_eq!(mechanisms(n, &[1]), expected);
        assert_eq!(mechanisms(n, &[1, 2]), 0);
        if n > 2 {
            assert_eq!(mechanisms(n, &[1, 3]), 3);
        }
    }
}

#[test]
fn a_resting_contact_with_bounce_never_rests_and_one_without_does() {
    let gravity = 9.81;
    for dt in [0.01, 0.0025] {
        // Gravity, drift, and what came below the ground is put back on it with half of its speed: the root of the mean square of the speed over the last
        // half of a thousand steps, and how deep it was before it was put back.
        let rest = |without_bounce_below: f64| {
            let (mut x, mut v, mut squares, mut deepest) = (0.0_f64, 0.0_f64, 0.0, [0.0_f64; 2]);
            for step in 0..1000 {
                v -= gravity * dt;
                x += v * dt;
                let half = usize::from(step >= 500);
                deepest[half] = deepest[half].max(-x);
                if x < 0.0 {
                    (x, v) = (0.0, if v > -without_bounce_below { 0.0 } else { -0.5 * v });
                }
                squares += half as f64 * v * v / 500.0;
            }
            (f64::sqrt(squares), deepest)
        };
        let (speed, deepest) = rest(0.0);
        assert!((speed / (gravity * dt / 3.0) - 1.0).abs() < 1e-9, "{speed}");
        // One step's fall at first, then two thirds of it in every step.
        for (depth, part) in deepest.into_iter().zip([1.0, 2.0 / 3.0]) {
            assert!((depth / (gravity * dt * dt) - part).abs() < 1e-9, "{deepest:?}");
        }
        // It rests exactly where what comes more slowly than gravity makes it in two steps does not bounce.
        assert_eq!(rest(2.0 * gravity * dt).0, 0.0);

        // Ours does, without bounce and with it, on the ground from the first and fallen on it, and is never below it.
        let floor = Terrain::new([Surface::Floor { height: 0.0 }]).unwrap().with_bounce(0.5).unwrap();
        for method in in_space() {
            for ground in [Ground::Flat, Ground::Terrain(floor.clone().into())] {
                for height in [0.0, 0.3] {
                    let start = Particles::new([Particle::at(DVec3::Y * height)]).unwrap();
                    let (springs, weight) = (Springs::default(), Gravity::new(gravity).ok());
                    let body = BodyParts {
                        gravity: weight,
                        ground: Some(&ground),
                        ..BodyParts::new(&start, &springs, method)
                    };
                    let (mut lowest, mut highest, mut fastest) = (f64::INFINITY, 0.0_f64, 0.0_f64);
                    // It bounces for 0.74 units of time.
                    follow::<3>(&body, dt, (2.0 / dt) as u64, |time, body| {
                        let mass = body.particles.get(ParticleId(0)).unwrap();
                        lowest = lowest.min(mass.position.y);
                        if time > 1.0 {
                            highest = highest.max(mass.position.y);
                            fastest = fastest.max(mass.velocity.length());
                        }
                    });
                    assert_eq!((lowest, highest), (0.0, 0.0), "{method:?} from {height}, {ground:?}");
                    // Explicit Euler moves by the velocity of the step before: what gravity makes in one step meets the ground in the next.
                    let expected = if method == Method::ExplicitEuler { gravity * dt } else { 0.0 };
                    assert_eq!(fastest, expected, "{method:?} from {height}, {ground:?}");
                }
            }
        }
    }
}

#[test]
fn friction_by_the_sign_of_the_velocity_creeps_and_a_projection_rests() {
    let (hold, pull, dt) = (5.0, 1.5, 0.01);
    let (mut v, mut most) = (0.0_f64, 0.0_f64);
    for _ in 0..10_000 {
        let friction = if v == 0.0 { 0.0 } else { hold * v.signum() };
        v += dt * (pull - friction);
        most = most.max(v.abs());
    }
    assert!((0.5..=1.0).contains(&(most / ((hold + pull) * dt))), "{most}");
    let row = oscillator(1.0 - pull, None);
    let coefficients = Coefficients { forward: 0.5, backward: 0.5, sideways: 0.0 };
    let friction = CoulombFriction::new(coefficients).unwrap().with_load(hold / 0.5).unwrap();
    let mut app = stepping_app(dt, 10_000);
    let body = app.world_mut().spawn((row.particles.clone(), row.springs.clone(), friction)).id();
    app.update();
    assert_eq!(bits(particles(&app, body)), bits(&row.particles));
}

#[test]
fn a_velocity_projection_takes_its_energy_with_a_unit_direction_and_adds_it_with_a_long_one() {
    let v = DVec3::new(-0.4, 0.0, 0.2);
    let change = |s: DVec3| {
        let after = v - s * s.dot(v);
        0.5 * (after.length_squared() - v.length_squared())
    };
    assert!((change(DVec3::X) + 0.5 * 0.16).abs() < 1e-15);
    assert!((change(DVec3::X * f64::sqrt(2.0))).abs() < 1e-15);
    assert!((change(DVec3::X * 2.0) - 0.5 * (0.8 * 0.8) * (4.0 - 2.0)).abs() < 1e-15);
    // Between neighbours that are four apart the spine is a unit vector all the same.
    let mut body = Worm { stiffness: 0.0, damping: 0.0, amplitude: 0.0, drag: 0.0, ..Worm::GARDEN }.body();
    for i in 0..3 {
        let velocity = if i == 1 { v } else { DVec3::ZERO };
        let position = DVec3::X * 2.0 * f64::from(i);
        body.particles.set(ParticleId(i), Particle { velocity, ..Particle::at(position) }).unwrap();
    }
    let before = kinetic_energy(&body.particles);
    let mut app = stepping_app(1e-6, 1);
    let entity = app.world_mut().spawn(body).id();
    app.update();
    let lost = before - kinetic_energy(particles(&app, entity));
    assert!((lost - 0.5 * 0.16).abs() < 1e-9, "{lost}");
}

/// How far the exact worm's masses are from their start after 20 units by steps of a millisecond in f32, from an origin so far away.
fn worm_in_f32(origin: f32) -> [f32; 3] {
    const DT: f32 = 0.001;
    let start = [origin, origin + 1.0, origin + 2.0];
    let (mut x, mut v) = (start, [0.0_f32; 3]);
    for step in 0..20_000 {
        let time = f64::from(step) * 0.001;
        let rest = [0.0, 0.5].map(|lag| (1.0 + 0.25 * libm::sin(PI * (time - lag))) as f32);
        let force = [0, 1].map(|i| 1.5 * (rest[i] - (x[i + 1] - x[i])) - 0.9 * (v[i + 1] - v[i]));
        for (v, f) in v.iter_mut().zip([-force[0], force[0] - force[1], force[1]]) {
            *v = (*v + DT * f).max(0.0);
        }
        for i in 0..3 {
            x[i] += DT * v[i];
        }
    }
    [0, 1, 2].map(|i| x[i] - start[i])
}

#[test]
fn far_from_the_origin_f32_loses_the_motion_and_f64_does_not() {
    let worm = |origin: f64| {
        let body = Worm::EXACT.body().moved(DVec3::X * origin, 0.0);
        let start: Vec<_> = body.particles.positions().collect();
        let mut app = stepping_app(0.001, 20_000);
        let entity = app.world_mut().spawn(body).id();
        app.update();
        let ways: Vec<f64> = particles(&app, entity).positions().zip(start).map(|(x, start)| x.x - start.x).collect();
        ways
    };
    let near = worm(0.0);
    let off = |ways: &[f64]| ways.iter().zip(&near).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let single = |origin: f32| off(&worm_in_f32(origin).map(f64::from));
    assert!(single(0.0) < 1e-3, "{}", single(0.0));
    assert!(single(1e3) > 1e-2, "{}", single(1e3));
    assert_eq!(worm_in_f32(1e5), [0.0; 3]);
    for origin in [1e3, 1e5] {
        assert!(off(&worm(origin)) < 1e-6, "{}", off(&worm(origin)));
    }
}

#[test]
fn a_clock_that_adds_in_f32_is_late_and_one_that_counts_is_not() {
    let mut time = 0.0_f32;
    for _ in 0..4_000_000 {
        time += 0.001;
    }
    assert!((time - 3920.8).abs() < 0.1, "{time}");
    assert_eq!(Clock::new(0.001, 1.0).unwrap().timeline().time_at(4_000_000), 4000.0);
}

/// A mass of 2 at rest on a spring of length 1 over a pinned particle: a ground that resists by being pressed in.
fn on_a_spring(stiffness: f64, damping: f64) -> Row {
    let pinned = Particle { pinned: true, ..Particle::at(DVec3::ZERO) };
    let particles = Particles::new([pinned, Particle { mass: 2.0, ..Particle::at(DVec3::Y) }]).unwrap();
    let spring = Spring { ends: [ParticleId(0), ParticleId(1)], stiffness, damping, rest_length: 1.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    Row::new(particles, springs)
}

#[test]
fn a_ground_of_springs_gives_way_and_bounds_the_step_and_contact_does_neither() {
    let (mass, gravity, method) = (2.0, 9.81, Method::SemiImplicitEuler);
    let limits = [(400.0, 12.0), (400.0, 60.0), (4e4, 120.0)].map(|(stiffness, damping)| {
        let row = on_a_spring(stiffness, damping);
        // ω·dt = 2(√(1+ζ²) − ζ), of which contact knows nothing.
        let (omega, zeta) = (f64::sqrt(stiffness / mass), damping / (2.0 * f64::sqrt(stiffness * mass)));
        let expected = 2.0 * (f64::sqrt(1.0 + zeta * zeta) - zeta) / omega;
        let predicted = predicted_limit(&row.parts(method)).unwrap();
        let found = linearised_limit(&row.parts(method)).unwrap();
        assert!((predicted / expected - 1.0).abs() < 1e-9, "k {stiffness}, D {damping}: {predicted}, not {expected}");
        assert!((found / predicted - 1.0).abs() < 1e-3, "k {stiffness}, D {damping}: {found}, not {predicted}");
        let dt = 0.25 * found;
        let mut app = stepping_app(dt, (20.0 / dt) as u64);
        let parts = (row.particles, row.springs, Gravity::new(gravity).unwrap(), method);
        let body = app.world_mut().spawn(parts).id();
        app.update();
        let depth = 1.0 - particles(&app, body).position(ParticleId(1)).unwrap().y;
        let sunk = mass * gravity / stiffness;
        assert!((depth / sunk - 1.0).abs() < 1e-9, "k {stiffness}, D {damping}: {depth}, expected {sunk}");
        found
    });
    // More damping costs, and what gives way a hundredth as much takes ten times as many steps.
    assert!(limits[1] < 0.6 * limits[0] && (limits[0] / limits[2] - 10.0).abs() < 0.01, "{limits:?}");

    let alone = Particles::new([Particle { mass, ..Particle::at(DVec3::Y * 0.5) }]).unwrap();
    let springs = Springs::default();
    let row = Row::new(alone, springs);
    let (gravity, ground) = (Gravity::new(gravity).unwrap(), Ground::Flat);
    let contact = BodyParts { gravity: Some(gravity), ground: Some(&ground), ..row.parts(method) };
    assert_eq!(contact.stability_limit(0.0), f64::INFINITY);
    let mut app = stepping_app(0.01, 1);
    let body = app.world_mut().spawn((row.particles, row.springs, gravity, ground, method)).id();
    let mut heights = Vec::new();
    for _ in 0..500 {
        app.update();
        heights.push(particles(&app, body).position(ParticleId(0)).unwrap().y);
    }
    assert!(heights[0] > 0.49 && heights.iter().all(|&y| y >= 0.0), "{heights:?}");
    // It falls for 32 steps.
    assert!(heights[40..].iter().all(|&y| y == 0.0), "{heights:?}");
}

#[test]
fn what_has_no_mass_or_is_no_number_is_refused_by_name() {
    let with = |particle| Particles::new([Particle::at(DVec3::ZERO), particle]).map(|_| ()).map_err(|e| e.to_string());
    let there = Particle::at(DVec3::X);
    for mass in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(with(Particle { mass, ..there }).unwrap_err().starts_with("particles[1].mass: "));
    }
    assert_eq!(with(Particle { mass: 0.0, pinned: true, ..there }), Ok(()));
    let nan = DVec3::new(0.0, f64::NAN, 0.0);
    assert!(with(Particle { position: nan, ..there }).unwrap_err().starts_with("particles[1].position: "));
    assert!(with(Particle { velocity: nan, ..there }).unwrap_err().starts_with("particles[1].velocity: "));
}
