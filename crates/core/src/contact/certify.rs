//! Steps that cannot pass a contact. Of a gap f and its rate f′ at a time it is known that f″ ≥ −M: the gap is then never less than
//! the parabola f + f′s − Ms²/2, which is concave in s, so that there is no contact up to its first zero, nor between two times at which
//! it is positive. The same holds backwards in time, with −f′ for f′.

use crate::simd::Pack;
use pulp::Simd;

/// The shortest step of a gap that does not close is this over M, 2⁻²⁶/M: rotation and gravity change it by less than the resolution in
/// that time.
pub(super) const SHORTEST: f64 = 1.0 / 67_108_864.0;
/// At a grazing contact the last step is at most this fraction of the flight time, and turns the axis by at most this angle, 2⁻¹¹...
pub(super) const LAST: f64 = 1.0 / 2048.0;
/// ...and leaves a gap of at most this, the resolution: 2⁻⁵² R.
pub(super) const INVISIBLE: f64 = 1.0 / 4_503_599_627_370_496.0;
/// Gaps up to this may be rounding errors: 2⁻⁴⁸ R.
pub(super) const TOUCHING: f64 = 1.0 / 281_474_976_710_656.0;

/// √(f′² + 2Mf): the speed at which the parabola arrives at its zero.
#[inline(always)]
pub(super) fn closing_speed<S: Simd, const K: usize>(
    width: Pack<S, K>,
    rate: Pack<S, K>,
    bound: Pack<S, K>,
) -> Pack<S, K> {
    rate.mul_add(rate, 2.0 * bound * width).sqrt()
}

/// The first zero τ ≥ 0 of the parabola, before which there is no contact, in that of the two forms of the root in which no digits
/// cancel; `closing` is its [`closing_speed`].
#[inline(always)]
pub(super) fn first_zero<S: Simd, const K: usize>(
    width: Pack<S, K>,
    rate: Pack<S, K>,
    closing: Pack<S, K>,
    bound: Pack<S, K>,
) -> Pack<S, K> {
    let approaching = rate.lt(0.0);
    let speed = rate.abs() + closing;
    let numerator = approaching.select(2.0 * width, speed.max(SHORTEST));
    let denominator = approaching.select(speed, bound);
    numerator / denominator
}

/// A lower bound on the gap during the interval of length `since` before its evaluation: the smaller end of the parabola.
#[inline(always)]
pub(super) fn least_before<S: Simd, const K: usize>(
    since: Pack<S, K>,
    width: Pack<S, K>,
    rate: Pack<S, K>,
    bound: Pack<S, K>,
) -> Pack<S, K> {
    let mean = mean_rate_before(since, rate, bound);
    since.mul_add(-mean, width).min(width)
}

/// An upper bound on the mean f′ during the interval of length `since` before a time at which f′ is `rate`, f′ + ½M·since. Where it
/// is negative, the gap was wider before: of a contact, for at least 2|f′|/M.
#[inline(always)]
pub(super) fn mean_rate_before<S: Simd, const K: usize>(
    since: Pack<S, K>,
    rate: Pack<S, K>,
    bound: Pack<S, K>,
) -> Pack<S, K> {
    since.mul_add(0.5 * bound, rate)
}
