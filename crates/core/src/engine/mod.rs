//! The bounce loop, steps 1–7 of Sec. III of the paper: next contact, motion until then, impact, for as many particles at once as
//! there are lanes, for planar and spatial motion and every hull.

mod bounce;
mod end;
mod gradual;
mod group;
mod impact;
mod leg;
mod passes;
mod single;
mod strike;

pub(crate) use bounce::bounce;
pub use end::{COLLAPSE_RUN, Limits, StopReason};
pub(crate) use group::{GROUPS, Release, Stuck};
pub(crate) use impact::{Impact, Meanwhile, Sink};
pub(crate) use leg::{Apart, Legs, Together};
pub use single::{
    Departure, Landing, NoConvergence, SingleImpact, collide, first_contact, trajectory,
};
pub(crate) use strike::{Planar, Spatial, Turn};
