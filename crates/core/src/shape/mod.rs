//! Bodies: mass, inertia, and the surface that can touch.

mod clump;
mod cuboid;
mod cylinder;
mod die;
mod egg;
mod ellipsoid;
mod hull;
mod mass;
mod mesh;
mod pieces;
mod polyhedron;
mod revolution;
mod revolved;
mod rigid;
mod ring;
mod rough;
mod superellipsoid;
mod surface;
mod top;
mod tree;
mod truncated_cone;
mod union;

use crate::Error;
use crate::describe::{Argument, Arguments, Kind, Parameter};
use crate::math::Vector;

pub use clump::Matter;
pub use hull::triangles as convex_hull;

pub(crate) use pieces::{Feature, Piece, PieceKind, Round};
pub use revolution::*;
pub(crate) use rigid::up;
pub use rigid::{Inertia, Rigid, RigidBall};
pub use rough::{Heights, Roughness};
pub(crate) use surface::{
    Convex, ConvexSurface, NormalMotion, RigidSurface, Support, each_surface,
};
pub(crate) use top::Symmetry;
pub use top::Top;
#[cfg(test)]
pub(crate) use tree::evaluations;
pub(crate) use tree::{BallTree, Least, Point, Pruning};

/// An entry of the table of bodies.
#[derive(Debug)]
pub enum BodyKind {
    /// A body of revolution whose hull has a closed form: an angle is its orientation.
    Revolution(Kind<Solid>),
    /// A body that is followed in any attitude.
    Rigid(Kind<Form>),
}

/// The shape of a rigid body, in m and the axes that it is given in: of what it is made, and what there is to draw of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// A convex polyhedron: points, and triangles of their numbers.
    Faces(Vec<Vector>, Vec<[usize; 3]>),
    /// The same of a solid within closed surfaces.
    Mesh(Vec<Vector>, Vec<[usize; 3]>),
    /// Points (z, r) of an outline that turns about the axis z, closed where it ends at its first one.
    Profile(Vec<[f64; 2]>),
    /// Any other, made; it is drawn by its balls, or by the points that lie farthest in every direction.
    Body(Box<Rigid>),
}

impl From<Rigid> for Form {
    fn from(body: Rigid) -> Self {
        Self::Body(Box::new(body))
    }
}

/// Every body, but for those that are another one with asperities.
pub const BODIES: &[BodyKind] = &[
    BodyKind::Revolution(Dumbbell::KIND),
    BodyKind::Revolution(LoadedSphere::KIND),
    BodyKind::Revolution(Spherocylinder::KIND),
    BodyKind::Revolution(Spheroid::KIND),
    ellipsoid::ELLIPSOID,
    superellipsoid::SUPERELLIPSOID,
    cuboid::BOX,
    die::DIE,
    polyhedron::CONVEX_POLYHEDRON,
    cylinder::CYLINDER,
    ring::RING,
    truncated_cone::TRUNCATED_CONE,
    egg::EGG,
    revolved::REVOLUTION,
    clump::CLUMP,
    rough::ROUGH_SPHERE,
    mesh::MESH,
];

impl BodyKind {
    /// Its name, its description and its parameters.
    pub const fn about(&self) -> (&'static str, &'static str, &'static [Parameter]) {
        match self {
            Self::Revolution(kind) => (kind.name, kind.text, kind.parameters),
            Self::Rigid(kind) => (kind.name, kind.text, kind.parameters),
        }
    }
}

impl Kind<Form> {
    /// The body of these parameters, with the density, the inertia and the centre of mass that are among them.
    ///
    /// # Errors
    /// As the constructors of [`Rigid`], under the names of these parameters.
    pub fn body(&self, given: &[Argument<'_>]) -> Result<Rigid, Error> {
        let place = |name: &str| self.parameters.iter().position(|about| about.name == name);
        let density = place("density").map_or(f64::NAN, |place| given.number(place));
        let made = match (self.make)(given)? {
            Form::Faces(points, triangles) => Rigid::polyhedron(&points, &triangles, density),
            Form::Mesh(points, triangles) => Rigid::mesh(&points, &triangles, density),
            Form::Profile(profile) => Rigid::revolution(&profile, density),
            Form::Body(body) => Ok(*body),
        };
        let made = made.map_err(|error| match (error, self.parameters) {
            (Error::Parameter { name, .. }, [first, ..]) if place(name).is_none() => {
                Error::Magnitude {
                    name: first.name,
                    value: given.number(0).into(),
                    allowed: "such that the volume neither overflows nor underflows",
                }
            }
            (error, _) => error,
        })?;
        match place("inertia") {
            Some(place) => made.given(given, place),
            None => Ok(made),
        }
    }
}

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
            Self::Rigid(_) => Err(Error::parameter(
                "body",
                "a rigid body of any shape",
                "a body of revolution",
            )),
        }
    }

    /// The parts with which it touches another body; `name` is for the error.
    pub(crate) fn pieces(&self, name: &'static str) -> Result<Vec<Piece>, Error> {
        let found = match self {
            Self::Revolution(solid) => Some(solid.pieces()),
            Self::Rigid(body) => body.pieces(),
        };
        let allowed = "made of balls, an ellipsoid, a superellipsoid with exponents up to 8, a convex polyhedron, a cylinder or a spherocylinder: \
                       the surface of another is not known where it is not on its convex hull, or not yet followed";
        found.ok_or_else(|| Error::parameter(name, "this body", allowed))
    }
}

/// Checks that a density, in kg/m³, is positive.
fn check_density(value: f64) -> Result<(), Error> {
    let positive = value.is_finite() && value > 0.0;
    Error::unless(positive, "density", value, "finite and > 0 (kg/m^3)")
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

/// Checks that numbers which follow from parameters, of which this one sets their scale, neither overflow nor underflow.
fn check_magnitude(name: &'static str, value: f64, derived: [f64; 5]) -> Result<(), Error> {
    let allowed = "such that mass and inertia neither overflow nor underflow";
    Error::unless_beyond(derived.iter().all(|x| x.is_normal()), name, value, allowed)
}
