//! The next contact of a body with the plane.

mod lanes;

pub(crate) use lanes::{Arrival, Departure, Leap, Look, MOST_STEPS, Residue, Search};
