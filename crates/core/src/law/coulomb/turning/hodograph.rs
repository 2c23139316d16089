//! The direction and size of a slip that turns, in closed form, and how far they are resolved by the nodes of a panel.
//!
//! The direction has fixed points: y* = 0 and y* = −ρ₊/ρ₋, if that is positive. About the nearer one, with D = y − y*, σ = ρ₊ or −ρ₊
//! and λ* = λ + κy*,
//!
//! dD/dθ = −2D(σ + ρ₋D), d ln A/dθ = −λ* − κD,
//!
//! and with ζ = D₀(1 − exp(−2σθ))/σ: D₀ − D = (σ + ρ₋D₀)ζ/(1 + ρ₋ζ), ∫D dθ = ln(1 + ρ₋ζ)/2ρ₋. About the other one ζ would grow
//! exponentially where D vanishes.
//!
//! A and y are analytic but for the poles of y, where 1 + ρ₋ζ = 0. Gauss's quadrature of n nodes is off by the order of r⁻²ⁿ of the
//! functions, where the ellipse whose foci are the ends of the panel and that goes through the nearest pole has the axes (r ± 1/r)/2
//! in half lengths of the panel. The distances of the pole from both ends together are then (r + 1/r)/2 times its length.

use super::panel::BRAKE;
use super::{Course, Rates};
use crate::simd::Pack;
use crate::simd::elementary::{exp_m1_in_lanes, polynomial};
use pulp::Simd;
use std::f64::consts::PI;

/// Least sum of the distances of a pole from the ends of a panel, over its length: r = 2.85, and twenty nodes are off by 10⁻¹⁸.
const ASIDE: f64 = 1.6;
/// Most by which ln A changes on a panel, of it six times what the direction contributes: twenty nodes integrate an exponential
/// function that falls by e⁻²⁸, A², to rounding. Twice as much where the slip is so small that half the digits count.
const DECAY: f64 = 14.0;
const SHARPER: f64 = 6.0;
const FADED: f64 = 1.0 / 524_288.0; // 2⁻¹⁹
/// Most by which ln |D| changes by itself, where D is tiny, small, and where it is not.
const LONG_TURN: f64 = 30.0;
const TURN: f64 = 14.0;
const SHARP_TURN: f64 = 8.0;
/// Up to there |D| is small, and tiny; below the last it does not count beside 1.
const SMALL: f64 = 1.0 / 16.0;
const TINY: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰
const NOTHING: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Most by which y grows on a panel, for beyond 1 it is looked at from the other side.
const GROWN: f64 = 8.0;
/// |σ| below which the direction does not turn by it, and |ρ₋D| below which it has no poles.
const STEADY: f64 = 1e-200;
/// Largest ratio of which a logarithm is bounded.
const FAR: f64 = 1e30;

/// Largest |s| in the series of artanh.
const STEEP: f64 = 0.45;
/// artanh(s)/s as a polynomial in s², |s| ≤ 0.45; error 10⁻¹⁷ (`tests/turning/tables.py`).
const ARTANH: [f64; 13] = [
    1.0,
    0.3333333333333263,
    0.20000000000191967,
    0.14285714265083493,
    0.1111111226052913,
    0.0909087109137827,
    0.07693110878969374,
    0.0665535339972996,
    0.05990548274556982,
    0.045616124173821285,
    0.07768094615369141,
    -0.036188137220939005,
    0.15022352089177232,
];

/// The hodograph from a point on.
pub(super) struct Hodograph<S: Simd, const K: usize> {
    /// y, y* and D.
    y: Pack<S, K>,
    pub limit: Pack<S, K>,
    distance: Pack<S, K>,
    sigma: Pack<S, K>,
    minus: Pack<S, K>,
    /// λ + κy* and κ.
    decay: Pack<S, K>,
    kappa: Pack<S, K>,
    /// −D/σ and σ + ρ₋D.
    scale: Pack<S, K>,
    gamma: Pack<S, K>,
}

/// A point of it.
pub(super) struct Point<S: Simd, const K: usize> {
    /// What y has lost.
    pub lost: Pack<S, K>,
    /// ∫D dθ, and ln A less its first value.
    pub turn: Pack<S, K>,
    pub growth: Pack<S, K>,
}

impl<S: Simd, const K: usize> Hodograph<S, K> {
    #[inline(always)]
    pub fn new(rates: &Rates<S, K>, y: Pack<S, K>) -> Self {
        let (plus, minus) = (rates.plus, rates.minus);
        let bend = minus * y;
        let gamma = minus.mul_add(y, plus);
        let oblique = gamma.abs().lt(bend.abs());
        let limit = oblique.select(-plus / minus, 0.0);
        let distance = oblique.select(gamma / minus, y);
        let sigma = oblique.select(-plus, plus);
        let gone = distance.abs().le(NOTHING) & Pack::splat(y.simd(), 0.0).le(sigma);
        let straight = gone | sigma.abs().le(STEADY);
        let sigma = straight.select(STEADY, sigma);
        let distance = gone.select(0.0, distance);
        Self {
            y,
            limit,
            distance,
            sigma,
            minus,
            decay: rates.kappa.mul_add(limit, rates.decay),
            kappa: rates.kappa,
            scale: -distance / sigma,
            gamma: oblique.select(bend, gamma),
        }
    }

    /// With ζ = D₀(1 − exp(−2σθ))/σ: D₀ − D = (σ + ρ₋D₀)ζ/(1 + ρ₋ζ) and ∫D dθ = ln(1 + ρ₋ζ)/2ρ₋.
    #[inline(always)]
    pub fn at(&self, theta: Pack<S, K>) -> Point<S, K> {
        let zeta = exp_m1_in_lanes(-2.0 * self.sigma * theta) * self.scale;
        let q = self.minus * zeta;
        let (m, n) = (q + 1.0, q + 2.0);
        // One division for both; ln(1 + q) = 2 artanh(q/(2 + q)).
        let inverse = zeta / (m * n);
        let half = m * inverse;
        let s = self.minus * half;
        let turn = half * polynomial(ARTANH, s * s);
        Point {
            lost: self.gamma * n * inverse,
            turn,
            growth: -self.decay.mul_add(theta, self.kappa * turn),
        }
    }

    /// How far it is, in θ, until ρ₋ζ is too large for the series of artanh, or y has grown too much: infinitely far if it never does.
    #[inline(always)]
    fn steep(&self) -> Pack<S, K> {
        let bend = self.minus * self.distance;
        let (most, least) = (2.0 * STEEP / (1.0 - STEEP), -2.0 * STEEP / (1.0 + STEEP));
        let steep = bend * bend.lt(0.0).select(1.0 / least, 1.0 / most);
        let grown = self.sigma * self.distance * (-1.0 / GROWN);
        let one = Pack::splat(bend.simd(), 1.0);
        reach(self.sigma, one, one / steep.max(grown))
    }

    /// How far it may be followed, in θ: where 1/y vanishes next to the path the functions have poles.
    #[inline(always)]
    fn resolved(&self) -> Pack<S, K> {
        // 1 + ρ₋ζ = 0 where exp(−2σθ) = E = 1 + σ/ρ₋D; |ln E| ≥ 16|q − 1|/(q + 1) with q⁸ = |E|.
        let bend = self.minus * self.distance;
        let ratio = self.gamma / bend;
        let q = ratio.abs().min(FAR).sqrt().sqrt().sqrt();
        let sum = (q + 1.0) * (q + 1.0);
        let square = q * q;
        // On the path, ahead of or behind its start, or beside it by π/2|σ|.
        let on = 8.0 / (sum * (square + 1.0) * square.mul_add(square, 1.0));
        let on = -on / bend;
        let beside = (q - 1.0) * (-8.0 / (q + 1.0)) / self.sigma;
        let away = (0.5 * PI) / self.sigma;
        let aside = ratio.lt(0.0);
        let real = aside.select(beside, on);
        let distance = aside.select(beside.mul_add(beside, away * away).sqrt(), on.abs());
        // |θ − θ_p| summed over both ends is ASIDE times the length.
        let length = distance.mul_add(ASIDE, -real) * (2.0 / (ASIDE * ASIDE - 1.0));
        bend.abs().le(STEADY).select(f64::INFINITY, length)
    }

    /// The longest panel on which the functions are resolved.
    #[inline(always)]
    pub fn longest(&self, rates: &Rates<S, K>, at: &Course<S, K>) -> Pack<S, K> {
        let y = self.y;
        let size = self.distance.abs();
        let still = size.eq(0.0);
        let singular = self.resolved().min(self.steep());
        let singular = still.select(f64::INFINITY, singular);
        let turn = size.lt(SMALL).select(2.0 / TURN, 2.0 / SHARP_TURN);
        let turn = size.lt(TINY).select(2.0 / LONG_TURN, turn);
        let turning = still.select(0.0, self.sigma.abs() * turn);
        let braked = rates.brake.mul_add(y.max(1.0), rates.brake);
        let growing = (rates.kappa.abs() * size).mul_add(SHARPER, self.decay.abs());
        let growing = growing * at.slip.le(FADED).select(0.5 / DECAY, 1.0 / DECAY);
        let braked = y.lt(TINY).select(0.0, braked * (1.0 / BRAKE));
        singular.min(1.0 / turning.max(growing).max(braked))
    }
}

impl<S: Simd> Hodograph<S, 1> {
    /// For several points of it.
    #[inline(always)]
    pub fn repeat<const N: usize>(&self) -> Hodograph<S, N> {
        Hodograph {
            y: self.y.repeat(),
            limit: self.limit.repeat(),
            distance: self.distance.repeat(),
            sigma: self.sigma.repeat(),
            minus: self.minus.repeat(),
            decay: self.decay.repeat(),
            kappa: self.kappa.repeat(),
            scale: self.scale.repeat(),
            gamma: self.gamma.repeat(),
        }
    }
}

/// Least way, in θ, on which ζ becomes so large: infinite if it never does.
#[inline(always)]
pub(super) fn reach<S: Simd, const K: usize>(
    sigma: Pack<S, K>,
    distance: Pack<S, K>,
    zeta: Pack<S, K>,
) -> Pack<S, K> {
    // −ln(1 − t)/2σ with t = σζ/D; −ln(1 − t) ≥ 8(1 − q)/(1 + q) with q⁴ = 1 − t.
    let fourth = 1.0 - sigma * zeta / distance;
    let q = fourth.max(0.0).sqrt().sqrt();
    let least = 4.0 * zeta / ((q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0) * distance);
    Pack::splat(sigma.simd(), 0.0)
        .lt(fourth)
        .select(least, f64::INFINITY)
}

#[cfg(test)]
mod tests;
