//! The compliance of a body of revolution that touches a plane.

use super::Compliant;
use crate::math::{Vector, Vectors};
use crate::simd::{Pack, one};
use pulp::Simd;

/// The matrix K = I/m + \[**r**_c\]ᵀĴ⁻¹\[**r**_c\], which turns an impulse into the change of contact velocity (10), in units of 1/m:
/// a block for **n** and **u** and an entry for **w**. It is stored as what it follows from, so that a law solves it as in (14).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxialCompliance<T = f64> {
    /// Moment of inertia J_xx across the symmetry axis.
    pub inertia: f64,
    /// **r**_c along **n**.
    pub arm_normal: T,
    /// **r**_c along **u**.
    pub arm_along: T,
    /// K_ww; not used in planar motion.
    pub ww: T,
}

impl AxialCompliance {
    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10).
    pub fn impulse(&self, change: Vector) -> Vector {
        self.map(one).impulse::<true>(change.in_lane()).lane(0)
    }

    /// The change of the contact velocity by an impulse, K P (10).
    pub fn change(&self, impulse: Vector) -> Vector {
        let (n, u, j) = (self.arm_normal, self.arm_along, self.inertia);
        let torque = n.mul_add(impulse.x, -(u * impulse.z)) / j;
        Vector {
            x: n.mul_add(torque, impulse.x),
            y: self.ww * impulse.y,
            z: u.mul_add(-torque, impulse.z),
        }
    }
}

impl<T: Copy> AxialCompliance<T> {
    /// The same function of every number but the moment of inertia, which all lanes share.
    #[inline(always)]
    pub(super) fn map<U>(&self, f: impl Fn(T) -> U) -> AxialCompliance<U> {
        AxialCompliance {
            inertia: self.inertia,
            arm_normal: f(self.arm_normal),
            arm_along: f(self.arm_along),
            ww: f(self.ww),
        }
    }
}

impl<S: Simd> Compliant<S> for AxialCompliance<Pack<S>> {
    #[inline(always)]
    fn nn(&self) -> Pack<S> {
        (self.arm_along * self.arm_along).mul_add(1.0 / self.inertia, 1.0)
    }

    #[inline(always)]
    fn pushed(&self, normal: Pack<S>, velocity: &Vectors<S>) -> [Pack<S>; 2] {
        [self.nu().mul_add(normal, velocity.x), velocity.y]
    }

    /// Solved as in (14).
    #[inline(always)]
    fn impulse<const SPACE: bool>(&self, change: Vectors<S>) -> Vectors<S> {
        let (n, u, j) = (self.arm_normal, self.arm_along, self.inertia);
        let nn = n.mul_add(n, j);
        let inverse = 1.0 / u.mul_add(u, nn); // 1/(J_xx/m + r_c²)
        let cross = n * u;
        Vector {
            x: u.mul_add(u, j).mul_add(change.x, cross * change.z) * inverse, // (14)
            y: if SPACE {
                change.y / self.ww
            } else {
                Pack::splat(n.simd(), 0.0)
            },
            z: nn.mul_add(change.z, cross * change.x) * inverse, // (14)
        }
    }
}

impl<S: Simd> AxialCompliance<Pack<S>> {
    /// K_uu.
    #[inline(always)]
    pub fn uu(&self) -> Pack<S> {
        (self.arm_normal * self.arm_normal).mul_add(1.0 / self.inertia, 1.0)
    }

    /// K_nu.
    #[inline(always)]
    pub fn nu(&self) -> Pack<S> {
        -(self.arm_normal * self.arm_along) * (1.0 / self.inertia)
    }

    /// K_nn − K_nu²/K_uu: change of the normal contact velocity per normal impulse while the contact sticks.
    #[inline(always)]
    pub fn sticking(&self) -> Pack<S> {
        let nn = self.arm_normal.mul_add(self.arm_normal, self.inertia);
        self.arm_along.mul_add(self.arm_along, nn) / nn
    }
}
