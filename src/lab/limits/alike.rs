//! Bodies that are alike have the same limits.

use crate::lab::ProblemBody;

/// Those that are alike once, under all of their names.
pub(super) fn distinct(bodies: Vec<ProblemBody>) -> Vec<ProblemBody> {
    let mut all: Vec<ProblemBody> = Vec::new();
    for body in bodies {
        match all.iter_mut().find(|other| are_alike(other, &body)) {
            Some(other) => {
                other.name.push_str(", ");
                other.name.push_str(&body.name);
            }
            None => all.push(body),
        }
    }
    all
}

/// Whether two bodies differ only in where they are.
fn are_alike(a: &ProblemBody, b: &ProblemBody) -> bool {
    let placed = |body: &ProblemBody| {
        let positions: Vec<_> = body.particles.positions().collect();
        positions.iter().map(|&position| position - positions[0]).collect::<Vec<_>>()
    };
    a.particles.masses() == b.particles.masses()
        && a.particles.pinned() == b.particles.pinned()
        && placed(a) == placed(b)
        && (&a.springs, &a.muscles, &a.friction, &a.coulomb) == (&b.springs, &b.muscles, &b.friction, &b.coulomb)
        && (a.strand, &a.waves) == (b.strand, &b.waves)
        && (a.gravity, &a.ground, a.mass_damping) == (b.gravity, &b.ground, b.mass_damping)
}
