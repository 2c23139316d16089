//! Steps that cannot pass a contact. Of a gap f and its rate f′ at a time it is known that f″ ≥ −M: the gap is then never less than
//! the parabola f + f′s − Ms²/2, which is concave in s, so that there is no contact up to its first zero, nor between two times at which
//! it is positive. The same holds backwards in time, with −f′ for f′. Each formula stands once, for numbers and for one in each lane.

use crate::simd::Pack;
use pulp::Simd;
use std::ops::{Add, Div, Mul, Neg};

/// The shortest step of a gap that does not close is this over M, 2⁻²⁶/M: rotation and gravity change it by less than the resolution in
/// that time.
pub(super) const SHORTEST: f64 = 1.0 / 67_108_864.0;
/// At a grazing contact the last step is at most this fraction of the flight time, and turns the axis by at most this angle, 2⁻¹¹...
pub(super) const LAST: f64 = 1.0 / 2048.0;
/// ...and leaves a gap of at most this, the resolution: 2⁻⁵² R.
pub(crate) const INVISIBLE: f64 = 1.0 / 4_503_599_627_370_496.0;
/// Gaps up to this may be rounding errors: 2⁻⁴⁸ R.
pub(super) const TOUCHING: f64 = 1.0 / 281_474_976_710_656.0;

/// A number, or one in each lane.
pub(super) trait Number:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
{
    /// a·b + c: in lanes rounded once.
    fn mul_plus(self, factor: Self, addend: Self) -> Self;
    fn root(self) -> Self;
    fn size(self) -> Self;
    fn at_least(self, other: f64) -> Self;
    /// The first where this is negative, else the second.
    fn if_negative(self, first: Self, second: Self) -> Self;
}

macro_rules! number {
    ([$($of:tt)*] $number:ty, $x:ident, $a:ident, $b:ident => $mul_plus:expr, $if_negative:expr) => {
        impl $($of)* Number for $number {
            #[inline(always)]
            fn mul_plus(self, $a: Self, $b: Self) -> Self {
                let $x = self;
                $mul_plus
            }

            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }

            #[inline(always)]
            fn size(self) -> Self {
                self.abs()
            }

            #[inline(always)]
            fn at_least(self, other: f64) -> Self {
                self.max(other)
            }

            #[inline(always)]
            fn if_negative(self, $a: Self, $b: Self) -> Self {
                let $x = self;
                $if_negative
            }
        }
    };
}
number!([] f64, x, a, b => x * a + b, if x < 0.0 { a } else { b });
number!([<S: Simd, const K: usize>] Pack<S, K>, x, a, b => x.mul_add(a, b), x.lt(0.0).select(a, b));

/// √(f′² + 2Mf): the speed at which the parabola arrives at its zero.
#[inline(always)]
pub(super) fn closing_speed<N: Number>(width: N, rate: N, bound: N) -> N {
    rate.mul_plus(rate, bound * 2.0 * width).root()
}

/// The first zero τ ≥ 0 of the parabola, before which there is no contact; `closing` is its [`closing_speed`]. A step of a gap that does not
/// close is no shorter than the shortest.
#[inline(always)]
pub(super) fn first_zero<N: Number>(width: N, rate: N, closing: N, bound: N) -> N {
    let speed = rate.size() + closing;
    zero(width, rate, speed, speed.at_least(SHORTEST), bound)
}

/// A zero of a parabola, in that of the two forms in which no digits cancel; `speed` is |f′| + [`closing_speed`], and so is `leaving`, by which a gap
/// that opens has its zero.
#[inline(always)]
pub(super) fn zero<N: Number>(width: N, rate: N, speed: N, leaving: N, bound: N) -> N {
    rate.if_negative(width * 2.0, leaving) / rate.if_negative(speed, bound)
}

/// The parabola at the other end of the interval of length `since` before its evaluation. The gap in between is no less than the smaller of both ends.
#[inline(always)]
pub(super) fn before<N: Number>(since: N, width: N, rate: N, bound: N) -> N {
    since.mul_plus(-mean_rate_before(since, rate, bound), width)
}

/// An upper bound on the mean f′ during the interval of length `since` before a time at which f′ is `rate`, f′ + ½M·since. Where it
/// is negative, the gap was wider before: of a contact, for at least 2|f′|/M.
#[inline(always)]
pub(super) fn mean_rate_before<N: Number>(since: N, rate: N, bound: N) -> N {
    since.mul_plus(bound * 0.5, rate)
}
