//! What is done with the layers of a block, as the way through them sees it.

use super::{columns::Eight, layer::Layer};

/// Where layers come from, and what is done with them.
pub(super) trait Task: Send {
    /// Brings a layer to where it feels the springs, once in a sweep: one of the slab, or the one behind it, or before it where that is not [taken over](Self::take_over).
    fn read(&mut self, z: usize, layer: &mut Layer<'_>);

    /// Uses the forces on the eight masses of a layer of the slab that begin with a row. They are complete, and no spring that is still to be computed ends there.
    fn write(&mut self, z: usize, row: usize, layer: &mut Layer<'_>, forces: [Eight; 3]);

    /// Gives the slab behind the sums of the springs that lead to its first layer from this one. Where nobody wants them they are lost.
    fn hand_on(&mut self, _: &[f64]) {}

    /// Whether the slab before has given its sums of the springs that lead to the first layer of this one. If not, they are computed once more.
    fn take_over(&mut self, _: &mut [f64]) -> bool {
        false
    }
}
