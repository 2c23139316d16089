//! Where the slip vanishes: the impulse until then as a continued fraction.
//!
//! With **u** taken the right way the direction tends to a fixed one, y → y*: to y* = 0 where ρ₊ ≥ 0, else to y* = −ρ₊/ρ₋. With
//! D = y − y*, σ = |ρ₊| and λ* = λ + κy*
//!
//! dD/dθ = −2D(σ + ρ₋D), d ln A/dθ = −λ* − κD,
//!
//! and the integrals ∫A Dʲ dθ over the rest of the way are hypergeometric functions of −ρ₋D/σ; ∫A dθ, for one, is
//! (A/λ*) ₂F₁(κ/2ρ₋, 1; λ*/2σ + 1; −ρ₋D/σ). C. F. Gauss's continued fraction of it, multiplied by its denominators so that none
//! can vanish, consists of
//!
//! G_k = λ* + 2σk, N_k = G_k N_{k+1} + n_{k+1} N_{k+2}, n_{2m} = 2mD(λ*ρ₋ − κσ + 2mσρ₋), n_{2m+1} = D(κ + 2mρ₋)(λ* + 2mσ).
//!
//! With M = N₁ + κDN₂ and by d(ADʲ)/dθ, which relates these integrals to one another,
//!
//! ∫A dθ = A N₁/(λ*M), ∫AD dθ = A D N₂/M, ∫AD² dθ = A D²G₁(N₃ + κDN₄)/M,
//! ∫AD³ dθ = A D³G₁G₂(N₄ + D(κ + 2ρ₋)(N₅ + κDN₆))/M.
//!
//! The impulse is ∫A(1 + y)² dθ. With A², 2λ* and 2κ for A, λ* and κ they give ∫u dp, and with it the work.

use super::{Course, Goal, Rates};
use crate::law::Hypothesis;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Pairs of levels of the fraction.
const PAIRS: usize = 12;
/// Most that the impulse may change, as a share of it, if the fraction is cut off instead of closed: it is then five to fifty times as
/// far off.
const SETTLED: f64 = 1.0 / 281_474_976_710_656.0; // 2⁻⁴⁸
/// Share by which a direction may turn until the slip vanishes and yet count as constant.
const STRAIGHT: f64 = 2.0 * f64::EPSILON;

/// The way of a slip that vanishes.
pub(super) struct Stop<S: Simd, const K: usize> {
    /// Whether the slip vanishes, unless the impact is over before.
    pub reached: Mask<S, K>,
    /// Whether **u** is taken the other way.
    back: Mask<S, K>,
    /// A, y*, D.
    a: Pack<S, K>,
    limit: Pack<S, K>,
    distance: Pack<S, K>,
    /// 1/G₁, and times that ρ₋, σ, λ*, κ.
    unit: Pack<S, K>,
    minus: Pack<S, K>,
    sigma: Pack<S, K>,
    decay: Pack<S, K>,
    kappa: Pack<S, K>,
}

/// N₁ to N₆ with a common factor.
struct Levels<S: Simd, const K: usize>([Pack<S, K>; 6]);

/// What the fraction is made of: λ*, κ, 2σ, 2ρ₋, D, and D(λ*ρ₋ − κσ) and 2Dσρ₋.
struct Terms<S: Simd, const K: usize> {
    decay: Pack<S, K>,
    kappa: Pack<S, K>,
    twice: Pack<S, K>,
    bend: Pack<S, K>,
    distance: Pack<S, K>,
    mixed: Pack<S, K>,
    curl: Pack<S, K>,
}

impl<S: Simd, const K: usize> Terms<S, K> {
    #[inline(always)]
    fn new(stop: &Stop<S, K>, order: f64) -> Self {
        let d = stop.distance;
        let (decay, kappa) = (stop.decay * order, stop.kappa * order);
        let twice = 2.0 * stop.sigma;
        Self {
            decay,
            kappa,
            twice,
            bend: 2.0 * stop.minus,
            distance: d,
            mixed: (decay * stop.minus - kappa * stop.sigma) * d,
            curl: twice * stop.minus * d,
        }
    }

    /// G_k.
    #[inline(always)]
    fn ground(&self, k: f64) -> Pack<S, K> {
        self.twice.mul_add(k, self.decay)
    }

    /// n_{2m}.
    #[inline(always)]
    fn even(&self, m: f64) -> Pack<S, K> {
        self.curl.mul_add(m, self.mixed) * (2.0 * m)
    }

    /// n_{2m+1}.
    #[inline(always)]
    fn odd(&self, m: f64) -> Pack<S, K> {
        self.bend.mul_add(m, self.kappa) * self.distance * self.ground(m)
    }
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
        let aside = rates.plus.lt(0.0) & zero.le(rates.nu);
        let forward = zero.le(rates.plus) & zero.lt(gamma);
        let back = !(straight | aside | forward);
        let plus = back.select(-rates.minus, rates.plus);
        let minus = back.select(-rates.plus, rates.minus);
        let kappa = rates.brake - minus;
        let decay = back.select(rates.nu.mul_add(2.0, rates.decay), rates.decay);
        let y = back.select(1.0 / y, y);
        let limit = plus.lt(0.0).select(-plus / minus, 0.0);
        let limit = straight.select(y, limit);
        let sigma = plus.abs();
        let decay = kappa.mul_add(limit, decay);
        let unit = 1.0 / sigma.mul_add(2.0, decay);
        Self {
            reached: zero.lt(decay),
            back,
            a: back.select(at.a * at.y, at.a),
            limit,
            distance: y - limit,
            unit,
            minus: minus * unit,
            sigma: sigma * unit,
            decay: decay * unit,
            kappa: kappa * unit,
        }
    }

    /// The fraction for A to the power of `order`: closed as if it went on without change, and cut off.
    #[inline(always)]
    fn levels(&self, order: f64) -> [Levels<S, K>; 2] {
        let terms = Terms::new(self, order);
        let top = (PAIRS + 1) as f64;
        let (g, n, o) = (
            terms.ground(2.0 * top - 1.0),
            terms.even(top),
            terms.odd(top),
        );
        // t = g + n/(g + o/t).
        let square = g * g;
        let half = square + (n - o);
        let root = half.mul_add(half, 4.0 * square * o).max(0.0).sqrt();
        let one = Pack::splat(g.simd(), 1.0);
        let mut found = [Levels([one; 6]), Levels([one; 6])];
        let mut pairs = [(half + root, 2.0 * g), (g, one)];
        for m in (1..=PAIRS).rev() {
            let (n, o) = (terms.even(m as f64), terms.odd(m as f64));
            let (low, high) = (
                terms.ground((2 * m - 1) as f64),
                terms.ground((2 * m) as f64),
            );
            for i in 0..2 {
                let second = high.mul_add(pairs[i].0, o * pairs[i].1);
                let first = low.mul_add(second, n * pairs[i].0);
                pairs[i] = (first, second);
                if m <= 3 {
                    found[i].0[2 * m - 1] = second;
                    found[i].0[2 * m - 2] = first;
                }
            }
        }
        found
    }

    /// ∫(1 + y)² A dθ from the levels for A, over A/G₁, as a fraction.
    #[inline(always)]
    fn impulse(&self, Levels(n): &Levels<S, K>) -> (Pack<S, K>, Pack<S, K>) {
        let (d, q) = (self.distance, 1.0 + self.limit);
        let pull = self.kappa * d;
        let whole = pull.mul_add(n[1], n[0]) * self.decay;
        let outer = (2.0 * q).mul_add(n[1], d * pull.mul_add(n[3], n[2]));
        ((q * q).mul_add(n[0], outer * (d * self.decay)), whole)
    }

    /// ∫(1 − y)(1 + y)² A² dθ from the levels for A², over A²/G₁, as a fraction.
    #[inline(always)]
    fn moment(&self, Levels(n): &Levels<S, K>) -> (Pack<S, K>, Pack<S, K>) {
        let (d, q) = (self.distance, 1.0 + self.limit);
        let (decay, pull) = (2.0 * self.decay, 2.0 * self.kappa * d);
        let whole = pull.mul_add(n[1], n[0]) * decay;
        let first = self.sigma.mul_add(2.0, decay);
        let second = self.sigma.mul_add(4.0, decay);
        let tilt = (2.0 * d).mul_add(self.minus, pull);
        let square = pull.mul_add(n[3], n[2]) * first;
        let cube = pull.mul_add(n[5], n[4]).mul_add(tilt, n[3]) * (first * second);
        // (1 − y)(1 + y)² = (s − D)(q + D)².
        let s = 1.0 - self.limit;
        let inner = (s - 2.0 * q).mul_add(square, -(d * cube));
        let outer = (q * (2.0 * s - q)).mul_add(n[1], d * inner);
        ((s * (q * q)).mul_add(n[0], outer * (d * decay)), whole)
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
        let scale = self.a * self.unit;
        let [closed, open] = self.levels(1.0);
        let ((impulse, whole), (crude, cut)) = (self.impulse(&closed), self.impulse(&open));
        let off = (impulse * cut - crude * whole).abs() * scale;
        let impulse = scale * impulse / whole;
        let mut settled = off.le((impulse + at.normal) * (whole * cut).abs() * SETTLED);
        let along = -impulse.mul_add(rates.nu, at.u) / rates.uu;
        let v = rates.nn.mul_add(impulse, rates.nu.mul_add(along, at.v));
        if goal.hypothesis == Hypothesis::Stronge {
            let scale = self.a * scale;
            let [closed, open] = self.levels(2.0);
            let ((moment, whole), (crude, cut)) = (self.moment(&closed), self.moment(&open));
            let off = (moment * cut - crude * whole).abs() * scale;
            settled = settled & off.le(at.slip * impulse * (whole * cut).abs() * SETTLED);
            let moment = scale * moment / whole;
            let moment = self.back.select(-moment, moment);
            let mean = (0.5 * rates.sticking).mul_add(impulse, at.v);
            let share = (-at.u).mul_add(impulse, moment) * rates.nu / rates.uu;
            at.work = at.work + mean.mul_add(impulse, share);
        }
        let jam = rates.nu * rates.friction;
        let jam = self.back.select(-jam, jam);
        let now = rates.slope(at.y);
        let then = (rates.nn + jam).mul_add(self.limit, rates.nn - jam);
        let crest = zero.lt(now) & then.lt(0.0);
        at.normal = at.normal + impulse;
        at.along = at.along + along;
        at.across = at.across - at.w / rates.ww;
        at.v = v;
        let compressing = at.compressing & v.lt(0.0);
        let restoring = !at.compressing & zero.le(v) & zero.lt(goal.missing(at));
        self.reached & settled & (compressing | restoring) & !crest
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Case, State, value};
    use super::*;
    use pulp::Scalar;

    /// Closed as if it went on without change the fraction is closer, twice at least, than if it is cut off, beside the impulse until
    /// the slip vanishes that the equation of the slip gives; of ways on which it has not converged.
    #[test]
    fn a_fraction_that_is_closed_is_closer_than_one_that_is_cut_off() {
        for (nu, uu, ww, y) in [
            (0.5, 1.1, 3.6, 1.3_f64),
            (-0.4, 1.3, 5.0, 0.7),
            (0.2, 1.2, 3.9, 1.0),
            (0.0, 3.0, 1.2, 0.1),
            (0.1, 3.0, 1.2, 0.2),
            (0.3, 4.0, 1.2, 0.1),
        ] {
            let case = Case {
                friction: 1.0,
                nn: 2.0,
                nu,
                uu,
                ww,
                direction: 2.0 * y.sqrt().atan(),
            };
            let impacts = case.impacts(0.5, 0.5, Hypothesis::Newton);
            let (rates, at) = (impacts.rates, impacts.course);
            let stop: Stop<Scalar, 1> = Stop::new(&rates, &at);
            assert!(stop.reached.any());
            let mut there = State::of(&at);
            while there.u.hypot(there.w) > 1e-12 {
                there = there.after(&rates, 2.0 / value(rates.pace(at.y)));
            }
            let off = stop.levels(1.0).map(|levels| {
                let (impulse, whole) = stop.impulse(&levels);
                (value(stop.a * stop.unit * impulse / whole) / there.normal - 1.0).abs()
            });
            assert!(off[1] < 1e-7 && off[0] < 0.5 * off[1], "{off:?} {case:?}");
        }
    }
}
