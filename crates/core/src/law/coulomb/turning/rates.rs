//! The rates at which a slip changes.

use super::Slipping;
use crate::simd::Pack;
use pulp::Simd;

/// K in the plane of **n** and the direction **u** along which the slip is positive, times μ where friction is.
#[derive(Clone, Copy)]
pub(super) struct Rates<S: Simd, const K: usize> {
    pub friction: f64,
    pub nn: Pack<S, K>,
    pub nu: Pack<S, K>,
    pub uu: Pack<S, K>,
    pub ww: Pack<S, K>,
    /// K_nn − K_nu²/K_uu.
    pub sticking: Pack<S, K>,
    /// μK_ww.
    pub brake: Pack<S, K>,
    /// ρ₊, ρ₋, λ, κ.
    pub plus: Pack<S, K>,
    pub minus: Pack<S, K>,
    pub decay: Pack<S, K>,
    pub kappa: Pack<S, K>,
}

impl<S: Simd, const K: usize> Rates<S, K> {
    #[inline(always)]
    pub fn new(contact: &Slipping<S, K>, friction: f64) -> Self {
        let Slipping { nn, nu, uu, ww, .. } = *contact;
        let square = nu * nu;
        let lost = nu.mul_add(nu, -square);
        let determinant = nn.mul_add(uu, -square) - lost;
        let mut rates = Self {
            friction,
            nn,
            nu,
            uu,
            ww,
            sticking: determinant / uu,
            brake: ww * friction,
            plus: nu,
            minus: nu,
            decay: nu,
            kappa: nu,
        };
        rates.turn(nu);
        rates
    }

    /// Takes **u** so that this is K_nu.
    #[inline(always)]
    pub fn turn(&mut self, nu: Pack<S, K>) {
        let (a, b) = (self.uu * self.friction, self.brake);
        self.nu = nu;
        self.plus = nu + (b - a);
        self.minus = nu - (b - a);
        self.decay = a - nu;
        self.kappa = b - self.minus;
    }

    /// Sum of the rates at which direction and size of the slip change in θ.
    #[inline(always)]
    pub fn pace(&self, y: Pack<S, K>) -> Pack<S, K> {
        let turning = self.minus.abs().mul_add(y, self.plus.abs());
        let growing = self.kappa.abs().mul_add(y, self.decay.abs());
        turning.mul_add(2.0, growing + 1e-30)
    }

    /// Δv_c^n after ∫A dθ, ∫Ay dθ and ∫Ay² dθ.
    #[inline(always)]
    pub fn velocity(&self, [x, y, z]: [Pack<S, K>; 3]) -> Pack<S, K> {
        let jam = self.nu * self.friction;
        let twice = 2.0 * self.nn;
        x.mul_add(self.nn - jam, y.mul_add(twice, z * (self.nn + jam)))
    }

    /// dv_c^n/dp times 1 + y.
    #[inline(always)]
    pub fn slope(&self, y: Pack<S, K>) -> Pack<S, K> {
        let jam = self.nu * self.friction;
        (self.nn + jam).mul_add(y, self.nn - jam)
    }
}
