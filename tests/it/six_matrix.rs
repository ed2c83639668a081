//! The six-matrix particle system: its reference figures, and the laws that hold whatever the numbers.

use bevy::math::DVec3;
use faer::{Mat, Side};
use wriggle::{
    body::{Drive, Particle, Particles, Rule},
    creatures::{Composed, Inchworm, RoadForm, Roller, Rough, Shape, SixBody, Strip, library},
    lab::limits::linearised_six_limit,
    mechanics::six_matrix::{
        Burst, Dense, Road, RoadSearch, Scan, SixParts, SixState, Stepper, bond_eigenvalue, look, stability_limit,
    },
};

pub const DT: f64 = 0.01;

/// A body on a road.
pub struct Six {
    pub particles: Particles,
    pub six: SixBody,
    pub road: Option<Road>,
}

impl Six {
    /// A creature with its particles put somewhere.
    pub fn new(creature: &Composed, place: impl Fn(DVec3) -> DVec3, road: Option<Road>) -> Self {
        let places: Vec<_> = creature.rest().into_iter().map(place).collect();
        let six = creature.build(&places).unwrap();
        Self { particles: Particles::new(places.into_iter().map(Particle::at)).unwrap(), six, road }
    }

    /// Where its own numbers put it, on a strip.
    pub fn on_strip(creature: &Composed, strip: RoadForm) -> Self {
        Self::new(creature, |x| x, Some(strip.build().unwrap()))
    }

    pub fn on_road(creature: &Composed, form: &RoadForm, road: &Road, row: f64, aside: f64, turn: f64) -> Self {
        let pose = creature.pose_on(road, form.station(row), aside, turn).unwrap();
        let rotation = bevy::math::DQuat::from_rotation_y(-pose.heading.to_radians());
        Self::new(creature, |x| rotation * x + pose.at, Some(road.clone()))
    }

    pub fn parts(&self) -> SixParts<'_> {
        let SixBody { columns, bonds, collisions, rules } = &self.six;
        SixParts { particles: &self.particles, columns, bonds, collisions, rules, road: self.road.as_ref(), pull: None }
    }

    pub fn drive(&self) -> &Drive {
        self.six.rules.iter().find_map(|rule| if let Rule::Drive(drive) = rule { Some(drive) } else { None }).unwrap()
    }

    /// Takes so many steps, and calls `see` before each of them and after the last.
    pub fn run(&self, steps: usize, mut see: impl FnMut(usize, &SixState)) -> Result<(), (usize, Burst)> {
        let parts = self.parts();
        let mut stepper = Stepper::new(&parts);
        for step in 0..steps {
            see(step, stepper.state());
            stepper.step(&parts, DT).map_err(|burst| (step, burst))?;
        }
        see(steps, stepper.state());
        Ok(())
    }

    /// What is measured after so many steps.
    pub fn after<T>(&self, steps: usize, measure: impl Fn(&SixState) -> T) -> T {
        let mut found = None;
        self.run(steps, |step, state| {
            if step == steps {
                found = Some(measure(state));
            }
        })
        .unwrap();
        found.unwrap()
    }
}

pub fn strip(spacing: f64, x: f64, rows: u32) -> RoadForm {
    RoadForm::Strip(Strip { rows, columns: 12, spacing, at: (x, 2.0, 40.0), heading: -90.0, bump: 0.0 })
}

pub fn inchworm_strip() -> RoadForm {
    strip(1.7, 15.0, 150)
}

pub fn roller_strip() -> RoadForm {
    strip(1.5, 0.0, 150)
}

pub fn legs(state: &SixState) -> f64 {
    state.position[60].distance(state.position[61])
}

/// Two decimals, as the tables are printed.
fn printed(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

#[test]
fn the_inchworm_meets_its_table_on_the_flat_strip() {
    let table = [
        (0, [3.99, -3.84, 15.30, 4.10]),
        (1000, [5.82, -1.71, 11.01, 3.93]),
        (2000, [3.99, 3.42, 16.06, 11.74]),
        (3000, [6.33, 5.66, 10.78, 11.30]),
        (4000, [3.99, 10.98, 16.11, 19.35]),
        (6000, [3.99, 18.71, 16.06, 27.04]),
        (8000, [3.95, 26.25, 16.11, 34.61]),
    ];
    let worm = Six::on_strip(&Inchworm::default().composed(), inchworm_strip());
    worm.run(8000, |step, state| {
        let Some((_, expected)) = table.iter().find(|(at, _)| *at == step) else { return };
        let center = state.center();
        let found = [center.y, center.z, legs(state), state.position[60].z];
        for (found, expected) in found.into_iter().zip(expected) {
            let near = if step <= 2000 { printed(found) == *expected } else { (found - expected).abs() < 0.02 };
            assert!(near, "step {step}: {found}, expected {expected}");
        }
    })
    .unwrap();
}

#[test]
fn the_roller_meets_its_table_on_the_flat_strip() {
    let table = [
        (0, 1.50, 6.00),
        (100, -0.42, 5.71),
        (200, -5.74, 5.40),
        (300, -13.46, 4.98),
        (400, -22.87, 4.74),
        (500, -33.45, 4.83),
        (600, -44.81, 5.13),
        (800, -68.86, 5.19),
        (1000, -94.09, 4.90),
    ];
    let roller = Six::on_strip(&Roller::default().composed(), roller_strip());
    let mut fastest: f64 = 0.0;
    roller
        .run(1000, |step, state| {
            let sight = look(roller.drive(), &state.position, roller.road.as_ref());
            assert!(step == 1000 || sight.decision() == "none", "step {step}: {sight:?}");
            fastest = state.velocity.iter().map(|v| v.length()).fold(fastest, f64::max);
            let Some(&(_, z, y)) = table.iter().find(|(at, ..)| *at == step) else { return };
            for (found, expected) in [(state.center().z, z), (state.center().y, y)] {
                let near = if step <= 500 { printed(found) == expected } else { (found - expected).abs() < 0.02 };
                assert!(near, "step {step}: {found}, expected {expected}");
            }
        })
        .unwrap();
    assert!((fastest - 37.0).abs() < 2.0, "the fastest particle goes at {fastest}");
}

#[test]
fn the_inchworm_goes_along_rough_road_as_far_as_ever() {
    let form = RoadForm::Rough(Rough::default());
    let road = form.build().unwrap();
    assert!((road.length() - 141.4).abs() < 0.05, "{}", road.length());
    // From its printed place, which is below this road.
    let worm = Six::new(&Inchworm::default().composed(), |x| x, Some(road.clone()));
    let expected = [4.4, 32.8, 54.3, 89.0, 110.2, 137.7, 136.7];
    worm.run(60_000, |step, state| {
        if step % 10_000 == 0 {
            let (way, expected) = (road.way(state.center()), expected[step / 10_000]);
            assert!((way - expected).abs() < 0.5, "step {step}: {way}, expected {expected}");
        }
    })
    .unwrap();
}

#[test]
fn the_picked_roller_makes_the_first_curve_of_rough_road() {
    let form = RoadForm::Rough(Rough::default());
    let road = form.build().unwrap();
    let roller = Six::on_road(&Roller::default().composed(), &form, &road, 3.5, 1.0, 0.0);
    // Chaotic: a change of 1e-13 shows at step 1490. That 10.8, 45.4 and 86.0 are met to the last digit therefore tells that this is the run of the reference,
    // which has 37.5 at step 500. There is no such place in it. The roller leaves the inner edge of the way into the curve for the way out of it, where s, the
    // nearest place of the middle, leaps from 25.5 (step 286) over to 39.1 (step 290); from there to step 500 it stays between 38.4 and 39.3, less than 1.5 from
    // the middle at the end, so that other ways to measure differ little: at step 500 the nearest place in 3-D is 39.0, the nearest ring 38.7, the arc of
    // the curve itself in place of the line through its rings 39.3, in 3-D 39.6, the mean of s over all particles 38.8, and of the axle or the
    // wheels alone 38.9 and 38.7. Its axle's ends are at 31.3 and 42.2.
    roller
        .run(1500, |step, state| {
            let way = road.way(state.center());
            for (at, expected) in [(0, 10.8), (500, 39.3), (1000, 45.4), (1500, 86.0)] {
                assert!(step != at || (way - expected).abs() < 0.05, "step {step}: {way}, expected {expected}");
            }
            assert!(!(25.8..38.2).contains(&way), "step {step}: {way}");
            let (left, right) = look(roller.drive(), &state.position, Some(&road)).goals;
            assert!(left * right >= 0.0, "step {step}: wheels are driven in opposite directions");
        })
        .unwrap();
}

/// The share of rollers past the first curve, and the largest way of any, from 21 rows, five places aside and both ends of a road.
fn past_the_first_curve(rough: Rough, rims: &[f64]) -> (f64, f64) {
    let form = RoadForm::Rough(rough);
    let road = form.build().unwrap();
    let mut ways = Vec::new();
    for &rim_angle in rims {
        let creature = Roller { rim_angle, ..Roller::default() }.composed();
        for (start, turn) in [(0.0, 0.0), (60.0, 180.0)] {
            for i in 0..21 {
                for aside in -2..=2 {
                    let row = f64::abs(start - 0.5 * f64::from(i));
                    // To the right of the way that it goes.
                    let aside = if turn == 0.0 { f64::from(aside) } else { -f64::from(aside) };
                    let roller = Six::on_road(&creature, &form, &road, row, aside, turn);
                    let (parts, mut furthest) = (roller.parts(), 0.0_f64);
                    let mut stepper = Stepper::new(&parts);
                    for step in 0..10_000 {
                        let center = stepper.state().center();
                        if center.y < -20.0 || stepper.step(&parts, DT).is_err() {
                            break;
                        }
                        let flat = |point: DVec3| point.with_y(0.0);
                        let is_on = step % 5 == 0
                            && road.nearest(center).is_some_and(|there| there.distance(center) < 5.0)
                            && road.line().iter().any(|middle| flat(*middle).distance(flat(center)) < 8.0);
                        if is_on {
                            let way = road.way(center);
                            furthest = furthest.max(if turn == 0.0 { way } else { road.length() - way });
                        }
                    }
                    ways.push(furthest);
                }
            }
        }
    }
    let past = ways.iter().filter(|way| **way > 50.0).count() as f64;
    (past / ways.len() as f64, ways.iter().copied().fold(0.0, f64::max))
}

#[test]
#[ignore = "takes minutes: cargo test --release --no-default-features --test it rollers_pass -- --ignored --nocapture"]
fn rollers_pass_the_first_curve_in_the_valley_and_not_on_the_hill() {
    let (valley, _) = past_the_first_curve(Rough::default(), &[0.1, 0.2]);
    println!("valley: {:.1} % of 420 starts", 100.0 * valley);
    assert!((valley - 0.14).abs() < 0.065, "{valley}");
    let hill = Rough { height: wriggle::creatures::Height::Hill, ..Rough::default() };
    let (hill, furthest) = past_the_first_curve(hill, &[0.1]);
    println!("hill: {:.1} %, the furthest gets to {furthest:.1}", 100.0 * hill);
    assert_eq!(hill, 0.0);
}

#[test]
fn the_grid_gives_what_the_scan_and_the_dense_form_give() {
    let inchworm = Six::on_strip(&Inchworm::default().composed(), strip(1.7, 15.0, 40));
    let roller = Six::on_strip(&Roller::default().composed(), strip(1.5, 0.0, 40));
    for six in [inchworm, roller] {
        let parts = six.parts();
        let road = six.road.as_ref().unwrap();
        let [mut grid, mut scan] = [(); 2].map(|()| Stepper::new(&parts));
        let mut dense = Dense::new(&parts);
        for step in 0..100 {
            grid.step(&parts, DT).unwrap();
            scan.step_on(&parts, Some(&Scan(road.points())), DT).unwrap();
            dense.step(&parts, DT);
            assert_eq!(grid.state(), scan.state(), "step {step}");
            assert_eq!(grid.state().position, dense.positions(), "step {step}");
        }
    }
}

#[test]
fn the_grid_answers_as_a_scan_of_the_road_does() {
    let forms = [
        RoadForm::Rough(Rough::default()),
        strip(1.5, 0.0, 30),
        RoadForm::Helix(wriggle::creatures::Helix {
            center: (0.0, 0.0, 0.0),
            radius: 20.0,
            rise: 9.0,
            turns: 2.0,
            columns: 9,
            spacing: 1.5,
        }),
    ];
    for form in forms {
        let road = form.build().unwrap();
        let scan = Scan(road.points());
        let mut touched = 0;
        for i in 0..3000 {
            // On and around the road, and far off.
            let spread = [1.0, 4.0, 300.0][i % 3];
            let part = |k: usize| ((i * k) % 997) as f64 / 498.0 - 1.0;
            let point =
                road.points()[(i * 61) % road.points().len()] + spread * DVec3::new(part(37), part(53), part(71));
            let near = |search: &dyn Fn(&mut Vec<DVec3>)| {
                let mut list = Vec::new();
                search(&mut list);
                list
            };
            let found = near(&|list| road.touching(point, |there| list.push(there)));
            assert_eq!(found, near(&|list| scan.touching(point, |there| list.push(there))));
            touched += found.len();
            assert_eq!(road.nearest(point), scan.nearest(point));
            let direction = DVec3::new(part(13), part(29), part(17)).normalize_or(DVec3::X);
            let beam = wriggle::mechanics::six_matrix::Beam { origin: point, direction, reach: 1.5 };
            assert_eq!(road.is_hit(&beam), scan.is_hit(&beam), "{beam:?}");
        }
        assert!(touched > 500, "{touched}");
    }
}

#[test]
fn only_the_undermost_rim_particles_touch_a_flat_strip() {
    let roller = Six::on_strip(&Roller::default().composed(), roller_strip());
    let parts = roller.parts();
    let mut stepper = Stepper::new(&parts);
    for step in 0..1000 {
        let before = stepper.state().position.clone();
        stepper.step(&parts, DT).unwrap();
        for wheel in [0..20, 20..40] {
            let height = |k: usize| before[k].y;
            let low = wheel.clone().map(height).fold(f64::INFINITY, f64::min);
            let high = wheel.clone().map(height).fold(f64::NEG_INFINITY, f64::max);
            for k in wheel.filter(|&k| stepper.touches()[k]) {
                let part = (height(k) - low) / (high - low);
                assert!(part < 0.45, "step {step}: rim particle {k} touches at {part} of its wheel");
            }
        }
    }
}

#[test]
fn the_largest_step_is_that_of_the_bonds() {
    for (creature, strip, eigenvalue, limit, fine, broken) in [
        (Inchworm::default().composed(), inchworm_strip(), 41.0, 0.0951, 0.07, 0.1),
        (Roller::default().composed(), roller_strip(), 147.9, 0.0270, 0.02, 0.03),
    ] {
        let six = Six::on_strip(&creature, strip);
        let parts = six.parts();
        let found = bond_eigenvalue(parts.bonds);
        assert!((found / eigenvalue - 1.0).abs() < 0.02, "K is {found}, expected {eigenvalue}");
        let predicted = stability_limit(parts.bonds, parts.columns);
        assert!((predicted / limit - 1.0).abs() < 0.02, "{predicted}, expected {limit}");
        let linearised = linearised_six_limit(&parts);
        assert!((linearised / predicted - 1.0).abs() < 0.02, "by bisection {linearised}, predicted {predicted}");
        let run = |dt| {
            let mut stepper = Stepper::new(&parts);
            (0..600).all(|_| stepper.step(&parts, dt).is_ok())
        };
        assert!(run(fine) && !run(broken));
    }
}

#[test]
fn the_eigenvalue_of_the_bonds_is_never_below_the_true_one() {
    let mut seen = 0;
    for (name, source) in library::list(library::CREATURE) {
        let creature = library::read_creature(&source).unwrap();
        let Some(composed) = creature.body.composed() else { continue };
        let six = composed.build(&composed.rest()).unwrap();
        let (bonds, count) = (&six.bonds, composed.rest().len());
        let mut matrix = Mat::<f64>::zeros(3 * count, 3 * count);
        for (i, j, _) in bonds.relation().pairs() {
            let along = (bonds.rest()[j] - bonds.rest()[i]).normalize_or_zero().to_array();
            for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
                let k = 2.0 * bonds.stiffness() * along[a] * along[b];
                for (row, column, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                    matrix[(3 * row + a, 3 * column + b)] += sign * k;
                }
            }
        }
        let exact = matrix.self_adjoint_eigenvalues(Side::Lower).unwrap().into_iter().fold(0.0, f64::max);
        let found = bond_eigenvalue(bonds);
        assert!(found >= exact * (1.0 - 1e-9) && found <= 1.02 * exact, "{name}: {found}, exactly {exact}");
        seen += 1;
    }
    assert_eq!(seen, 4);
}

#[test]
fn a_turned_inchworm_follows_the_turned_path() {
    let creature = Inchworm::default().composed();
    let strip = inchworm_strip().build().unwrap();
    let straight = Six::new(&creature, |x| x, Some(strip.clone()));
    let mut path = Vec::new();
    straight.run(2000, |_, state| path.push(state.position.clone())).unwrap();
    for degrees in [37.0_f64, 123.0, -90.0] {
        let turn = bevy::math::DQuat::from_rotation_y(degrees.to_radians());
        let road = Road::new(strip.points().iter().map(|x| turn * *x).collect(), Vec::new()).unwrap();
        let turned = Six::new(&creature, |x| turn * x, Some(road));
        turned
            .run(2000, |step, state| {
                for (i, (x, straight)) in state.position.iter().zip(&path[step]).enumerate() {
                    let off = (*x - turn * *straight).length();
                    assert!(off < 1e-9, "{degrees}°, step {step}: particle {i} is {off} off");
                }
            })
            .unwrap();
    }
}

#[test]
fn a_mirrored_roller_takes_mirrored_decisions() {
    let creature = Roller::default().composed();
    // The same in a mirror: its axle and its wheels are not quite symmetric.
    let mut mirror = creature.clone();
    for (group, x) in mirror.groups.iter_mut().zip([-4.5, 6.0, -17.0 / 3.0]) {
        match &mut group.shape {
            Shape::Ring { center, .. } => center.0 = x,
            Shape::Row { from, .. } => from.0 = x,
            Shape::Points(_) => {}
        }
    }
    // So near to the edge of a strip that it sees it on one side.
    let form = |x| {
        RoadForm::Strip(Strip { rows: 60, columns: 11, spacing: 1.5, at: (x, 2.0, 20.0), heading: -90.0, bump: 0.0 })
    };
    let run = |creature: &Composed, x| {
        let six = Six::on_strip(creature, form(x));
        let mut sights = Vec::new();
        six.run(300, |_, state| sights.push((look(six.drive(), &state.position, six.road.as_ref()), state.center())))
            .unwrap();
        sights
    };
    let mut seen = std::collections::BTreeSet::new();
    for (step, ((a, here), (b, there))) in run(&creature, 1.0).into_iter().zip(run(&mirror, -1.0)).enumerate() {
        assert_eq!([a.hits[2], a.hits[3], a.hits[0], a.hits[1]], b.hits, "step {step}");
        assert_eq!((a.goals.1, a.goals.0), b.goals, "step {step}");
        assert!((here - there * DVec3::new(-1.0, 1.0, 1.0)).length() < 1e-6, "step {step}: {here} and {there}");
        seen.insert(a.decision());
    }
    assert!(seen.contains("only left side beam"), "{seen:?}");
}
