//! The surface of an ellipsoid.

use super::support::{Length, NormalMotion};
use super::{Convex, ConvexSurface, Piece, RigidSurface};
use crate::math::{Quaternion, Vector};

/// An ellipsoid about the origin with these semi-axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EllipsoidSurface(pub [f64; 3]);

impl EllipsoidSurface {
    /// A**v**, whose length is the support.
    #[inline(always)]
    fn stretched(&self, v: Vector) -> Vector {
        let [a, b, c] = self.0;
        Vector::new(a * v.x, b * v.y, c * v.z)
    }
}

impl ConvexSurface for EllipsoidSurface {
    type Along<'a> = Length;

    const OF: fn(Convex<Self>) -> RigidSurface = RigidSurface::Ellipsoid;

    fn inner(&self) -> f64 {
        let [a, b, c] = self.0;
        a.min(b).min(c)
    }

    fn support(&self, up: Vector) -> f64 {
        self.stretched(up).norm()
    }

    #[inline(always)]
    fn nearest(&self, _: usize, up: Vector, _: Vector) -> Vector {
        let stretched = self.stretched(up);
        self.stretched(stretched) * (-1.0 / stretched.norm())
    }

    #[inline(always)]
    fn along(&self, _: usize, at: &NormalMotion) -> Length {
        Length::new([at.up, at.turning, at.bending].map(|v| self.stretched(v)))
    }

    fn scaled(&self, part: f64, _: f64) -> Self {
        Self(self.0.map(|axis| axis / part))
    }

    fn piece(&self, axes: Quaternion, centre: Vector, unit: f64) -> Option<Piece> {
        let semi_axes = self.0.map(|axis| axis * unit);
        Some(Piece::ellipsoid(semi_axes, axes, centre * unit))
    }
}
