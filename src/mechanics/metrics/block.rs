//! How well a block on a grid keeps its shape.

use bevy::math::DVec3;
use faer::{Mat, Side};
use serde::Serialize;

use super::pose::hexahedron_volume;
use crate::body::{Lattice, Particles};

/// The shape of a block on a grid at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlockShape {
    /// How far its masses are from where they are in the undeformed grid, after the best rigid motion of that: root of the mean square, in spacings.
    pub shape_error: f64,
    /// The volume of all cells over that of the undeformed grid; nothing where there is no cell.
    pub volume: Option<f64>,
    /// How many cells are inside out.
    pub inverted: usize,
    /// The smallest volume of a cell, below 0 inside out; nothing where there is no cell.
    pub smallest_cell: Option<f64>,
    /// How high its highest mass is above its lowest.
    pub height: f64,
}

impl BlockShape {
    /// Measures a block of masses at spacing 1; nothing where the particles are not those of the lattice.
    pub fn measure(particles: &Particles, lattice: Lattice) -> Option<Self> {
        Self::of_places(&particles.positions().collect::<Vec<_>>(), lattice)
    }

    /// As [`measure`](Self::measure), of masses at these places.
    pub fn of_places(places: &[DVec3], lattice: Lattice) -> Option<Self> {
        if places.len() != lattice.particles() {
            return None;
        }
        let [across, along, layers] = lattice.size();
        let corner = |cell: [usize; 3], i: usize| {
            // Round a face across x, then the face across from it.
            let [x, y, z] = [cell[0] + i / 4, cell[1] + usize::from(i % 4 > 1), cell[2] + usize::from((i + 1) % 4 > 1)];
            places[x + across * (y + along * z)]
        };
        let cells = (0..layers - 1)
            .flat_map(|z| (0..along - 1).flat_map(move |y| (0..across - 1).map(move |x| [x, y, z])))
            .map(|cell| hexahedron_volume(|i| corner(cell, i)));
        let (mut count, mut sum, mut inverted, mut smallest) = (0, 0.0, 0, f64::INFINITY);
        for volume in cells {
            count += 1;
            sum += volume;
            inverted += usize::from(volume < 0.0);
            smallest = smallest.min(volume);
        }
        let heights = places.iter().map(|place| place.y);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        Some(Self {
            shape_error: shape_error(places, lattice),
            volume: (count > 0).then(|| sum / f64::from(count)),
            inverted,
            smallest_cell: (count > 0).then_some(smallest),
            height: high - low,
        })
    }
}

/// B. K. P. Horn, "Closed-form solution of absolute orientation using unit quaternions" (1987): the best rotation is the eigenvector of the
/// largest eigenvalue of a symmetric 4 × 4 matrix, and the eigenvalue is all that the error asks for.
fn shape_error(places: &[DVec3], lattice: Lattice) -> f64 {
    let [across, along, _] = lattice.size();
    let grid = |i: usize| DVec3::new((i % across) as f64, (i / across % along) as f64, (i / (across * along)) as f64);
    let count = places.len() as f64;
    let middle = places.iter().sum::<DVec3>() / count;
    let grid_middle = (0..places.len()).map(grid).sum::<DVec3>() / count;
    let (mut s, mut squares) = ([[0.0; 3]; 3], 0.0);
    for (i, place) in places.iter().enumerate() {
        let (from, to) = (grid(i) - grid_middle, *place - middle);
        squares += from.length_squared() + to.length_squared();
        for (row, from) in s.iter_mut().zip(from.to_array()) {
            for (sum, to) in row.iter_mut().zip(to.to_array()) {
                *sum += from * to;
            }
        }
    }
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = s;
    let n = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let largest = Mat::from_fn(4, 4, |i, j| n[i][j]).self_adjoint_eigenvalues(Side::Lower).ok();
    let largest = largest.and_then(|values| values.last().copied()).unwrap_or(f64::NAN);
    ((squares - 2.0 * largest).max(0.0) / count).sqrt()
}
