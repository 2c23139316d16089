//! The free flight between two impacts.

mod asymmetric;
mod bounds;
mod symmetric;

pub use asymmetric::{Rotation, Top};
pub use symmetric::State;
pub(crate) use symmetric::{
    Attitude, Flight, PlanarFlight, PlanarMotion, PlanarState, SpatialFlight, SpatialMotion,
    SpatialState, SymmetricState,
};
