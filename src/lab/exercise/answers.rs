//! The five answers.

use super::{
    Answer, ExerciseOptions, Table,
    runs::{
        ATTITUDES, Block, DROP, GRAVITY, KINDS, NO_STIFFNESS, TURNED, along, cube, free_motions, largest_step, spectrum,
    },
};
use crate::{
    body::{BodyError, MassDamping, Neighbours, ParticleId},
    creatures::JellyPlan,
    lab::{
        IS_DEBUG_BUILD,
        chart::{curves::Curves, short},
    },
    mechanics::integrators::Method,
};

/// The template's step.
const DT: f64 = 0.1;
/// How often a curve is measured that does not swing.
const SAMPLES: u32 = 200;
/// How long a block is followed that does, and how often it is measured: some fifteen times a period of its slowest swing, 3.6.
const SWINGS: f64 = 600.0;
const FINE_SAMPLES: u32 = 2400;

/// A block whose masses are this near to their grid keeps its shape, in spacings.
const HOLDS: f64 = 0.05;

/// Damping by a rate, which does not change the physics with the step.
const CALM: MassDamping = MassDamping::Rate(0.1);

fn plan(count: u32, kinds: &[Neighbours]) -> JellyPlan {
    JellyPlan { drop: DROP, ..cube(count, kinds) }
}

fn fixed(value: f64, digits: usize) -> String {
    format!("{value:.digits$}")
}

/// Words with commas and an `and` between them.
fn listed(words: &[&str]) -> String {
    match words {
        [] => "none".into(),
        [one] => (*one).into(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// What speeds were measured with.
fn build() -> &'static str {
    if IS_DEBUG_BUILD { "; this is a debug build, whose speeds say little" } else { "" }
}

/// When each layer of the template's block meets the floor and how fast, beside √(2h/g) and √(2gh).
fn impacts(count: u32) -> Result<Vec<Vec<String>>, BodyError> {
    let mut block = Block::new(plan(count, &[]), Method::StormerVerlet, DT)?.falling();
    let mass = |layer: u32| ParticleId(layer * count);
    let heights: Vec<_> = (0..count).filter_map(|layer| block.fall(mass(layer))).map(|(height, _)| height).collect();
    let mut rows = Vec::new();
    for (layer, &height) in (0..count).zip(&heights) {
        let (time, speed) = ((2.0 * height / GRAVITY).sqrt(), (2.0 * GRAVITY * height).sqrt());
        let mut falling = 0.0;
        // Twice the time that it should take is enough to see that it takes longer.
        while block.time() < 2.0 * time && block.fall(mass(layer)).is_some_and(|(height, _)| height > 0.0) {
            falling = block.fall(mass(layer)).map_or(0.0, |(_, speed)| speed);
            block.take(1);
        }
        rows.push(vec![
            layer.to_string(),
            fixed(height, 1),
            fixed(block.time(), 1),
            fixed(time, 2),
            fixed(falling, 4),
            fixed(speed, 4),
        ]);
    }
    Ok(rows)
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
            "msd_kernel is the template's step: by the exercise's words it accelerates all particles of a 3-D grid towards the ground, y = 0, and no more. To it \
             corresponds what is done here with a layer of the grid (mechanics::lattice, Model::step_lattice): the same for every mass, whose neighbours are \
             found by where they are in the grid, eight masses at a time, and slabs of layers side by side in threads."
                .into(),
            "A step has four parts. First what pulls at each mass: gravity, and the springs to its neighbours. The springs of a layer, and those to the next, are \
             computed once, and each acts on both of its ends. Then the velocities, then the positions, and last the floor: what came to be below y = 0 is put \
             back on it and loses what of its velocity leads down. The sums of a mass have the same order however slabs are shared by threads."
                .into(),
            format!(
                "The template does all of that but the springs: every mass falls by itself, and the layers meet the floor one after another. Until the first one meets the floor at t = √(2·{DROP}/g) = {}, \
                 the middle of the block follows ½gt² within {off:.1e}; in the end {} of the masses lie on the floor.",
                fixed(first, 1),
                if flat { "all" } else { "not all" },
            ),
        ],
        tables: vec![Table {
            caption: format!("Without springs, g = {GRAVITY}: when a layer meets the floor, to a step of {DT}, and how fast it was before that step"),
            head: vec!["layer", "starts at h", "lands at t", "√(2h/g)", "speed", "√(2gh)"],
            rows: impacts(count)?,
        }],
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
    let free = bouncing.follow(SWINGS, FINE_SAMPLES, Block::height);
    let calm = block.follow(SWINGS, FINE_SAMPLES, Block::height);
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
            "Upright, the block lands on its lower face; at t = {} it is {} high. At rest each layer is shorter by the weight of what is above it over the \
             stiffness, which stands beside what was measured; the volume is {} of what it was.",
            short(options.time),
            fixed(block.height(), 3),
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

/// When a curve falls below a value, on the line between its places.
fn falls_below(curve: &[(f64, f64)], value: f64) -> Option<f64> {
    curve.windows(2).find_map(|pair| {
        let [(from, above), (to, below)] = pair else { return None };
        (*above >= value && *below < value).then(|| from + (to - from) * (above - value) / (above - below))
    })
}

/// Question 3: other attitudes.
pub(super) fn tilts(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let (mut rows, mut curves) = (Vec::new(), Vec::new());
    let (mut fallen, mut standing) = (Vec::new(), Vec::new());
    for (name, tilt, rotation) in ATTITUDES {
        let plan = JellyPlan { tilt, rotation, ..plan(count, KINDS[0].1) };
        let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(MassDamping::PerStep(0.01));
        // Some one sample a unit of time.
        let curve = block.follow(options.time, options.time as u32, Block::height);
        let halved = falls_below(&curve, 0.5 * f64::from(count - 1));
        let shape = block.shape();
        if halved.is_some() {
            fallen.push(name)
        } else {
            standing.push(name)
        }
        rows.push(vec![
            name.into(),
            fixed(block.height(), 3),
            halved.map_or("not yet".into(), |t| fixed(t, 0)),
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
        let free = spectrum(&block.body).iter().filter(|value| value.abs() < NO_STIFFNESS).count();
        mechanisms.push(vec![name.into(), free.saturating_sub(6).to_string(), theory.to_string()]);
    }
    Ok(Answer {
        question: "3. Tilting and rotating the block",
        paragraphs: vec![
            format!(
                "Until t = {}, {} of the {} blocks fall below half of their height ({}), and the others do not ({}). Springs along the axes of the grid resist no \
                 shear: each row of the grid can slide along its neighbours, and no spring changes its length at first. A block stands on them only while nothing \
                 pushes it sideways.",
                short(options.time),
                fallen.len(),
                ATTITUDES.len(),
                listed(&fallen),
                listed(&standing),
            ),
            format!(
                "Counted: an N × N × N grid has 3N² motions in which no spring changes its length at first. Six of them are those of a rigid body; \
                 the other 3N² − 6 are mechanisms. The table has N = {small}."
            ),
        ],
        tables: vec![
            Table {
                caption: format!("Springs of length 1 alone, at t = {}", short(options.time)),
                head: vec!["start", "height", "below half, (N − 1)/2, at t", "volume", "cells inside out"],
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

/// Of the shape error of an upright block of lengths 1 and √3, the part of its square at a time that is motion along mechanisms: that its springs do not resist, and no
/// rigid body has.
fn part_in_mechanisms(count: u32, time: f64) -> Result<f64, BodyError> {
    let of = |kinds: &[Neighbours]| Block::new(plan(count, kinds), Method::DampedVerlet, DT);
    let (start, firm) = (of(KINDS[2].1)?, of(KINDS[3].1)?);
    let mut block = of(KINDS[2].1)?.falling().damped(CALM);
    block.take_until(time);
    let positions = |block: &Block| block.body.particles.positions().flat_map(|x| x.to_array()).collect::<Vec<_>>();
    let less = |a: Vec<f64>, b: Vec<f64>| a.into_iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>();
    let moved = less(positions(&block), positions(&start));
    // What is left of it without rigid motions, which are all that a block with all springs is free to do.
    let error = less(moved.clone(), along(&moved, &free_motions(&firm.body)));
    let free = along(&error, &free_motions(&start.body));
    let square = |vector: &[f64]| vector.iter().map(|value| value * value).sum::<f64>();
    Ok(square(&free) / square(&error))
}

/// Question 4: neighbours further away.
pub(super) fn neighbours(options: &ExerciseOptions) -> Result<Answer, BodyError> {
    let count = options.count;
    let (mut shapes, mut costs, mut curves) = (Vec::new(), Vec::new(), Vec::new());
    let (mut first, mut last, mut more) = (None, f64::NAN, f64::NAN);
    let (mut errors, mut holding, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for (name, kinds) in KINDS {
        let mut worst = 0.0_f64;
        for (attitude, tilt, rotation) in ATTITUDES {
            let plan = JellyPlan { tilt, rotation, ..plan(count, kinds) };
            let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(CALM);
            block.take_until(options.time);
            let Some(shape) = block.shape() else { continue };
            worst = worst.max(shape.shape_error);
            shapes.push(vec![
                name.into(),
                attitude.into(),
                fixed(shape.shape_error, 4),
                shape.volume.map_or("–".into(), |volume| fixed(volume, 4)),
                shape.inverted.to_string(),
            ]);
        }
        errors.push(format!("{worst:.4} with {name}"));
        if worst < HOLDS {
            holding.push(name)
        } else {
            others.push(name)
        }
        let plan = JellyPlan { tilt: 20.0, ..plan(count, kinds) };
        let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(MassDamping::PerStep(0.01));
        let error = |block: &Block| block.shape().map_or(f64::NAN, |shape| shape.shape_error);
        curves.push((name.to_owned(), block.follow(SWINGS, FINE_SAMPLES, error)));
        const STEPS: u64 = 1000;
        let seconds = (0..5).map(|_| block.take(STEPS)).fold(f64::INFINITY, f64::min) / STEPS as f64;
        let springs = block.body.springs.len();
        let (one, few) = *first.get_or_insert((seconds, springs));
        (last, more) = (seconds / one, springs as f64 / few as f64);
        costs.push(vec![
            name.into(),
            springs.to_string(),
            format!("{:.2} µs", 1e6 * seconds),
            format!("× {last:.2}"),
            format!("{:.0} million", springs as f64 / seconds / 1e6),
        ]);
    }
    // What does not hold is out of the picture of what does.
    curves.remove(0);
    let part = part_in_mechanisms(count, options.time)?;
    let n = count;
    Ok(Answer {
        question: "4. Neighbours at √2 and √3",
        paragraphs: vec![
            format!(
                "The largest shape error at t = {} in any attitude is {} spacings. Within {HOLDS} in every attitude are the blocks with springs of length {}; not \
                 those with {}.",
                short(options.time),
                errors.join(", "),
                holding.join("; "),
                if others.is_empty() { "none".into() } else { others.join("; ") },
            ),
            format!(
                "With √2 no mechanism is left. √3 alone leaves three, along which the weight of the block lets it buckle, the slower the more it is damped: of the \
                 square of its shape error, upright, at t = {}, {:.0} % is motion that none of its springs resists.",
                short(options.time),
                100.0 * part
            ),
            format!(
                "A block has 3N²(N−1) springs of length 1, {} here, 6N(N−1)² of √2 and 4(N−1)³ of √3. With all of them it has {more:.2} times as many as with those of \
                 length 1 alone, and a step took {last:.2} times as long.",
                3 * n * n * (n - 1)
            ),
        ],
        tables: vec![
            Table {
                caption: format!("At t = {}", short(options.time)),
                head: vec!["springs of length", "start", "shape error", "volume", "cells inside out"],
                rows: shapes,
            },
            Table {
                caption: format!("What a step costs: shortest of five times a thousand{}", build()),
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
    /// So far above the theory is more than the trials' own uncertainty.
    const ABOVE: f64 = 1.03;
    let (mut limits, mut smaller, mut rattling) = (Vec::new(), Vec::new(), Vec::new());
    for (name, kinds) in KINDS {
        // Edges alone have no stiffness sideways: turned, it would be another body after a while.
        let rotation = (kinds.len() > 1).then_some(TURNED);
        let plan = JellyPlan { rotation, ..cube(count, kinds) };
        let omega =
            spectrum(&Block::new(plan.clone(), Method::StormerVerlet, DT)?.body).last().map_or(f64::NAN, |v| v.sqrt());
        let limit = 2.0 / omega;
        let mut row = vec![name.into(), fixed(omega, 3), fixed(limit, 3)];
        let euler = largest_step(&plan, Method::ExplicitEuler, None, [0.0, 0.1 * limit], options)?;
        row.push(format!("{} (0)", euler.text(4)));
        let near = [0.8 * limit, 1.1 * limit];
        for method in [Method::SemiImplicitEuler, Method::StormerVerlet] {
            let found = largest_step(&plan, method, None, near, options)?;
            row.push(found.text(3));
            if method == Method::SemiImplicitEuler {
                smaller.push(found.dt / euler.dt);
            }
        }
        for loss in [0.01, 0.1, 0.5] {
            let theory = (4.0_f64 - 2.0 * loss).sqrt() / omega;
            let damping = Some(MassDamping::PerStep(loss));
            let near = [0.8 * theory, 1.1 * theory];
            let found = largest_step(&plan, Method::DampedVerlet, damping, near, options)?;
            row.push(format!("{} ({theory:.3})", found.text(3)));
            if found.dt > ABOVE * theory {
                rattling.push(format!("{name} with λ = {loss}"));
            }
        }
        limits.push(row);
    }
    let mut curves = Vec::new();
    for (name, loss) in [("Verlet", 0.0), ("λ = 0.001", 0.001), ("λ = 0.01", 0.01)] {
        let plan = JellyPlan { tilt: 20.0, ..plan(count, &Neighbours::ALL) };
        let mut block = Block::new(plan, Method::DampedVerlet, DT)?.falling().damped(MassDamping::per_step(loss)?);
        let error = |block: &Block| block.shape().map_or(f64::NAN, |shape| shape.shape_error);
        curves.push((name.to_owned(), block.follow(SWINGS, FINE_SAMPLES, error)));
    }
    let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max].map(|pick| smaller.iter().copied().reduce(pick));
    let mut paragraphs = vec![
        format!(
            "Verlet allows no larger step than symplectic Euler: the two are the same recurrence for positions, stable up to 2/ω_max. Forward Euler has no \
             stable step without damping: in each it multiplies the energy of every oscillation by 1 + (ω·dt)². What is found for it is how small a step has to be \
             for that not to burst a spring within the trial: {:.0} to {:.0} times smaller here. What Verlet adds is order 2 without another evaluation of the forces.",
            least.unwrap_or(f64::NAN),
            most.unwrap_or(f64::NAN),
        ),
        "Damping lowers the largest step, to √(4 − 2λ)/ω_max, and removes the ringing after the landing. λ is what a step takes of the velocity: the rate of \
         the damping is λ/dt, so the same λ with another step is other physics. It also brakes the fall: the more damping, the later the landing."
            .to_owned(),
    ];
    if !rattling.is_empty() {
        paragraphs.push(format!(
            "Found above the theory: {}. A spring that is squeezed through its own length turns over, and what swings too fast is braked so strongly that it \
             rattles within bounds before a spring bursts.",
            rattling.join("; ")
        ));
    }
    Ok(Answer {
        question: "5. Verlet and damping",
        paragraphs,
        tables: vec![Table {
            caption: format!(
                "The largest stable step, by halving: a free block that trembles, {} steps and {:.0} units of time, no spring beyond four rest lengths; > where \
                 no larger step was found unstable. Theory in brackets",
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_five_are_below_half_of_their_height_when_the_reference_says() {
        let options = ExerciseOptions { time: 600.0, ..ExerciseOptions::default() };
        let answer = tilts(&options).unwrap();
        let found: Vec<_> = answer.tables[0].rows.iter().map(|row| row[2].as_str()).collect();
        assert_eq!(found[0], "not yet");
        for (found, reference) in found[1..].iter().zip([486.0, 505.0, 581.0]) {
            let found: f64 = found.parse().unwrap();
            assert!((found - reference).abs() <= 1.0, "{found}, not {reference}");
        }
        assert!(answer.paragraphs[0].contains("3 of the 4 blocks"), "{}", answer.paragraphs[0]);
    }

    #[test]
    fn a_block_of_lengths_one_and_root_three_comes_to_lean_along_its_mechanisms() {
        let [early, late] = [400.0, 4000.0].map(|time| part_in_mechanisms(3, time).unwrap());
        assert!(early < 0.1 && late > 0.9, "{early} {late}");
    }

    #[test]
    fn what_has_not_fallen_yet_is_not_said_to_have() {
        let options = ExerciseOptions { count: 3, time: 300.0, ..ExerciseOptions::default() };
        let answer = tilts(&options).unwrap();
        assert!(answer.tables[0].rows.iter().all(|row| row[2] == "not yet"), "{:?}", answer.tables[0].rows);
        assert!(answer.paragraphs[0].contains("0 of the 4 blocks"), "{}", answer.paragraphs[0]);
    }
}
