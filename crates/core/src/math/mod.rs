//! Vectors, of one particle or of one in each lane, symmetric matrices and rotations.

mod quaternion;
mod symmetric;
mod vector;

pub use quaternion::Quaternion;
pub(crate) use quaternion::sum;
pub use symmetric::Symmetric;
pub use vector::Vector;
pub(crate) use vector::Vectors;
