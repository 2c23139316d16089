//! Vectors in the frame whose z axis is the plane normal **n**.
//!
//! Products are summed with fused multiply-adds in a fixed order, so that results are reproducible, and components that are
//! exactly 0, as in a motion in the x–z plane, remain exactly 0.

use crate::simd::{Mask, Operand, Pack};
use pulp::{Scalar, Simd};
use std::ops::{Add, Div, Mul, Sub};

/// A vector (x, y, z); z is along the plane normal.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vector {
    /// Component along the plane, down the slope if it is inclined.
    pub x: f64,
    /// Component along the plane, perpendicular to x.
    pub y: f64,
    /// Component along the plane normal.
    pub z: f64,
}

impl Vector {
    /// The vector (x, y, z).
    #[inline(always)]
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    /// The components.
    #[inline(always)]
    pub const fn parts(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> f64 {
        self.x.mul_add(b.x, self.y.mul_add(b.y, self.z * b.z))
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y.mul_add(b.z, -(self.z * b.y)),
            y: self.z.mul_add(b.x, -(self.x * b.z)),
            z: self.x.mul_add(b.y, -(self.y * b.x)),
        }
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// A unit vector across this one, whose own length is 1.
    #[inline(always)]
    pub fn across(self) -> Self {
        self.in_lane().across().lane(0)
    }

    /// The only lane of a vector in each.
    #[inline(always)]
    pub(crate) fn in_lane(self) -> Vectors<Scalar, 1> {
        Vectors::splat(Scalar::new(), self)
    }

    /// Length of the component along the plane.
    pub fn horizontal(self) -> f64 {
        self.x.mul_add(self.x, self.y * self.y).sqrt()
    }

    /// `self * factor + addend`, each component rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: f64, addend: Self) -> Self {
        Self {
            x: self.x.mul_add(factor, addend.x),
            y: self.y.mul_add(factor, addend.y),
            z: self.z.mul_add(factor, addend.z),
        }
    }
}

impl Add for Vector {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl Sub for Vector {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl Div<f64> for Vector {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: f64) -> Self {
        Self::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

/// A vector (x, y, z) in each lane; z is along the plane normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vectors<S: Simd, const K: usize> {
    pub x: Pack<S, K>,
    pub y: Pack<S, K>,
    pub z: Pack<S, K>,
}

impl<S: Simd, const K: usize> Vectors<S, K> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(simd: S, vector: Vector) -> Self {
        Self {
            x: Pack::splat(simd, vector.x),
            y: Pack::splat(simd, vector.y),
            z: Pack::splat(simd, vector.z),
        }
    }

    /// The components.
    #[inline(always)]
    pub const fn parts(self) -> [Pack<S, K>; 3] {
        [self.x, self.y, self.z]
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> Pack<S, K> {
        self.x.mul_add(b.x, self.y.mul_add(b.y, self.z * b.z))
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y.mul_add(b.z, -(self.z * b.y)),
            y: self.z.mul_add(b.x, -(self.x * b.z)),
            z: self.x.mul_add(b.y, -(self.y * b.x)),
        }
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> Pack<S, K> {
        self.dot(self).sqrt()
    }

    /// A unit vector across this one, whose own length is 1.
    #[inline(always)]
    pub fn across(self) -> Self {
        let simd = self.x.simd();
        let first = self.x.abs().lt(0.6);
        let across = self.cross(Self {
            x: first.select(Pack::splat(simd, 1.0), 0.0),
            y: first.select(Pack::splat(simd, 0.0), 1.0),
            z: Pack::splat(simd, 0.0),
        });
        across.over(across.norm())
    }

    /// `self * factor + addend`, each component rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: impl Operand<S, K>, addend: Self) -> Self {
        let factor = factor.in_lanes(self.x.simd());
        Self {
            x: self.x.mul_add(factor, addend.x),
            y: self.y.mul_add(factor, addend.y),
            z: self.z.mul_add(factor, addend.z),
        }
    }

    /// `self * factor`.
    #[inline(always)]
    pub fn times(self, factor: impl Operand<S, K>) -> Self {
        let factor = factor.in_lanes(self.x.simd());
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }

    /// `self / divisor`.
    #[inline(always)]
    pub fn over(self, divisor: Pack<S, K>) -> Self {
        Self {
            x: self.x / divisor,
            y: self.y / divisor,
            z: self.z / divisor,
        }
    }

    /// `self + b`.
    #[inline(always)]
    pub fn plus(self, b: Self) -> Self {
        Self {
            x: self.x + b.x,
            y: self.y + b.y,
            z: self.z + b.z,
        }
    }

    /// `self − b`.
    #[inline(always)]
    pub fn minus(self, b: Self) -> Self {
        Self {
            x: self.x - b.x,
            y: self.y - b.y,
            z: self.z - b.z,
        }
    }

    /// The same vectors, but those of `other` in the lanes of the mask.
    #[inline(always)]
    pub fn or(self, mask: Mask<S, K>, other: Self) -> Self {
        Self {
            x: mask.select(other.x, self.x),
            y: mask.select(other.y, self.y),
            z: mask.select(other.z, self.z),
        }
    }

    /// The vector in a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Vector {
        Vector {
            x: self.x.as_slice()[lane],
            y: self.y.as_slice()[lane],
            z: self.z.as_slice()[lane],
        }
    }

    #[inline(always)]
    pub fn put(&mut self, lane: usize, vector: Vector) {
        self.x.as_mut_slice()[lane] = vector.x;
        self.y.as_mut_slice()[lane] = vector.y;
        self.z.as_mut_slice()[lane] = vector.z;
    }
}
