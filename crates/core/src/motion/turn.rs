//! The motion of the points of a free body about its centre of mass, along one flight.
//!
//! A point **p** on the axis **e** of a body with two equal moments J turns with it about the angular momentum **Λ** at the rate |Λ|/J, and
//! |**p**″| = |p||**ω** × **e**||Λ|/J. Any other point has |**p**″| ≤ (1 + a/√3)Ω²|**p**| ([`SpinBounds`](super::SpinBounds)).

use super::Rotation;
use crate::math::{Quaternion, UNITS, Vector};
use crate::shape::{Symmetry, Top};
use crate::simd::elementary::sincos;

/// The rotation of a body during a flight.
pub(crate) struct Turn {
    way: TurnWay,
    /// The largest velocity and acceleration of a point, per distance from the centre of mass.
    pub bounds: [f64; 2],
}

#[expect(
    clippy::large_enum_variant,
    reason = "two live at a time, on the stack"
)]
enum TurnWay {
    /// All points are on an axis of this number: the part of it along **Λ**, that across and **Λ** × **e**/|Λ|, the rate.
    Axis(usize, [Vector; 3], f64),
    Any(Rotation),
}

/// A body at a time: attitude and ω in its own axes, or an axis of it with **e**′ and **e**″.
///
/// All of it is always written: compilers compute with both beforehand, and what happens to be there may be denormal, which takes a hundred cycles.
pub(crate) struct BodyPose {
    attitude: Quaternion,
    spin: Vector,
    axis: Option<usize>,
    motion: [Vector; 3],
}

impl Top {
    /// True if **e**, the principal axis of this number, turns about **Λ** at a constant rate.
    pub(crate) fn precesses(&self, axis: usize) -> bool {
        match self.symmetry() {
            Symmetry::Isotropic => true,
            Symmetry::About(own) => own == axis,
            Symmetry::Asymmetric => false,
        }
    }
}

impl Turn {
    /// The rotation from this attitude with this ω in the axes of the body, whose points are all on a principal axis that precesses, if that
    /// is given.
    #[inline(always)]
    pub fn new(top: &Top, axis: Option<usize>, attitude: Quaternion, spin: Vector) -> Self {
        let Some(axis) = axis else {
            let bounds = top.bounds(spin);
            return Self {
                way: TurnWay::Any(Rotation::new(*top, attitude, spin)),
                bounds: [bounds.fastest, bounds.whole],
            };
        };
        let e = attitude.rotate(UNITS[axis]);
        let across = top.moments()[(axis + 1) % 3];
        let momentum = top.momentum(attitude, spin) / across;
        let rate = momentum.norm();
        if rate == 0.0 {
            let none = Vector::default();
            return Self {
                way: TurnWay::Axis(axis, [e, none, none], 0.0),
                bounds: [0.0; 2],
            };
        }
        let about = momentum / rate;
        let third = about.cross(e);
        let second = third.cross(about);
        let along = about * about.dot(e);
        let speed = rate * third.norm();
        Self {
            way: TurnWay::Axis(axis, [along, second, third], rate),
            bounds: [speed, rate * speed],
        }
    }

    /// The body at a time ≥ 0.
    #[inline(always)]
    pub fn at(&mut self, time: f64) -> BodyPose {
        match &mut self.way {
            TurnWay::Axis(axis, [along, second, third], rate) => {
                let (sine, cosine) = sincos(*rate * time);
                let level = third.mul_add(sine, *second * cosine);
                let change = third.mul_add(cosine, *second * -sine) * *rate;
                let bend = level * -(*rate * *rate);
                BodyPose {
                    attitude: Quaternion::IDENTITY,
                    spin: Vector::default(),
                    axis: Some(*axis),
                    motion: [*along + level, change, bend],
                }
            }
            TurnWay::Any(rotation) => {
                let (attitude, spin) = rotation.at(time);
                BodyPose::new(attitude, spin)
            }
        }
    }

    /// Attitude, and ω in the axes of the body, at a time ≥ 0; none of a body of which only the axis is followed.
    #[inline(always)]
    pub fn rotated(&mut self, time: f64) -> Option<(Quaternion, Vector)> {
        match &mut self.way {
            TurnWay::Axis(..) => None,
            TurnWay::Any(rotation) => Some(rotation.at(time)),
        }
    }
}

impl BodyPose {
    /// The body with this attitude and ω in its own axes.
    #[inline(always)]
    pub fn new(attitude: Quaternion, spin: Vector) -> Self {
        Self {
            attitude,
            spin,
            axis: None,
            motion: [Vector::default(); 3],
        }
    }

    /// Where a point of the body is, from the centre of mass, and its velocity relative to it, in space.
    #[inline(always)]
    pub fn moves(&self, point: Vector) -> [Vector; 2] {
        let Self { attitude, spin, .. } = *self;
        match self.axis {
            Some(axis) => {
                let along = point.parts()[axis];
                [self.motion[0] * along, self.motion[1] * along]
            }
            None => [attitude.rotate(point), attitude.rotate(spin.cross(point))],
        }
    }

    /// Attitude, and ω in space; of balls on an axis a rotation that takes the axis where it is.
    #[inline(always)]
    pub fn frame(&self) -> (Quaternion, Vector) {
        match self.axis {
            Some(axis) => {
                let [e, change, _] = self.motion;
                (Self::about(axis, e), e.cross(change))
            }
            None => (self.attitude, self.attitude.rotate(self.spin)),
        }
    }

    /// A rotation that takes this principal axis to a unit vector.
    fn about(axis: usize, e: Vector) -> Quaternion {
        let from = UNITS[axis];
        let (along, across) = (from.dot(e), from.cross(e));
        if along > -0.5 {
            return Quaternion::new(1.0 + along, across.x, across.y, across.z).normalized();
        }
        // Half a turn about the next axis first.
        let Vector { x, y, z } = UNITS[(axis + 1) % 3];
        let (along, across) = (-along, across * -1.0);
        Quaternion::new(1.0 + along, across.x, across.y, across.z).normalized()
            * Quaternion::new(0.0, x, y, z)
    }

    /// Its acceleration.
    #[inline(always)]
    pub fn bends(&self, top: &Top, point: Vector) -> Vector {
        let Self { attitude, spin, .. } = *self;
        match self.axis {
            Some(axis) => self.motion[2] * point.parts()[axis],
            None => attitude.rotate(top.change(spin).cross(point) + spin.cross(spin.cross(point))),
        }
    }
}
