//! The surfaces of rigid bodies that can touch: balls in a tree, or a convex surface in a file of its own here. [`each_surface`] is the one place
//! that tells them apart.

mod bands;
mod ellipsoid;
mod superellipsoid;
mod support;

pub(crate) use bands::{Band, Bands, Place};
pub(crate) use ellipsoid::EllipsoidSurface;
pub(crate) use superellipsoid::Superellipsoid;
pub(super) use superellipsoid::{exp, power};
pub(crate) use support::{NormalMotion, Support};

use super::pieces::Piece;
use super::tree::{BallTree, Least, Pruning};
use crate::math::{Quaternion, Vector};

/// A convex surface in its own axes, in units of R: one that is smooth, or several parts of which it is the hull.
pub(crate) trait ConvexSurface: Sized {
    /// The support of a part while the body moves.
    type Along<'a>: Support
    where
        Self: 'a;

    /// The surface of a body that it is.
    const OF: fn(Convex<Self>) -> RigidSurface;

    /// False where f″ and the bound backward take longer than the steps that they save.
    const LOOKS_BACK: bool = true;

    /// The number of parts.
    #[inline(always)]
    fn parts(&self) -> usize {
        1
    }

    /// The largest distance of a point of a part from the centre of mass.
    #[inline(always)]
    fn reach(&self, _part: usize) -> f64 {
        1.0
    }

    /// No more than the radius of the largest ball about the origin inside; 0 where that is not needed.
    fn inner(&self) -> f64;

    /// The distance from the origin to the lowest place, in the direction against `up`.
    fn support(&self, up: Vector) -> f64;

    /// The point of a part that lies lowest; of several the one that comes down first, while **n** changes with `turning`.
    fn nearest(&self, part: usize, up: Vector, turning: Vector) -> Vector;

    /// The support of a part and what it becomes.
    fn along<'a>(&'a self, part: usize, at: &'a NormalMotion) -> Self::Along<'a>;

    /// The same in units of `part` of the present one, in a body whose centre of mass is this far from the present one.
    fn scaled(&self, part: f64, shift: f64) -> Self;

    /// With what it touches another body, with these axes and this centre, and in this unit, where that is known.
    fn piece(&self, axes: Quaternion, centre: Vector, unit: f64) -> Option<Piece>;
}

/// The surface that can touch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RigidSurface {
    /// Balls, or the vertices of a polyhedron.
    Balls(BallTree),
    Ellipsoid(Convex<EllipsoidSurface>),
    Superellipsoid(Convex<Superellipsoid>),
    Bands(Convex<Bands>),
}

/// An expression of balls, and one of any convex surface; or one of any surface.
macro_rules! each_surface {
    ($surface:expr, $each:ident => $answer:expr) => {
        each_surface!($surface, $each => $answer, $each => $answer)
    };
    ($surface:expr, $balls:ident => $one:expr, $convex:ident => $other:expr) => {
        match $surface {
            $crate::shape::RigidSurface::Balls($balls) => $one,
            $crate::shape::RigidSurface::Ellipsoid($convex) => $other,
            $crate::shape::RigidSurface::Superellipsoid($convex) => $other,
            $crate::shape::RigidSurface::Bands($convex) => $other,
        }
    };
}
pub(crate) use each_surface;

impl<S: ConvexSurface> From<Convex<S>> for RigidSurface {
    fn from(surface: Convex<S>) -> Self {
        S::OF(surface)
    }
}

impl RigidSurface {
    /// The distance from the centre of mass to the lowest part, in the direction against `up`.
    pub fn support(&self, up: Vector) -> f64 {
        let at = NormalMotion {
            up,
            ..NormalMotion::default()
        };
        each_surface!(self, balls => {
            let exceeds = |least: &Least, limit: f64| least.gap > limit;
            let lowest = balls.cheapest(&at, None, Pruning::EXACT, exceeds, |_, point, _| {
                point.opening(&at).0
            });
            -lowest.cost
        }, convex => {
            let mut moved = NormalMotion::default();
            let own = convex.own(&at, &mut moved);
            convex.surface.support(own.up) - own.height
        })
    }

    /// The point of a part that is nearest to the plane, from the centre of mass, in the axes of the body; of several the one that
    /// comes down first, while **n** changes with **n**′.
    #[inline(always)]
    pub fn nearest(&self, part: usize, up: Vector, turning: Vector) -> Vector {
        each_surface!(self, balls => {
            let point = &balls.points()[part];
            point.place - up * point.radius
        }, convex => {
            let [own, tie] = match convex.frame {
                Some(frame) => [up, turning].map(|v| frame.axes.rotate(v)),
                None => [up, turning],
            };
            let place = convex.surface.nearest(part, own, tie);
            convex.frame.map_or(place, |frame| frame.place(place))
        })
    }

    /// The number of a part among those that the body was given.
    pub fn number(&self, part: usize) -> usize {
        match self {
            Self::Balls(balls) => balls.points()[part].number as usize,
            _ => part,
        }
    }
}

/// A convex surface in a body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Convex<S> {
    /// None where its centre is the centre of mass, and its axes are the principal ones.
    pub frame: Option<Frame>,
    pub surface: S,
    /// No more than the radius of the largest ball about the centre of mass inside of the body.
    pub inner: f64,
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
    fn own(&self, at: &NormalMotion) -> NormalMotion {
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
    #[inline(always)]
    fn place(&self, own: Vector) -> Vector {
        self.axes.inverse().rotate(own - self.centre)
    }
}

impl<S: ConvexSurface> Convex<S> {
    /// A surface about the centre of mass, its axes the principal ones.
    pub fn new(surface: S) -> Self {
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
        let surface = self.surface.scaled(part, centre.norm());
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

    /// The rotation from the axes of the surface to the principal ones, and where its centre is there.
    pub fn place(&self) -> (Quaternion, Vector) {
        match self.frame {
            Some(frame) => (frame.axes.inverse(), frame.place(Vector::default())),
            None => (Quaternion::IDENTITY, Vector::default()),
        }
    }

    /// With what it touches another body, in m and the principal axes.
    pub fn piece(&self, unit: f64) -> Option<Piece> {
        let (axes, centre) = self.place();
        self.surface.piece(axes, centre, unit)
    }

    /// The body in the axes of the surface, in `moved` where these are others.
    #[inline(always)]
    pub fn own<'a>(&self, at: &'a NormalMotion, moved: &'a mut NormalMotion) -> &'a NormalMotion {
        let Some(frame) = self.frame else { return at };
        *moved = frame.own(at);
        moved
    }
}
