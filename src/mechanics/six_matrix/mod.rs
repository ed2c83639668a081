//! The second model of motion: the six-matrix particle system of Holopainen and Rönkkö, "Plausible motion simulation: Inchworm vs. Roller", GRAPP 2007.
//!
//! Particles are unit balls of unit mass with the columns p, v, d and m and the relations b (bonds) and c (collisions):
//!
//! ```text
//! p'_i = p_i + t·v'_i
//! v'_i = d_i·v_i + B_i(p) + C_i(p) + R_i(p, v, m)
//! m'_i = M_i(p, m)
//! B_i(p) = Σ_j b_ij (p_j − p_i)(1 − ‖p⁰_j − p⁰_i‖²/‖p_j − p_i‖²)
//! C_i(p) = Σ_j c_ij (p_j − p_i)·min{0, 1 − 4/‖p_j − p_i‖²}
//! ```
//!
//! Everything on the right is of the old state. **Forces are added per step and not multiplied by t**, so t is also the clock of a gait, and none of the methods of
//! [`integrators`](super::integrators) can step such a body. Of two particles in the same place neither acts on the other: 0/0 has no direction.
//!
//! One file each: the bonds B, the collisions C, the rules R and M and what they see of the road, the road with its grid, a hand that pulls at a particle (a
//! further term H, which print does not have), a step, and the dense form that they are tested against.

mod bonds;
mod contacts;
mod dense;
mod drive;
mod grid;
mod hand;
mod road;
mod rules;
mod stability;
mod step;

pub use dense::Dense;
pub use drive::{Beam, Sight, beams, look};
pub use road::{Road, RoadSearch, Scan};
pub use stability::{bond_eigenvalue, stability_limit};
pub use step::{Burst, SixParts, SixState, Stepper};
