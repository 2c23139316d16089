//! Vectors of doubles, with one particle per lane, and elementary functions of them. Independent of the physics.
//!
//! Every operation follows IEEE 754 in every lane, so that a formula over a [`Pack`] gives the same bits at every SIMD level. A pack
//! of one lane ([`one`]) is a scalar.

pub mod elementary;
#[cfg(any(target_arch = "wasm32", test))]
mod fused;
mod lanewise;
mod level;
mod pack;

pub(crate) use lanewise::{Lanewise, lanewise};
pub use level::Level;
pub(crate) use pack::{LANES, Mask, Operand, Pack};

use pulp::Scalar;

/// A pack of one lane.
#[inline(always)]
pub(crate) fn one(x: f64) -> Pack<Scalar> {
    Pack::splat(Scalar::new(), x)
}
