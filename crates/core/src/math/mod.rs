//! Vectors, of one particle or of one in each lane, and symmetric matrices.

mod symmetric;
mod vector;

pub use symmetric::Symmetric;
pub use vector::Vector;
pub(crate) use vector::Vectors;
