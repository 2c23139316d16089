//! Vectors in the frame whose z axis is the plane normal **n**.
//!
//! Products are summed with fused multiply-adds in a fixed order, so that results are reproducible, and components that are
//! exactly 0, as in a motion in the x–z plane, remain exactly 0.

use crate::simd::{Operand, Pack, lanewise};
use pulp::{Scalar, Simd};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A component of a vector, or a part of a quaternion: a number, or one in each lane.
pub trait Part:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Fused<Self>
{
    /// The square root.
    fn root(self) -> Self;
}

/// A component, and what it can be multiplied by.
pub trait Fused<F> {
    /// `self * factor + addend`, rounded once.
    fn fused(self, factor: F, addend: Self) -> Self;
}

impl Part for f64 {
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
}

impl Fused<f64> for f64 {
    #[inline(always)]
    fn fused(self, factor: f64, addend: f64) -> f64 {
        self.mul_add(factor, addend)
    }
}

impl<S: Simd, const K: usize> Part for Pack<S, K> {
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
}

impl<S: Simd, const K: usize, F: Operand<S, K>> Fused<F> for Pack<S, K> {
    #[inline(always)]
    fn fused(self, factor: F, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }
}

/// A vector (x, y, z), or one in each lane; z is along the plane normal.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vector<T = f64> {
    /// Component along the plane, down the slope if it is inclined.
    pub x: T,
    /// Component along the plane, perpendicular to x.
    pub y: T,
    /// Component along the plane normal.
    pub z: T,
}

/// A vector in each lane.
pub(crate) type Vectors<S, const K: usize = 1> = Vector<Pack<S, K>>;

impl<T: Copy> Vector<T> {
    /// The vector (x, y, z).
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }

    /// The components.
    #[inline(always)]
    pub const fn parts(self) -> [T; 3] {
        [self.x, self.y, self.z]
    }

    /// The same function of every component.
    #[inline(always)]
    pub(crate) fn map<U>(self, f: impl Fn(T) -> U) -> Vector<U> {
        Vector {
            x: f(self.x),
            y: f(self.y),
            z: f(self.z),
        }
    }
}

impl<T> From<[T; 3]> for Vector<T> {
    #[inline(always)]
    fn from([x, y, z]: [T; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<T: Part> Vector<T> {
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> T {
        self.x.fused(b.x, self.y.fused(b.y, self.z * b.z))
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y.fused(b.z, -(self.z * b.y)),
            y: self.z.fused(b.x, -(self.x * b.z)),
            z: self.x.fused(b.y, -(self.y * b.x)),
        }
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> T {
        self.dot(self).root()
    }

    /// Length of the component along the plane.
    #[inline(always)]
    pub fn horizontal(self) -> T {
        self.x.fused(self.x, self.y * self.y).root()
    }

    /// `self * factor + addend`, each component rounded once.
    #[inline(always)]
    pub fn mul_add<F: Copy>(self, factor: F, addend: Self) -> Self
    where
        T: Fused<F>,
    {
        Self {
            x: self.x.fused(factor, addend.x),
            y: self.y.fused(factor, addend.y),
            z: self.z.fused(factor, addend.z),
        }
    }
}

impl<T: Part> Add for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<T: Part> Sub for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<T: Part + Mul<F, Output = T>, F: Copy> Mul<F> for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<T: Part> Div<T> for Vector<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: T) -> Self {
        Self::new(self.x / divisor, self.y / divisor, self.z / divisor)
    }
}

impl Vector {
    /// A unit vector across this one, whose own length is 1.
    #[inline(always)]
    pub fn across(self) -> Self {
        self.in_lane().across().lane(0)
    }

    /// The only lane of a vector in each.
    #[inline(always)]
    pub(crate) fn in_lane(self) -> Vectors<Scalar> {
        Vectors::splat(Scalar::new(), self)
    }
}

lanewise! { Vectors<S> { x, y, z } }

impl<S: Simd, const K: usize> Vectors<S, K> {
    /// The same vector in every lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, vector: Vector) -> Self {
        Self {
            x: Pack::splat(simd, vector.x),
            y: Pack::splat(simd, vector.y),
            z: Pack::splat(simd, vector.z),
        }
    }

    /// A unit vector across this one, whose own length is 1.
    #[inline(always)]
    pub(crate) fn across(self) -> Self {
        let simd = self.x.simd();
        let first = self.x.abs().lt(0.6);
        let across = self.cross(Self {
            x: first.select(Pack::splat(simd, 1.0), 0.0),
            y: first.select(Pack::splat(simd, 0.0), 1.0),
            z: Pack::splat(simd, 0.0),
        });
        across / across.norm()
    }

    /// The vector in a lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Vector {
        self.map(|part| part.as_slice()[lane])
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, vector: Vector) {
        self.x.as_mut_slice()[lane] = vector.x;
        self.y.as_mut_slice()[lane] = vector.y;
        self.z.as_mut_slice()[lane] = vector.z;
    }
}
