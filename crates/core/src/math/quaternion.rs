//! Rotations as unit quaternions.

use super::Vector;
use std::ops::Mul;

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
    pub const fn new(w: f64, x: f64, y: f64, z: f64) -> Self {
        Self { w, x, y, z }
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
        let part = 1.0 / (w * w + x * x + y * y + z * z).sqrt();
        Self::new(part * w, part * x, part * y, part * z)
    }

    /// The same, but for rounding, of one whose length is 1 but for rounding.
    #[inline(always)]
    pub(crate) fn renormalized(self) -> Self {
        let Self { w, x, y, z } = self;
        let part = 1.5 - 0.5 * (w * w + x * x + y * y + z * z);
        Self::new(part * w, part * x, part * y, part * z)
    }

    /// A vector of the body in the axes of space: **v** + 2w **q** × **v** + 2**q** × (**q** × **v**).
    #[inline(always)]
    pub fn rotate(self, v: Vector) -> Vector {
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
impl Mul for Quaternion {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let a = self;
        Self::new(
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
            a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
        )
    }
}
