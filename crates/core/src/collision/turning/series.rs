//! Power series in x, one in each lane, and where they take a value.

use crate::simd::Pack;
use pulp::Simd;

/// Terms.
pub(super) const ORDER: usize = 6;
/// Newton's steps towards a value.
const STEPS: usize = 3;

/// Coefficients of x, x², ...
#[derive(Clone, Copy)]
pub(super) struct Series<S: Simd, const K: usize>(pub [Pack<S, K>; ORDER]);

/// Where a series takes a value.
pub(super) struct Root<S: Simd, const K: usize> {
    pub x: Pack<S, K>,
    /// The slope there, and Newton's last step.
    pub slope: Pack<S, K>,
    pub step: Pack<S, K>,
}

impl<S: Simd, const K: usize> Series<S, K> {
    #[inline(always)]
    pub fn at(&self, x: Pack<S, K>) -> Pack<S, K> {
        let mut sum = self.0[ORDER - 1];
        for k in (0..ORDER - 1).rev() {
            sum = sum.mul_add(x, self.0[k]);
        }
        sum * x
    }

    /// Where it is `value`, beyond `from`, where its slope is `slope`.
    #[inline(always)]
    pub fn reaches(&self, value: Pack<S, K>, from: Pack<S, K>, slope: Pack<S, K>) -> Root<S, K> {
        let rest = value - self.at(from);
        let mut x = from + parabola(slope, self.0[1], rest);
        let mut step = x;
        let mut slope = slope;
        for _ in 0..STEPS {
            let mut sum = self.0[ORDER - 1];
            let mut derivative = Pack::splat(x.simd(), 0.0);
            for k in (0..ORDER - 1).rev() {
                derivative = derivative.mul_add(x, sum);
                sum = sum.mul_add(x, self.0[k]);
            }
            slope = derivative.mul_add(x, sum);
            let off = sum.mul_add(x, -value);
            step = off.eq(0.0).select(0.0, off / slope);
            x = x - step;
        }
        Root { x, slope, step }
    }

    /// Size of what is left out at 1.
    #[inline(always)]
    pub fn rest(&self) -> Pack<S, K> {
        self.0[ORDER - 1].abs() + self.0[ORDER - 2].abs()
    }
}

/// Where bx + cx² = `value`: the root next to 0, or the positive one where b = 0.
#[inline(always)]
pub(super) fn parabola<S: Simd, const K: usize>(
    b: Pack<S, K>,
    c: Pack<S, K>,
    value: Pack<S, K>,
) -> Pack<S, K> {
    let root = b.mul_add(b, 4.0 * c * value).max(0.0).sqrt();
    let sum = b + b.lt(0.0).select(-root, root);
    sum.eq(0.0).select(0.0, 2.0 * value / sum)
}

/// |x| to the power of the first term left out.
#[inline(always)]
pub(super) fn power<S: Simd, const K: usize>(x: Pack<S, K>) -> Pack<S, K> {
    let cube = x * x * x;
    (cube * cube * x).abs()
}
