//! Work-precision charts: where things are drawn, what is written, and what data may be.

use ab_glyph::{Font, FontRef};
use wriggle::{
    lab::{
        Edge, Errors, Point, Setting, WorkPrecision,
        chart::{self, Cost, Guide, Look, Panel, Picture, Place, Rect, Shape, Text},
        page,
    },
    mechanics::integrators::{Method, StickRule},
};

/// A run of which the error follows from its step.
pub fn point(method: Method, stick: StickRule, dt: f64, evaluations: u64, error: Option<f64>) -> Point {
    let steps = (20.0 / dt).ceil() as u64;
    let seconds = 4e-8 * (steps * evaluations) as f64;
    Point {
        setting: Setting { method, stick, dt },
        steps,
        evaluations: steps * evaluations,
        runs: 20,
        seconds,
        median_seconds: 1.15 * seconds,
        errors: error.map(errors_of),
    }
}

/// All errors of a run, in proportion to the largest.
fn errors_of(largest: f64) -> Errors {
    let part = |part: f64| Some(largest / part);
    Errors {
        largest,
        rms: largest / 3.0,
        distance: largest / 2.0,
        cycle: part(5.0),
        energy: part(7.0),
        penetration: None,
    }
}

pub fn empty() -> WorkPrecision {
    WorkPrecision {
        scene: "garden".into(),
        title: "Garden".into(),
        duration: 20.0,
        real_time: 20.0 / 3.0,
        points: Vec::new(),
        edges: Method::ALL.map(|method| Edge { method, dt: f64::INFINITY, predicted: true }).to_vec(),
        setting: Setting { method: Method::RungeKutta4, stick: StickRule::InStages, dt: 0.05 },
        unit: wriggle::lab::Unit::Length,
        budget: 0.0089,
        reference: "DOP853 with located events, confirmed by Gauss collocation".into(),
        reference_error: 2.3e-12,
        machine: "AMD EPYC 7B13, one thread; Wriggle 0.1.0 (2d644c7), release build".into(),
    }
}

/// A chart as a sweep of every method would give it.
pub fn full() -> WorkPrecision {
    let mut chart = empty();
    for (i, method) in Method::ALL.into_iter().enumerate() {
        let order = f64::from(method.about().order);
        let evaluations = method.about().evaluations.unwrap_or(3);
        let limit = [0.7, 0.9, 1.1, 1.05, 0.72, 1.6, f64::INFINITY][i % 7];
        (chart.edges[i].dt, chart.edges[i].predicted) = (limit, i % 2 == 0);
        let sticks: &[_] = match order as u32 {
            2.. => &[StickRule::InStages, StickRule::EndOfStep],
            _ => &[StickRule::InStages],
        };
        for &stick in sticks {
            let order = if stick == StickRule::EndOfStep { 1.0 } else { order };
            let largest = if limit.is_finite() { limit } else { 1.0 };
            for dt in [2.0, 1.4, 0.98, 0.5, 0.25, 0.125, 0.05, 0.02, 0.005].map(|part| part * largest) {
                let noise = 1.0 + 0.3 * libm::sin(1e3 * dt + i as f64);
                let error = (0.1 + 0.07 * i as f64) * libm::pow(dt, order) * noise;
                let blown = dt >= limit;
                chart.points.push(point(method, stick, dt, evaluations, (!blown).then_some(error)));
            }
        }
    }
    chart.points.push(point(Method::SemiImplicitEuler, StickRule::InStages, 0.0005, 1, Some(1e-4)));
    chart.points.push(point(Method::RungeKutta4, StickRule::InStages, 0.05, 4, Some(6e-6)));
    chart
}

/// One run only.
pub fn one() -> WorkPrecision {
    let mut chart = empty();
    chart.points.push(point(Method::RungeKutta4, StickRule::InStages, 0.05, 4, Some(6e-6)));
    chart
}

/// Some runs without any error, a reference that is no better than the best runs, and a real time within reach.
fn exact() -> WorkPrecision {
    let mut chart = full();
    chart.points.truncate(30);
    for point in &mut chart.points[20..25] {
        point.errors = Some(errors_of(0.0));
    }
    (chart.real_time, chart.reference_error) = (5e-4, 2e-5);
    chart
}

/// Numbers as no run should give them.
fn absurd() -> WorkPrecision {
    let mut chart = full();
    let values = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e-300, 1e300, 5e-324];
    for (i, point) in chart.points.iter_mut().enumerate() {
        let value = values[i % values.len()];
        match i / values.len() % 4 {
            0 => point.setting.dt = value,
            1 => (point.seconds, point.median_seconds) = (value, values[(i + 3) % values.len()]),
            2 => (point.steps, point.evaluations) = (0, if value > 0.0 { u64::MAX } else { 0 }),
            _ => point.errors = Some(errors_of(value)),
        }
    }
    for (i, edge) in chart.edges.iter_mut().enumerate() {
        edge.dt = values[i % values.len()];
    }
    (chart.budget, chart.duration, chart.real_time) = (f64::NAN, f64::INFINITY, 0.0);
    (chart.reference_error, chart.setting.dt) = (f64::NAN, 0.0);
    chart.title = "A title that goes on and on ".repeat(20);
    chart.reference = "a\u{0}\n<b>&\"".repeat(200);
    chart
}

/// A chart of a method that is exactly of order 2 in both costs.
pub fn of_order_two() -> WorkPrecision {
    let mut chart = empty();
    let errors = (0..9).map(|i| 0.5 * libm::pow(0.25, f64::from(i)));
    chart.points = errors
        .zip([0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625, 0.0078125, 0.00390625, 0.001953125])
        .map(|(error, dt)| point(Method::RungeKutta2, StickRule::InStages, dt, 2, Some(error)))
        .collect();
    chart
}

fn distance_from(guide: &Guide, (x, y): Place) -> f64 {
    let (dx, dy) = (guide.to.0 - guide.from.0, guide.to.1 - guide.from.1);
    ((x - guide.from.0) * dy - (y - guide.from.1) * dx).abs() / libm::hypot(dx, dy)
}

/// The middles of the polygons of a colour in an SVG, in pixels of the picture.
pub fn marks(svg: &str, color: [u8; 3]) -> Vec<Place> {
    let [r, g, b] = color;
    let fill = format!("fill=\"#{r:02X}{g:02X}{b:02X}\"");
    let polygons = svg.lines().filter(|line| line.starts_with("<polygon") && line.contains(&fill));
    polygons
        .map(|line| {
            let points = line.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
            let points: Vec<Place> = points
                .split_whitespace()
                .map(|pair| pair.split_once(',').unwrap())
                .map(|(x, y)| (x.parse::<f64>().unwrap() / 4.0, y.parse::<f64>().unwrap() / 4.0))
                .collect();
            let count = points.len() as f64;
            let sum = points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
            (sum.0 / count, sum.1 / count)
        })
        .collect()
}

fn within(frame: &Rect, (x, y): Place) -> bool {
    frame.left <= x && x <= frame.right && frame.top <= y && y <= frame.bottom
}

#[test]
fn a_method_of_order_two_is_drawn_on_its_guide_line() {
    let chart = of_order_two();
    let plot = chart::plot(&chart);
    let drawn = marks(&chart::svg(&chart).unwrap(), Look::of(Method::RungeKutta2, StickRule::InStages).color);
    for panel in &plot.panels {
        assert_eq!(panel.guides.iter().map(|guide| guide.order).collect::<Vec<_>>(), [1, 2, 4]);
        let [first, second, fourth] = [0, 1, 2].map(|i| &panel.guides[i]);
        let here: Vec<_> = drawn.iter().copied().filter(|&place| within(&panel.frame, place)).collect();
        assert_eq!(here.len(), chart.points.len());
        for (&place, point) in here.iter().zip(&chart.points) {
            let known = panel.place(panel.cost.of(point), point.errors.unwrap().largest);
            assert!(libm::hypot(place.0 - known.0, place.1 - known.1) < 0.5, "{place:?} {known:?}");
            assert!(distance_from(second, place) < 1.0, "{place:?} is off {second:?}");
        }
        let last = here[here.len() - 1];
        assert!(distance_from(first, last) > 50.0 && distance_from(fourth, last) > 50.0);
    }
}

#[test]
fn axes_are_logarithmic_and_a_decade_is_a_decade() {
    let panels = chart::plot(&full()).panels;
    for Panel { x, y, frame, .. } in &panels {
        let steps = |scale: &chart::LogScale| scale.place(100.0) - scale.place(10.0);
        assert!((steps(x) - (x.place(1e-3) - x.place(1e-4))).abs() < 1e-9 && steps(x) > 0.0);
        assert!(steps(y) < 0.0, "larger errors are higher");
        for tick in x.ticks() {
            assert!((frame.left..=frame.right).contains(&x.place(tick.value)));
        }
        for tick in y.ticks() {
            assert!((frame.top..=frame.bottom).contains(&y.place(tick.value)));
        }
        assert!(y.ticks().iter().filter(|tick| tick.written).count() >= 3);
    }
    assert_eq!(panels.map(|panel| panel.cost), [Cost::Evaluations, Cost::Seconds]);
}

#[test]
fn what_blew_up_stands_in_the_strip_at_the_cost_of_a_whole_run() {
    let mut chart = of_order_two();
    chart.edges = vec![Edge { method: Method::RungeKutta2, dt: 0.7, predicted: true }];
    // Broken off after a few steps.
    let blown = Point { steps: 7, evaluations: 14, ..point(Method::RungeKutta2, StickRule::InStages, 1.0, 2, None) };
    let not_finite = point(Method::RungeKutta2, StickRule::InStages, 2.0, 2, Some(f64::NAN));
    chart.points.splice(0..0, [not_finite, blown]);
    let plot = chart::plot(&chart);
    let picture = chart::picture(&chart);
    let color = Look::of(Method::RungeKutta2, StickRule::InStages).color;
    for panel in &plot.panels {
        let [track] = &panel.tracks[..] else { panic!("{:?}", panel.tracks) };
        let known = chart.points[2];
        let cost = |dt| panel.cost.of(&known) * known.setting.dt / dt;
        for (x, dt) in track.crosses.iter().zip([2.0, 1.0]) {
            assert!((x - panel.x.place(cost(dt))).abs() < 1e-6, "{x} at dt {dt}");
        }
        assert_eq!(track.crosses.len(), 2);
        assert!((track.edge.unwrap() - panel.x.place(cost(0.7))).abs() < 1e-6);
        assert_eq!(track.label, "0.7");
        let strokes = picture.shapes.iter().filter(|shape| {
            matches!(shape, Shape::Line { points, color: drawn, .. }
                if *drawn == color && points.len() == 2 && points.iter().all(|&place| within(&panel.strip, place)))
        });
        assert!(strokes.count() > 4, "two strokes a cross and one for the limit");
        assert!(panel.strip.bottom < panel.frame.top);
    }
    assert_eq!(plot.series[0].good.len(), 9, "and nowhere else");
}

#[test]
fn settings_and_real_time_are_where_they_were_measured_or_said() {
    let said = |chart: &WorkPrecision, text: &str| chart::picture(chart).texts().any(|drawn| drawn.text.contains(text));
    let chart = full();
    for panel in chart::plot(&chart).panels {
        let near = |place: Option<Place>, setting: (Method, f64)| {
            let found = |point: &&Point| (point.setting.method, point.setting.dt) == setting;
            let point = chart.points.iter().find(found).unwrap();
            assert_eq!(place, Some(panel.place(panel.cost.of(point), point.errors.unwrap().largest)));
        };
        near(panel.setting, (Method::RungeKutta4, 0.05));
        near(panel.document, (Method::SemiImplicitEuler, 0.0005));
        assert_eq!(panel.real_time, None);
    }
    assert!(said(&chart, "real time, 6.67 s:") && said(&chart, "further right"));
    let close = WorkPrecision { real_time: 1e-3, ..full() };
    let [evaluations, seconds] = chart::plot(&close).panels;
    let x = seconds.x.place(1e-3);
    assert_eq!((evaluations.real_time, seconds.real_time), (None, Some(x)));
    let upright = [(x, seconds.frame.top), (x, seconds.frame.bottom)];
    let picture = chart::picture(&close);
    let is_line = |shape: &&Shape| matches!(shape, Shape::Line { points, width: 2.2, .. } if points[..] == upright);
    assert_eq!(picture.shapes.iter().filter(is_line).count(), 1, "on the axis it is a line");
    assert!(said(&close, "real time: 0.001 s"));
    // Between two runs, a setting lies on the line between them.
    let mut between = of_order_two();
    between.setting = Setting { method: Method::RungeKutta2, stick: StickRule::InStages, dt: 0.1 };
    let panel = &chart::plot(&between).panels[0];
    assert!(distance_from(&panel.guides[1], panel.setting.unwrap()) < 1e-6);
    assert!(said(&empty(), "this scene: dt 0.05 was not measured"));
}

#[test]
fn errors_that_the_reference_is_not_sure_enough_of_are_on_grey_and_marked() {
    let count = |chart: &WorkPrecision| {
        chart.points.iter().filter(|point| point.errors.is_some() && !chart.is_known(point)).count()
    };
    let [sure, unsure] = [1e-15, 1e-5].map(|reference_error| WorkPrecision { reference_error, ..full() });
    assert!(count(&sure) == 0 && count(&unsure) > 10 && count(&unsure) < full().points.len() - 10);
    let least = unsure.points.iter().filter(|point| unsure.is_known(point)).map(|point| point.largest_error().unwrap());
    assert!(least.fold(f64::INFINITY, f64::min) >= 1e-3);
    for (chart, frames) in [(&sure, 0), (&unsure, 2)] {
        let picture = chart::picture(chart);
        let grey = |shape: &&Shape| matches!(shape, Shape::Area { color: [0x9a, 0x9a, 0x9a], .. });
        let top = |shape: &Shape| match shape {
            Shape::Area { points, .. } => points[0].1,
            _ => 0.0,
        };
        let tops: Vec<_> = picture.shapes.iter().filter(grey).map(top).collect();
        let place = chart::plot(chart).panels[0].y.place(1e-3);
        assert_eq!(tops.iter().filter(|top| (**top - place).abs() < 1e-9).count(), frames, "{tops:?}");
        // And one in the legend.
        assert_eq!(tops.len(), if frames > 0 { frames + 1 } else { 0 });
        let said = picture.texts().any(|text| text.text.contains(&format!("{} of", count(chart))));
        assert_eq!(said, frames > 0);
        let html = page(std::slice::from_ref(chart), &[]).unwrap();
        let marks = html.split("<details>").nth(1).unwrap().matches(" †</td>").count();
        assert_eq!((marks, html.contains("<p>†")), (count(chart), frames > 0));
    }
}

#[test]
fn a_limit_that_is_a_bound_is_said_to_be_one() {
    let mut chart = of_order_two();
    chart.edges = vec![Edge { method: Method::RungeKutta2, dt: 0.7, predicted: false }];
    let said =
        |chart: &WorkPrecision, text: &str| chart::picture(chart).texts().filter(|drawn| drawn.text == text).count();
    assert_eq!((said(&chart, "≥ 0.7"), said(&chart, "largest stable step (≥: a bound)")), (3, 1));
    chart.edges[0].predicted = true;
    assert_eq!((said(&chart, "0.7"), said(&chart, "largest stable step (linear)")), (3, 1));
}

#[test]
fn the_star_of_the_scene_lies_over_all_marks_but_its_own() {
    let chart = full();
    let picture = chart::picture(&chart);
    let own = Look::of(chart.setting.method, chart.setting.stick).color;
    for panel in chart::plot(&chart).panels {
        let area = |shape: &Shape| match shape {
            Shape::Area { points, color, alpha }
                if *alpha == 1.0 && points.iter().all(|&at| within(&panel.frame, at)) =>
            {
                Some(*color)
            }
            _ => None,
        };
        let colors: Vec<_> = picture.shapes.iter().filter_map(area).collect();
        let star = colors.iter().position(|color| *color == [0xf0, 0xe4, 0x42]).unwrap();
        assert!(star > 100 && colors[star + 1..].iter().all(|color| *color == own || *color == [0xff; 3]));
        assert!(colors[star + 1..].contains(&own));
    }
}

/// All glyphs are in the bundled font, nothing is smaller than 12 pixels, outside of the picture or over another text.
pub fn check_texts(picture: &Picture) {
    let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).unwrap();
    let all = Rect { left: 0.0, top: 0.0, right: Picture::WIDTH, bottom: Picture::HEIGHT };
    let texts: Vec<&Text> = picture.texts().collect();
    for (i, text) in texts.iter().enumerate() {
        let bounds = text.bounds();
        assert!(all.contains(&bounds), "{text:?} leaves the picture");
        assert!(text.size >= 12.0, "{text:?} is small");
        for letter in text.text.chars() {
            assert_ne!(font.glyph_id(letter).0, 0, "no glyph for {letter:?} of {text:?}");
        }
        for other in &texts[..i] {
            assert!(!bounds.overlaps(&other.bounds()), "{text:?} lies over {other:?}");
        }
    }
}

#[test]
fn texts_never_overlap_and_every_letter_has_a_glyph() {
    for chart in [full(), empty(), one(), exact(), of_order_two()] {
        check_texts(&chart::picture(&chart));
    }
}

#[test]
fn first_and_last_step_of_a_lone_method_are_written() {
    let picture = chart::picture(&of_order_two());
    for dt in ["0.5", "0.00195"] {
        assert_eq!(picture.texts().filter(|text| text.text == dt).count(), 2, "{dt} in both panels");
    }
}

#[test]
fn no_number_spoils_a_chart() {
    for chart in [absurd(), empty(), one()] {
        for shape in chart::picture(&chart).shapes {
            let places = match shape {
                Shape::Line { points, .. } | Shape::Area { points, .. } => points,
                Shape::Text(text) => vec![text.at],
            };
            assert!(places.iter().all(|(x, y)| x.abs() < 1e5 && y.abs() < 1e5), "{places:?}");
        }
        let svg = chart::svg(&chart).unwrap();
        assert!(!svg.contains(|letter: char| letter.is_control() && letter != '\n'));
        page(&[chart], &[]).unwrap();
    }
}

#[test]
fn methods_differ_in_shape_and_line_where_colours_repeat() {
    let looks: Vec<_> = Method::ALL.into_iter().map(|method| Look::of(method, StickRule::InStages)).collect();
    for (i, look) in looks.iter().enumerate() {
        for other in &looks[..i] {
            let mut grey = *look;
            grey.color = other.color;
            assert_ne!(grey, *other, "they can be told apart without colour");
            assert!(look.color != other.color || look.dashes != other.dashes);
        }
    }
    let end = Look::of(Method::ALL[0], StickRule::EndOfStep);
    assert!(end.color == looks[0].color && end.dashes != looks[0].dashes);
}
