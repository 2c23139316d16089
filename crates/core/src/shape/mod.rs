//! Bodies: mass, inertia, and the surface that can touch.

mod mass;
mod revolution;

pub use revolution::*;
