//! The bounce loop, steps 1–7 of Sec. III of the paper: next contact, motion until then, impact, for as many particles at once as
//! there are lanes, for planar and spatial motion and every hull.

mod advance;
mod bounce;
mod collision;
mod group;
mod impact;
mod interleaved;
mod particles;
mod passes;

pub(super) use advance::{Advance, General, Inlined};
pub(super) use bounce::bounce;
pub(super) use collision::{Dimension, Planar, Spatial};
#[cfg(feature = "one-lane")]
pub use group::one_lane;
pub(crate) use impact::{Impact, ImpactSink, Meanwhile, Pose};
pub(super) use interleaved::GROUPS;
pub(crate) use interleaved::{PLACES, of_group};
pub(super) use particles::{Lost, Release};
