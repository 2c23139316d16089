//! The next contact of a body with the plane.

mod certify;
mod lanes;

pub(crate) use lanes::{
    GapEvaluation, LastContact, LocatedContact, MOST_STEPS, Prediction, Search, Steps,
};
