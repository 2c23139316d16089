//! The next contact of a body with the plane.

mod axial;
mod certify;
mod convex;
mod first;
mod lanes;
mod pair;
mod plane;

pub(crate) use axial::{BallGaps, RoundPart, RoundParts, TurningAxis};
pub(crate) use certify::INVISIBLE;
pub(crate) use first::{Fall, FirstContact, NoContact};
pub(crate) use lanes::{
    GapEvaluation, LastContact, LocatedContact, MOST_STEPS, Prediction, Search, Steps,
};
pub(crate) use pair::{Between, PairDeparture, PairFlight, PairSearch, PairTouch};
pub(crate) use plane::Departure;
