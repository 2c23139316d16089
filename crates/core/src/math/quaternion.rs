//! Rotations as unit quaternions.

use super::{Part, Vector, Vectors};
use crate::simd::{Pack, lanewise};
use pulp::{Scalar, Simd};
use std::ops::{Div, Mul, Sub};

/// A quaternion w + x**i** + y**j** + z**k**, or one in each lane. One of length 1 is the rotation by 2 arccos w about (x, y, z), and as an
/// attitude takes the axes of the body to those of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quaternion<T = f64> {
    /// Real part.
    pub w: T,
    /// Part along **i**.
    pub x: T,
    /// Part along **j**.
    pub y: T,
    /// Part along **k**.
    pub z: T,
}

/// A unit quaternion in each lane.
pub(crate) type Quaternions<S> = Quaternion<Pack<S>>;

impl<T: Copy> Quaternion<T> {
    /// The quaternion (w, x, y, z).
    #[inline(always)]
    pub const fn new(w: T, x: T, y: T, z: T) -> Self {
        Self { w, x, y, z }
    }

    /// The quaternion of a real part and of those along **i**, **j** and **k**.
    #[inline(always)]
    pub(crate) const fn of(w: T, Vector { x, y, z }: Vector<T>) -> Self {
        Self { w, x, y, z }
    }

    /// w, x, y and z.
    #[inline(always)]
    pub const fn parts(self) -> [T; 4] {
        [self.w, self.x, self.y, self.z]
    }

    /// The parts along **i**, **j** and **k**.
    #[inline(always)]
    pub(crate) const fn vector(self) -> Vector<T> {
        Vector::new(self.x, self.y, self.z)
    }
}

impl<T: Part> Quaternion<T> {
    /// The rotation backward.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self::new(self.w, -self.x, -self.y, -self.z)
    }
}

impl<T: Part + Sub<f64, Output = T>> Quaternion<T>
where
    f64: Div<T, Output = T> + Mul<T, Output = T> + Sub<T, Output = T>,
{
    /// The same direction with length 1.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        let Self { w, x, y, z } = self;
        let part = 1.0 / (w * w + x * x + y * y + z * z).root();
        Self::new(part * w, part * x, part * y, part * z)
    }

    /// The product of two whose length is 1 but for rounding, with length 1. Over many turns by the same angle rounding must not lean to one
    /// side, as it does in w(1 − 10⁻¹⁶): so the turn's difference from 1 is multiplied, and what the last sum has lost is added with what the
    /// length lacks.
    #[inline(always)]
    pub(crate) fn turned(self, turn: Self) -> Self {
        let [aw, ax, ay, az] = self.parts();
        let [bw, bx, by, bz] = turn.parts();
        let less = bw - 1.0;
        let (w, dw) = sum(aw, aw * less - ax * bx - ay * by - az * bz);
        let (x, dx) = sum(ax, ax * less + aw * bx + ay * bz - az * by);
        let (y, dy) = sum(ay, ay * less + aw * by + az * bx - ax * bz);
        let (z, dz) = sum(az, az * less + aw * bz + ax * by - ay * bx);
        let part = 0.5 * (1.0 - w * w - x * x - y * y - z * z);
        Self::new(
            w + (dw + part * w),
            x + (dx + part * x),
            y + (dy + part * y),
            z + (dz + part * z),
        )
    }

    /// A vector of the body in the axes of space: **v** + 2w **q** × **v** + 2**q** × (**q** × **v**).
    #[inline(always)]
    pub fn rotate(self, v: Vector<T>) -> Vector<T> {
        let Self { w, x, y, z } = self;
        let (a, b, c) = (
            2.0 * (y * v.z - z * v.y),
            2.0 * (z * v.x - x * v.z),
            2.0 * (x * v.y - y * v.x),
        );
        Vector::new(
            v.x + (w * a + (y * c - z * b)),
            v.y + (w * b + (z * a - x * c)),
            v.z + (w * c + (x * b - y * a)),
        )
    }
}

/// The rotation by the second and then by the first.
impl<T: Part> Mul for Quaternion<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, second: Self) -> Self {
        let [aw, ax, ay, az] = self.parts();
        let [bw, bx, by, bz] = second.parts();
        Self::new(
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by + ay * bw + az * bx - ax * bz,
            aw * bz + az * bw + ax * by - ay * bx,
        )
    }
}

/// A sum, and what it has lost by rounding: D. E. Knuth, *The Art of Computer Programming* 2, theorem 4.2.2 B.
#[inline(always)]
pub(crate) fn sum<T: Part>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let second = sum - a;
    (sum, (a - (sum - second)) + (b - second))
}

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Self = Self::new(1.0, 0.0, 0.0, 0.0);

    /// A rotation that takes the z axis to a unit vector.
    #[inline(always)]
    pub(crate) fn from_z(Vector { x, y, z }: Vector) -> Self {
        if z < -0.5 {
            // Half a turn about the x axis first.
            return Self::new(1.0 - z, y, -x, 0.0).normalized() * Self::new(0.0, 1.0, 0.0, 0.0);
        }
        Self::new(1.0 + z, -y, x, 0.0).normalized()
    }

    /// The only lane of one in each.
    #[inline(always)]
    pub(crate) fn in_lane(self) -> Quaternions<Scalar> {
        Quaternions::splat(Scalar::new(), self)
    }
}

lanewise! { Quaternions<S> { w, x, y, z } }

impl<S: Simd> Quaternions<S> {
    /// The same one in every lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, of: Quaternion) -> Self {
        Self::of(Pack::splat(simd, of.w), Vectors::splat(simd, of.vector()))
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, of: Quaternion) {
        self.w.as_mut_slice()[lane] = of.w;
        self.x.as_mut_slice()[lane] = of.x;
        self.y.as_mut_slice()[lane] = of.y;
        self.z.as_mut_slice()[lane] = of.z;
    }

    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Quaternion {
        Quaternion::of(self.w.as_slice()[lane], self.vector().lane(lane))
    }
}
