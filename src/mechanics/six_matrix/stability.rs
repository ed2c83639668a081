//! How large a step may be.

use crate::{
    body::{Bonds, Columns},
    mechanics::stability::{BondLine, largest_bond_eigenvalue},
};

/// K: the largest eigenvalue of all bonds at rest, each a spring of stiffness 2 times the factor along its line, on unit masses. From above, within 2 % or so.
/// A bond that only one end feels counts as if both did.
pub fn bond_eigenvalue(bonds: &Bonds) -> f64 {
    let rest = bonds.rest();
    let lines = bonds.relation().pairs().map(|(i, j, _)| BondLine {
        ends: [i, j],
        direction: (rest[j] - rest[i]).normalize_or_zero(),
        stiffness: 2.0 * bonds.stiffness(),
    });
    largest_bond_eigenvalue(lines, rest.len())
}

/// The largest stable step, t ≤ 2(1 + d)/K: v' = dv − Kx, x' = x + tv' keeps |λ| ≤ 1 up to there. Contacts, which are stiffer the deeper they are, are not in it.
/// Infinite for a body without bonds.
pub fn stability_limit(bonds: &Bonds, columns: &Columns) -> f64 {
    let damping = columns.damping().iter().copied().fold(f64::INFINITY, f64::min);
    let eigenvalue = bond_eigenvalue(bonds);
    if eigenvalue > 0.0 { (2.0 * (1.0 + damping) / eigenvalue).max(0.0) } else { f64::INFINITY }
}
