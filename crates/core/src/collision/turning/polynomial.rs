//! Polynomials in ξ ∈ [−1, 1], one in each lane, and where they pass a value.

use super::nodes::HALF;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Coefficients.
pub(super) const TERMS: usize = 2 * HALF + 1;
/// Steps of the search for a root; four are usual.
const MOST_STEPS: usize = 60;

/// A polynomial.
#[derive(Clone, Copy)]
pub(super) struct Polynomial<S: Simd, const K: usize>(pub [Pack<S, K>; TERMS]);

impl<S: Simd, const K: usize> Polynomial<S, K> {
    #[inline(always)]
    pub fn at(&self, x: Pack<S, K>) -> Pack<S, K> {
        let mut sum = self.0[TERMS - 1];
        for k in (0..TERMS - 1).rev() {
            sum = sum.mul_add(x, self.0[k]);
        }
        sum
    }

    /// a·self + b·other + c·third.
    #[inline(always)]
    pub fn combined(
        &self,
        a: Pack<S, K>,
        other: (&Self, Pack<S, K>),
        third: (&Self, Pack<S, K>),
    ) -> Self {
        let mut sum = self.0;
        for (k, term) in sum.iter_mut().enumerate() {
            *term = term.mul_add(a, other.0.0[k].mul_add(other.1, third.0.0[k] * third.1));
        }
        Self(sum)
    }

    #[inline(always)]
    pub fn negative(&self) -> Self {
        let mut terms = self.0;
        for term in &mut terms {
            *term = -*term;
        }
        Self(terms)
    }

    /// Quotient and remainder by ξ − x.
    #[inline(always)]
    fn divided(&self, x: Pack<S, K>) -> (Self, Pack<S, K>) {
        let mut quotient = self.0;
        let mut sum = self.0[TERMS - 1];
        quotient[TERMS - 1] = Pack::splat(x.simd(), 0.0);
        for k in (0..TERMS - 1).rev() {
            quotient[k] = sum;
            sum = sum.mul_add(x, self.0[k]);
        }
        (Self(quotient), sum)
    }

    /// The polynomial about x, where its slope is given.
    #[inline(always)]
    pub fn about(&self, x: Pack<S, K>, slope: Pack<S, K>) -> Local<S, K> {
        let rest = self.divided(x).0.divided(x).0;
        Local { slope, rest, x }
    }
}

/// The change of a polynomial from x on: δ(slope + δ rest(x + δ)), which loses nothing where it is small.
pub(super) struct Local<S: Simd, const K: usize> {
    slope: Pack<S, K>,
    rest: Polynomial<S, K>,
    x: Pack<S, K>,
}

impl<S: Simd, const K: usize> Local<S, K> {
    /// The change up to ξ.
    #[inline(always)]
    pub fn change(&self, xi: Pack<S, K>) -> Pack<S, K> {
        let step = xi - self.x;
        self.rest.at(xi).mul_add(step, self.slope) * step
    }

    /// Where, before `end`, the change becomes `value` ≥ 0, for the lanes in `wanted`, in which it grows until then.
    #[inline(always)]
    pub fn reaches(&self, value: Pack<S, K>, end: Pack<S, K>, wanted: Mask<S, K>) -> Pack<S, K> {
        let (mut low, mut high) = (self.x, end);
        let length = end - self.x;
        // The root of a parabola through the end.
        let total = self.change(end);
        let bend = (total - self.slope * length) / (length * length);
        let root = self
            .slope
            .mul_add(self.slope, 4.0 * bend * value)
            .max(0.0)
            .sqrt();
        let sum = self.slope + root;
        let guess = self.x + sum.eq(0.0).select(0.0, 2.0 * value / sum);
        let mut xi = guess.max(low).min(high);
        let mut active = wanted;
        for _ in 0..MOST_STEPS {
            // Value and slope of `rest` together.
            let terms = &self.rest.0;
            let mut rest = terms[TERMS - 3];
            let mut derivative = Pack::splat(xi.simd(), 0.0);
            for k in (0..TERMS - 3).rev() {
                derivative = derivative.mul_add(xi, rest);
                rest = rest.mul_add(xi, terms[k]);
            }
            let step = xi - self.x;
            let secant = rest.mul_add(step, self.slope);
            let slope = derivative.mul_add(step, rest).mul_add(step, secant);
            let off = secant.mul_add(step, -value);
            let below = off.lt(0.0);
            low = below.select(xi, low);
            high = below.select(high, xi);
            let newton = xi - off / slope;
            let inside = low.le(newton) & newton.le(high);
            let next = inside.select(newton, 0.5 * (low + high));
            let moved = (next - xi).abs();
            xi = active.select(next, xi);
            active = active & !moved.le((xi - self.x).abs() * TOLERANCE);
            if !active.any() {
                break;
            }
        }
        xi
    }
}

/// Step after which the search has ended: Newton's next one is its square.
const TOLERANCE: f64 = 1e-9;
