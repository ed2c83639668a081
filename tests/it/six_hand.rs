//! A hand at creatures of the six-matrix particle system: what it does to a particle, to a step, and to whom it has let go.

use bevy::{math::DVec3, prelude::*};
use wriggle::{
    body::{ParticleId, Pull, Rule, Rules, Weight},
    creatures::{Composed, Inchworm, RoadForm, Roller, RulePlan},
    lab::limits::linearised_six_limit,
    mechanics::six_matrix::{SixParts, SixState, Stepper},
    physics::{Clock, Frozen, six_parts},
};

use crate::{
    six_house::{open, state},
    six_matrix::{DT, Six, inchworm_strip, roller_strip},
    six_odd::bare,
    support::{bits, particles},
};

/// A body at which a hand pulls.
fn pulled<'a>(body: &SixParts<'a>, particle: u32, target: DVec3) -> SixParts<'a> {
    SixParts { pull: Some(Pull { particle: ParticleId(particle), target }), ..*body }
}

#[test]
fn a_particle_alone_comes_to_the_hand_by_its_closed_form() {
    let mut six = bare(&[DVec3::ZERO], |_, _| false, Vec::new(), None);
    six.six.columns.set_damping(0, 1.0).unwrap();
    let target = DVec3::new(0.3, -0.2, 0.5);
    let parts = pulled(&six.parts(), 0, target);
    // κ = ½ and h = t·κ: the double root is 1/(1 + √h), whatever the step.
    for dt in [DT, 0.4, 50.0] {
        let root = libm::sqrt(0.5 * dt);
        let part = root / (1.0 + root);
        let mut stepper = Stepper::new(&parts);
        for n in 1..=2000 {
            stepper.step(&parts, dt).unwrap();
            let left = (1.0 + f64::from(n) * part) * libm::pow(1.0 - part, f64::from(n));
            let at = stepper.state().position[0];
            assert!((at - target * (1.0 - left)).length() < 1e-12, "dt {dt}, step {n}: {at}");
        }
    }
}

/// Four particles in a bent row, which a hand may hold anywhere.
fn row() -> Six {
    let places = [DVec3::ZERO, DVec3::new(1.0, 0.2, 0.0), DVec3::new(2.1, 0.0, 0.3), DVec3::new(2.9, -0.4, 0.0)];
    bare(&places, |i, j| i.abs_diff(j) == 1 || i.abs_diff(j) == 2, Vec::new(), None)
}

#[test]
fn a_hand_lowers_no_largest_step() {
    let six = row();
    let without = linearised_six_limit(&six.parts());
    for particle in 0..4 {
        // It begins where the hand is, so that it is at rest.
        let target = six.particles.position(ParticleId(particle)).unwrap();
        let held = linearised_six_limit(&pulled(&six.parts(), particle, target));
        assert!(held > 0.995 * without, "particle {particle}: {held}, without the hand {without}");
    }
}

/// A target that leaps about a place, from far to farther.
fn leaping(around: DVec3, step: usize) -> DVec3 {
    let part = |k: usize| ((step / 50 * k) % 101) as f64 / 50.0 - 1.0;
    around + 20.0 * DVec3::new(part(37), part(53), part(71))
}

#[test]
fn a_step_gets_from_the_hand_at_most_its_cap_and_at_no_other_particle() {
    // 1.25 weights of .32 a particle, or of what its rules give it, and at most what its bonds bear.
    let weighing = |pull: f64| {
        let mut six = row();
        let on = (0..4).map(ParticleId).collect();
        six.six.rules = Rules::new([Rule::Weight(Weight { on, pull })], 4).unwrap();
        six
    };
    // Of the first particle: bonds to the second and the third, of squares 1.04 and 4.5.
    let aside = 36.0 * 1.04;
    let bonds = libm::pow(aside, 1.5) * (1.0 / (1.04 + aside) + 1.0 / (4.5 + aside));
    for (six, most) in [(row(), 1.6), (weighing(0.1), 1.6), (weighing(1.0), 5.0), (weighing(50.0), bonds)] {
        let parts = six.parts();
        let mut stepper = Stepper::new(&parts);
        let mut largest = 0.0_f64;
        for step in 0..2000 {
            let held = pulled(&parts, 0, leaping(stepper.state().position[0], step));
            let mut without = stepper.clone();
            without.step(&parts, DT).unwrap();
            stepper.step(&held, DT).unwrap();
            let given = |i: usize| stepper.state().velocity[i] - without.state().velocity[i];
            assert!((1..4).all(|i| given(i) == DVec3::ZERO), "step {step}");
            largest = largest.max(given(0).length());
        }
        assert!(largest <= most * (1.0 + 1e-12) && largest > 0.8 * most, "{largest}, the cap is {most}");
    }
}

/// A creature that does nothing of itself but weigh, on its strip.
fn idle(creature: &Composed, road: RoadForm) -> Six {
    let mut creature = creature.clone();
    creature.rules.retain(|rule| matches!(rule, RulePlan::Gravity(_)));
    Six::on_strip(&creature, road)
}

#[test]
fn near_the_largest_step_a_hand_tears_no_creature() {
    let [inchworm, roller] = [Inchworm::default().composed(), Roller::default().composed()];
    for (six, dt) in [
        (Six::on_strip(&inchworm, inchworm_strip()), 0.07),
        (idle(&inchworm, inchworm_strip()), 0.09),
        (idle(&roller, roller_strip()), 0.02),
    ] {
        let parts = six.parts();
        let count = parts.particles.len();
        for particle in [0, count / 3, count / 2, count - 1] {
            let mut stepper = Stepper::new(&parts);
            for step in 0..3000 {
                let held = pulled(&parts, particle as u32, leaping(DVec3::Y * 10.0, step));
                if let Err(burst) = stepper.step(&held, dt) {
                    panic!("{particle} of {count}: {burst:?} at step {step}");
                }
            }
        }
    }
}

#[test]
fn the_held_particle_of_an_inchworm_comes_to_the_hand() {
    let (app, bodies) = open("flat-strip", 1);
    let parts = six_parts(app.world().entity(bodies[0])).unwrap();
    for particle in [0, 20, 40, 59, 60] {
        let target = parts.particles.position(ParticleId(particle)).unwrap() + DVec3::new(1.0, 4.0, -0.5);
        let held = pulled(&parts, particle, target);
        let mut stepper = Stepper::new(&held);
        let away = |state: &SixState| state.position[particle as usize].distance(target);
        let start = away(stepper.state());
        (0..800).for_each(|_| stepper.step(&held, DT).unwrap());
        assert!(away(stepper.state()) < 0.3 * start, "particle {particle}: {} of {start}", away(stepper.state()));
    }
}

#[test]
fn who_is_let_go_goes_on_as_if_nobody_had_pulled_and_nobody_else_is_pulled() {
    let run = |steps: u64| {
        let (mut app, bodies) = open("flat-strip", steps);
        let go_on = |app: &mut App, until: u64| {
            while app.world().resource::<Clock>().step() < until {
                app.update();
            }
        };
        go_on(&mut app, 60);
        let target = particles(&app, bodies[1]).center() + DVec3::new(2.0, 6.0, 0.0);
        app.world_mut().entity_mut(bodies[1]).insert(Pull { particle: ParticleId(50), target });
        go_on(&mut app, 120);
        app.world_mut().get_mut::<Pull>(bodies[1]).unwrap().target += DVec3::Z;
        go_on(&mut app, 180);
        app.world_mut().entity_mut(bodies[1]).remove::<Pull>();
        let parts = six_parts(app.world().entity(bodies[1])).unwrap();
        let mut stepper = Stepper::new(&parts);
        (0..120).for_each(|_| stepper.step(&parts, DT).unwrap());
        go_on(&mut app, 300);
        let now = particles(&app, bodies[1]);
        assert!(now.positions().eq(stepper.state().position.iter().copied()));
        assert!(now.velocities().eq(stepper.state().velocity.iter().copied()));
        assert!(bodies.iter().all(|body| app.world().get::<Frozen>(*body).is_none()));
        state(&app, &bodies)
    };
    let pulled = run(60);
    assert_eq!(run(3), pulled, "whatever the ticks");
    let (mut calm, bodies) = open("flat-strip", 300);
    calm.update();
    assert_eq!(bits(particles(&calm, bodies[0])), pulled[0]);
    assert_ne!(bits(particles(&calm, bodies[1])), pulled[1]);
}

#[test]
fn any_particle_lifts_the_roller_and_none_is_torn_out() {
    let (app, bodies) = open("rough-road", 1);
    let parts = six_parts(app.world().entity(bodies[1])).unwrap();
    for particle in (0..79).step_by(13) {
        let is_rim = particle < 40;
        let target = parts.particles.position(ParticleId(particle)).unwrap() + DVec3::Y * 12.0;
        let held = pulled(&parts, particle, target);
        let mut stepper = Stepper::new(&held);
        let start = stepper.state().center().y;
        for step in 0..800 {
            stepper.step(&held, DT).unwrap_or_else(|burst| panic!("particle {particle}: {burst:?} at step {step}"));
        }
        let lifted = stepper.state().center().y - start;
        assert!(is_rim || lifted > 2.5, "particle {particle}: {lifted}");
    }
}
