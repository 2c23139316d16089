//! A part of the way of a slip that turns, by quadrature over its nodes.
//!
//! With ∫A dθ, ∫Ay dθ and ∫Ay² dθ everything is known: dp = A(1 + y)² dθ, |**s**|-weighted friction −μA(1 − y²) dθ along
//! **u**, dA = −A(λ + κy) dθ and dw = −μK_ww w(1 + y) dθ. With v_c^n as it follows from p and u, the work of the normal force is
//!
//! ∫v_c^n dp = v p + (K_nn − K_nu²/K_uu) p²/2 + (K_nu/K_uu) ∫(u − u₀) dp.

use super::nodes::NODES;
use super::{Course, Goal, Rates};
use crate::collision::Hypothesis;
use crate::simd::Pack;
use crate::simd::elementary::{exp_in_lanes, exp_m1_in_lanes, polynomial};
use pulp::Simd;

/// Most by which ln A changes on a panel, of it thrice what the direction contributes: twenty nodes integrate an exponential
/// function that falls by e⁻²⁸, A², to rounding. Twice as much where the slip is so small that half the digits count.
const DECAY: f64 = 14.0;
const SHARPER: f64 = 3.0;
const FADED: f64 = 1.0 / 524_288.0; // 2⁻¹⁹
/// Most by which ln w does.
const BRAKE: f64 = 32.0;
/// Most by which ln y changes by itself, where y is tiny, small, and where it is not: 1/y is singular at ±iπ/2ρ₊, too.
const LONG_TURN: f64 = 30.0;
const TURN: f64 = 14.0;
const SHARP_TURN: f64 = 4.0;
/// Up to there y is small, and tiny; below the last it does not count beside 1.
const SMALL: f64 = 1.0 / 16.0;
const TINY: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰
const NOTHING: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Most of |ρ₋ζ|, which is −1 where 1/y is singular; −ρ₊ζ, by which a small y grows, is 1 at most.
const BEND: f64 = 0.4;
/// ρ₊ below which the direction does not turn by it.
const STEADY: f64 = 1e-200;

/// Nodes side by side, for the chain of operations at one of them is long.
const WIDE: usize = 10;

/// artanh(s)/s as a polynomial in s², |s| ≤ 1/3; error 10⁻¹⁸.
const ARTANH: [f64; 11] = [
    1.0,
    0.333_333_333_333_330_75,
    0.200_000_000_000_928_74,
    0.142_857_142_727_270_57,
    0.111_111_120_403_738_37,
    0.090_908_704_162_524_02,
    0.076_933_070_211_520_04,
    0.066_501_870_163_373_12,
    0.060_550_843_640_346_09,
    0.041_622_532_559_304_1,
    0.085_220_817_813_906_99,
];

/// The hodograph from a point on.
struct Hodograph<S: Simd, const K: usize> {
    plus: Pack<S, K>,
    minus: Pack<S, K>,
    decay: Pack<S, K>,
    kappa: Pack<S, K>,
    /// −y/ρ₊ and ρ₊ + ρ₋y.
    scale: Pack<S, K>,
    gamma: Pack<S, K>,
}

/// A point of it.
struct Point<S: Simd, const K: usize> {
    /// What y has lost.
    lost: Pack<S, K>,
    /// ∫y dθ, and ln A less its first value.
    turn: Pack<S, K>,
    growth: Pack<S, K>,
}

impl<S: Simd, const K: usize> Hodograph<S, K> {
    #[inline(always)]
    fn new(rates: &Rates<S, K>, y: Pack<S, K>) -> Self {
        let straight = y.le(NOTHING) | rates.plus.abs().le(STEADY);
        let plus = straight.select(STEADY, rates.plus);
        let y = y.le(NOTHING).select(0.0, y);
        Self {
            plus: -2.0 * plus,
            minus: rates.minus,
            decay: rates.decay,
            kappa: rates.kappa,
            scale: -y / plus,
            gamma: rates.minus.mul_add(y, plus),
        }
    }

    /// With ζ = y₀(1 − exp(−2ρ₊θ))/ρ₊: y₀ − y = (ρ₊ + ρ₋y₀)ζ/(1 + ρ₋ζ) and ∫y dθ = ln(1 + ρ₋ζ)/2ρ₋.
    #[inline(always)]
    fn at(&self, theta: Pack<S, K>) -> Point<S, K> {
        let zeta = exp_m1_in_lanes(self.plus * theta) * self.scale;
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
}

impl<S: Simd> Hodograph<S, 1> {
    /// For several points of it.
    #[inline(always)]
    fn repeat<const N: usize>(&self) -> Hodograph<S, N> {
        Hodograph {
            plus: self.plus.repeat(),
            minus: self.minus.repeat(),
            decay: self.decay.repeat(),
            kappa: self.kappa.repeat(),
            scale: self.scale.repeat(),
            gamma: self.gamma.repeat(),
        }
    }
}

/// Sum over the vectors.
#[inline(always)]
fn sum<S: Simd>(terms: &Pack<S, WIDE>) -> Pack<S, 1> {
    let mut sum = terms.part(0);
    for k in 1..WIDE {
        sum = sum + terms.part(k);
    }
    sum
}

/// Least way, in θ, on which ζ becomes so large: infinite if it never does.
#[inline(always)]
pub(super) fn reach<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    y: Pack<S, K>,
    zeta: Pack<S, K>,
) -> Pack<S, K> {
    // −ln(1 − t)/2ρ₊ with t = ρ₊ζ/y; −ln(1 − t) ≥ 8(1 − q)/(1 + q) with q⁴ = 1 − t.
    let fourth = 1.0 - rates.plus * zeta / y;
    let q = fourth.max(0.0).sqrt().sqrt();
    let least = 4.0 * zeta / ((q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0) * y);
    Pack::splat(y.simd(), 0.0)
        .lt(fourth)
        .select(least, f64::INFINITY)
}

/// The longest panel on which the functions are resolved.
#[inline(always)]
pub(super) fn longest<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    at: &Course<S, K>,
) -> Pack<S, K> {
    let y = at.y;
    let plain = y.le(NOTHING);
    let bound = (rates.minus.abs() * (1.0 / BEND)).max(-rates.plus);
    let near = reach(rates, y, 1.0 / bound);
    let singular = plain.select(f64::INFINITY, near);
    let turn = y.lt(SMALL).select(2.0 / TURN, 2.0 / SHARP_TURN);
    let turn = y.lt(TINY).select(2.0 / LONG_TURN, turn);
    let turning = plain.select(0.0, rates.plus.abs() * turn);
    let braked = rates.brake.mul_add(y.max(1.0), rates.brake);
    let growing = (rates.kappa.abs() * y).mul_add(SHARPER, rates.decay.abs());
    let growing = growing * at.slip.le(FADED).select(0.5 / DECAY, 1.0 / DECAY);
    let braked = y.lt(TINY).select(0.0, braked * (1.0 / BRAKE));
    singular.min(1.0 / turning.max(growing).max(braked))
}

/// Goes on by θ = `length`.
#[inline(always)]
pub(super) fn pass<S: Simd>(
    rates: &Rates<S, 1>,
    goal: &Goal<S, 1>,
    at: &Course<S, 1>,
    length: Pack<S, 1>,
) -> Course<S, 1> {
    let path = Hodograph::new(rates, at.y);
    let end_turn = path.at(length).turn;
    let path = path.repeat::<WIDE>();
    let start = at.y.repeat::<WIDE>();
    let zero = Pack::<S, WIDE>::splat(at.y.simd(), 0.0);
    let [mut x, mut y, mut z, mut moment] = [zero; 4];
    for chunk in NODES.chunks_exact(WIDE) {
        let (mut theta, mut weight) = (zero, zero);
        for (k, &(node, share)) in chunk.iter().enumerate() {
            theta.set_part(k, &(length * node));
            weight.set_part(k, &Pack::<S, 1>::splat(length.simd(), share));
        }
        let point = path.at(theta);
        let change = exp_m1_in_lanes(point.growth);
        let tangent = start - point.lost;
        let first = change.mul_add(weight, weight);
        let second = first * tangent;
        let third = second * tangent;
        (x, y, z) = (x + first, y + second, z + third);
        if goal.hypothesis == Hypothesis::Stronge {
            let gained = (1.0 - tangent).mul_add(change, point.lost); // of u, over A
            moment = (2.0_f64 * second + (first + third)).mul_add(gained, moment);
        }
    }
    let [x, y, z, moment] = [sum(&x), sum(&y), sum(&z), sum(&moment)];
    let size = at.a * length;
    let moments = [x * size, y * size, z * size];
    let mut end = *at;
    arrive(rates, &mut end, moments, length, end_turn);
    end.v = at.v + rates.velocity(moments);
    let p = moments[0] + moments[2] + 2.0 * moments[1];
    let mean = (0.5 * rates.sticking).mul_add(p, at.v);
    end.work = at.work + mean.mul_add(p, moment * (at.a * size) * rates.nu / rates.uu);
    end
}

/// The slip and the impulse after ∫A dθ, ∫Ay dθ, ∫Ay² dθ, θ and ∫y dθ.
#[inline(always)]
pub(super) fn arrive<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    at: &mut Course<S, K>,
    [x, y, z]: [Pack<S, K>; 3],
    theta: Pack<S, K>,
    turn: Pack<S, K>,
) {
    let exponent = -rates.decay.mul_add(theta, rates.kappa * turn);
    let braked = (-(rates.brake * (theta + turn))).max(-BRAKE);
    let a = at.a * exp_in_lanes(exponent);
    let lost = at.w * exp_m1_in_lanes(braked); // Δw
    at.w = at.w * exp_in_lanes(braked);
    at.a = a;
    at.u = a - at.w * at.w / (4.0 * a);
    at.normal = at.normal + (x + z + 2.0 * y);
    at.along = at.along - (x - z) * rates.friction;
    at.across = at.across + lost / rates.ww;
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Case, value};
    use super::*;

    /// The longest panel of a slip of this size and with this y, times μ, where μK_uu and μK_ww are `a` and `b`.
    fn resolved(a: f64, b: f64, nu: f64, slip: f64, y: f64) -> f64 {
        let friction = 0.1;
        let case = Case {
            friction,
            nn: 1.0,
            nu: nu * friction,
            uu: a,
            ww: b,
            direction: 2.0 * y.sqrt().atan(),
        };
        let impacts = case.impacts(slip, 1.0 - slip, Hypothesis::Newton);
        friction * value(longest(&impacts.rates, &impacts.course))
    }

    fn near(x: f64, y: f64) {
        assert!((x - y).abs() < 1e-9 * y, "{x} {y}");
    }

    /// Where one of the functions alone limits it, it changes on the longest panel by as much as the rule says.
    #[test]
    fn a_panel_is_as_long_as_its_functions_are_resolved() {
        // d ln A/dθ = −λ where y = 0.
        near(resolved(1.0, 2.0, 0.3, 0.5, 0.0) * 0.7, 14.0);
        near(resolved(1.0, 2.0, 1.7, 0.5, 0.0) * 0.7, 14.0);
        near(resolved(1.0, 2.0, 0.3, 1e-7, 0.0) * 0.7, 28.0);
        // d ln y/dθ = −2ρ₊ where ρ₋ = 0: with b = 2a and K_nu = a λ = 0, too, and κ = 2a.
        near(resolved(1.0, 2.0, 1.0, 0.5, 1e-8) * 4.0, 30.0);
        near(resolved(1.0, 2.0, 1.0, 0.5, 1e-3) * 4.0, 14.0);
        near(resolved(1.0, 2.0, 1.0, 0.5, 0.1) * 4.0, 4.0);
        // d ln w/dθ = −μK_ww(1 + y) where ρ₊ = κ = 0, at a slip so small that A may change more.
        near(resolved(1.5, 1.0, 0.5, 1e-7, 1e-5) * 2.0, 32.0);
        // κy beside λ, thrice, where the direction all but stays.
        let (d, y) = (0.01, 0.1);
        near(
            resolved(1.0, 1.0 - d, -d, 0.5, y) * (1.0 + d + 3.0 * y * (1.0 - d)),
            14.0,
        );
    }
}
