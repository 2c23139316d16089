//! Symmetric 3×3 matrices: tensors of inertia, and what an impulse does to a contact.

use super::Vector;
use std::ops::Mul;

/// A symmetric 3×3 matrix.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Symmetric {
    /// Entry (x, x).
    pub xx: f64,
    /// Entry (y, y).
    pub yy: f64,
    /// Entry (z, z).
    pub zz: f64,
    /// Entries (x, y) and (y, x).
    pub xy: f64,
    /// Entries (x, z) and (z, x).
    pub xz: f64,
    /// Entries (y, z) and (z, y).
    pub yz: f64,
}

impl Mul<Vector> for Symmetric {
    type Output = Vector;

    fn mul(self, v: Vector) -> Vector {
        Vector::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }
}
