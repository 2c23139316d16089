//! Bodies: mass, inertia, and the surface that can touch.

mod mass;
mod revolution;

pub(crate) use revolution::{AxisMotion, Hull, HullPart, with_hull};
pub use revolution::{
    BODIES, Body, Dumbbell, LoadedSphere, Shape, Solid, Sphere, Spherocylinder, Spheroid, Surface,
};
