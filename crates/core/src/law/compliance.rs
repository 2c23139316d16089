//! The change of the contact velocity by an impulse at the point of contact, for bodies of any shape.

use super::Compliant;
use crate::Error;
use crate::math::{Symmetric, Vector, Vectors};
use crate::simd::{Pack, one};
use pulp::Scalar;
use std::ops::Add;

/// The matrix K that turns an impulse **P** at the point of contact into the change of the contact velocity, Δ**v**_c = K**P** (10), in
/// the frame whose z axis is the normal of the contact.
///
/// Of two bodies, with **v**_c the velocity of the first relative to the second, it is the sum of theirs; a plane at rest, the body of
/// infinite mass, adds nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance(pub(super) Symmetric);

impl Compliance {
    /// The compliance with these entries.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless the matrix is finite and positive definite.
    pub fn new(entries: Symmetric) -> Result<Self, Error> {
        let [first, second, third] = Factors::new(&entries).pivots;
        let size = entries.xx + entries.yy + entries.zz;
        let holds = first > 0.0 && second > 0.0 && third > 0.0 && size < f64::INFINITY;
        let (least, allowed) = (first.min(second).min(third), "finite and positive definite");
        Error::unless(holds, "compliance", least, allowed)?;
        Ok(Self(entries))
    }

    /// I/m + \[**r**\]ᵀJ⁻¹\[**r**\]: that of a body with mass m and the inverse tensor of inertia J⁻¹, hit at **r** from its centre of mass.
    #[inline(always)]
    pub fn of_body(mass: f64, inverse_inertia: &Symmetric, arm: Vector) -> Self {
        // Column i of [r] is r × e_i.
        let x = Vector::new(0.0, arm.z, -arm.y);
        let y = Vector::new(-arm.z, 0.0, arm.x);
        let z = Vector::new(arm.y, -arm.x, 0.0);
        let [jx, jy, jz] = [
            *inverse_inertia * x,
            *inverse_inertia * y,
            *inverse_inertia * z,
        ];
        let dot = |a: Vector, b: Vector| a.x * b.x + a.y * b.y + a.z * b.z;
        let free = 1.0 / mass;
        Self(Symmetric {
            xx: free + dot(x, jx),
            yy: free + dot(y, jy),
            zz: free + dot(z, jz),
            xy: dot(x, jy),
            xz: dot(x, jz),
            yz: dot(y, jz),
        })
    }

    /// Its entries.
    #[inline(always)]
    pub fn entries(&self) -> &Symmetric {
        &self.0
    }

    /// K_nn: the change of the normal velocity by a unit impulse along the normal.
    #[inline(always)]
    pub fn normal(&self) -> f64 {
        self.0.zz
    }

    /// K**P**: the change of the contact velocity by an impulse.
    #[inline(always)]
    pub fn change(&self, impulse: Vector) -> Vector {
        self.0 * impulse
    }

    /// K⁻¹Δ**v**_c: the impulse that changes the contact velocity by this much.
    #[inline(always)]
    pub fn impulse(&self, change: Vector) -> Vector {
        Factors::new(&self.0).solve(change)
    }
}

/// For one contact: **n**, **u** and **w** are its axes z, x and y.
impl Compliant<Scalar> for Compliance {
    #[inline(always)]
    fn nn(&self) -> Pack<Scalar> {
        one(self.normal())
    }

    #[inline(always)]
    fn pushed(&self, normal: Pack<Scalar>, velocity: &Vectors<Scalar>) -> [Pack<Scalar>; 2] {
        let k = self.entries();
        [
            normal.mul_add(k.xz, velocity.x),
            normal.mul_add(k.yz, velocity.y),
        ]
    }

    #[inline(always)]
    fn impulse<const SPACE: bool>(&self, change: Vectors<Scalar>) -> Vectors<Scalar> {
        self.impulse(change.lane(0)).in_lane()
    }
}

impl Add for Compliance {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

/// K = LDLᵀ with a unit lower triangular L; stable without an exchange of rows, because K is positive definite.
struct Factors {
    pivots: [f64; 3],
    yx: f64,
    zx: f64,
    zy: f64,
}

impl Factors {
    #[inline(always)]
    fn new(k: &Symmetric) -> Self {
        let yx = k.xy / k.xx;
        let zx = k.xz / k.xx;
        let second = k.yy - yx * k.xy;
        let cross = k.yz - yx * k.xz;
        let zy = cross / second;
        Self {
            pivots: [k.xx, second, k.zz - zx * k.xz - zy * cross],
            yx,
            zx,
            zy,
        }
    }

    #[inline(always)]
    fn solve(&self, v: Vector) -> Vector {
        let y = v.y - self.yx * v.x;
        let z = v.z - self.zx * v.x - self.zy * y;
        let z = z / self.pivots[2];
        let y = y / self.pivots[1] - self.zy * z;
        Vector::new(v.x / self.pivots[0] - self.yx * y - self.zx * z, y, z)
    }
}
