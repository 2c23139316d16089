//! Power series in x, one in each lane, and where they take a value.

use crate::simd::Pack;
use pulp::Simd;

/// Terms.
pub(super) const ORDER: usize = 6;
/// Newton's steps towards a value.
const STEPS: usize = 2;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::one;
    use pulp::Scalar;

    fn series(terms: [f64; ORDER]) -> Series<Scalar, 1> {
        Series(terms.map(one))
    }

    fn value(x: Pack<Scalar, 1>) -> f64 {
        x.as_slice()[0]
    }

    /// Polynomials of the sixth degree, whose slopes change by a fifth up to there.
    #[test]
    fn a_polynomial_takes_its_value_where_it_does() {
        for (terms, x) in [
            ([1.0, -0.2, 0.05, 0.02, -0.01, 0.01], 0.5),
            ([1.5, 0.1, 0.1, 0.1, 0.1, 0.1], 0.5_f64),
            ([-1.2, 0.1, 0.1, 0.0, 0.1, -0.1], -0.5),
        ] {
            let target: f64 = (0..ORDER).map(|k| terms[k] * x.powi(k as i32 + 1)).sum();
            let slope: f64 = (0..ORDER)
                .map(|k| (k + 1) as f64 * terms[k] * x.powi(k as i32))
                .sum();
            let path = series(terms);
            assert!((value(path.at(one(x))) - target).abs() < 1e-15);
            let root = path.reaches(one(target), one(0.0), one(terms[0]));
            let step = value(root.step);
            assert!(step.abs() < 1e-4 && (value(root.x) - x).abs() < step * step + 1e-15);
            assert!((value(root.slope) - slope).abs() < 1e-4);
        }
    }

    /// Just beyond an extremum two roots are close together, and Newton's steps must begin at the one that is ahead; for a
    /// parabola the first guess is the root.
    #[test]
    fn a_root_beyond_an_extremum_is_the_one_ahead() {
        let path = series([-1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        let lowest = one(0.5);
        for ahead in [1e-4, 1e-3, 0.1] {
            let target = path.at(lowest) + ahead * ahead;
            let root = path.reaches(target, lowest, one(0.0));
            assert!((value(root.x) - 0.5 - ahead).abs() < 1e-12, "{ahead}");
            assert!(value(root.step).abs() < 1e-11);
        }
    }

    #[test]
    fn what_is_left_out_grows_with_the_seventh_power() {
        let path = series([1.0, 2.0, 4.0, 8.0, -16.0, 32.0]);
        assert_eq!(value(path.rest()), 48.0);
        assert_eq!(value(power(one(2.0))), 128.0);
        assert_eq!(value(power(one(3.0))), 2187.0);
        assert_eq!(value(power(one(-2.0))), 128.0);
    }
}
