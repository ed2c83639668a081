//! Crawlers on dry friction, whose speeds are known, and what dry friction may and may not do.

use core::f64::consts::PI;

use bevy::math::{DQuat, DVec3};
use wriggle::{
    body::{
        Coefficients, CoulombFriction, Ground, Muscle, Muscles, Particle, ParticleId, Particles, Spring, SpringId,
        Springs, Wave,
    },
    mechanics::{
        Advance, BodyParts, Model, State, Timeline,
        integrators::{Method, StickRule},
    },
};

use crate::support::{bits, in_space, particles, stepping_app};

const LOAD: f64 = 9.81;

/// Equal masses in a row from tail to head, one unit long, whose springs all have the same muscle but for its phase.
struct Crawler {
    legs: u32,
    mass: f64,
    stiffness: f64,
    damping: f64,
    amplitude: f64,
    frequency: f64,
    /// How many cycles each spring lags behind the one before it.
    lag: f64,
    forward: f64,
    backward: f64,
    method: Method,
    stick: StickRule,
}

impl Crawler {
    const PAIR: Self = Self {
        legs: 2,
        mass: 0.1,
        stiffness: 200.0,
        damping: 3.0,
        amplitude: 0.1,
        frequency: 0.25,
        lag: 0.0,
        forward: 0.2,
        backward: 0.5,
        method: Method::SemiImplicitEuler,
        stick: StickRule::InStages,
    };

    fn friction(&self) -> CoulombFriction {
        let coefficients = Coefficients { forward: self.forward, backward: self.backward, sideways: self.backward };
        CoulombFriction::new(coefficients).unwrap().with_load(LOAD).unwrap()
    }

    fn parts(&self) -> (Particles, Springs, Muscles) {
        let gap = 1.0 / f64::from(self.legs - 1);
        let mass = |i| Particle { mass: self.mass, ..Particle::at(DVec3::X * gap * f64::from(i)) };
        let particles = Particles::new((0..self.legs).map(mass)).unwrap();
        let spring = |i| Spring {
            ends: [ParticleId(i), ParticleId(i + 1)],
            stiffness: self.stiffness,
            damping: self.damping,
            rest_length: gap,
        };
        let springs = Springs::new((0..self.legs - 1).map(spring), &particles).unwrap();
        let muscle = |i| Muscle {
            spring: SpringId(i),
            wave: Wave::Sine,
            amplitude: self.amplitude,
            period: 1.0 / self.frequency,
            phase: self.lag * f64::from(i),
            ramp: 1.0,
        };
        let muscles = Muscles::new((0..self.legs - 1).map(muscle), &springs).unwrap();
        (particles, springs, muscles)
    }

    /// Its speed over `cycles`, after two to come into its gait.
    fn speed(&self, steps_a_cycle: u64, cycles: u64) -> f64 {
        let (particles, springs, muscles) = self.parts();
        let friction = self.friction();
        let body = BodyParts {
            muscles: Some(&muscles),
            coulomb: Some(&friction),
            stick: self.stick,
            ..BodyParts::new(&particles, &springs, self.method)
        };
        assert!(body.on_axis());
        let dt = 1.0 / (self.frequency * steps_a_cycle as f64);
        let timeline = Timeline { dt, base_step: 0, base_time: 0.0 };
        let (mut model, mut state) = (Model::<f64, 1>::new(&body, [], dt), State::new(particles.len()));
        state.set_lane(0, &particles);
        let mut advance = |first, steps| {
            let (model, state, method) = (&mut model, &mut state, self.method);
            Advance { model, state, method, timeline, first, steps }.run();
            assert!(!model.has_exploded(0) && !model.has_refused(0));
            state.position.iter().map(|x| x[0]).sum::<f64>() / f64::from(self.legs)
        };
        let start = advance(0, 2 * steps_a_cycle);
        let end = advance(2 * steps_a_cycle, cycles * steps_a_cycle);
        (end - start) * self.frequency / cycles as f64
    }
}

/// Many stiff legs that breathe or wave once in ten units of time.
const MANY: Crawler = Crawler {
    mass: 0.01,
    stiffness: 20_000.0,
    damping: 4.0,
    frequency: 0.1,
    forward: 0.1,
    backward: 0.2,
    ..Crawler::PAIR
};
/// Steps that take half a millisecond.
const MANY_STEPS: u64 = 20_000;

fn assert_near(speed: f64, expected: f64, part: f64, what: &str) {
    assert!((speed / expected - 1.0).abs() < part, "{what}: {speed}, expected {expected}");
}

#[test]
fn two_masses_crawl_by_their_stroke_less_what_friction_takes_of_it_by_every_method() {
    for method in in_space() {
        let pair = Crawler { method, ..Crawler::PAIR };
        let expected = 0.25 * (0.2 - 2.0 * 0.2 * 0.1 * LOAD / 200.0);
        assert_near(pair.speed(2000, 3), expected, 0.01, method.name());
        // A soft spring loses a tenth of the stroke to friction. At half the pace: the formula leaves out the inertia, which is 1 % of it at the other.
        let soft = Crawler { stiffness: 20.0, damping: 1.0, frequency: 0.125, ..pair }.speed(2000, 3);
        assert_near(soft, 0.125 * (0.2 - 2.0 * 0.2 * 0.1 * LOAD / 20.0), 0.01, method.name());
        // Friction that knows no forward goes nowhere.
        let null = Crawler { backward: 0.2, ..pair }.speed(2000, 3);
        assert!(null.abs() < 1e-10, "{}: {null}", method.name());
        // With friction only at the end of a step, masses at rest creep by Runge–Kutta methods: an error of first order, 4 % where the others have 0.1 %.
        let creeps = method.locates();
        let end = Crawler { stick: StickRule::EndOfStep, ..pair };
        assert_near(end.speed(if creeps { 16_000 } else { 2000 }, 1), expected, 0.01, method.name());
        if creeps {
            let errors = [8000, 16_000, 32_000].map(|steps| end.speed(steps, 1) - pair.speed(steps, 1));
            for pair in errors.windows(2) {
                let order = libm::log2(pair[0] / pair[1]);
                assert!((order - 1.0).abs() < 0.3, "{}: order {order} in {errors:?}", method.name());
            }
        }
    }
}

#[test]
fn many_legs_that_breathe_crawl_by_how_many_of_them_hold() {
    let expected = |legs: u32, holding: f64| 0.1 * 0.2 * (1.0 - 2.0 * holding / f64::from(legs - 1));
    for method in in_space() {
        let crawler = Crawler { legs: 11, method, ..MANY };
        let (particles, springs, _) = crawler.parts();
        let limit = BodyParts::new(&particles, &springs, method).stability_limit(0.0);
        // At four fifths of what is stable, and no more than 2 ms: one pass of XPBD is soft with more.
        let steps = u64::max(5000, (1.0 / (0.1 * 0.8 * limit)).ceil() as u64);
        assert_near(crawler.speed(steps, 1), expected(11, 3.0), 0.01, method.name());
    }
    let crawler = Crawler { legs: 41, ..MANY };
    assert_near(crawler.speed(MANY_STEPS, 1), expected(41, 13.0), 0.01, "41 legs");
    let null = Crawler { legs: 11, forward: 0.2, ..MANY }.speed(MANY_STEPS, 1);
    assert!(null.abs() < 1e-12, "{null}");
}

#[test]
fn a_strain_wave_drives_a_body_against_itself() {
    // Two waves of twenty legs, each half a unit long, that run from head to tail.
    let crawler = Crawler { legs: 41, frequency: 0.2, lag: -1.0 / 20.0, ..MANY };
    let expected = 0.5 * 0.2 * 0.1 * libm::cos(PI * 0.1 / 0.3);
    assert_near(expected, 0.005, 1e-9, "the formula");
    assert_near(crawler.speed(MANY_STEPS / 2, 1), expected, 0.05, "wave");
    let null = Crawler { forward: 0.2, ..crawler }.speed(MANY_STEPS / 2, 1);
    assert!(null.abs() < 1e-12, "{null}");
}

/// Dry friction with the same load everywhere.
fn dry(forward: f64, backward: f64, sideways: f64) -> CoulombFriction {
    CoulombFriction::new(Coefficients { forward, backward, sideways }).unwrap().with_load(10.0).unwrap()
}

/// A mass of 2 on a spring to a pinned one, which pulls it by `force`; +x is turned by `turn` about the vertical.
fn pulled(force: f64, turn: f64) -> (Particles, Springs) {
    let along = DQuat::from_rotation_y(turn) * DVec3::X;
    let pinned = Particle { pinned: true, ..Particle::at(along * 3.0) };
    let particles = Particles::new([Particle { mass: 2.0, ..Particle::at(DVec3::ZERO) }, pinned]).unwrap();
    let spring =
        Spring { ends: [ParticleId(0), ParticleId(1)], stiffness: 8.0, damping: 0.5, rest_length: 3.0 - force / 8.0 };
    let springs = Springs::new([spring], &particles).unwrap();
    (particles, springs)
}

#[test]
fn a_mass_that_is_pulled_less_than_friction_holds_does_not_move_by_one_bit() {
    for method in in_space() {
        for (turn, ground) in [(0.0, false), (0.7, false), (2.0, true)] {
            // XPBD pulls with the force at the end of a step, which is 0.3 % less. Friction holds 2·10·0.1 = 2 forward and 2·10·0.3 = 6 backward.
            for (force, moves) in [(1.99, false), (2.03, true), (-5.99, false), (-6.09, true)] {
                let (start, springs) = pulled(force, turn);
                let friction = dry(0.1, 0.3, 0.2).with_spine([ParticleId(0), ParticleId(1)], &start).unwrap();
                let mut app = stepping_app(0.01, 200);
                let body = app.world_mut().spawn((start.clone(), springs, friction, method)).id();
                if ground {
                    app.world_mut().entity_mut(body).insert(Ground::Flat);
                }
                app.update();
                let same = bits(particles(&app, body)) == bits(&start);
                if !app.world().entity(body).contains::<wriggle::physics::Frozen>() {
                    assert_eq!(!same, moves, "{method:?}, pull {force}, turn {turn}, ground {ground}");
                }
            }
        }
    }
}

#[test]
fn a_mass_slides_as_far_as_its_energy_lasts_and_stops_for_good() {
    for method in in_space() {
        for stick in [StickRule::InStages, StickRule::EndOfStep] {
            for (speed, way) in [(1.0, 1.0 / (2.0 * 2.0)), (-1.0, -1.0 / (2.0 * 5.0))] {
                let sliding = Particle { velocity: DVec3::X * speed, ..Particle::at(DVec3::ZERO) };
                let mut app = stepping_app(0.006, 1);
                let start = Particles::new([sliding]).unwrap();
                let body = app.world_mut().spawn((start, Springs::default(), dry(0.2, 0.5, 0.0), method, stick)).id();
                let mut last = speed;
                for _ in 0..100 {
                    app.update();
                    let now = particles(&app, body).velocity(ParticleId(0)).unwrap().x;
                    assert!(now * speed >= 0.0 && now.abs() <= last.abs(), "{method:?} {stick:?}: {last} to {now}");
                    last = now;
                }
                let mass = particles(&app, body).get(ParticleId(0)).unwrap();
                assert_eq!(mass.velocity, DVec3::ZERO, "{method:?} {stick:?}");
                // Within the way of one step, at the ends of which friction acts.
                assert!((mass.position.x - way).abs() < 0.006, "{method:?} {stick:?}: {}", mass.position.x);
            }
        }
    }
}

#[test]
fn with_three_equal_coefficients_friction_is_the_same_in_every_direction() {
    for method in [Method::SemiImplicitEuler, Method::RungeKutta4] {
        for turn in [0.0, 0.4, 1.0, 2.5] {
            let velocity = DQuat::from_rotation_y(turn) * DVec3::X;
            let start = Particles::new([Particle { velocity, ..Particle::at(DVec3::ZERO) }]).unwrap();
            let mut app = stepping_app(0.001, 1000);
            let body = app.world_mut().spawn((start, Springs::default(), dry(0.2, 0.2, 0.2), method)).id();
            app.update();
            let mass = particles(&app, body).get(ParticleId(0)).unwrap();
            assert_eq!(mass.velocity, DVec3::ZERO);
            assert!((mass.position - velocity * 0.25).length() < 1.1e-3, "{} at {turn}, {method:?}", mass.position);
        }
    }
}

#[test]
fn across_the_cone_is_an_ellipse_and_a_step_solves_its_equation() {
    // v = u − dt·N·(μ_s v_s, μ_q v_q)/|v| with N = 10, dt = 0.1: what friction can take is 0.3 backward and 0.1 across.
    let after = |velocity: DVec3| {
        let start = Particles::new([Particle { velocity, ..Particle::at(DVec3::ZERO) }]).unwrap();
        let mut app = stepping_app(0.1, 1);
        let body = app.world_mut().spawn((start, Springs::default(), dry(0.2, 0.3, 0.1))).id();
        app.update();
        particles(&app, body).velocity(ParticleId(0)).unwrap()
    };
    for (x, z) in [(-0.31, 0.01), (-0.2, 0.08), (-0.01, 0.2), (-3.0, -0.4), (-0.299, 0.03), (-1e-9, 0.11), (-0.3, 0.05)]
    {
        let u = DVec3::new(x, 0.0, z);
        let v = after(u);
        if (x / 0.3) * (x / 0.3) + (z / 0.1) * (z / 0.1) <= 1.0 {
            assert_eq!(v, DVec3::ZERO, "{u}");
        } else {
            let again = v + DVec3::new(0.3 * v.x, 0.0, 0.1 * v.z) / v.length();
            assert!((again - u).length() < 1e-14, "{u} became {v}, which comes from {again}");
        }
    }
    assert_eq!(after(DVec3::new(-0.2, 0.0, 0.07)), DVec3::ZERO);
    // Off the surface it does not act.
    assert_eq!(after(DVec3::new(0.1, 0.5, 0.0)), DVec3::new(0.0, 0.5, 0.0));
}

#[test]
fn coefficients_that_cannot_be_are_refused() {
    let (particles, _) = pulled(1.0, 0.0);
    let good = Coefficients { forward: 0.1, backward: 0.2, sideways: 0.0 };
    let bad = |value| Coefficients { backward: value, ..good };
    for value in [-0.1, f64::NAN, f64::INFINITY] {
        let text = CoulombFriction::new(bad(value)).unwrap_err().to_string();
        assert!(text.starts_with("coulomb.backward: "), "{text}");
        let text = CoulombFriction::for_each([good, bad(value)], &particles).unwrap_err().to_string();
        assert!(text.starts_with("coulomb[1].backward: "), "{text}");
        let text = CoulombFriction::new(good).unwrap().with_load(value).unwrap_err().to_string();
        assert!(text.starts_with("coulomb.load: "), "{text}");
    }
    let text = CoulombFriction::for_each([good], &particles).unwrap_err().to_string();
    assert!(text.contains("1 particle(s), and the body has 2"), "{text}");
    assert!(CoulombFriction::new(good).unwrap().with_spine([ParticleId(0)], &particles).is_err());
    let each = CoulombFriction::for_each([good, Coefficients::default()], &particles).unwrap();
    assert_eq!((each.coefficients(ParticleId(0)), each.coefficients(ParticleId(1)).forward), (good, 0.0));
}

#[test]
fn a_creature_file_gives_dry_friction_and_is_written_the_same() {
    use wriggle::creatures::{Creature, GardenWorm, Pose, library};
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("dry.creature.ron");
    let read = |text: &str| {
        std::fs::write(&file, text).unwrap();
        library::read_creature(&library::Source::Disk(file.clone()))
    };
    let text = "Creature(version: 1, body: GardenWorm(mass: 1), coulomb: (forward: 0.1, backward: 0.2, load: 5))";
    let creature = read(text).unwrap();
    let body = creature.body(Pose::default()).unwrap();
    let friction = body.coulomb.unwrap();
    assert_eq!((friction.load(), friction.spine().len()), (Some(5.0), 3));
    assert_eq!(friction.coefficients(ParticleId(2)), Coefficients { forward: 0.1, backward: 0.2, sideways: 0.0 });
    let extensions = ron::extensions::Extensions::IMPLICIT_SOME | ron::extensions::Extensions::UNWRAP_VARIANT_NEWTYPES;
    let written = ron::Options::default().with_default_extension(extensions).to_string(&creature).unwrap();
    assert_eq!(read(&written).unwrap(), creature, "{written}");
    assert!(Creature::from(GardenWorm::default()).body(Pose::default()).unwrap().coulomb.is_none());
    let error = read(&text.replace("0.2", "-1")).unwrap_err().to_string();
    assert!(error.contains("coulomb.backward: -1 is not allowed"), "{error}");
    let text = "Creature(version: 1, body: (particles: [(position: (0,0,0))]), coulomb: (forward: 1, backward: 1))";
    let error = read(&text.replace("body: (", "body: Raw(")).unwrap().body(Pose::default()).unwrap_err().to_string();
    assert!(error.starts_with("coulomb: works along a spine"), "{error}");
}
