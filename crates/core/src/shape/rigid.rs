//! Bodies of any shape: mass, principal axes, and what can touch the plane.

use super::check_magnitude;
use super::pieces::{Extent, Piece};
use super::surface::{RigidSurface, each_surface};
use super::top::Top;
use super::tree::{BallTree, Point};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Parameter};
use crate::math::{Quaternion, Symmetric, Vector};
use crate::memory::{empty, filled};
use crate::simd::elementary::sincos;
use crate::threads::go_on;
use std::f64::consts::PI;

/// Volume, or mass, with its first and second moments: the integrals of 1, **x** and **x**⊗**x**.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct VolumeMoments {
    pub content: f64,
    pub first: Vector,
    pub second: Symmetric,
}

/// Mass, centre of mass and tensor of inertia about it, in coherent units and the axes that the body was given in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Mass.
    pub mass: f64,
    /// Centre of mass.
    pub centre: Vector,
    /// Tensor of inertia about the centre of mass.
    pub tensor: Symmetric,
}

/// A ball, or a vertex as one of no size.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigidBall {
    /// Its centre.
    pub centre: Vector,
    /// Its radius.
    pub radius: f64,
}

/// Most balls, so that their numbers can be recorded.
const MOST: usize = i32::MAX as usize;

/// Parts that are made between looks whether that is still wanted.
const OFTEN: usize = 1 << 16;

/// A rigid body of any shape. Its unit of length R is the largest distance of a part of it from the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Rigid {
    /// Mass, centre and inertia, in SI units, in the axes that the body was given in.
    pub inertia: Inertia,
    /// The core's unit of length R, in m.
    pub unit: f64,
    /// The rotation from the principal axes to those that the body was given in.
    pub axes: Quaternion,
    /// The principal moments over mR².
    pub top: Top,
    /// The parts that can touch, in units of R and the principal axes.
    pub(crate) surface: RigidSurface,
    pub(crate) extent: Extent,
}

impl VolumeMoments {
    /// Those of a part of mass `content` about its own centre, with these second moments about it, moved there.
    pub fn about(content: f64, centre: Vector, second: Symmetric) -> Self {
        Self {
            content,
            first: centre * content,
            second: second + Symmetric::square(centre, content),
        }
    }

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            content: self.content + other.content,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }

    /// Mass, centre and inertia of matter of this density.
    pub fn inertia(&self, density: f64) -> Inertia {
        let c = self.first / self.content;
        let m = self.content;
        let central = Self::about(-m, c, self.second).second;
        Inertia {
            mass: density * m,
            centre: c,
            tensor: Symmetric {
                xx: density * (central.yy + central.zz),
                yy: density * (central.zz + central.xx),
                zz: density * (central.xx + central.yy),
                xy: -density * central.xy,
                xz: -density * central.xz,
                yz: -density * central.yz,
            },
        }
    }
}

/// The tensor of inertia of a body that need not be homogeneous, and its centre of mass.
pub(super) const TENSOR: Parameter = Parameter::new(
    "inertia",
    "tensor of inertia about the centre of mass, instead of that of homogeneous matter",
    Some("kg m2"),
    Allowed::Rows(&["x", "y", "z"], 3, Interval::ANY),
    Argument::Numbers(&[1e-8, 0.0, 0.0, 0.0, 1e-8, 0.0, 0.0, 0.0, 1e-8]),
)
.optional();
pub(super) const CENTRE: Parameter = Parameter::new(
    "centre",
    "centre of mass, where a tensor of inertia is given",
    Some("m"),
    Allowed::Several(
        &[["x", "along x"], ["y", "along y"], ["z", "along z"]],
        Interval::ANY,
    ),
    Argument::Numbers(&[0.0; 3]),
)
.optional();

/// The parameters of a homogeneous body: its own, and then density, [`TENSOR`] and [`CENTRE`].
macro_rules! homogeneous {
    ($($own:expr),+ $(,)?) => {{
        use $crate::shape::rigid::{CENTRE, TENSOR};
        &[$($own,)+ $crate::describe::Parameter::density("density"), TENSOR, CENTRE]
    }};
}
pub(super) use homogeneous;

/// Triples of numbers as vectors.
pub(super) fn vectors(numbers: &[f64]) -> Vec<Vector> {
    let rows = numbers.as_chunks::<3>().0.iter();
    rows.map(|&row| row.into()).collect()
}

impl Rigid {
    /// The same body, unless [`TENSOR`] at this place, and [`CENTRE`] after it, give it another inertia of the same mass.
    pub(super) fn given(self, given: &[Argument<'_>], place: usize) -> Result<Self, Error> {
        let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = match given.get(place) {
            Some(Argument::Numbers(_)) => given.several(place),
            _ => return Ok(self),
        };
        let mut centre = self.inertia.centre;
        if !given.is_absent(place + 1) {
            centre = given.several(place + 1).into();
        }
        let inertia = Inertia {
            mass: self.inertia.mass,
            centre,
            tensor: Symmetric::from_rows([[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]),
        };
        let body = self.with_inertia(inertia)?;
        // Evenly all around: a spiral that turns by the golden angle.
        let within = (0..400).all(|k| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 400.0;
            let (sine, cosine) = sincos(f64::from(k) * PI * (3.0 - 5.0_f64.sqrt()));
            let level = (1.0 - z * z).sqrt();
            body.support(Vector::new(level * cosine, level * sine, z)) > 0.0
        });
        Error::unless(within, "centre", centre.x, "within the body (m)")?;
        Ok(body)
    }

    /// A body with these parts, in m and the axes of its inertia; `what` is for the error.
    pub(super) fn of_balls(
        inertia: Inertia,
        what: &'static str,
        extent: Extent,
        balls: impl ExactSizeIterator<Item = RigidBall>,
    ) -> Result<Self, Error> {
        Error::unless(balls.len() < MOST, what, balls.len(), "fewer than 2^31")?;
        let about_centre = balls
            .enumerate()
            .map(|(number, ball)| Point::new(ball.centre - inertia.centre, ball.radius, number));
        let mut points = empty(what, about_centre.len())?;
        for point in about_centre {
            if points.len().is_multiple_of(OFTEN) {
                go_on()?;
            }
            points.push(point);
        }
        let reach = |point: &Point| point.place.norm() + point.radius;
        let unit = points.iter().map(reach).fold(0.0, f64::max);
        Self::new(inertia, unit, extent, |axes| {
            let back = axes.inverse();
            for (number, point) in points.iter_mut().enumerate() {
                *point = Point::new(back.rotate(point.place) / unit, point.radius / unit, number);
            }
            Ok(RigidSurface::Balls(BallTree::new(what, points)?))
        })
    }

    /// The balls or vertices, in m and the axes that the body was given in; none of an ellipsoid.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn balls(&self) -> Result<Vec<RigidBall>, Error> {
        let RigidSurface::Balls(balls) = &self.surface else {
            return Ok(Vec::new());
        };
        let mut found = filled("asperities", RigidBall::default(), balls.points().len())?;
        for point in balls.points() {
            found[point.number as usize] = RigidBall {
                centre: self.axes.rotate(point.place * self.unit) + self.inertia.centre,
                radius: self.unit * point.radius,
            };
        }
        Ok(found)
    }

    /// A body whose parts, in its principal axes and in units of `unit`, follow from the rotation of these to the axes of its inertia.
    pub(super) fn new(
        inertia: Inertia,
        unit: f64,
        extent: Extent,
        surface: impl FnOnce(Quaternion) -> Result<RigidSurface, Error>,
    ) -> Result<Self, Error> {
        let (moments, axes) = inertia.tensor.principal();
        let scale = 1.0 / (inertia.mass * unit * unit);
        let moments = moments.map(|moment| scale * moment);
        let [a, b, c] = moments;
        check_magnitude("density", inertia.mass, [inertia.mass, scale, a, b, c])?;
        Ok(Self {
            inertia,
            unit,
            axes,
            top: Top::new(moments)?,
            surface: surface(axes)?,
            extent,
        })
    }

    /// The same parts with another inertia: mass, centre and tensor, in the axes that the body was given in.
    ///
    /// # Errors
    /// Unless the mass is positive, and the tensor is that of a body.
    pub fn with_inertia(self, inertia: Inertia) -> Result<Self, Error> {
        each_surface!(&self.surface, _balls => {
            Self::of_balls(inertia, "points", self.extent, self.balls()?.into_iter())
        }, convex => {
            let back = self.axes.inverse();
            let shift = back.rotate(inertia.centre - self.inertia.centre);
            // No part is farther from the new centre than this.
            let unit = self.unit + shift.norm();
            Self::new(inertia, unit, self.extent, |axes| {
                let moved = convex.with_frame(back * axes, shift / self.unit, unit / self.unit);
                Ok(moved.into())
            })
        })
    }

    /// The principal moments of inertia, in kg m².
    pub fn principal_moments(&self) -> [f64; 3] {
        let scale = self.inertia.mass * self.unit * self.unit;
        self.top.moments().map(|moment| scale * moment)
    }

    /// The distance in m from the centre of mass to the plane that touches the body with this outward normal, in the axes that it was given in.
    pub fn support(&self, normal: Vector) -> f64 {
        let up = self.axes.inverse().rotate(normal) * -1.0;
        self.unit * self.surface.support(up)
    }

    /// The place of the part with this number, from 0, that is nearest to a plane with this normal, from the centre of mass in m; of several the
    /// one that comes down first as the normal changes with `turning`. All are in the axes that the body was given in.
    pub fn nearest(&self, number: usize, up: Vector, turning: Vector) -> Vector {
        let part = each_surface!(&self.surface, balls => {
            let mut points = balls.points().iter();
            let place = points.position(|point| point.number as usize == number);
            place.expect("the number of a part")
        }, _convex => number);
        let [up, turning] = [up, turning].map(|v| self.axes.inverse().rotate(v));
        self.axes.rotate(self.surface.nearest(part, up, turning)) * self.unit
    }

    /// The parts with which it touches another body, in m and the principal axes, where they are known.
    pub(super) fn pieces(&self) -> Option<Vec<Piece>> {
        each_surface!(&self.surface, balls => {
            let points = balls.points().iter();
            match self.extent {
                Extent::Balls => {
                    let piece = |point: &Point| Piece::ball(point.place * self.unit, point.radius * self.unit);
                    Some(points.map(piece).collect())
                }
                Extent::Hull => {
                    let corners = points.map(|point| point.place * self.unit);
                    Some(vec![Piece::polyhedron(corners.collect())?])
                }
                Extent::Other => None,
            }
        }, convex => {
            let piece = (self.extent == Extent::Hull).then(|| convex.piece(self.unit));
            Some(vec![piece??])
        })
    }

    /// Smallest height of the centre of mass, in m, at which no part of the body is below the plane in an attitude of the axes that
    /// the body was given in.
    pub fn lowest(&self, attitude: Quaternion) -> f64 {
        self.unit * self.surface.support(up(attitude * self.axes))
    }
}

/// The plane normal in the axes of a body with this attitude.
pub(crate) fn up(attitude: Quaternion) -> Vector {
    let Quaternion { w, x, y, z } = attitude;
    Vector::new(
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    )
}
