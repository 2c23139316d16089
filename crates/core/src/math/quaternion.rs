//! Rotations as unit quaternions.

use super::{Vector, Vectors};
use crate::simd::{Mask, Pack};
use pulp::{Scalar, Simd};
use std::ops::{Add, Mul, Sub};

/// A quaternion w + x**i** + y**j** + z**k**. One of length 1 is the rotation by 2 arccos w about (x, y, z), and as an attitude takes the
/// axes of the body to those of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quaternion {
    /// Real part.
    pub w: f64,
    /// Part along **i**.
    pub x: f64,
    /// Part along **j**.
    pub y: f64,
    /// Part along **k**.
    pub z: f64,
}

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Self = Self::new(1.0, 0.0, 0.0, 0.0);

    /// The quaternion (w, x, y, z).
    #[inline(always)]
    pub const fn new(w: f64, x: f64, y: f64, z: f64) -> Self {
        Self { w, x, y, z }
    }

    /// w, x, y and z.
    #[inline(always)]
    pub const fn parts(self) -> [f64; 4] {
        [self.w, self.x, self.y, self.z]
    }

    /// The rotation backward.
    #[inline(always)]
    pub const fn inverse(self) -> Self {
        Self::new(self.w, -self.x, -self.y, -self.z)
    }

    /// The same direction with length 1.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        let Self { w, x, y, z } = self;
        let part = 1.0 / square(self.parts()).sqrt();
        Self::new(part * w, part * x, part * y, part * z)
    }

    /// [`turned`].
    #[inline(always)]
    pub(crate) fn turned(self, turn: Self) -> Self {
        let [w, x, y, z] = turned(self.parts(), turn.parts());
        Self::new(w, x, y, z)
    }

    /// The only lane of one in each.
    #[inline(always)]
    pub(crate) fn in_lane(self) -> Quaternions<Scalar> {
        Quaternions::splat(Scalar::new(), self)
    }

    /// A vector of the body in the axes of space.
    #[inline(always)]
    pub fn rotate(self, v: Vector) -> Vector {
        let [x, y, z] = rotated(self.parts(), v.parts());
        Vector::new(x, y, z)
    }
}

/// A part of a quaternion: a number, or one in each lane.
pub(crate) trait Part:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Part for T {}

/// The product of two quaternions (w, x, y, z): the rotation by the second and then by the first.
#[inline(always)]
pub(crate) fn product<T: Part>([aw, ax, ay, az]: [T; 4], [bw, bx, by, bz]: [T; 4]) -> [T; 4] {
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
    ]
}

/// The product of two whose length is 1 but for rounding, with length 1. Over many turns by the same angle rounding must not lean to one side, as it
/// does in w(1 − 10⁻¹⁶): so the turn's difference from 1 is multiplied, and what the last sum has lost is added with what the length lacks.
#[inline(always)]
fn turned<T: Part + Sub<f64, Output = T>>(
    [aw, ax, ay, az]: [T; 4],
    [bw, bx, by, bz]: [T; 4],
) -> [T; 4]
where
    f64: Mul<T, Output = T> + Sub<T, Output = T>,
{
    let less = bw - 1.0;
    let (w, dw) = sum(aw, aw * less - ax * bx - ay * by - az * bz);
    let (x, dx) = sum(ax, ax * less + aw * bx + ay * bz - az * by);
    let (y, dy) = sum(ay, ay * less + aw * by + az * bx - ax * bz);
    let (z, dz) = sum(az, az * less + aw * bz + ax * by - ay * bx);
    let part = 0.5 * (1.0 - w * w - x * x - y * y - z * z);
    [
        w + (dw + part * w),
        x + (dx + part * x),
        y + (dy + part * y),
        z + (dz + part * z),
    ]
}

/// The square of its length.
#[inline(always)]
pub(crate) fn square<T: Part>([w, x, y, z]: [T; 4]) -> T {
    w * w + x * x + y * y + z * z
}

/// A vector after the rotation by a unit quaternion: **v** + 2w **q** × **v** + 2**q** × (**q** × **v**).
#[inline(always)]
pub(crate) fn rotated<T: Part>([w, x, y, z]: [T; 4], [vx, vy, vz]: [T; 3]) -> [T; 3]
where
    f64: Mul<T, Output = T>,
{
    let (a, b, c) = (
        2.0 * (y * vz - z * vy),
        2.0 * (z * vx - x * vz),
        2.0 * (x * vy - y * vx),
    );
    [
        vx + (w * a + (y * c - z * b)),
        vy + (w * b + (z * a - x * c)),
        vz + (w * c + (x * b - y * a)),
    ]
}

/// A sum, and what it has lost by rounding: D. E. Knuth, *The Art of Computer Programming* 2, theorem 4.2.2 B.
#[inline(always)]
pub(crate) fn sum<T: Part>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let second = sum - a;
    (sum, (a - (sum - second)) + (b - second))
}

/// The rotation by the second and then by the first.
impl Mul for Quaternion {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let [w, x, y, z] = product(self.parts(), b.parts());
        Self::new(w, x, y, z)
    }
}

/// A unit quaternion in each lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quaternions<S: Simd> {
    pub w: Pack<S, 1>,
    pub v: Vectors<S, 1>,
}

impl<S: Simd> Quaternions<S> {
    /// The same one in every lane.
    #[inline(always)]
    pub fn splat(simd: S, of: Quaternion) -> Self {
        Self {
            w: Pack::splat(simd, of.w),
            v: Vectors::splat(simd, Vector::new(of.x, of.y, of.z)),
        }
    }

    #[inline(always)]
    pub fn parts(self) -> [Pack<S, 1>; 4] {
        [self.w, self.v.x, self.v.y, self.v.z]
    }

    #[inline(always)]
    pub fn of([w, x, y, z]: [Pack<S, 1>; 4]) -> Self {
        Self {
            w,
            v: Vectors { x, y, z },
        }
    }

    /// The rotation by the second and then by this.
    #[inline(always)]
    pub fn times(self, second: Self) -> Self {
        Self::of(product(self.parts(), second.parts()))
    }

    /// [`turned`].
    #[inline(always)]
    pub fn turned(self, turn: Self) -> Self {
        Self::of(turned(self.parts(), turn.parts()))
    }

    #[inline(always)]
    pub fn normalized(self) -> Self {
        let part = 1.0 / square(self.parts()).sqrt();
        Self {
            w: self.w * part,
            v: self.v.times(part),
        }
    }

    /// A vector after the rotation.
    #[inline(always)]
    pub fn rotate(self, v: Vectors<S, 1>) -> Vectors<S, 1> {
        let [x, y, z] = rotated(self.parts(), [v.x, v.y, v.z]);
        Vectors { x, y, z }
    }

    /// The rotation backward.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self {
            v: self.v.times(-1.0),
            ..self
        }
    }

    /// The same, but those of `other` in the lanes of the mask.
    #[inline(always)]
    pub fn or(self, mask: Mask<S, 1>, other: Self) -> Self {
        Self {
            w: mask.select(other.w, self.w),
            v: self.v.or(mask, other.v),
        }
    }

    #[inline(always)]
    pub fn put(&mut self, lane: usize, of: Quaternion) {
        self.w.as_mut_slice()[lane] = of.w;
        self.v.put(lane, Vector::new(of.x, of.y, of.z));
    }

    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Quaternion {
        let Vector { x, y, z } = self.v.lane(lane);
        Quaternion::new(self.w.as_slice()[lane], x, y, z)
    }
}
