//! Roads: where Rough Road lies, and that courses have no gaps.

use bevy::math::DVec3;
use wriggle::{
    creatures::{Course, Inchworm, RoadForm, Rough},
    mechanics::six_matrix::RoadSearch,
};

#[test]
fn only_one_reading_puts_the_printed_inchworm_on_the_start_of_rough_road() {
    let starts = |x: f64| {
        let rest = Inchworm { x, legs_x: x + 0.3 * x.signum(), ..Inchworm::default() }.composed().rest();
        let center = rest.iter().sum::<DVec3>() / rest.len() as f64;
        let mut good = Vec::new();
        for i in 0..16_u32 {
            let sign = |bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let (middle, signs) = ((8.0 * sign(0), 8.0 * sign(1)), (sign(2), sign(3)));
            let form = RoadForm::Rough(Rough { middle, signs, ..Rough::default() });
            let way = form.build().unwrap().way(center);
            let row = (0..600)
                .map(|row| 0.1 * f64::from(row))
                .min_by(|a, b| {
                    let distance = |row: f64| (form.station(row).middle - center).with_y(0.0).length();
                    distance(*a).total_cmp(&distance(*b))
                })
                .unwrap();
            let place = form.station(row);
            let apart = (center - place.middle).with_y(0.0).length();
            // In the first ten lengths, on the road, and looking along it.
            if way < 10.0 && apart < 8.0 && place.ahead.z > 0.99 {
                good.push((middle, signs, row));
            }
        }
        good
    };
    for (x, middle, cosine) in [(15.0, -8.0, 1.0), (-15.0, 8.0, -1.0)] {
        let good = starts(x);
        assert_eq!(good.len(), 1, "{good:?}");
        assert_eq!((good[0].0, good[0].1), ((middle, -8.0), (cosine, 1.0)));
        assert!((good[0].2 - 1.4).abs() < 0.11, "row {}", good[0].2);
    }
}

fn course(points: Vec<(f64, f64, f64)>) -> RoadForm {
    RoadForm::Course(Course { points, width: 16.0, spacing: 1.6, ring: None })
}

#[test]
fn courses_have_no_gaps_at_their_corners() {
    for degrees in [-150.0_f64, -90.0, -40.0, -8.0, 8.0, 25.0, 90.0, 135.0] {
        for before in [30.0, 30.7, 31.9] {
            let turn = degrees.to_radians();
            let corner = DVec3::new(before, 3.0, 0.0);
            let (sin, cos) = libm::sincos(turn);
            let end = corner + 30.0 * DVec3::new(cos, 0.1, sin);
            // Away from the inside of the curve, once it has turned by so much.
            let outwards = |angle: f64| {
                let (sin, cos) = libm::sincos(angle);
                DVec3::new(sin, 0.0, -cos) * turn.signum()
            };
            let road = course(vec![(0.0, 0.0, 0.0), corner.into(), end.into()]).build().unwrap();
            // Everywhere between what goes straight across before the corner and behind it, on the outer side.
            for i in 0..=40 {
                for away in 0..=8 {
                    let angle = turn * f64::from(i) / 40.0;
                    let point = corner + f64::from(away) * outwards(angle);
                    let near = road.nearest(point).unwrap().distance(point);
                    assert!(near < 1.45, "{degrees}°: {near} from {away} beside the corner, at {i} of 40");
                }
            }
            // And nothing is heaped up there.
            let outside = |x: &&DVec3| (**x - corner).dot(outwards(0.5 * turn)) > 1.0;
            let outer: Vec<_> = road.points().iter().filter(outside).collect();
            for (i, a) in outer.iter().enumerate() {
                for b in &outer[..i] {
                    assert!(a.distance(**b) > 0.5, "{degrees}°: {a} and {b}");
                }
            }
        }
    }
}

#[test]
fn courses_without_corners_are_rows() {
    let straight = course(vec![(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 0.0, 0.0), (40.0, 0.0, 0.0)]).build().unwrap();
    assert_eq!(straight.points().len(), 25 * 11);
    let plain = course(vec![(0.0, 0.0, 0.0), (40.0, 0.0, 0.0)]).build().unwrap();
    assert!(straight.points().iter().zip(plain.points()).all(|(a, b)| a.distance(*b) < 1e-12));
    // A ring at each row leaves none either.
    let points = vec![(0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 0.0, 20.0)];
    let ringed = RoadForm::Course(Course { points, width: 16.0, spacing: 1.6, ring: Some(30) }).build().unwrap();
    assert_eq!(ringed.points().len(), 25 * 30);
}

#[test]
fn courses_of_too_many_particles_are_refused_before_they_are_built() {
    let turns = |width, spacing, corners: u32| {
        let points = (0..corners).map(|i| (f64::from(i % 2), 0.0, 0.001 * f64::from(i))).collect();
        RoadForm::Course(Course { points, width, spacing, ring: None }).build().map(|road| road.points().len())
    };
    let said = turns(1000.0, 0.01, 3).unwrap_err().to_string();
    assert!(said.contains("a road has at most 4000000"), "{said}");
    // Few rows, but many corners with wide outer sides.
    let said = turns(1000.0, 1.0, 200).unwrap_err().to_string();
    assert!(said.contains("comes to 4000001 particles or more"), "{said}");
}
