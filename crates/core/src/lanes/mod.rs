//! The same physics over SIMD lanes, for motion in one vertical plane, to which every release from rest leads.
//!
//! The axis is (s, 0, c), the velocity (v_x, 0, v_z) and the angular velocity (0, ω, 0). Each formula here is the one of
//! the module of the same name one level up with the components that vanish left out and every rounding the same:
//! the results agree to the last bit with the three-dimensional engine, whatever the SIMD level.
//!
//! All lanes take the same impact at the same time and wait for the slowest search; it is rare that one needs a second pass. A lane whose particle has ended computes on without being looked at.

mod arrival;
mod bounce;
mod collision;
mod contact;
mod flight;
mod pack;
mod sink;

pub(crate) use bounce::{Release, bounce};
pub(crate) use pack::{Mask, Operand, Pack};
pub(crate) use sink::{Impact, Sink};
