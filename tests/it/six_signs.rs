//! The signs that print lost: what the readings do that were rejected.

use bevy::math::DVec3;
use wriggle::{
    body::{Beams, Sense, Table},
    creatures::{Composed, Inchworm, RoadForm, Roller, Rough, RulePlan, Strip},
    mechanics::six_matrix::{Burst, RoadSearch, SixState, Stepper, look},
};

use crate::six_matrix::{DT, Six, inchworm_strip, legs, roller_strip, strip};

/// How far the inchworm gets in the second cycle, and the least and largest distance of its legs in it.
fn stroke(inchworm: Inchworm) -> Result<(f64, [f64; 2]), (usize, Burst)> {
    let (mut at, mut least, mut most) = ([0.0; 2], f64::INFINITY, 0.0_f64);
    Six::on_strip(&inchworm.composed(), inchworm_strip()).run(4000, |step, state| {
        if step >= 2000 {
            (least, most) = (least.min(legs(state)), most.max(legs(state)));
            at[usize::from(step > 2000)] = state.center().z;
        }
    })?;
    Ok((at[1] - at[0], [least, most]))
}

#[test]
fn the_inchworm_walks_only_with_the_restored_signs() {
    let restored = Inchworm::default();
    let (way, [least, most]) = stroke(restored).unwrap();
    assert!((way - 7.6).abs() < 0.2 && least < 11.0 && most > 16.0, "{way}, legs {least} to {most}");
    // Without either minus sign it hardly contracts.
    let (way, [least, _]) = stroke(Inchworm { body_step: 0.3, leg_step: 15.3, ..restored }).unwrap();
    assert!((way - 0.8).abs() < 0.1 && least > 14.0, "{way}, legs from {least}");
    // With one of them the legs are bound to nothing.
    for unbound in [Inchworm { body_step: 0.3, ..restored }, Inchworm { leg_step: 15.3, ..restored }] {
        let (step, burst) = stroke(unbound).unwrap_err();
        assert!(step < 500 && burst.bond.is_some(), "step {step}: {burst:?}");
    }
    // A muscle that pushes forms no arch: it slides.
    let (way, [least, _]) = stroke(Inchworm { strength: -0.1, ..restored }).unwrap();
    assert!((way - 3.4).abs() < 0.1 && least > 14.9, "{way}, legs from {least}");
    // Without the push of the front leg, or pulled back, it gets nowhere.
    for push in [0.0, -0.2] {
        let (way, _) = stroke(Inchworm { push, ..restored }).unwrap();
        assert!(way < 1.3, "push {push}: {way}");
    }
    // Legs that flee from what they should seek.
    for wrong in [Inchworm { seek: -0.5, ..restored }, Inchworm { grip: -1.0, ..restored }] {
        assert!(stroke(wrong).is_err(), "{wrong:?}");
    }
    // The mirror image goes the same way.
    let mirror = Inchworm { x: -15.0, legs_x: -15.3, ..restored };
    let mirrored = Six::on_strip(&mirror.composed(), strip(1.7, -15.0, 150)).after(2000, SixState::center);
    let plain = Six::on_strip(&restored.composed(), inchworm_strip()).after(2000, SixState::center);
    assert!((mirrored - plain * DVec3::new(-1.0, 1.0, 1.0)).length() < 1e-9, "{mirrored} and {plain}");
}

#[test]
fn forces_are_added_per_step_and_not_times_t() {
    let slow = |six: &mut Six| {
        six.six.bonds.set_stiffness(DT).unwrap();
        six.six.collisions.set_stiffness(DT).unwrap();
    };
    let worm = Inchworm { strength: 0.1 * DT, seek: 0.5 * DT, push: 0.2 * DT, grip: DT, ..Inchworm::default() };
    let mut worm = Six::on_strip(&worm.composed(), inchworm_strip());
    slow(&mut worm);
    let way = worm.after(2000, |state| state.center().z) - worm.after(0, |state| state.center().z);
    assert!((0.05..0.3).contains(&way), "creeps {way} a cycle");
    let roller = Roller { gravity: 0.32 * DT, friction: 0.02 * DT, limit: 10.0 * DT, ..Roller::default() };
    let mut roller = Six::on_strip(&roller.composed(), roller_strip());
    slow(&mut roller);
    let (z, height) = roller.after(750, |state| (state.center().z, state.center().y));
    assert!(z > 0.0 && height < 3.5, "its wheels collapse: {height} above the strip's 2, at {z}");
}

#[test]
fn the_roller_drives_only_with_the_restored_signs() {
    let restored = Roller::default();
    let run = |roller: Roller| Six::on_strip(&roller.composed(), roller_strip());
    let way = |roller: Roller| run(roller).after(1000, |state| state.center().z - roller.z);
    let plain = way(restored);
    // Two particles in each of ten places, the other z, and the printed product with ⇒ drive alike.
    for same in [
        Roller { rim_angle: 0.2, ..restored },
        Roller { z: -1.5, ..restored },
        Roller { sense: Sense::Implied, ..restored },
    ] {
        assert!((way(same) - plain).abs() < 0.2, "{same:?}: {} and {plain}", way(same));
    }
    let height = run(Roller { gravity: -0.32, ..restored }).after(500, |state| state.center().y);
    assert!(height > 300.0, "it flies away: {height}");
    for wrong in [
        Roller { friction: -0.02, ..restored },
        Roller { sense: Sense::Reversed, ..restored },
        Roller { sense: Sense::Printed, ..restored },
    ] {
        assert!(run(wrong).run(1000, |_, _| {}).is_err(), "{wrong:?}");
    }
    // The axis of the right wheel mirrored literally drives it backwards.
    let (step, _) = Six::on_strip(&turned_axes(&[1]), roller_strip()).run(1000, |_, _| {}).unwrap_err();
    assert!(step < 1000);
    // With −θ both are, and it goes the other way, where no beam looks.
    let mut furthest: f64 = 0.0;
    let backwards = Six::on_strip(&turned_axes(&[0, 1]), roller_strip());
    let (step, _) = backwards.run(1000, |_, state| furthest = furthest.max(state.center().z)).unwrap_err();
    assert!(step < 200 && furthest > 15.0, "step {step}, at {furthest}");
}

/// The roller with the axes of some wheels pointing the other way.
fn turned_axes(wheels: &[usize]) -> Composed {
    let mut turned = Roller::default().composed();
    for rule in &mut turned.rules {
        if let RulePlan::WheelDrive(drive) = rule {
            for &wheel in wheels {
                let wheel = &mut drive.wheels[wheel];
                core::mem::swap(&mut wheel.from, &mut wheel.to);
            }
        }
    }
    turned
}

/// What the beams and the table decide, with the readings that were rejected.
fn rejected_decisions() -> [(&'static str, Roller); 6] {
    let (restored, table, beams) = (Roller::default(), Table::default(), Beams::default());
    [
        ("restored", restored),
        (
            "(1, 0) and (0, 1)",
            Roller { table: Table { left_side: (1.0, 0.0), right_side: (0.0, 1.0), ..table }, ..restored },
        ),
        ("as printed", Roller { table: Table { left_side: (0.0, 1.0), right_side: (1.0, 0.0), ..table }, ..restored }),
        ("on where a front beam misses", Roller { table: Table { front: (1.0, 1.0), ..table }, ..restored }),
        ("beams turned backwards", Roller { beams: Beams { lift: 20.0, ..beams }, ..restored }),
        ("side beams inwards", Roller { beams: Beams { down: -20.0, ..beams }, ..restored }),
    ]
}

#[test]
fn rows_of_the_table_are_tried_from_the_last_one_up() {
    let table = Table {
        none: (1.0, 1.0),
        left_side: (0.0, -1.0),
        right_side: (-1.0, 0.0),
        both_sides: (0.0, 0.0),
        front: (-1.0, -1.0),
    };
    let creature = Roller { table, ..Roller::default() }.composed();
    // So many columns, with their middle there.
    for (columns, x, row, goals) in [
        (16, -0.67, "none", table.none),
        (10, -0.67, "both side beams", table.both_sides),
        (12, 2.0, "only left side beam", table.left_side),
        (12, -3.3, "only right side beam", table.right_side),
        (12, 6.0, "left or right front beam", table.front),
        (12, -7.0, "left or right front beam", table.front),
        (1, 300.0, "left or right front beam", table.front),
    ] {
        let form = Strip { rows: 60, columns, spacing: 1.5, at: (x, 2.0, 40.0), heading: -90.0, bump: 0.0 };
        let six = Six::on_strip(&creature, RoadForm::Strip(form));
        let position: Vec<_> = six.particles.positions().collect();
        let sight = look(six.drive(), &position, six.road.as_ref());
        assert_eq!((sight.decision(), sight.goals), (row, goals), "{columns} columns at {x}: {:?}", sight.hits);
    }
}

#[test]
fn the_roller_keeps_on_a_strip_best_with_the_restored_decisions() {
    // On strips that are more or less aside. That it is on is that it has not fallen below the road.
    let stays = |creature: &Composed, aside: f64| {
        let six = Six::on_strip(creature, strip(1.5, aside, 150));
        let parts = six.parts();
        let mut stepper = Stepper::new(&parts);
        (0..1500).all(|_| stepper.step(&parts, DT).is_ok() && stepper.state().center().y > 0.0)
    };
    for ((name, roller), expected) in rejected_decisions().into_iter().zip([14, 9, 7, 6, 6, 11]) {
        let creature = roller.composed();
        let on = (-10..=10).filter(|i| stays(&creature, 0.25 * f64::from(*i))).count();
        assert_eq!(on, expected, "{name}: still on the strip after 1500 steps");
    }
}

#[test]
fn rollers_whose_beams_look_elsewhere_do_not_pass_the_first_curve() {
    let form = RoadForm::Rough(Rough::default());
    let road = form.build().unwrap();
    let passes = |creature: &Composed, row: f64, aside: f64| {
        let six = Six::on_road(creature, &form, &road, row, aside, 0.0);
        let parts = six.parts();
        let mut stepper = Stepper::new(&parts);
        for step in 0..3000 {
            let center = stepper.state().center();
            let is_near = || road.nearest(center).is_some_and(|there| there.distance(center) < 5.0);
            if step % 5 == 0 && road.way(center) > 50.0 && is_near() {
                return true;
            }
            if center.y < -15.0 || stepper.step(&parts, DT).is_err() {
                return false;
            }
        }
        false
    };
    let passed = |roller: Roller| {
        let creature = roller.composed();
        (0..40).filter(|i| passes(&creature, f64::from(i / 5), f64::from(i % 5 - 2))).count()
    };
    let [(_, restored), .., (_, backwards), (_, inwards)] = rejected_decisions();
    // The road is chaotic: of so few starts one more or less says nothing.
    let (restored, backwards, inwards) = (passed(restored), passed(backwards), passed(inwards));
    assert!(restored >= 4 && backwards <= 2 && inwards == 0, "{restored}, {backwards} and {inwards} of 40");
}

#[test]
fn beams_go_ahead_and_outwards_only_with_the_restored_signs() {
    let ahead = |roller: Roller| {
        let six = Six::on_strip(&roller.composed(), roller_strip());
        let position: Vec<_> = six.particles.positions().collect();
        // Where they are a unit below the axle, ahead of it and to its left.
        look(six.drive(), &position, six.road.as_ref()).beams.map(|beam| {
            let below = beam.direction / -beam.direction.y;
            (-below.z, -below.x)
        })
    };
    let [left_front, left_side, right_front, right_side] = ahead(Roller::default());
    for (found, expected) in
        [(left_front, (2.22, 0.0)), (right_front, (2.22, 0.0)), (left_side, (2.86, 0.68)), (right_side, (2.86, -0.68))]
    {
        let near = (found.0 - expected.0).abs() < 0.01 && (found.1 - expected.1).abs() < 0.01;
        assert!(near, "{found:?}, expected {expected:?}");
    }
    let beams = Beams::default();
    let back = ahead(Roller { beams: Beams { lift: 20.0, ..beams }, ..Roller::default() });
    assert!(back.iter().all(|(ahead, _)| *ahead < 0.0), "{back:?}");
    let inwards = ahead(Roller { beams: Beams { down: -20.0, ..beams }, ..Roller::default() });
    assert!(inwards[1].1 < 0.0 && inwards[3].1 > 0.0, "{inwards:?}");
}
