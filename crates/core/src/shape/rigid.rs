//! Bodies of any shape: mass, principal axes, and what can touch the plane.

use super::check_density;
use super::convex::{Convex, ConvexSurface};
use super::top::Top;
use super::tree::{Balls, Effort, Instant, Least, Point};
use crate::Error;
use crate::math::{Quaternion, Symmetric, Vector};
use crate::memory::{collected, filled};

/// Volume, or mass, with its first and second moments: the integrals of 1, **x** and **x**⊗**x**.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Moments {
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidBall {
    /// Its centre.
    pub centre: Vector,
    /// Its radius.
    pub radius: f64,
}

/// The parts of a body that can touch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Skin {
    /// Balls, or the vertices of a polyhedron.
    Points(Balls),
    Convex(Convex),
}

/// Most balls, so that their numbers can be recorded.
const MOST: usize = i32::MAX as usize;

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
    pub(crate) skin: Skin,
}

impl Moments {
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
        let Symmetric {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        } = central;
        Inertia {
            mass: density * m,
            centre: c,
            tensor: Symmetric {
                xx: density * (yy + zz),
                yy: density * (zz + xx),
                zz: density * (xx + yy),
                xy: -density * xy,
                xz: -density * xz,
                yz: -density * yz,
            },
        }
    }
}

impl Rigid {
    /// A body with these parts, in m and the axes of its inertia; `what` is for the error.
    pub(super) fn of_balls(
        inertia: Inertia,
        what: &'static str,
        balls: impl ExactSizeIterator<Item = RigidBall>,
    ) -> Result<Self, Error> {
        Error::unless(balls.len() < MOST, what, balls.len(), "fewer than 2^31")?;
        let about_centre = balls
            .enumerate()
            .map(|(number, ball)| Point::new(ball.centre - inertia.centre, ball.radius, number));
        let mut points = collected(what, about_centre)?;
        let reach = |point: &Point| point.place.norm() + point.radius;
        let unit = points.iter().map(reach).fold(0.0, f64::max);
        Self::new(inertia, unit, |axes| {
            let back = axes.inverse();
            for (number, point) in points.iter_mut().enumerate() {
                *point = Point::new(back.rotate(point.place) / unit, point.radius / unit, number);
            }
            Ok(Skin::Points(Balls::new(what, points)?))
        })
    }

    /// The balls or vertices, in m and the axes that the body was given in; none of an ellipsoid.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn balls(&self) -> Result<Vec<RigidBall>, Error> {
        let Skin::Points(balls) = &self.skin else {
            return Ok(Vec::new());
        };
        let none = RigidBall {
            centre: Vector::default(),
            radius: 0.0,
        };
        let mut found = filled("asperities", none, balls.points().len())?;
        for point in balls.points() {
            found[point.number as usize] = RigidBall {
                centre: self.axes.rotate(point.place * self.unit) + self.inertia.centre,
                radius: self.unit * point.radius,
            };
        }
        Ok(found)
    }

    /// A homogeneous ellipsoid with these semi-axes (m) along its own axes.
    ///
    /// # Errors
    /// Unless they and the density are positive, and the largest is at most 1000 times the smallest.
    pub fn ellipsoid(semi_axes: [f64; 3], density: f64) -> Result<Self, Error> {
        Self::check_semi_axes(semi_axes)?;
        check_density(density)?;
        let [a, b, c] = semi_axes;
        let mass = density * (4.0 / 3.0 * std::f64::consts::PI) * a * b * c;
        let fifth = mass / 5.0;
        let inertia = Inertia {
            mass,
            centre: Vector::default(),
            tensor: Symmetric::diagonal([
                fifth * (b * b + c * c),
                fifth * (c * c + a * a),
                fifth * (a * a + b * b),
            ]),
        };
        let unit = a.max(b).max(c);
        let surface = ConvexSurface::Ellipsoid(semi_axes.map(|axis| axis / unit));
        Self::new(inertia, unit, |_| Ok(Skin::Convex(Convex::new(surface))))
    }

    /// Refuses semi-axes that are no positive numbers, or differ by more than 1000 times.
    pub(super) fn check_semi_axes(semi_axes: [f64; 3]) -> Result<(), Error> {
        for axis in semi_axes {
            let positive = axis.is_finite() && axis > 0.0;
            Error::unless(positive, "semi_axes", axis, "finite and > 0 (m)")?;
        }
        let [most, least] =
            [f64::max, f64::min].map(|of| semi_axes.into_iter().fold(semi_axes[0], of));
        Error::unless(
            most <= 1000.0 * least * (1.0 + 4.0 * f64::EPSILON),
            "semi_axes",
            least,
            "at least 1/1000 of the largest",
        )
    }

    /// A body whose parts, in its principal axes and in units of `unit`, follow from the rotation of these to the axes of its inertia.
    pub(super) fn new(
        inertia: Inertia,
        unit: f64,
        skin: impl FnOnce(Quaternion) -> Result<Skin, Error>,
    ) -> Result<Self, Error> {
        let (top, axes) = principal(&inertia, unit)?;
        Ok(Self {
            inertia,
            unit,
            axes,
            top,
            skin: skin(axes)?,
        })
    }

    /// The same parts with another inertia: mass, centre and tensor, in the axes that the body was given in.
    ///
    /// # Errors
    /// Unless the mass is positive, and the tensor is that of a body.
    pub fn with_inertia(self, inertia: Inertia) -> Result<Self, Error> {
        let Skin::Convex(convex) = &self.skin else {
            return Self::of_balls(inertia, "points", self.balls()?.into_iter());
        };
        let shift = self
            .axes
            .inverse()
            .rotate(inertia.centre - self.inertia.centre);
        // No part is farther from the new centre than this.
        let unit = self.unit + shift.norm();
        Self::new(inertia, unit, |axes| {
            let turn = self.axes.inverse() * axes;
            let moved = convex.with_frame(turn, shift / self.unit, unit / self.unit);
            Ok(Skin::Convex(moved))
        })
    }

    /// The principal moments of inertia, in kg m².
    pub fn principal_moments(&self) -> [f64; 3] {
        let scale = self.inertia.mass * self.unit * self.unit;
        self.top.moments().map(|moment| scale * moment)
    }

    /// The distance in m from the centre of mass to the plane that touches the body with this outward normal, in the axes that it was given in.
    pub fn support(&self, normal: Vector) -> f64 {
        self.unit * self.skin.support(self.axes.inverse().rotate(normal) * -1.0)
    }

    /// The place of the part with this number, from 0, that is nearest to a plane with this normal, from the centre of mass in m; of several the
    /// one that comes down first as the normal changes with `turning`. All are in the axes that the body was given in.
    pub fn nearest(&self, number: usize, up: Vector, turning: Vector) -> Vector {
        let part = match &self.skin {
            Skin::Points(balls) => {
                let mut points = balls.points().iter();
                let place = points.position(|point| point.number as usize == number);
                place.expect("the number of a part")
            }
            Skin::Convex(_) => number,
        };
        let back = self.axes.inverse();
        let nearest = self
            .skin
            .nearest(part, back.rotate(up), back.rotate(turning));
        self.axes.rotate(nearest) * self.unit
    }

    /// Smallest height of the centre of mass, in m, at which no part of the body is below the plane in an attitude of the axes that
    /// the body was given in.
    pub fn lowest(&self, attitude: Quaternion) -> f64 {
        self.unit * self.skin.support(up(attitude * self.axes))
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

impl Skin {
    /// The distance from the centre of mass to the lowest part, in the direction against `up`.
    pub(crate) fn support(&self, up: Vector) -> f64 {
        match self {
            Self::Points(balls) => {
                let at = Instant {
                    up,
                    ..Instant::default()
                };
                let exceeds = |least: &Least, limit: f64| least.gap > limit;
                let lowest = balls.cheapest(&at, None, Effort::EXACT, exceeds, |_, point, _| {
                    point.opening(&at).0
                });
                -lowest.cost
            }
            Self::Convex(convex) => convex.support(up),
        }
    }
}

/// The principal moments over mR², and the rotation from the principal axes.
fn principal(inertia: &Inertia, unit: f64) -> Result<(Top, Quaternion), Error> {
    let (moments, axes) = inertia.tensor.principal();
    let scale = 1.0 / (inertia.mass * unit * unit);
    let moments = moments.map(|moment| scale * moment);
    let all = [inertia.mass, scale, moments[0], moments[1], moments[2]];
    let finite = all.iter().all(|x| x.is_normal());
    let allowed = "such that mass and inertia neither overflow nor underflow";
    Error::unless_beyond(finite, "density", inertia.mass, allowed)?;
    Ok((Top::new(moments)?, axes))
}
