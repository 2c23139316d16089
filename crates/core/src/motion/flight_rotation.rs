//! The motion of the points of a free body about its centre of mass, along one flight.
//!
//! A point **p** on the axis **e** of a body with two equal moments J turns with it about the angular momentum **Λ** at the rate |Λ|/J, and
//! |**p**″| = |p||**ω** × **e**||Λ|/J. The surface of a body of revolution about **e** turns about **Λ** at that rate, too: how it turns about **e** is not
//! seen. Any other point has |**p**″| ≤ (1 + a/√3)Ω²|**p**| ([`SpinBounds`]).

use super::{Rotation, SpinBounds};
use crate::math::{Quaternion, Symmetric, UNITS, Vector};
use crate::shape::{Round, Symmetry, Top};
use crate::simd::elementary::sincos;

/// The rotation of a body during a flight.
#[expect(
    clippy::large_enum_variant,
    reason = "two live at a time, on the stack"
)]
pub(crate) enum FlightRotation {
    /// About the axis of this number: the part of it along **Λ**, that across and **Λ** × **e**/|Λ|.
    Axis(usize, [Vector; 3], Precession),
    /// Any, with the bounds on it.
    Any(Rotation, SpinBounds),
}

/// The uniform rotation of a body of revolution.
#[derive(Clone, Copy)]
pub(crate) struct Precession {
    /// The direction of **Λ**.
    pub direction: Vector,
    /// |Λ|/J.
    pub rate: f64,
    /// Sine and cosine of the angle between both.
    pub sine: f64,
    pub cosine: f64,
}

/// A body at a time: its axes in space and **ω**, or an axis of it with **e**′ and **e**″, and **Λ**/J.
///
/// All of it is always written: compilers compute with both beforehand, and what happens to be there may be denormal, which takes a hundred cycles.
pub(crate) struct BodyPose {
    axis: Option<usize>,
    motion: [Vector; 3],
    spin: Vector,
}

/// The principal axes of a body in space, or of a body of revolution some that turn with its axis, and their **ω**.
#[derive(Clone, Copy)]
pub(crate) struct BodyFrame {
    columns: [Vector; 3],
    axis: Option<usize>,
    pub spin: Vector,
}

impl Top {
    /// True if **e**, the principal axis of this number, turns about **Λ** at a constant rate.
    pub(crate) fn precesses(&self, axis: usize) -> bool {
        match self.symmetry {
            Symmetry::Isotropic => true,
            Symmetry::About(own) => own == axis,
            Symmetry::Asymmetric => false,
        }
    }
}

impl FlightRotation {
    /// The rotation from this attitude with this ω in the axes of the body, which is one of revolution about a principal axis that precesses, if
    /// that is given.
    #[inline(always)]
    pub fn new(top: &Top, axis: Option<usize>, attitude: Quaternion, spin: Vector) -> Self {
        let Some(axis) = axis else {
            return Self::Any(Rotation::begun(top, attitude, spin), top.bounds(spin));
        };
        let e = attitude.rotate(UNITS[axis]);
        let across = top.moments()[(axis + 1) % 3];
        let momentum = top.momentum(attitude, spin) / across;
        let rate = momentum.norm();
        let about = if rate > 0.0 { momentum / rate } else { e };
        let third = about.cross(e);
        let second = third.cross(about);
        let cosine = about.dot(e);
        let along = about * cosine;
        let precession = Precession {
            direction: about,
            rate,
            sine: third.norm(),
            cosine,
        };
        Self::Axis(axis, [along, second, third], precession)
    }

    /// The body at a time ≥ 0.
    #[inline(always)]
    pub fn at(&mut self, time: f64) -> BodyPose {
        match self {
            Self::Axis(axis, [along, second, third], about) => {
                let rate = about.rate;
                let (sine, cosine) = sincos(rate * time);
                let level = third.mul_add(sine, *second * cosine);
                let change = third.mul_add(cosine, *second * -sine) * rate;
                let bend = level * -(rate * rate);
                BodyPose {
                    axis: Some(*axis),
                    motion: [*along + level, change, bend],
                    spin: about.direction * rate,
                }
            }
            Self::Any(rotation, _) => {
                let (attitude, spin) = rotation.later(time);
                BodyPose::new(attitude, spin)
            }
        }
    }

    /// Attitude, and ω in the axes of the body, at a time ≥ 0; none of a body of which only the axis is followed.
    #[inline(always)]
    pub fn rotated(&mut self, time: f64) -> Option<(Quaternion, Vector)> {
        match self {
            Self::Axis(..) => None,
            Self::Any(rotation, _) => Some(rotation.later(time)),
        }
    }

    /// The largest acceleration of a point, per distance from the centre of mass; of a body of revolution, of a point on its axis.
    #[inline(always)]
    pub fn bound(&self) -> f64 {
        match self {
            Self::Axis(_, _, about) => about.rate * (about.rate * about.sine),
            Self::Any(_, bounds) => bounds.whole,
        }
    }
}

impl BodyPose {
    /// The body with this attitude and ω in its own axes.
    #[inline(always)]
    pub fn new(attitude: Quaternion, spin: Vector) -> Self {
        let [x, y, z] = UNITS;
        let columns = [attitude.rotate(x), attitude.rotate(y), attitude.rotate(z)];
        Self {
            axis: None,
            motion: columns,
            spin: combined(columns, spin),
        }
    }

    /// Where a point of the body is, from the centre of mass, and its velocity relative to it, in space.
    #[inline(always)]
    pub fn moves(&self, point: Vector) -> [Vector; 2] {
        match self.axis {
            Some(axis) => {
                let along = point.parts()[axis];
                [self.motion[0] * along, self.motion[1] * along]
            }
            None => {
                let place = combined(self.motion, point);
                [place, self.spin.cross(place)]
            }
        }
    }

    /// Its axes.
    #[inline(always)]
    pub fn frame(&self) -> BodyFrame {
        let columns = match self.axis {
            None => self.motion,
            Some(axis) => {
                let e = self.motion[0];
                let across = e.across();
                let mut columns = [e; 3];
                columns[(axis + 1) % 3] = across;
                columns[(axis + 2) % 3] = e.cross(across);
                columns
            }
        };
        BodyFrame {
            columns,
            axis: self.axis,
            spin: self.spin,
        }
    }

    /// The acceleration of a point.
    #[inline(always)]
    pub fn bends(&self, top: &Top, point: Vector) -> Vector {
        match self.axis {
            Some(axis) => self.motion[2] * point.parts()[axis],
            None => {
                let frame = self.frame();
                let change = frame.rotate(top.change(frame.back(self.spin)));
                let place = frame.rotate(point);
                change.cross(place) + self.spin.cross(self.spin.cross(place))
            }
        }
    }
}

impl BodyFrame {
    /// A vector of the body in space.
    #[inline(always)]
    pub fn rotate(&self, v: Vector) -> Vector {
        combined(self.columns, v)
    }

    /// A vector of space in the axes of the body.
    #[inline(always)]
    pub fn back(&self, v: Vector) -> Vector {
        let [x, y, z] = self.columns;
        Vector::new(x.dot(v), y.dot(v), z.dot(v))
    }

    /// The round portion of a part, in space; of a body of revolution it is symmetric about the axis.
    #[inline(always)]
    pub fn round(&self, round: &Round) -> Round {
        match round {
            Round::Ellipsoid(body) => Round::Ellipsoid(self.matrix(body)),
            Round::Superellipsoid(surface, axes) => {
                Round::Superellipsoid(*surface, axes.map(|axis| self.rotate(axis)))
            }
        }
    }

    #[inline(always)]
    fn matrix(&self, body: &Symmetric) -> Symmetric {
        if let Some(axis) = self.axis {
            let entries = [body.xx, body.yy, body.zz];
            let [along, across] = [entries[axis], entries[(axis + 1) % 3]];
            return Symmetric::diagonal([across; 3])
                + Symmetric::square(self.columns[axis], along - across);
        }
        let [x, y, z] = self.columns;
        // The rows of the axes.
        let [a, b, c] = [
            Vector::new(x.x, y.x, z.x),
            Vector::new(x.y, y.y, z.y),
            Vector::new(x.z, y.z, z.z),
        ];
        let [p, q, r] = [*body * a, *body * b, *body * c];
        Symmetric {
            xx: a.dot(p),
            yy: b.dot(q),
            zz: c.dot(r),
            xy: a.dot(q),
            xz: a.dot(r),
            yz: b.dot(r),
        }
    }
}

#[inline(always)]
fn combined([x, y, z]: [Vector; 3], v: Vector) -> Vector {
    z.mul_add(v.z, y.mul_add(v.y, x * v.x))
}
