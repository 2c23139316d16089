//! Convex surfaces that are not made of balls or vertices, and where they are in their body.

use super::revolved::Band;
use super::superellipsoid::Superellipsoid;
use super::tree::NormalMotion;
use crate::math::{Quaternion, Vector};

/// A convex surface in a body, in units of R.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Convex {
    /// None where its centre is the centre of mass, and its axes are the principal ones.
    pub frame: Option<Frame>,
    pub surface: ConvexSurface,
    /// No more than the radius of the largest ball about the centre of mass inside of the body.
    pub inner: f64,
}

/// A convex surface in its own axes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ConvexSurface {
    /// An ellipsoid with these semi-axes.
    Ellipsoid([f64; 3]),
    Superellipsoid(Superellipsoid),
    /// Bands about the third axis.
    Bands(Vec<Band>),
}

/// Where the centre of mass and the principal axes of a body are in the axes of its surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// The rotation from the principal axes to those of the surface.
    pub axes: Quaternion,
    /// The centre of mass.
    pub centre: Vector,
}

impl Frame {
    /// The body in the axes of the surface. From its origin the height is z − **n**·**c**.
    #[inline(always)]
    pub fn own(&self, at: &NormalMotion) -> NormalMotion {
        let [up, turning, bending] = [at.up, at.turning, at.bending].map(|v| self.axes.rotate(v));
        NormalMotion {
            height: at.height - self.centre.dot(up),
            rate: at.rate - self.centre.dot(turning),
            acceleration: at.acceleration - self.centre.dot(bending),
            up,
            turning,
            bending,
        }
    }

    /// A place of the surface, from the centre of mass and in the principal axes.
    pub fn place(&self, own: Vector) -> Vector {
        self.axes.inverse().rotate(own - self.centre)
    }
}

impl Convex {
    /// A surface about the centre of mass, its axes the principal ones.
    pub fn new(surface: ConvexSurface) -> Self {
        Self {
            frame: None,
            inner: surface.inner(),
            surface,
        }
    }

    /// The same surface in another body, whose centre of mass and axes are these in the present ones, in units of `part` of the present one.
    pub fn with_frame(&self, axes: Quaternion, centre: Vector, part: f64) -> Self {
        let (turn, shift) = match self.frame {
            Some(frame) => (frame.axes, frame.centre),
            None => (Quaternion::IDENTITY, Vector::default()),
        };
        let surface = match &self.surface {
            ConvexSurface::Ellipsoid(semi_axes) => {
                ConvexSurface::Ellipsoid(semi_axes.map(|axis| axis / part))
            }
            ConvexSurface::Superellipsoid(body) => ConvexSurface::Superellipsoid(body.scaled(part)),
            ConvexSurface::Bands(bands) => {
                let moved = |band: &Band| band.scaled(part, centre.norm());
                ConvexSurface::Bands(bands.iter().map(moved).collect())
            }
        };
        let centre = (shift + turn.rotate(centre)) / part;
        Self {
            frame: Some(Frame {
                axes: (turn * axes).normalized(),
                centre,
            }),
            inner: (surface.inner() - centre.norm()).max(0.0),
            surface,
        }
    }

    /// The body in the axes of the surface, in `moved` where these are others.
    #[inline(always)]
    pub fn own<'a>(&self, at: &'a NormalMotion, moved: &'a mut NormalMotion) -> &'a NormalMotion {
        let Some(frame) = self.frame else { return at };
        *moved = frame.own(at);
        moved
    }

    /// The distance from the centre of mass to the lowest place, in the direction against `up`.
    pub fn support(&self, up: Vector) -> f64 {
        let at = NormalMotion {
            up,
            ..NormalMotion::default()
        };
        let mut moved = NormalMotion::default();
        let own = self.own(&at, &mut moved);
        self.surface.support(own.up) - own.height
    }
}

impl ConvexSurface {
    /// No more than the radius of the largest ball about the origin inside; 0 where that is not needed.
    fn inner(&self) -> f64 {
        match self {
            Self::Ellipsoid([a, b, c]) => a.min(*b).min(*c),
            Self::Superellipsoid(body) => body.inner(),
            Self::Bands(_) => 0.0,
        }
    }

    fn support(&self, up: Vector) -> f64 {
        match self {
            Self::Ellipsoid([a, b, c]) => Vector::new(a * up.x, b * up.y, c * up.z).norm(),
            Self::Superellipsoid(body) => body.support(up),
            Self::Bands(bands) => bands
                .iter()
                .map(|band| band.support(up * -1.0))
                .fold(f64::NEG_INFINITY, f64::max),
        }
    }
}
