//! The free flight between two impacts.

mod asymmetric;
mod bounds;
mod symmetric;

pub use asymmetric::{Rotation, Top};
pub use symmetric::State;
pub(crate) use symmetric::{
    Attitude, Flight, PlanarMotion, PlanarStates, SpatialFlight, SpatialMotion, SpatialStates,
    States,
};
