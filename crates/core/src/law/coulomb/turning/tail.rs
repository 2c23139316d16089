//! The last part of a slip, whose direction hardly turns any more: impulse and work are sums of exponential functions.
//!
//! About a fixed direction y* that attracts, with D, σ and λ* as in the [hodograph](super::hodograph), ζ = D/(1 + ρ₋D/σ) falls
//! as E = exp(−2σθ). With w = ρ₋ζ₀/σ and η = κζ₀/2σ
//!
//! D = ζ₀E/(1 − wE), A = A₀ exp(−λ*θ) S(E)/S(1), S(E) = (1 − wE)^{−κ/2ρ₋} = Σ a_k Eᵏ, a_{k+1} = a_k (η + kw)/(k + 1),
//!
//! and S(E)(1 − wE)⁻ʲ, of which ADʲ consists, has η + jw for η. So dp/dθ = A(1 + y)² is a sum of exponential functions with the rates
//! λ* + 2σk, and u dp/dθ, for the work, one with 2λ* + 2σk. Both are integrated term by term, with 1 − e^{−λ*θ}Eᵏ from one k to the next.
//! The rest follows from p and the slip at the end, and the ends of compression and restitution by steps of third order.

use super::step::way;
use super::{Course, Goal, Rates};
use crate::law::Hypothesis;
use crate::simd::elementary::{exp_m1_in_lanes, polynomial};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Terms of the series: with what follows, those left out are below 10⁻¹⁷.
const TERMS: usize = 12;
/// Largest |w| and |η|.
const BEND: f64 = 1.0 / 48.0;
const PULL: f64 = 1.0 / 24.0;
/// Least |σ|, so that quotients stay finite.
const STEADY: f64 = 1e-200;
/// Most by which ln A and ln E^½ change.
const LARGE: f64 = 32.0;
/// Steps towards an event, and the last of them, relative to the way, at which it is found: a few roundings.
const STEPS: usize = 7;
/// Most by which ln A changes in a step.
const FOLDS: f64 = 8.0;
const CLOSE: f64 = 1.0 / 562_949_953_421_312.0; // 2⁻⁴⁹

/// Largest speed that the slip's coupling may lend to the normal motion, over that of the approach.
const SLIDES: f64 = 16.0;

/// artanh(s)/s in powers of s².
const ARTANH: [f64; 5] = [1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0];

/// The slip from a point on.
pub(super) struct Tail<S: Simd, const K: usize> {
    /// Whether its direction turns so little.
    straight: Mask<S, K>,
    /// y*, ζ₀, w, σ, λ*.
    limit: Pack<S, K>,
    zeta: Pack<S, K>,
    bend: Pack<S, K>,
    sigma: Pack<S, K>,
    decay: Pack<S, K>,
    /// η.
    pull: Pack<S, K>,
}

/// What the sums consist of, in units of A/S(1), and of its square for the work.
struct Sums<S: Simd, const K: usize> {
    /// a_k.
    size: [Pack<S, K>; TERMS],
    /// The coefficients of dp/dθ, of the impulse along **u**, and of u dp/dθ, over their rates.
    impulse: [Pack<S, K>; TERMS],
    along: [Pack<S, K>; TERMS],
    moment: [Pack<S, K>; TERMS],
}

impl<S: Simd, const K: usize> Tail<S, K> {
    #[inline(always)]
    pub fn new(rates: &Rates<S, K>, y: Pack<S, K>) -> Self {
        let zero = Pack::splat(y.simd(), 0.0);
        let (plus, minus) = (rates.plus, rates.minus);
        let oblique = plus.lt(0.0);
        let sigma = plus.abs().max(STEADY);
        let inverse = 1.0 / oblique.select(minus * sigma, sigma);
        // y* = −ρ₊/ρ₋.
        let limit = oblique.select(sigma * sigma * inverse, 0.0);
        let scale = oblique.select(minus * inverse, inverse);
        let distance = y - limit;
        let gamma = minus.mul_add(distance * scale, 1.0);
        let zeta = distance / gamma;
        let bend = minus * zeta * scale;
        let pull = rates.kappa * zeta * (0.5 * scale);
        let decay = rates.kappa.mul_add(limit, rates.decay);
        let steady = oblique.select(minus, 1.0);
        let straight = zero.lt(steady)
            & bend.abs().le(BEND)
            & pull.abs().le(PULL)
            & zero.le(decay.mul_add(2.0, sigma));
        let even = decay.abs().max(STEADY);
        Self {
            straight,
            limit,
            zeta,
            bend,
            sigma,
            decay: decay.lt(0.0).select(-even, even),
            pull,
        }
    }

    /// Of which lanes it is known where the next event is.
    #[inline(always)]
    pub fn leads(&self, rates: &Rates<S, K>, goal: &Goal<S, K>, at: &Course<S, K>) -> Mask<S, K> {
        let zero = Pack::splat(at.y.simd(), 0.0);
        // v_c^n rises all the way, and the work keeps its digits beside that of the slip.
        let rises = zero.lt(rates.slope(at.y)) & zero.lt(rates.slope(self.limit));
        let lanes = self.straight & rises & !at.over & !at.is_late(goal);
        if goal.hypothesis != Hypothesis::Stronge {
            return lanes;
        }
        lanes & (at.slip * rates.nu.abs()).le(goal.approach * rates.uu * SLIDES)
    }

    /// The coefficients of S(E)ᵒ(1 − wE)⁻ʲ.
    #[inline(always)]
    fn series(&self, order: f64, j: f64) -> [Pack<S, K>; TERMS] {
        let first = self.bend.mul_add(j, order * self.pull);
        let mut terms = [Pack::splat(self.zeta.simd(), 1.0); TERMS];
        for k in 1..TERMS {
            let factor = self.bend.mul_add((k - 1) as f64, first);
            terms[k] = terms[k - 1] * factor * (1.0 / k as f64);
        }
        terms
    }

    /// The sums from here on.
    #[inline(always)]
    fn sums(&self, rates: &Rates<S, K>, hypothesis: Hypothesis) -> Sums<S, K> {
        let zero = Pack::splat(self.zeta.simd(), 0.0);
        let (z, y) = (self.zeta, self.limit);
        let (q, s) = (1.0 + y, 1.0 - y);
        // (1 + y)², −μ(1 − y²), and (1 − y)(1 + y)² in powers of D.
        let impulse = [q * q, 2.0 * q, 1.0 + zero];
        let mu = rates.friction;
        let along = [-mu * (q * s), 2.0 * mu * y, mu + zero];
        let moment = [s * (q * q), q * (2.0 * s - q), s - 2.0 * q, zero - 1.0];
        let powers = [1.0 + zero, z, z * z, z * (z * z)];
        let single = [0.0, 1.0, 2.0].map(|j| self.series(1.0, j));
        let mut sums = Sums {
            size: single[0],
            impulse: [zero; TERMS],
            along: [zero; TERMS],
            moment: [zero; TERMS],
        };
        for k in 0..TERMS {
            let inverse = 1.0 / (2.0 * self.sigma).mul_add(k as f64, self.decay);
            for j in 0..=k.min(2) {
                let term = powers[j] * single[j][k - j] * inverse;
                sums.impulse[k] = impulse[j].mul_add(term, sums.impulse[k]);
                sums.along[k] = along[j].mul_add(term, sums.along[k]);
            }
        }
        if hypothesis == Hypothesis::Stronge {
            let double = [0.0, 1.0, 2.0, 3.0].map(|j| self.series(2.0, j));
            for k in 0..TERMS {
                let rate = 2.0 * self.sigma.mul_add(k as f64, self.decay);
                for j in 0..=k.min(3) {
                    let term = powers[j] * double[j][k - j] / rate;
                    sums.moment[k] = moment[j].mul_add(term, sums.moment[k]);
                }
            }
        }
        sums
    }

    /// Where the slip has come to after θ.
    #[inline(always)]
    fn at(
        &self,
        rates: &Rates<S, K>,
        goal: &Goal<S, K>,
        sums: &Sums<S, K>,
        from: &Course<S, K>,
        theta: Pack<S, K>,
    ) -> Course<S, K> {
        let half = self.half(theta);
        let (e, turned) = ((1.0 + half) * (1.0 + half), -(half * (2.0 + half)));
        let lost = -exp_m1_in_lanes((-(self.decay * theta)).max(-LARGE).min(LARGE));
        let x = 1.0 - lost;
        let [zero, one] = [0.0, 1.0].map(|value| Pack::splat(theta.simd(), value));
        let (mut size, mut power) = (zero, one);
        let (mut impulse, mut along, mut moment) = (size, size, size);
        // 1 − e^{−λ*θ}Eᵏ, and for A².
        let (mut first, mut second) = (lost, lost * (2.0 - lost));
        for k in 0..TERMS {
            size = sums.size[k].mul_add(power, size);
            impulse = sums.impulse[k].mul_add(first, impulse);
            along = sums.along[k].mul_add(first, along);
            let step = x * power * turned;
            first = first + step;
            if goal.hypothesis == Hypothesis::Stronge {
                moment = sums.moment[k].mul_add(second, moment);
                second = x.mul_add(step, second);
            }
            power = power * e;
        }
        let unit = from.a / sums.whole();
        let (impulse, along) = (impulse * unit, along * unit);
        let a = size * x * unit;
        let distance = self.zeta * e / (1.0 - self.bend * e);
        let y = (self.limit + distance).max(0.0);

        let mut at = *from;
        at.y = y;
        at.a = a;
        at.slip = a * (1.0 + y);
        at.u = a * (1.0 - y);
        at.v = rates.nn.mul_add(impulse, rates.nu.mul_add(along, from.v));
        at.normal = from.normal + impulse;
        at.along = from.along + along;
        if goal.hypothesis == Hypothesis::Stronge {
            let mean = (0.5 * rates.sticking).mul_add(impulse, from.v);
            let gained = moment * (unit * unit) - from.u * impulse;
            at.work = from.work + mean.mul_add(impulse, gained * rates.nu / rates.uu);
        }
        at
    }

    /// Δw after θ, from d ln w/dθ = −μK_ww(1 + y): ∫D dθ = artanh(s)/ρ₋ with s = w(1 − E)/(2 − w(1 + E)).
    #[inline(always)]
    fn braked(&self, rates: &Rates<S, K>, w: Pack<S, K>, theta: Pack<S, K>) -> Pack<S, K> {
        let half = self.half(theta);
        let (e, turned) = ((1.0 + half) * (1.0 + half), -(half * (2.0 + half)));
        let part = turned / (2.0 - self.bend * (1.0 + e));
        let s = self.bend * part;
        let turn = self.zeta / self.sigma * part * polynomial(ARTANH, s * s);
        let whole = (1.0 + self.limit).mul_add(theta, turn);
        let half = exp_m1_in_lanes((-0.5 * rates.brake * whole).max(-LARGE));
        w * (half * (2.0 + half))
    }

    /// E^½ − 1 after θ.
    #[inline(always)]
    fn half(&self, theta: Pack<S, K>) -> Pack<S, K> {
        exp_m1_in_lanes((-(self.sigma * theta)).max(-LARGE))
    }

    /// Goes through the next events, in the lanes of the mask, as far as they are before the slip vanishes.
    #[inline(always)]
    pub fn pass(
        mut self,
        rates: &Rates<S, K>,
        goal: &Goal<S, K>,
        mut lanes: Mask<S, K>,
        at: &mut Course<S, K>,
    ) {
        let zero = Pack::splat(at.y.simd(), 0.0);
        let mut sums = self.sums(rates, goal.hypothesis);
        // The ends of compression and restitution.
        for _ in 0..2 {
            let from = *at;
            let mut theta = zero;
            let longest = FOLDS / self.decay.abs();
            // Of the others the slip vanishes first.
            lanes = lanes & zero.lt(way(rates, goal, at).fourth);
            let mut found = !lanes;
            for _ in 0..STEPS {
                let way = way(rates, goal, at);
                let done = way.impulse.abs().le((at.normal - from.normal) * CLOSE);
                found = found | done & zero.lt(theta);
                if found.all() {
                    break;
                }
                theta = found.select(theta, theta + way.length.min(longest).max(-longest));
                let there = self.at(rates, goal, &sums, &from, theta);
                *at = Course::choose(found, at, &there);
            }
            let lost = self.braked(rates, from.w, theta);
            at.w = from.w + lost;
            at.across = from.across + lost / rates.ww;
            let far = (self.decay.abs() * theta).le(LARGE);
            lanes = lanes & found & far;
            let compressed = lanes & at.compressing;
            at.turn_back(compressed, goal);
            let done = lanes & !compressed | compressed & goal.missing(at).le(0.0);
            at.over = at.over | done;
            *at = Course::choose(lanes, at, &from);
            lanes = lanes & !done;
            if !lanes.any() {
                return;
            }
            self.forward(&mut sums, theta);
        }
    }

    /// Goes on by θ.
    #[inline(always)]
    fn forward(&mut self, sums: &mut Sums<S, K>, theta: Pack<S, K>) {
        let root = 1.0 + self.half(theta);
        let e = root * root;
        self.zeta = self.zeta * e;
        self.bend = self.bend * e;
        sums.forward(e);
    }
}

impl<S: Simd, const K: usize> Sums<S, K> {
    /// S(1).
    #[inline(always)]
    fn whole(&self) -> Pack<S, K> {
        let mut sum = self.size[TERMS - 1];
        for k in (0..TERMS - 1).rev() {
            sum = sum + self.size[k];
        }
        sum
    }

    /// The sums from where E has fallen so far.
    #[inline(always)]
    fn forward(&mut self, e: Pack<S, K>) {
        let mut power = e;
        for k in 1..TERMS {
            for terms in [
                &mut self.size,
                &mut self.impulse,
                &mut self.along,
                &mut self.moment,
            ] {
                terms[k] = terms[k] * power;
            }
            power = power * e;
        }
    }
}

#[cfg(test)]
mod tests;
