//! What a strand does, in numbers: what can be said of it at one moment, and of its gait over cycles ([`Gait`]). And how well a block keeps its shape
//! ([`BlockShape`]).

mod block;
mod fourier;
mod gait;
mod path;
mod pose;

pub use block::BlockShape;
pub use gait::{Gait, GaitMetrics, SAMPLES_A_CYCLE};
pub use pose::{
    bend, cell_volume, heading, inverted_segment, is_lifted, length_at_rest, section_center, section_width,
    segment_length, spine_vector, strains,
};
