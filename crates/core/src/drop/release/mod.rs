//! Initial conditions: height, orientation and spin at release.

mod height;
mod orientation;
mod spin;

pub use height::Height;
pub use orientation::Orientation;
pub use spin::{About, Spin};
