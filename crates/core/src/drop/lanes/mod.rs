//! The bounce loop, steps 1–7 of Sec. III of the paper: next contact, motion until then, impact, for as many particles at once as
//! there are lanes, for planar and spatial motion and every hull.

mod bounce;
mod gradual;
mod group;
mod impact;
mod leg;
mod passes;
mod strike;

pub(super) use bounce::bounce;
pub(crate) use group::GROUPS;
pub(super) use group::{Found, Group, Release, Stuck};
pub(crate) use impact::{Impact, Meanwhile, Sink};
pub(super) use leg::{Apart, Idle, Legs, Together, find};
pub(super) use strike::{Planar, Spatial, Strike, Touch, Turn};
