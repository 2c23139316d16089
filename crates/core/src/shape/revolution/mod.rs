//! Bodies of revolution: the properties on which the motion depends, and one file per shape.
//!
//! A new shape is a file with its parameters in SI units that implements [`Shape`], and an entry of [`super::BODIES`]. Its hull consists of
//! balls or is smooth; [`Hull`] lists what it has to provide.

mod dumbbell;
mod hollow;
mod hull;
mod loaded_sphere;
mod spherocylinder;
mod spheroid;

pub use dumbbell::Dumbbell;
pub(crate) use hull::{AxisMotion, Hull, HullPart, with_hull};
pub use hull::{Ball, Balls, Ellipsoid, EqualBalls, OneBall, Sphere, Surface, TwoBalls};
pub use loaded_sphere::LoadedSphere;
pub use spherocylinder::Spherocylinder;
pub use spheroid::Spheroid;

use super::pieces::Piece;
use super::{check_density, check_distance, check_length, check_magnitude};
use crate::Error;
use crate::math::{Quaternion, Vector};
use hollow::{INERTIA, WALL, made};
use std::f64::consts::{FRAC_PI_2, PI};

/// A body of revolution in the core's units (lengths in R, masses in m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// The surface that can touch the plane.
    pub hull: Surface,
    /// Half the distance between the centres of the two spheres, L/(2R); 0 if the hull is a single sphere or smooth.
    pub half_separation: f64,
    /// Moment of inertia J_xx/(mR²) across the symmetry axis, about the centre of mass.
    pub transverse: f64,
    /// Moment of inertia J_zz/(mR²) about the symmetry axis.
    pub axial: f64,
}

/// A shape of a body of revolution.
pub trait Shape {
    /// The body in SI units and in the core's.
    fn solid(&self) -> Solid;
    /// The body with a wall of this thickness, in m: the shape less itself drawn in by it; the whole shape if it leaves nothing inside.
    ///
    /// # Errors
    /// Unless the wall is at least 10⁻⁶ of the longest radius, and no thicker than the body.
    fn hollow(self, wall: f64) -> Result<Self, Error>
    where
        Self: Sized;
}

/// The properties of any shape, as a run uses them.
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
    /// Position of the centre of mass on the axis, in m, relative to the middle of the shape: the midpoint of the centres of its
    /// two spheres, or the centre of a single one.
    pub centre_of_mass: f64,
    /// True if the body is its convex hull; false if it is made of the spheres of its hull.
    pub is_filled: bool,
    /// The curve that the surface cuts out of a plane through the axis, as far as it is not straight: the arc at the end to which the
    /// axis points, and that at the other end, joined by a straight line. In m; the origin is the centre of mass.
    pub outline: [Arc; 2],
    /// The body in the core's units.
    pub scaled: Body,
}

/// An arc of an ellipse whose centre is on the axis: the points `centre` + `along` cos t on the axis and `across` sin t beside it, t
/// from `from` to `to` within [0, π].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Position of the centre on the axis, from the centre of mass, in m.
    pub centre: f64,
    /// Semi-axis along the axis, in m.
    pub along: f64,
    /// Semi-axis across the axis, in m.
    pub across: f64,
    /// The first t, in rad.
    pub from: f64,
    /// The last t, in rad.
    pub to: f64,
}

impl Arc {
    /// A whole ellipse of revolution, in two halves.
    pub(super) fn halves(centre: f64, along: f64, across: f64) -> [Self; 2] {
        [(0.0, FRAC_PI_2), (FRAC_PI_2, PI)].map(|(from, to)| Self {
            centre,
            along,
            across,
            from,
            to,
        })
    }

    /// The caps of two spheres with these centres and radii; the first ends at the first of `angles` from the axis, the second begins
    /// at the second.
    pub(super) fn caps(centres: [f64; 2], radii: [f64; 2], angles: [f64; 2]) -> [Self; 2] {
        let cap = |i: usize, from, to| Self {
            centre: centres[i],
            along: radii[i],
            across: radii[i],
            from,
            to,
        };
        [cap(0, 0.0, angles[0]), cap(1, angles[1], PI)]
    }
}

impl<S: Shape> From<S> for Solid {
    fn from(shape: S) -> Self {
        shape.solid()
    }
}

impl Solid {
    /// Smallest height of the centre of mass, in m, at which no part of the body is below the plane, for an axis at an angle to the
    /// plane normal with this cosine. It is rounded; compare heights with it by [`Solid::clears`].
    pub fn lowest(&self, cosine: f64) -> f64 {
        self.unit * self.scaled.hull.support(cosine)
    }

    /// True if a `height` of the centre of mass is at least `lowest` up to rounding, both in m, so that a body may be placed on the
    /// plane.
    pub fn clears(height: f64, lowest: f64) -> bool {
        height >= lowest * (1.0 - 4.0 * f64::EPSILON)
    }

    /// The parts with which it touches another body, in m and the principal axes.
    pub(super) fn pieces(&self) -> Vec<Piece> {
        let unit = self.unit;
        let balls = match &self.scaled.hull {
            Surface::EqualBalls(hull) => hull.balls(),
            Surface::TwoBalls(hull) => hull.balls(),
            Surface::OneBall(hull) => hull.balls(),
            Surface::Ellipsoid(hull) => {
                let [across, along] = hull.semi_axes().map(|axis| axis * unit);
                let semi_axes = [across, across, along];
                let centre = Vector::default();
                return vec![Piece::ellipsoid(semi_axes, Quaternion::IDENTITY, centre)];
            }
        };
        let place = |ball: &Ball| Vector::new(0.0, 0.0, unit * ball.offset);
        if let (true, [one, two]) = (self.is_filled, balls)
            && one.offset != two.offset
        {
            let ends = [place(two), place(one)];
            return vec![Piece::rod(ends, unit * one.radius, false)];
        }
        let piece = |ball: &Ball| Piece::ball(place(ball), unit * ball.radius);
        let count = if self.is_filled { 1 } else { balls.len() };
        balls[..count].iter().map(piece).collect()
    }

    /// The largest value of [`Solid::lowest`] over all angles, in m.
    pub fn farthest(&self) -> f64 {
        self.unit * self.scaled.hull.farthest()
    }
}

/// The shape, unless its mass, its inertia or their ratio overflows or underflows: then an error that names `name`, the
/// parameter that sets its size.
fn representable<S: Shape>(shape: S, name: &'static str) -> Result<S, Error> {
    let solid = shape.solid();
    let all = [
        solid.mass,
        solid.transverse_inertia,
        solid.axial_inertia,
        solid.scaled.transverse,
        solid.scaled.axial,
    ];
    check_magnitude(name, solid.unit, all)?;
    Ok(shape)
}

/// L/R below which a dumbbell is treated as a sphere: far too small to change any digit of the motion.
const NEGLIGIBLE: f64 = 1e-75;

/// L/R, or 0 if it is below [`NEGLIGIBLE`], so that its powers do not underflow.
fn seen(elongation: f64) -> f64 {
    if elongation < NEGLIGIBLE {
        0.0
    } else {
        elongation
    }
}
