//! The static grid of a road: which road particles can be near a point, and which near a line.

use core::ops::Range;

use bevy::{math::DVec3, platform::collections::HashMap};

/// How near two unit balls are that touch.
pub(super) const TOUCH: f64 = 2.0;
/// The edge of a cell. A particle's contacts are looked for in its cell alone, which therefore lists all that is within [`TOUCH`] of it.
const CELL: f64 = 4.0;
/// The edge of a block of so many particles. The nearest of them and the beams' hits are looked for block by block, so there should be about as many blocks as
/// particles in a block: on a road, which is a surface, its edge goes with the fourth root of their number.
fn block_edge(particles: usize) -> f64 {
    2.0 * (particles as f64).sqrt().sqrt()
}

/// Road particles by place. Its memory grows with their number and with nothing else.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// The number of each cell that has anything near.
    cells: HashMap<[i32; 3], u32>,
    /// Where the list of each cell begins in `near`; one more than there are cells.
    starts: Vec<u32>,
    /// Particles in rising order, cell by cell.
    near: Vec<u32>,
    blocks: Vec<Block>,
    /// Particles in rising order, block by block.
    members: Vec<u32>,
}

/// A block of road particles and the box around them.
#[derive(Clone, Debug)]
pub(super) struct Block {
    least: DVec3,
    most: DVec3,
    members: Range<u32>,
}

impl Block {
    /// The square of the distance from a point to the nearest that a particle of the block can be.
    pub(super) fn distance_squared(&self, point: DVec3) -> f64 {
        (point.clamp(self.least, self.most) - point).length_squared()
    }

    /// The middle of its box, and how far a corner is from there.
    pub(super) fn ball(&self) -> (DVec3, f64) {
        (0.5 * (self.least + self.most), 0.5 * self.least.distance(self.most))
    }
}

fn cell(point: DVec3, edge: f64) -> [i32; 3] {
    // What is beyond all numbers shares the outermost cell, for points and questions alike.
    (point / edge).floor().to_array().map(|x| x as i32)
}

impl Grid {
    pub(super) fn new(points: &[DVec3]) -> Self {
        let mut grid = Self::default();
        grid.list_cells(points);
        grid.list_blocks(points);
        grid
    }

    /// Counts what each cell lists, then writes the lists.
    fn list_cells(&mut self, points: &[DVec3]) {
        let mut counts: Vec<u32> = Vec::new();
        for &point in points {
            for key in around(point) {
                let next = counts.len() as u32;
                let id = *self.cells.entry(key).or_insert(next);
                if id == next {
                    counts.push(0);
                }
                counts[id as usize] += 1;
            }
        }
        self.starts = running_sum(&counts);
        let mut at = self.starts.clone();
        self.near = vec![0; self.starts.last().map_or(0, |&all| all as usize)];
        for (i, &point) in points.iter().enumerate() {
            for key in around(point) {
                if let Some(&id) = self.cells.get(&key) {
                    self.near[at[id as usize] as usize] = i as u32;
                    at[id as usize] += 1;
                }
            }
        }
    }

    fn list_blocks(&mut self, points: &[DVec3]) {
        let edge = block_edge(points.len());
        let mut ids: HashMap<[i32; 3], u32> = HashMap::default();
        let mut members: Vec<Vec<u32>> = Vec::new();
        for (i, &point) in points.iter().enumerate() {
            let next = members.len() as u32;
            let id = *ids.entry(cell(point, edge)).or_insert(next);
            if id == next {
                members.push(Vec::new());
            }
            members[id as usize].push(i as u32);
        }
        for list in members {
            let places = || list.iter().map(|&i| points[i as usize]);
            let least = places().fold(DVec3::INFINITY, DVec3::min);
            let most = places().fold(DVec3::NEG_INFINITY, DVec3::max);
            let first = self.members.len() as u32;
            self.blocks.push(Block { least, most, members: first..first + list.len() as u32 });
            self.members.extend(list);
        }
    }

    /// All particles that may be within [`TOUCH`] of a point, in rising order.
    #[inline]
    pub(super) fn near(&self, point: DVec3) -> &[u32] {
        let Some(&id) = self.cells.get(&cell(point, CELL)) else { return &[] };
        &self.near[self.starts[id as usize] as usize..self.starts[id as usize + 1] as usize]
    }

    /// How many bytes its lists take.
    pub(super) fn bytes(&self) -> usize {
        self.cells.capacity() * size_of::<([i32; 3], u32)>()
            + (self.starts.capacity() + self.near.capacity() + self.members.capacity()) * size_of::<u32>()
            + self.blocks.capacity() * size_of::<Block>()
    }

    pub(super) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// The particles of a block, in rising order.
    pub(super) fn members(&self, block: &Block) -> &[u32] {
        &self.members[block.members.start as usize..block.members.end as usize]
    }
}

/// The cells that have a place within [`TOUCH`] of a point, and some beside them.
fn around(point: DVec3) -> impl Iterator<Item = [i32; 3]> {
    // A little more, so that no rounding leaves out what touches.
    let reach = TOUCH * (1.0 + 1e-9);
    let ([x0, y0, z0], [x1, y1, z1]) = (cell(point - reach, CELL), cell(point + reach, CELL));
    let cube = (x0..=x1).flat_map(move |x| (y0..=y1).flat_map(move |y| (z0..=z1).map(move |z| [x, y, z])));
    cube.filter(move |key| {
        // Corners of the cube are out of reach.
        let least = DVec3::from(key.map(f64::from)) * CELL;
        (point.clamp(least, least + CELL) - point).length_squared() <= reach * reach
    })
}

fn running_sum(counts: &[u32]) -> Vec<u32> {
    let mut sum = 0;
    let mut sums = Vec::with_capacity(counts.len() + 1);
    sums.push(0);
    for count in counts {
        sum += count;
        sums.push(sum);
    }
    sums
}
