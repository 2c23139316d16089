//! The free flight between two impacts.

mod bounds;
mod elliptic;
mod flight_rotation;
mod rotation;
mod series;
mod symmetric;
mod top;

pub use bounds::SpinBounds;
pub(crate) use flight_rotation::{BodyFrame, BodyPose, FlightRotation};
pub use rotation::Rotation;
pub(crate) use rotation::Rotations;
pub use symmetric::State;
pub(crate) use symmetric::{
    Attitude, Flight, PlanarMotion, PlanarState, SpatialFlight, SpatialMotion, SpatialState,
    SymmetricState,
};
