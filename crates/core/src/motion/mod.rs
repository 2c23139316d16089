//! The free flight between two impacts.

mod symmetric;

pub use symmetric::State;
pub(crate) use symmetric::{
    Attitude, Flight, PlanarMotion, PlanarStates, SpatialFlight, SpatialMotion, SpatialStates,
    States,
};
