//! A function at the nodes of the quadrature, and its integrals.

use super::nodes::{
    EVEN_COEFFICIENTS, EVEN_POWERS, EVEN_VALUES, HALF, ODD_COEFFICIENTS, ODD_POWERS, ODD_VALUES,
};
use super::polynomial::{Polynomial, TERMS};
use crate::simd::Pack;
use pulp::Simd;

/// Values at the nodes ξ > 0, and at their mirror images.
#[derive(Clone, Copy)]
pub(super) struct Values<S: Simd, const K: usize> {
    pub right: [Pack<S, K>; HALF],
    pub left: [Pack<S, K>; HALF],
}

impl<S: Simd, const K: usize> Values<S, K> {
    #[inline(always)]
    pub fn new(zero: Pack<S, K>) -> Self {
        Self {
            right: [zero; HALF],
            left: [zero; HALF],
        }
    }

    /// Sums and differences over pairs of nodes.
    #[inline(always)]
    fn parity(&self) -> ([Pack<S, K>; HALF], [Pack<S, K>; HALF]) {
        let (mut sums, mut differences) = (self.right, self.right);
        for j in 0..HALF {
            sums[j] = self.right[j] + self.left[j];
            differences[j] = self.right[j] - self.left[j];
        }
        (sums, differences)
    }

    /// The integral from −1 as a polynomial.
    #[inline(always)]
    pub fn integral(&self) -> Polynomial<S, K> {
        let (sums, differences) = self.parity();
        let (mut odd, mut even) = (sums, sums);
        for k in 0..HALF {
            odd[k] = row(&ODD_COEFFICIENTS[k], &sums);
            even[k] = row(&EVEN_COEFFICIENTS[k], &differences);
        }
        let zero = Pack::splat(sums[0].simd(), 0.0);
        let mut terms = [zero; TERMS];
        for i in (0..HALF).rev() {
            let (mut a, mut b) = (
                odd[HALF - 1] * ODD_POWERS[i][HALF - 1],
                even[HALF - 1] * EVEN_POWERS[i][HALF - 1],
            );
            for k in (i..HALF - 1).rev() {
                a = odd[k].mul_add(ODD_POWERS[i][k], a);
                b = even[k].mul_add(EVEN_POWERS[i][k], b);
            }
            (terms[2 * i + 1], terms[2 * i + 2]) = (a, b);
            terms[0] = terms[0] + (a - b);
        }
        Polynomial(terms)
    }

    /// The integral over all of it.
    #[inline(always)]
    pub fn whole(&self) -> Pack<S, K> {
        2.0 * row(&ODD_VALUES[HALF], &self.parity().0)
    }

    /// The integral from −1 to the nodes.
    #[inline(always)]
    pub fn running(&self) -> Self {
        let (sums, differences) = self.parity();
        let start = row(&ODD_VALUES[HALF], &sums) - row(&EVEN_VALUES[HALF], &differences);
        let mut values = *self;
        for i in 0..HALF {
            let odd = row(&ODD_VALUES[i], &sums);
            let even = row(&EVEN_VALUES[i], &differences) + start;
            values.right[i] = even + odd;
            values.left[i] = even - odd;
        }
        values
    }
}

#[inline(always)]
fn row<S: Simd, const K: usize>(row: &[f64; HALF], values: &[Pack<S, K>; HALF]) -> Pack<S, K> {
    let mut sum = values[0] * row[0];
    for j in 1..HALF {
        sum = values[j].mul_add(row[j], sum);
    }
    sum
}

/// y₀/g at the nodes.
#[inline(always)]
pub(super) fn ratios<S: Simd, const K: usize>(y: Pack<S, K>, g: &Values<S, K>) -> Values<S, K> {
    let mut values = *g;
    for j in 0..HALF {
        // One division for both.
        let inverse = y / (g.right[j] * g.left[j]);
        values.right[j] = inverse * g.left[j];
        values.left[j] = inverse * g.right[j];
    }
    values
}
