//! Contacts as a law sees them, and the impulses that it returns, in all lanes. A law depends on the contact velocity and the
//! matrix K (see [`super`]), and not on the body otherwise.

use super::coulomb::turning::Slipping;
use crate::simd::Pack;
use pulp::Simd;

/// A contact in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Contacts<S: Simd, const K: usize> {
    /// Velocity **v**_c of the point of contact (7), (8); `slip_normal` ≤ 0.
    pub slip_normal: Pack<S, K>,
    pub slip_along: Pack<S, K>,
    /// 0 in planar motion.
    pub slip_across: Pack<S, K>,
    /// J_xx.
    pub(super) inertia: f64,
    /// **r**_c along **n** and **u**.
    pub(super) arm_normal: Pack<S, K>,
    pub(super) arm_along: Pack<S, K>,
    /// K_ww; not used in planar motion.
    pub(super) across: Pack<S, K>,
}

/// The outcome of a law in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Responses<S: Simd, const K: usize> {
    /// Components of the impulse **P** on the particle along **n**, **u** and **w** (10).
    pub normal: Pack<S, K>,
    pub along: Pack<S, K>,
    /// 0 in planar motion.
    pub across: Pack<S, K>,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: Pack<S, K>,
}

/// Responses of which some take long, and are not known yet.
#[derive(Clone, Copy)]
pub(crate) struct Late<S: Simd> {
    pub response: Responses<S, 1>,
    /// 1 in the lanes in which it is not known, else 0.
    pub open: Pack<S, 1>,
    pub(super) slipping: Slipping<S, 1>,
}

impl<S: Simd> Late<S> {
    /// Responses of no contact.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            response: Responses {
                normal: zero,
                along: zero,
                across: zero,
                separation_speed: zero,
            },
            open: zero,
            slipping: Slipping::none(simd),
        }
    }

    /// −v_c^n of the contacts.
    #[inline(always)]
    pub fn approach(&self) -> Pack<S, 1> {
        self.slipping.speed
    }
}

impl<S: Simd, const K: usize> Contacts<S, K> {
    /// A contact whose velocity is in the vertical plane of the axis. `inertia` is J_xx, `arm` is **r**_c along **n** and **u**.
    #[inline(always)]
    pub fn in_plane(slip: [Pack<S, K>; 2], inertia: f64, arm: [Pack<S, K>; 2]) -> Self {
        let zero = Pack::splat(slip[0].simd(), 0.0);
        Self::in_space([slip[0], slip[1], zero], inertia, arm, zero)
    }

    /// A contact whose velocity has any direction, with `across` = K_ww.
    #[inline(always)]
    pub fn in_space(
        [slip_normal, slip_along, slip_across]: [Pack<S, K>; 3],
        inertia: f64,
        [arm_normal, arm_along]: [Pack<S, K>; 2],
        across: Pack<S, K>,
    ) -> Self {
        Self {
            slip_normal,
            slip_along,
            slip_across,
            inertia,
            arm_normal,
            arm_along,
            across,
        }
    }

    /// Vector k of them.
    #[inline(always)]
    pub fn part(&self, k: usize) -> Contacts<S, 1> {
        Contacts {
            slip_normal: self.slip_normal.part(k),
            slip_along: self.slip_along.part(k),
            slip_across: self.slip_across.part(k),
            inertia: self.inertia,
            arm_normal: self.arm_normal.part(k),
            arm_along: self.arm_along.part(k),
            across: self.across.part(k),
        }
    }

    /// The speed of approach, −v_c^n ≥ 0.
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

    /// K_ww.
    #[inline(always)]
    pub fn across_response(&self) -> Pack<S, K> {
        self.across
    }

    /// K_nn − K_nu²/K_uu: change of the normal contact velocity per normal impulse while the contact sticks.
    #[inline(always)]
    pub fn sticking_response(&self) -> Pack<S, K> {
        let nn = self.arm_normal.mul_add(self.arm_normal, self.inertia);
        self.arm_along.mul_add(self.arm_along, nn) / nn
    }
}
