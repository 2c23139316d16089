//! A contact that slips in the vertical plane of the axis only, in each lane.

use crate::lanes::Pack;
use pulp::Simd;

/// What a law needs to know of a contact in the plane of **n** and **u**.
#[derive(Clone, Copy)]
pub(crate) struct Plane<S: Simd, const K: usize> {
    /// Velocity **v**_c of the point of contact (7), (8); `slip_normal` ≤ 0.
    pub slip_normal: Pack<S, K>,
    pub slip_along: Pack<S, K>,
    /// J_xx.
    pub inertia: f64,
    /// **r**_c along **n** and **u**.
    pub arm_normal: Pack<S, K>,
    pub arm_along: Pack<S, K>,
}

/// What a law answers.
#[derive(Clone, Copy)]
pub(crate) struct Rebound<S: Simd, const K: usize> {
    /// Impulse P on the particle.
    pub normal: Pack<S, K>,
    pub along: Pack<S, K>,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: Pack<S, K>,
}

impl<S: Simd, const K: usize> Plane<S, K> {
    /// −v_c^n ≥ 0.
    #[inline(always)]
    pub fn approach_speed(&self) -> Pack<S, K> {
        self.slip_normal.abs()
    }

    /// The impulse along **n** and **u** that changes the contact velocity by this much: K P = Δ**v**_c (10), solved as in
    /// (14).
    #[inline(always)]
    pub fn impulse(&self, normal: Pack<S, K>, along: Pack<S, K>) -> (Pack<S, K>, Pack<S, K>) {
        let (n, u, j) = (self.arm_normal, self.arm_along, self.inertia);
        let nn = n.mul_add(n, j);
        let inverse = 1.0 / u.mul_add(u, nn); // 1/(J_xx/m + r_c²)
        let cross = n * u;
        (
            nn.mul_add(normal, cross * along) * inverse, // (14)
            u.mul_add(u, j).mul_add(along, cross * normal) * inverse, // (14)
        )
    }

    /// K_nn.
    #[inline(always)]
    pub fn normal_response(&self) -> Pack<S, K> {
        (self.arm_along * self.arm_along).mul_add(1.0 / self.inertia, 1.0)
    }

    /// K_uu.
    #[inline(always)]
    pub fn along_response(&self) -> Pack<S, K> {
        (self.arm_normal * self.arm_normal).mul_add(1.0 / self.inertia, 1.0)
    }

    /// K_nu.
    #[inline(always)]
    pub fn coupling(&self) -> Pack<S, K> {
        -(self.arm_normal * self.arm_along) * (1.0 / self.inertia)
    }

    /// K_nn − K_nu²/K_uu, what a normal impulse changes where the contact sticks.
    #[inline(always)]
    pub fn sticking_response(&self) -> Pack<S, K> {
        let nn = self.arm_normal.mul_add(self.arm_normal, self.inertia);
        self.arm_along.mul_add(self.arm_along, nn) / nn
    }
}
