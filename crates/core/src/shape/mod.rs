//! Bodies: mass, inertia, and the surface that can touch.

mod clump;
mod convex;
mod mass;
mod polyhedron;
mod revolution;
mod revolved;
mod rigid;
mod rough;
mod superellipsoid;
mod top;
mod tree;

use crate::Error;

pub use clump::Matter;

pub(crate) use convex::{Convex, ConvexSurface};
pub use revolution::*;
pub(crate) use revolved::Band;
pub use rigid::{Inertia, Rigid, RigidBall};
pub(crate) use rigid::{Skin, up};
pub use rough::{Heights, Roughness};
pub(crate) use superellipsoid::Superellipsoid;
pub(crate) use top::Symmetry;
pub use top::Top;
#[cfg(test)]
pub(crate) use tree::{Balls, evaluations};
pub(crate) use tree::{Effort, Instant, Least, Point};

/// A body that can be dropped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AnyBody<'a> {
    /// A body of revolution.
    Revolution(Solid),
    /// A rigid body of any shape.
    Rigid(&'a Rigid),
}

impl<T: Into<Solid>> From<T> for AnyBody<'_> {
    fn from(body: T) -> Self {
        Self::Revolution(body.into())
    }
}

impl<'a> From<&'a Rigid> for AnyBody<'a> {
    fn from(body: &'a Rigid) -> Self {
        Self::Rigid(body)
    }
}

impl AnyBody<'_> {
    /// The core's unit of length R, in m.
    pub fn unit(&self) -> f64 {
        match self {
            Self::Revolution(solid) => solid.unit,
            Self::Rigid(body) => body.unit,
        }
    }

    /// Mass m, in kg.
    pub fn mass(&self) -> f64 {
        match self {
            Self::Revolution(solid) => solid.mass,
            Self::Rigid(body) => body.inertia.mass,
        }
    }

    /// The body of revolution, if it is one.
    ///
    /// # Errors
    /// [`Error::Parameter`] for another body.
    pub fn revolution(&self) -> Result<&Solid, Error> {
        match self {
            Self::Revolution(solid) => Ok(solid),
            Self::Rigid(_) => Err(Error::Parameter {
                name: "body",
                value: crate::Value::Name("a rigid body of any shape".into()),
                allowed: "a body of revolution".into(),
            }),
        }
    }
}

/// Checks that a density, in kg/m³, is positive.
fn check_density(value: f64) -> Result<(), Error> {
    let positive = value.is_finite() && value > 0.0;
    Error::unless(positive, "density", value, "finite and > 0 (kg/m^3)")
}
