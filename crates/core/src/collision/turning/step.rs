//! How far to go on: to the next event, as far as one can tell from here, and back where that was too far.

use super::near::Near;
use super::panel::reach;
use super::series::parabola;
use super::{Course, Goal, Rates};
use crate::collision::Hypothesis;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Guess of x up to which the series are asked.
const NEAR: f64 = 3.0;
/// Length over which v_c^n may have an extremum between its ends, times R.
const SHORT: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰

/// How far the next event is, in θ, if the velocity is linear in p and A(1 + y)² exponential in θ; infinitely far if there is none.
#[inline(always)]
pub(super) fn guess<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &Course<S, K>,
) -> Pack<S, K> {
    let whole = 1.0 + at.y;
    let stiff = rates.slope(at.y) / whole;
    let zero = Pack::splat(at.v.simd(), 0.0);
    let missing = goal.missing(at);
    let restitution = match goal.hypothesis {
        Hypothesis::Newton => missing / stiff,
        Hypothesis::Poisson => missing,
        Hypothesis::Stronge => parabola(at.v, 0.5 * stiff, missing),
    };
    // In a jam v_c^n falls to 0, perhaps before that.
    let falls = zero.le(at.v) & stiff.lt(0.0);
    let rest = -at.v / stiff;
    let soon = match goal.hypothesis {
        Hypothesis::Newton => rest,
        _ => rest.min(restitution),
    };
    let p = at.compressing.select(rest, falls.select(soon, restitution));
    let gamma = rates.minus.mul_add(at.y, rates.plus);
    let growth = -(4.0 * at.y * gamma) / whole - rates.kappa.mul_add(at.y, rates.decay);
    let share = p / (at.slip * whole);
    let fourth = growth.mul_add(share, 1.0);
    let q = fourth.max(0.0).sqrt().sqrt();
    // ln(1 + t) = 8(q − 1)/(q + 1), nearly, with q⁴ = 1 + t.
    let theta = 8.0 * share / ((q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0));
    let rises = zero.lt(stiff) | !at.compressing;
    let ahead = rises & zero.le(p) & zero.lt(fourth);
    ahead.select(theta, f64::INFINITY)
}

/// How far it is certain, in θ, that v_c^n has no extremum, or all but none.
#[inline(always)]
fn crest<S: Simd, const K: usize>(rates: &Rates<S, K>, at: &Course<S, K>) -> Pack<S, K> {
    let zero = Pack::splat(at.y.simd(), 0.0);
    let (now, jam) = (rates.slope(at.y), rates.nu * rates.friction);
    // There y = c, and y₀ − y = (ρ₊ + ρ₋y₀)ζ/(1 + ρ₋ζ).
    let c = (jam - rates.nn) / (jam + rates.nn);
    let zeta = now / (rates.nn + jam) / rates.minus.mul_add(c, rates.plus);
    let certain = reach(rates, at.y, zeta).max(SHORT / rates.pace(at.y));
    (zero.lt(at.y) & zero.lt(c) & zero.lt(zeta)).select(certain, f64::INFINITY)
}

/// Goes through the events that are near, and says how far the next one is, in θ: infinitely far if there is none.
#[inline(always)]
pub(super) fn events<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &mut Course<S, K>,
) -> Pack<S, K> {
    let far = guess(rates, goal, at);
    let crest = crest(rates, at);
    let near = (at.is_late(goal) | (far * rates.pace(at.y)).le(NEAR)) & !at.over;
    if !near.any() {
        return far.min(crest);
    }
    let wanted = Near::new(rates, at).pass(rates, goal, near, crest, at);
    near.select(wanted, far).min(crest)
}

/// Which lanes have gone too far on the way from `at` to `end`, and how far they should have gone.
#[inline(always)]
pub(super) fn beyond<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    goal: &Goal<S, K>,
    at: &Course<S, K>,
    end: &Course<S, K>,
    length: Pack<S, K>,
) -> (Mask<S, K>, Pack<S, K>) {
    let zero = Pack::splat(at.v.simd(), 0.0);
    let y = end.w * end.w / (4.0 * end.a * end.a);
    let slip = end.a * (1.0 + y);
    let inverse = 1.0 / rates.pace(y);
    let (before, after) = (rates.slope(at.y), rates.slope(y));
    // v_c^n = 0: what was missing, how far it is beyond, and both slopes.
    let sign = at.compressing.select(1.0, zero - 1.0);
    let rests = Beyond {
        value: -sign * at.v,
        off: sign * end.v,
        early: sign * at.slip * before * length,
        late: sign * slip * after * inverse,
    };
    // The end of the restitution.
    let (early, late) = match goal.hypothesis {
        Hypothesis::Newton => (at.slip * before, slip * after),
        Hypothesis::Poisson => (at.slip * (1.0 + at.y), slip * (1.0 + y)),
        Hypothesis::Stronge => (at.v * at.slip * (1.0 + at.y), end.v * slip * (1.0 + y)),
    };
    let ends = Beyond {
        value: goal.missing(at),
        off: -goal.missing(end),
        early: early * length,
        late: late * inverse,
    };
    let forward = zero.lt(length);
    let (at_rest, at_end) = (
        rests.is_far() & forward,
        ends.is_far() & forward & !at.compressing,
    );
    let rest = at_rest.select(rests.share(), 1.0);
    let share = at_end.select(ends.share(), 1.0).min(rest);
    (at_rest | at_end, share.max(1.0 / 64.0).min(0.9) * length)
}

/// An event that is behind the end of a way.
struct Beyond<S: Simd, const K: usize> {
    value: Pack<S, K>,
    off: Pack<S, K>,
    early: Pack<S, K>,
    late: Pack<S, K>,
}

impl<S: Simd, const K: usize> Beyond<S, K> {
    /// Whether it is too far behind for the series.
    #[inline(always)]
    fn is_far(&self) -> Mask<S, K> {
        Pack::splat(self.off.simd(), 0.0).lt(self.off) & !self.off.le(0.5 * self.late)
    }

    /// At which share of the way it is, on a parabola.
    #[inline(always)]
    fn share(&self) -> Pack<S, K> {
        parabola(self.early, self.off + self.value - self.early, self.value)
    }
}
