//! The next contact of a body with the plane.

mod certify;
mod convex;
mod lanes;
mod plane;

pub(crate) use certify::{INVISIBLE, LAST};
pub(crate) use lanes::{
    GapEvaluation, LastContact, LocatedContact, MOST_STEPS, Prediction, Search, Steps,
};
pub(crate) use plane::{Departure, Gap};
