//! The free flight between two impacts.

mod bounds;
mod elliptic;
mod rotation;
mod series;
mod symmetric;
mod top;
mod turn;

pub use bounds::SpinBounds;
pub use rotation::Rotation;
pub(crate) use rotation::Rotations;
pub use symmetric::State;
pub(crate) use symmetric::{
    Attitude, Flight, PlanarMotion, PlanarState, SpatialFlight, SpatialMotion, SpatialState,
    SymmetricState,
};
pub(crate) use turn::{BodyFrame, BodyPose, Turn};
