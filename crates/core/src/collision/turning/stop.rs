//! Where the slip vanishes: the impulse until then as a power series about the direction in which it does.
//!
//! The direction tends to y* = 0 where ρ₊ > 0, else to y* = −ρ₊/ρ₋. The impulse that is left is p = A H(y), and
//! Q = ∫ u dp = A² G(y), which gives the work. From the equations of the slip, with D = y − y*, σ = |ρ₊|, λ* = λ + κy*,
//!
//! 2D(σ + ρ₋D)H′ + (λ* + κD)H = (1 + y)², 2D(σ + ρ₋D)G′ + 2(λ* + κD)G = (1 − y)(1 + y)².
//!
//! In χ = D/(σ + ρ₋D) the singularities of H/(1 + ρ₋D/σ) and G/(1 + ρ₋D/σ)² are at 1/ρ₋, that is at the other fixed direction, and ∞, and
//! their coefficients follow from one another, c_k = (n_k + (β₀ + β₁k) c_{k−1})/(e₀ + 2σk), n_k = 0 for k > 3.

use super::{Course, Goal, Rates};
use crate::collision::Hypothesis;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Largest |ρ₋χ| for which the series are used.
const REACH: f64 = 0.35;
/// Their terms: REACH to this power is below 2⁻⁵².
const TERMS: usize = 36;
/// Share by which a direction may turn until the slip vanishes and yet count as constant.
const STRAIGHT: f64 = 2.0 * f64::EPSILON;

/// The way of a slip that vanishes.
pub(super) struct Stop<S: Simd, const K: usize> {
    /// Whether the series converge fast enough.
    pub reached: Mask<S, K>,
    /// y*, D, χ, σ, λ* and 1/(1 − ρ₋χ).
    limit: Pack<S, K>,
    chi: Pack<S, K>,
    sigma: Pack<S, K>,
    decay: Pack<S, K>,
    stretch: Pack<S, K>,
}

impl<S: Simd, const K: usize> Stop<S, K> {
    #[inline(always)]
    pub fn new(rates: &Rates<S, K>, at: &Course<S, K>) -> Self {
        let y = at.y;
        let zero = Pack::splat(y.simd(), 0.0);
        let gamma = rates.minus.mul_add(y, rates.plus);
        // A direction that is left must be the right one from the start.
        let weight = zero.lt(gamma).select(y, 1.0);
        let straight = (gamma.abs() * weight).le(rates.kappa.mul_add(y, rates.decay) * STRAIGHT);
        let forward = zero.lt(rates.plus) & zero.lt(gamma);
        let aside = rates.plus.lt(0.0) & zero.le(rates.nu);
        let limit = straight.select(y, aside.select(-rates.plus / rates.minus, 0.0));
        let sigma = rates.plus.abs();
        let distance = straight.select(0.0, y - limit);
        let sum = rates.minus.mul_add(distance, sigma);
        let chi = straight.select(0.0, distance / sum);
        let decay = rates.kappa.mul_add(limit, rates.decay);
        // What a term of the series is over the one before lies between that of the third and ρ₋χ.
        let bend = rates.minus * (decay - sigma) - rates.brake * sigma;
        let converges = (chi * rates.minus).abs().le(REACH)
            & quick(rates.minus, bend, chi, sigma, decay, 1.0)
            & quick(rates.minus, bend, chi, sigma, decay, 2.0);
        let reached = zero.lt(decay) & (straight | (forward | aside) & converges);
        Self {
            reached,
            limit,
            chi,
            sigma,
            decay,
            stretch: straight.select(1.0, sum / sigma),
        }
    }

    /// Σ c_k χᵏ, for e₀ = `order` λ*.
    #[inline(always)]
    fn series(&self, rates: &Rates<S, K>, order: f64, start: [Pack<S, K>; 4]) -> Pack<S, K> {
        let chi = self.chi;
        let scale = 1.0 / self.sigma.mul_add((2 * TERMS) as f64, self.decay * order);
        let (constant, step) = (self.decay * order * scale, 2.0 * self.sigma * scale);
        // β₀ + β₁k, times χ.
        let slope = rates.minus * step * chi;
        let first = (rates.minus * (self.decay - self.sigma) - rates.brake * self.sigma)
            * (scale * order)
            * chi
            - slope;
        let mut below = Pack::splat(chi.simd(), 1.0);
        let mut above = below;
        for k in (4..TERMS).rev() {
            let e = step.mul_add(k as f64, constant);
            let b = slope.mul_add(k as f64, first);
            below = e * below;
            above = b.mul_add(above, below);
        }
        // r_k = above/below = 1 + b_k r_{k+1}/e_k, and the sum of n_i χⁱ r_{i+1}/e_i on one denominator.
        let mut sum = Pack::splat(chi.simd(), 0.0);
        for k in (0..4).rev() {
            let e = step.mul_add(k as f64, constant);
            let b = slope.mul_add(k as f64, first);
            // sum/below stands for the terms i > k, over χ^{k+1}.
            let term = start[k] * above;
            sum = (chi * e).mul_add(sum, term);
            below = e * below;
            above = b.mul_add(above, below);
        }
        sum * scale / below
    }

    /// Goes to where the slip vanishes, if nothing happens before: of which lanes that is true.
    #[inline(always)]
    pub fn pass(
        &self,
        rates: &Rates<S, K>,
        goal: &Goal<S, K>,
        at: &mut Course<S, K>,
    ) -> Mask<S, K> {
        let zero = Pack::splat(at.y.simd(), 0.0);
        if !(self.reached & !at.over).any() {
            return self.reached & zero.lt(zero);
        }
        let q = 1.0 + self.limit;
        let r = (-rates.minus).mul_add(q, self.sigma);
        // (1 + y)(1 − ρ₋χ) = q + rχ.
        let impulse =
            at.a * self.stretch * self.series(rates, 1.0, [q * q, 2.0 * q * r, r * r, zero]);
        let along = -impulse.mul_add(rates.nu, at.u) / rates.uu;
        let v = rates.nn.mul_add(impulse, rates.nu.mul_add(along, at.v));
        if goal.hypothesis == Hypothesis::Stronge {
            // (1 − y)(1 − ρ₋χ) = s − tχ.
            let s = 1.0 - self.limit;
            let t = rates.minus.mul_add(s, self.sigma);
            let start = [
                s * (q * q),
                (2.0 * s * r - t * q) * q,
                (s * r - 2.0 * t * q) * r,
                -t * (r * r),
            ];
            let side = at.a * self.stretch;
            let moment = side * side * self.series(rates, 2.0, start);
            let mean = (0.5 * rates.sticking).mul_add(impulse, at.v);
            let share = (-at.u).mul_add(impulse, moment) * rates.nu / rates.uu;
            at.work = at.work + mean.mul_add(impulse, share);
        }
        let (now, then) = (rates.slope(at.y), rates.slope(self.limit));
        let crest = zero.lt(now) & then.lt(0.0);
        let dip = now.lt(0.0) & zero.lt(then);
        at.normal = at.normal + impulse;
        at.along = at.along + along;
        at.across = at.across - at.w / rates.ww;
        at.v = v;
        let compressing = at.compressing & v.lt(0.0);
        let restoring = !at.compressing & zero.le(v) & zero.lt(goal.missing(at)) & !dip;
        self.reached & (compressing | restoring) & !crest
    }
}

/// Whether the third term is small beside the second.
#[inline(always)]
fn quick<S: Simd, const K: usize>(
    minus: Pack<S, K>,
    bend: Pack<S, K>,
    chi: Pack<S, K>,
    sigma: Pack<S, K>,
    decay: Pack<S, K>,
    order: f64,
) -> Mask<S, K> {
    let above = (4.0 * sigma).mul_add(minus, bend * order) * chi;
    above.abs().le(sigma.mul_add(6.0, decay * order) * REACH)
}
