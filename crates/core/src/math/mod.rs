//! Vectors, of one particle or of one in each lane.

mod vector;

pub use vector::Vector;
pub(crate) use vector::Vectors;
