//! Bodies: mass, inertia, and the surface that can touch.

mod mass;
mod revolution;

pub use revolution::{
    Body, Dumbbell, LoadedSphere, Shape, Solid, Sphere, Spherocylinder, Spheroid, Surface,
};
pub(crate) use revolution::{Hull, Part, Swing, with_hull};
