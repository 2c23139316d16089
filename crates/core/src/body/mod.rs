//! Bodies of revolution: what the motion needs to know of one, and one file a shape.
//!
//! A further shape is a file with its parameters in SI units that implements [`Shape`]. Its hull is made of balls or is
//! smooth; what either has to tell is in [`Hull`].

mod dumbbell;
mod hull;
mod inertia;
mod loaded_sphere;
mod spherocylinder;
mod spheroid;

pub use dumbbell::Dumbbell;
pub use hull::{Ball, Ellipsoid, EqualPair, Pair, Single, Sphere, Surface};
pub(crate) use hull::{Hull, Part, Swing, with_hull};
pub use loaded_sphere::LoadedSphere;
pub use spherocylinder::Spherocylinder;
pub use spheroid::Spheroid;

use crate::Error;

/// A body of revolution in the core's units (lengths in R, masses in m): all that the motion depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// What can touch the plane.
    pub hull: Surface,
    /// Half the distance between the centres of the two spheres, L/(2R); 0 if there is only one, or none.
    pub half_separation: f64,
    /// J_xx/(mR²), about the centre of mass.
    pub transverse: f64,
    /// J_zz/(mR²).
    pub axial: f64,
}

/// A body of revolution in SI units.
pub trait Shape {
    /// The core's unit of length R, in m.
    fn unit(&self) -> f64;
    /// Mass m, in kg.
    fn mass(&self) -> f64;
    /// Moment of inertia J_xx about any axis through the centre of mass and across the symmetry axis, in kg m².
    fn transverse_inertia(&self) -> f64;
    /// Moment of inertia J_zz about the symmetry axis, in kg m².
    fn axial_inertia(&self) -> f64;
    /// Place of the centre of mass on the axis, in m, from the middle of the shape: of its two centres, or of its one.
    fn centre_of_mass(&self) -> f64 {
        0.0
    }
    /// The body in the core's units.
    fn scaled(&self) -> Body;
}

/// What a run needs to know of any shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// The core's unit of length R, in m.
    pub unit: f64,
    /// Mass m, in kg.
    pub mass: f64,
    /// Moment of inertia J_xx across the symmetry axis, in kg m².
    pub transverse_inertia: f64,
    /// Moment of inertia J_zz about the symmetry axis, in kg m².
    pub axial_inertia: f64,
    /// Place of the centre of mass on the axis, in m, from the middle of the shape.
    pub centre_of_mass: f64,
    /// The body in the core's units.
    pub scaled: Body,
}

impl<S: Shape> From<S> for Solid {
    fn from(shape: S) -> Self {
        Self {
            unit: shape.unit(),
            mass: shape.mass(),
            transverse_inertia: shape.transverse_inertia(),
            axial_inertia: shape.axial_inertia(),
            centre_of_mass: shape.centre_of_mass(),
            scaled: shape.scaled(),
        }
    }
}

impl Solid {
    /// Least height of the centre of mass, in m, at which nothing is below the plane when the axis leans by an angle of this
    /// cosine. A height below it by a few roundings will do.
    pub fn lowest(&self, cosine: f64) -> f64 {
        self.unit * self.scaled.hull.support(cosine)
    }

    /// Whether a `height` of the centre of mass, in m, is as large as one of these. A body put down on the plane may be off by
    /// the rounding of its height.
    pub fn clears(height: f64, lowest: f64) -> bool {
        height >= lowest * (1.0 - 4.0 * f64::EPSILON)
    }

    /// The largest of these heights over all angles.
    pub fn farthest(&self) -> f64 {
        self.unit * self.scaled.hull.farthest()
    }
}

/// The shape, if neither its mass nor its inertia nor what follows from them is beyond floating-point numbers; else an error
/// that names its unit of length.
fn representable<S: Shape>(shape: S, name: &'static str) -> Result<S, Error> {
    let body = shape.scaled();
    let all = [
        shape.mass(),
        shape.transverse_inertia(),
        shape.axial_inertia(),
        body.transverse,
        body.axial,
    ];
    Error::unless_beyond(
        all.iter().all(|x| x.is_normal()),
        name,
        shape.unit(),
        "such that mass and inertia neither overflow nor underflow",
    )?;
    Ok(shape)
}

/// L/R below which a dumbbell is a sphere: far below the last digit of anything that is computed.
const NEGLIGIBLE: f64 = 1e-75;

/// L/R, or 0 where no digit of the motion could show it, lest its powers underflow.
fn seen(elongation: f64) -> f64 {
    if elongation < NEGLIGIBLE {
        0.0
    } else {
        elongation
    }
}

/// Checks that a length, in m, is positive.
fn check_length(name: &'static str, value: f64) -> Result<(), Error> {
    let positive = value.is_finite() && value > 0.0;
    Error::unless(positive, name, value, "finite and > 0 (m)")
}

/// Checks that a length, in m, is not negative.
fn check_distance(name: &'static str, value: f64) -> Result<(), Error> {
    let positive = value.is_finite() && value >= 0.0;
    Error::unless(positive, name, value, "finite and >= 0 (m)")
}

/// Checks that a density, in kg/m³, is positive.
fn check_density(value: f64) -> Result<(), Error> {
    let positive = value.is_finite() && value > 0.0;
    Error::unless(positive, "density", value, "finite and > 0 (kg/m^3)")
}
