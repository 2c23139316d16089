//! Rotations as unit quaternions.

use super::Vector;
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

    /// The product of two whose length is 1 but for rounding, with length 1. Over many turns by the same angle rounding must not lean to one side, as it
    /// does in w(1 − 10⁻¹⁶): so the turn's difference from 1 is multiplied, and what the last sum has lost is added with what the length lacks.
    #[inline(always)]
    pub(crate) fn turned(self, turn: Self) -> Self {
        let (a, b) = (self, turn);
        let less = b.w - 1.0;
        let (w, dw) = sum(a.w, a.w * less - a.x * b.x - a.y * b.y - a.z * b.z);
        let (x, dx) = sum(a.x, a.x * less + a.w * b.x + a.y * b.z - a.z * b.y);
        let (y, dy) = sum(a.y, a.y * less + a.w * b.y + a.z * b.x - a.x * b.z);
        let (z, dz) = sum(a.z, a.z * less + a.w * b.z + a.x * b.y - a.y * b.x);
        let part = 0.5 * (1.0 - w * w - x * x - y * y - z * z);
        Self::new(
            w + (dw + part * w),
            x + (dx + part * x),
            y + (dy + part * y),
            z + (dz + part * z),
        )
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
pub(crate) fn sum(a: f64, b: f64) -> (f64, f64) {
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
