//! The exercise's answers: what was measured is near the theory beside it.

use wriggle::lab::exercise::{ExerciseOptions, exercise, html, text};

#[test]
fn the_exercise_is_answered_with_numbers_near_their_theory() {
    let mut told = Vec::new();
    let options = ExerciseOptions { count: 3, time: 600.0, halvings: 4, trial: 750 };
    let answered = exercise(&options, &mut |done| told.push(done)).unwrap();
    assert_eq!(told, [1, 2, 3, 4, 5]);
    let number = |cell: &str| cell.split_whitespace().next().unwrap().parse::<f64>().unwrap();
    let tables: Vec<_> = answered.answers.iter().map(|answer| &answer.tables).collect();

    for row in &tables[0][0].rows {
        // To a step of 0.1, in which gravity adds 1e-4.
        let late = number(&row[2]) - number(&row[3]);
        assert!((-0.01..0.11).contains(&late), "{row:?}");
        assert!((0.0..=2e-4).contains(&(number(&row[5]) - number(&row[4]))), "{row:?}");
    }
    assert_eq!(tables[0][0].rows.len(), 3);
    for row in &tables[1][0].rows {
        assert!((number(&row[1]) / number(&row[2]) - 1.0).abs() < 0.01, "{row:?}");
    }
    let [upright, .., turned] = &tables[2][0].rows[..] else { panic!() };
    assert!(number(&upright[1]) > 1.9 && upright[2] == "not yet", "{upright:?}");
    assert!(number(&turned[1]) < 0.5, "{turned:?}");
    for row in &tables[2][1].rows {
        assert_eq!(row[1], row[2], "{row:?}");
    }
    for row in tables[3][0].rows.iter().filter(|row| row[0].contains("√2")) {
        assert!(number(&row[2]) < 0.01 && row[4] == "0", "{row:?}");
    }
    for row in &tables[4][0].rows {
        let limit = number(&row[2]);
        // A trial as short finds a slow growth late.
        assert!(number(&row[3]) < limit / 4.0 && row[3].ends_with(" (0)"), "{row:?}");
        assert!(
            (number(&row[4]) / limit - 1.0).abs() < 0.04 && (number(&row[5]) / limit - 1.0).abs() < 0.04,
            "{row:?}"
        );
        for (column, cell) in row.iter().enumerate().skip(6) {
            let (found, theory) = cell.split_once(" (").unwrap();
            let ratio = number(found) / number(theory.trim_end_matches(')'));
            // Damped strongly, a block of edges alone rattles within bounds above its linear limit.
            let most = if (row[0].as_str(), column) == ("1", 8) { 1.5 } else { 1.05 };
            assert!((0.95..most).contains(&ratio), "{ratio}: {row:?}");
        }
    }

    let (page, text) = (html(&answered).unwrap(), text(&answered));
    assert_eq!(page.matches("<svg").count(), 5);
    for said in [&page, &text] {
        assert!(said.contains("msd_kernel") && said.contains("debug build") == cfg!(debug_assertions));
        assert!(!["NaN", ">inf", " inf "].iter().any(|bad| said.contains(bad)), "{said}");
        for question in ["1. Overview", "2. Springs", "3. Tilting", "4. Neighbours", "5. Verlet"] {
            assert!(said.contains(question));
        }
    }
}
