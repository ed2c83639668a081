//! The five answers.

use super::{
    Answer, ExerciseOptions, Table,
    runs::{ATTITUDES, Block, DROP, GRAVITY, KINDS, TURNED, cube, largest_step, spectrum},
};
use crate::{
    body::{BodyError, MassDamping, Neighbours},
    creatures::JellyPlan,
    lab::chart::{curves::Curves, short},
    mechanics::integrators::Method,
};

/// The template's step.
const DT: f64 = 0.1;
/// How often a curve is measured.
const SAMPLES: u32 = 200;

/// Damping by a rate, which does not change the physics with the step.
const CALM: MassDamping = MassDamping::Rate(0.1);

fn plan(count: u32, kinds: &[Neighbours]) -> JellyPlan {
    JellyPlan { drop: DROP, ..cube(count, kinds) }
}

fn fixed(value: f64, digits: usize) -> String {
    format!("{value:.digits$}")
}

/// Question 1: the kernel, and the template: free fall without springs.
pub(super) fn template(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let mut block = Block::new(plan(count, &[]), Method::StormerVerlet, DT)?.falling();
    let start = block.center();
    let span = 1.2 * (2.0 * (DROP + f64::from(count - 1)) / GRAVITY).sqrt();
    let fallen = block.follow(span, SAMPLES, Block::center);
    // The same while nothing has met the floor.
    let first = (2.0 * DROP / GRAVITY).sqrt();
    let point: Vec<_> =
        fallen.iter().take_while(|(t, _)| *t <= first).map(|&(t, _)| (t, start - 0.5 * GRAVITY * t * t)).collect();
    let off = fallen.iter().zip(&point).map(|((_, y), (_, fall))| (y - fall).abs()).fold(0.0, f64::max);
    let flat = block.body.particles.positions().all(|x| x.y == 0.0);
    Ok(Answer {
        question: "1. Overview of the template and its kernel",
        paragraphs: vec![
            "A step has four parts. First what pulls at each mass: gravity, and the springs to its neighbours, which a regular grid finds by where they are \
             and not in a list. The springs of a layer, and those to the next, are computed eight at a time, and each acts on both of its ends. Then \
             the velocities, then the positions, and last the floor: what came to be below y = 0 is put back on it and loses what of its velocity leads down. \
             Slabs of layers are shared by threads; the sums of a mass have the same order however they are shared."
                .into(),
            format!(
                "The template does all of that but the springs: every mass falls by itself. Until the first one meets the floor at t = √(2·{DROP}/g) = {}, \
                 the middle of the block follows ½gt² within {off:.1e}; in the end {} of the masses lie on the floor.",
                fixed(first, 1),
                if flat { "all" } else { "not all" },
            ),
        ],
        tables: Vec::new(),
        figures: vec![Curves {
            title: "Without springs: how high the middle of the block is".into(),
            across: "time".into(),
            upwards: "height of the middle".into(),
            curves: vec![("block".into(), fallen), ("a point in free fall".into(), point)],
        }],
    })
}

/// Question 2: springs of rest length 1.
pub(super) fn springs(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let start = || Block::new(plan(count, KINDS[0].1), Method::DampedVerlet, DT);
    let mut bouncing = start()?.falling();
    let mut block = start()?.falling().damped(CALM);
    let free = bouncing.follow(600.0, SAMPLES, Block::height);
    let calm = block.follow(600.0, SAMPLES, Block::height);
    block.take_until(options.time);
    let layer = |y: u32| {
        let (lattice, _) = block.body.block?;
        Some(block.body.particles.position(lattice.particle([1, y, 1]))?.y)
    };
    let rows = (0..count - 1).map(|y| {
        let shorter = layer(y).zip(layer(y + 1)).map_or(f64::NAN, |(low, high)| 1.0 - (high - low));
        let weight = GRAVITY * f64::from(count - 1 - y);
        vec![
            format!("{y} to {}", y + 1),
            format!("{shorter:.6}"),
            format!("{weight:.6}"),
            format!("{:+.3} %", 100.0 * (shorter / weight - 1.0)),
        ]
    });
    let volume = block.shape().and_then(|shape| shape.volume).unwrap_or(f64::NAN);
    Ok(Answer {
        question: "2. Springs of rest length 1",
        paragraphs: vec![format!(
            "Upright, the block lands on its lower face and stands. At rest each layer is shorter by the weight of what is above it over the stiffness, \
             which is what the table shows; the volume is {} of what it was.",
            fixed(volume, 4)
        )],
        tables: vec![Table {
            caption: "How much shorter the springs between two layers are at rest".into(),
            head: vec!["layers", "measured", "weight above / k", "off by"],
            rows: rows.collect(),
        }],
        figures: vec![Curves {
            title: "Upright on springs of length 1: the height of the block".into(),
            across: "time".into(),
            upwards: "height".into(),
            curves: vec![("undamped".into(), free), ("damped, rate 0.1".into(), calm)],
        }],
    })
}

/// Question 3: other attitudes.
pub(super) fn tilts(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let (mut rows, mut curves) = (Vec::new(), Vec::new());
    for (name, tilt, rotation) in ATTITUDES {
        let plan = JellyPlan { tilt, rotation, ..plan(count, KINDS[0].1) };
        let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(MassDamping::PerStep(0.01));
        let whole = block.height();
        let curve = block.follow(options.time, 2 * SAMPLES, Block::height);
        let halved = curve.iter().find(|(_, height)| *height < 0.5 * whole);
        let shape = block.shape();
        rows.push(vec![
            name.into(),
            fixed(block.height(), 3),
            halved.map_or("never".into(), |(t, _)| fixed(*t, 0)),
            shape.and_then(|shape| shape.volume).map_or("–".into(), |volume| fixed(volume, 3)),
            shape.map_or("–".into(), |shape| shape.inverted.to_string()),
        ]);
        curves.push((name.into(), curve));
    }
    // Smaller, so that its eigenvalues are found in no time; the count is that of any size.
    let small = count.min(4);
    let n = small as usize;
    let mut mechanisms = Vec::new();
    for ((name, kinds), theory) in KINDS.into_iter().zip([3 * n * n - 6, 0, 3, 0]) {
        let block = Block::new(cube(small, kinds), Method::StormerVerlet, DT)?;
        let free = spectrum(&block.body).iter().filter(|value| value.abs() < 1e-10).count();
        mechanisms.push(vec![name.into(), free.saturating_sub(6).to_string(), theory.to_string()]);
    }
    Ok(Answer {
        question: "3. Tilting and rotating the block",
        paragraphs: vec![
            "It collapses. Springs along the axes of the grid resist no shear: each row of the grid can slide along its neighbours, and no spring changes its \
             length at first. The upright block stands only because nothing pushes it sideways; a tilt of one degree is enough to bring it down."
                .into(),
            format!(
                "Counted: an N × N × N grid has 3N² motions in which no spring changes its length at first. Six of them are those of a rigid body; \
                 the other 3N² − 6 are mechanisms. The table has N = {small}."
            ),
        ],
        tables: vec![
            Table {
                caption: format!("Springs of length 1 alone, at t = {}", short(options.time)),
                head: vec!["start", "height", "below half at t", "volume", "cells inside out"],
                rows,
            },
            Table {
                caption: "Mechanisms: motions that no spring resists, without those of a rigid body".into(),
                head: vec!["springs of length", "found by rank", "theory"],
                rows: mechanisms,
            },
        ],
        figures: vec![Curves {
            title: "Springs of length 1 alone: the height of the block".into(),
            across: "time".into(),
            upwards: "height".into(),
            curves,
        }],
    })
}

/// Question 4: neighbours further away.
pub(super) fn neighbours(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let (mut shapes, mut costs, mut curves) = (Vec::new(), Vec::new(), Vec::new());
    let mut first = f64::NAN;
    for (name, kinds) in KINDS {
        for (attitude, tilt, rotation) in ATTITUDES {
            let plan = JellyPlan { tilt, rotation, ..plan(count, kinds) };
            let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(CALM);
            block.take_until(options.time);
            let Some(shape) = block.shape() else { continue };
            shapes.push(vec![
                name.into(),
                attitude.into(),
                fixed(shape.shape_error, 4),
                shape.volume.map_or("–".into(), |volume| fixed(volume, 4)),
                shape.inverted.to_string(),
            ]);
        }
        let plan = JellyPlan { tilt: 20.0, ..plan(count, kinds) };
        let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(MassDamping::PerStep(0.01));
        let error = |block: &Block| block.shape().map_or(f64::NAN, |shape| shape.shape_error);
        curves.push((name.to_owned(), block.follow(600.0, SAMPLES, error)));
        const STEPS: u64 = 1000;
        let seconds = (0..5).map(|_| block.take(STEPS)).fold(f64::INFINITY, f64::min) / STEPS as f64;
        first = if first.is_nan() { seconds } else { first };
        let springs = block.body.springs.len();
        costs.push(vec![
            name.into(),
            springs.to_string(),
            format!("{:.2} µs", 1e6 * seconds),
            format!("× {:.2}", seconds / first),
            format!("{:.0} million", springs as f64 / seconds / 1e6),
        ]);
    }
    // What does not hold is out of the picture of what does.
    curves.remove(0);
    let n = count;
    Ok(Answer {
        question: "4. Neighbours at √2 and √3",
        paragraphs: vec![
            "They hold the block in every attitude. √2 alone is enough: no mechanism is left. √3 alone leaves three, which gravity does not find, and is \
             softer. Both together cost most and add nothing that is seen."
                .into(),
            format!(
                "A block has 3N²(N−1) springs of length 1, {} here, 6N(N−1)² of √2 and 4(N−1)³ of √3; what a step costs grows less than their number \
                 while the masses themselves still count.",
                3 * n * n * (n - 1)
            ),
        ],
        tables: vec![
            Table {
                caption: format!("At rest, t = {}", short(options.time)),
                head: vec!["springs of length", "start", "shape error", "volume", "cells inside out"],
                rows: shapes,
            },
            Table {
                caption: "What a step costs: shortest of five times a thousand".into(),
                head: vec!["springs of length", "springs", "a step", "as a multiple", "spring updates a second"],
                rows: costs,
            },
        ],
        figures: vec![Curves {
            title: "Dropped with a tilt of 20°, λ = 0.01: how far the masses are from their grid".into(),
            across: "time".into(),
            upwards: "shape error".into(),
            curves,
        }],
    })
}

/// Question 5: Verlet and damping.
pub(super) fn verlet(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let mut limits = Vec::new();
    for (name, kinds) in KINDS {
        // Edges alone have no stiffness sideways: turned, it would be another body after a while.
        let rotation = (kinds.len() > 1).then_some(TURNED);
        let plan = JellyPlan { rotation, ..cube(count, kinds) };
        let omega =
            spectrum(&Block::new(plan.clone(), Method::StormerVerlet, DT)?.body).last().map_or(f64::NAN, |v| v.sqrt());
        let limit = 2.0 / omega;
        let mut row = vec![name.into(), fixed(omega, 3), fixed(limit, 3)];
        let euler = largest_step(&plan, Method::ExplicitEuler, None, [0.0, 0.1 * limit], options)?;
        row.push(fixed(euler, 4));
        let near = [0.8 * limit, 1.1 * limit];
        for method in [Method::SemiImplicitEuler, Method::StormerVerlet] {
            row.push(fixed(largest_step(&plan, method, None, near, options)?, 3));
        }
        for loss in [0.01, 0.1, 0.5] {
            let theory = (4.0_f64 - 2.0 * loss).sqrt() / omega;
            let damping = Some(MassDamping::PerStep(loss));
            let near = [0.8 * theory, 1.1 * theory];
            let found = largest_step(&plan, Method::DampedVerlet, damping, near, options)?;
            row.push(format!("{found:.3} ({theory:.3})"));
        }
        limits.push(row);
    }
    let mut curves = Vec::new();
    for (name, loss) in [("Verlet", 0.0), ("λ = 0.001", 0.001), ("λ = 0.01", 0.01)] {
        let plan = JellyPlan { tilt: 20.0, ..plan(count, &Neighbours::ALL) };
        let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(MassDamping::per_step(loss)?);
        let error = |block: &Block| block.shape().map_or(f64::NAN, |shape| shape.shape_error);
        curves.push((name.to_owned(), block.follow(600.0, SAMPLES, error)));
    }
    Ok(Answer {
        question: "5. Verlet and damping",
        paragraphs: vec![
            "Verlet allows no larger step than symplectic Euler: the two are the same recurrence for positions, stable up to 2/ω_max. Forward Euler, \
             which feeds energy to every oscillation, needs steps many times smaller. What Verlet adds is order 2 without another evaluation of the forces."
                .into(),
            "Damping lowers the largest step, to √(4 − 2λ)/ω_max, and removes the ringing after the landing. λ is what a step takes of the velocity: the rate of \
             the damping is λ/dt, so the same λ with another step is other physics. It also brakes the fall: the more damping, the later the landing."
                .into(),
            "With λ = 0.5 the step at which a spring bursts is found above the theory: a spring that is squeezed through its own length turns over, and what \
             swings too fast is braked so strongly that it rattles within bounds."
                .into(),
        ],
        tables: vec![Table {
            caption: format!(
                "The largest stable step, by halving: a free block that trembles, {} steps and {:.0} units of time, no spring beyond four rest lengths. Theory \
                 in brackets",
                options.trial,
                f64::from(options.trial) * 400.0 / 3000.0
            ),
            head: vec![
                "springs of length",
                "ω_max",
                "2/ω_max",
                "forward Euler",
                "symplectic Euler",
                "Verlet",
                "damped, λ = 0.01",
                "λ = 0.1",
                "λ = 0.5",
            ],
            rows: limits,
        }],
        figures: vec![Curves {
            title: "All springs, dropped with a tilt of 20°: how far the masses are from their grid".into(),
            across: "time".into(),
            upwards: "shape error".into(),
            curves,
        }],
    })
}
