//! Vectors of doubles, one particle a lane, and the functions of analysis over them. Independent of the physics.
//!
//! Every operation is the IEEE 754 one in every lane, so that a formula written once over a [`Pack`] gives the same bits at every SIMD
//! level. A pack of one lane ([`one`]) is the scalar.

pub mod elementary;
#[cfg(any(target_arch = "wasm32", test))]
mod fused;
mod level;
mod pack;

pub use level::Level;
pub(crate) use pack::{Mask, Operand, Pack};

use pulp::Scalar;

/// A single lane.
pub(crate) fn one(x: f64) -> Pack<Scalar, 1> {
    Pack::splat(Scalar::new(), x)
}
