//! Moments as exact integer sums of a rounded quantity.
//!
//! The offset of each value from the origin is rounded once, to a multiple of 2⁻²⁴ ≈ 6·10⁻⁸, or of 2⁻²⁰ if it exceeds 2; its powers
//! are then summed without further rounding, in integers wide enough for 2⁶⁴ values. Merging is therefore associative and commutative
//! to the last bit.

use super::recent::{Extremes, QUANTA, Totals};

/// A two's-complement integer of N 64-bit words, low word first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Wide<const N: usize>([u64; N]);

impl<const N: usize> Wide<N> {
    const ZERO: Self = Self([0; N]);

    /// Adds `value`, whose missing high words are those of its sign (`fill` = 0 or !0).
    #[inline(always)]
    fn add<const M: usize>(&mut self, value: [u64; M], fill: u64) {
        let mut carry = false;
        for (i, word) in self.0.iter_mut().enumerate() {
            let addend = if i < M { value[i] } else { fill };
            let (sum, first) = word.overflowing_add(addend);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            *word = sum;
            carry = first | second;
        }
    }

    /// The same number with six words.
    fn widened(self) -> Wide<6> {
        let mut wide = Wide::ZERO;
        let negative = self.0[N - 1] >> 63 == 1;
        wide.add(self.0, if negative { u64::MAX } else { 0 });
        wide
    }

    fn negated(self) -> Self {
        let mut negated = Self(self.0.map(|word| !word));
        negated.add([1], 0);
        negated
    }

    fn plus(mut self, other: Self) -> Self {
        self.add(other.0, 0);
        self
    }

    /// The product with a factor, which must fit into N words.
    fn times(self, factor: i64) -> Self {
        let mut carry = 0_u64;
        // Modulo 2^(64 N) the product of the two's complements is the two's complement of the product.
        let product = Self(self.0.map(|word| {
            let sum = u128::from(word) * u128::from(factor.unsigned_abs()) + u128::from(carry);
            carry = (sum >> 64) as u64;
            sum as u64
        }));
        if factor < 0 {
            product.negated()
        } else {
            product
        }
    }

    /// The nearest double, up to a few units in the last place.
    fn to_f64(self) -> f64 {
        let negative = self.0[N - 1] >> 63 == 1;
        let magnitude = if negative { self.negated() } else { self };
        let size = magnitude.0.iter().rev().fold(0.0, |sum, &word| {
            f64::mul_add(sum, 18_446_744_073_709_551_616.0, word as f64)
        });
        if negative { -size } else { size }
    }
}

/// Σq, Σq², Σq³, Σq⁴ and the extremes of the values in one bin, where q is the offset of a value from an origin, in quanta of 2⁻²⁴.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sums {
    first: Wide<2>,
    second: Wide<3>,
    third: Wide<4>,
    fourth: Wide<5>,
    minimum: f64,
    maximum: f64,
}

/// Moments of the values in a bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Second central moment.
    pub variance: f64,
    /// Third central moment over the variance to the power 3/2; NaN where the variance is 0.
    pub skewness: f64,
    /// Fourth central moment over the variance squared (3 for a Gaussian); NaN where the variance is 0.
    pub kurtosis: f64,
    /// Smallest value.
    pub minimum: f64,
    /// Largest value.
    pub maximum: f64,
}

impl Sums {
    /// The sums of no values.
    pub const EMPTY: Self = Self {
        first: Wide::ZERO,
        second: Wide::ZERO,
        third: Wide::ZERO,
        fourth: Wide::ZERO,
        minimum: f64::INFINITY,
        maximum: f64::NEG_INFINITY,
    };

    /// Upper bound on the magnitude of an offset that can be added.
    pub const LARGEST: f64 = 8_589_934_592.0; // 2³³

    /// Adds an offset, in quanta, of any size below [`Sums::LARGEST`].
    pub(super) fn add(&mut self, q: i64) {
        let sign = (q >> 63) as u64;
        let size = q.unsigned_abs();
        if size < 1 << 32 {
            let square = size * size;
            let [third, fourth] = [size, square].map(|x| u128::from(square) * u128::from(x));
            let third = if sign == 0 {
                third
            } else {
                third.wrapping_neg()
            };
            self.first.add([q as u64], sign);
            self.second.add([square], 0);
            self.third.add(words(third), sign);
            self.fourth.add(words(fourth), 0);
        } else {
            self.add_wide(q, size);
        }
    }

    /// The same for an offset whose square does not fit into one word.
    #[cold]
    fn add_wide(&mut self, q: i64, size: u64) {
        let sign = (q >> 63) as u64;
        let square = u128::from(size) * u128::from(size);
        let (low, high) = (square as u64, (square >> 64) as u64);
        self.first.add([q as u64], sign);
        self.second.add([low, high], 0);
        let product = |a: u64, b: u64| u128::from(a) * u128::from(b);
        let mut cube = Wide([0_u64; 4]);
        cube.add(words(product(low, size)), 0);
        cube.add(shifted(product(high, size), 1), 0);
        if sign != 0 {
            cube = cube.negated();
        }
        self.third.add(cube.0, sign);
        self.fourth.add(words(product(low, low)), 0);
        self.fourth.add(shifted(product(low, high), 1), 0);
        self.fourth.add(shifted(product(low, high), 1), 0);
        self.fourth.add(shifted(product(high, high), 2), 0);
    }

    /// Adds recent sums, whose offsets are in multiples of `unit` quanta.
    pub(super) fn absorb(&mut self, recent: &Totals, unit: i64) {
        let power = |sum: i128, power: u32| {
            let sum = Wide(words(sum as u128)).widened();
            (0..power).fold(sum, |product, _| product.times(unit))
        };
        self.first.add(power(recent.first.into(), 1).0, 0);
        self.second.add(power(recent.second.into(), 2).0, 0);
        self.third.add(power(recent.third, 3).0, 0);
        self.fourth.add(power(recent.fourth, 4).0, 0);
    }

    /// Adds the extremes of recent values.
    pub(super) fn widen(&mut self, extremes: &Extremes) {
        self.minimum = self.minimum.min(extremes.minimum);
        self.maximum = self.maximum.max(extremes.maximum);
    }

    /// Adds the sums of another set of values.
    pub fn merge(&mut self, other: &Self) {
        self.first.add(other.first.0, 0);
        self.second.add(other.second.0, 0);
        self.third.add(other.third.0, 0);
        self.fourth.add(other.fourth.0, 0);
        self.minimum = self.minimum.min(other.minimum);
        self.maximum = self.maximum.max(other.maximum);
    }

    /// Calls `visit` with every word, which it may change.
    pub(super) fn words(&mut self, visit: &mut impl FnMut(&mut u64)) {
        self.first.0.iter_mut().for_each(&mut *visit);
        self.second.0.iter_mut().for_each(&mut *visit);
        self.third.0.iter_mut().for_each(&mut *visit);
        self.fourth.0.iter_mut().for_each(&mut *visit);
        for extreme in [&mut self.minimum, &mut self.maximum] {
            float(extreme, visit);
        }
    }

    /// Moments of `number` values whose offsets are relative to `origin`; NaN where there are none.
    pub fn moments(&self, number: u64, origin: f64) -> Moments {
        const UNIT: f64 = 1.0 / QUANTA;
        let n = number as f64;
        // Exact sums of powers about the multiple of a quantum next to the mean, so that no digits cancel afterwards.
        let centre = (self.first.to_f64() / n).round_ties_even() as i64;
        let count = Wide([number, 0]).widened();
        let sums = [
            self.first.widened(),
            self.second.widened(),
            self.third.widened(),
            self.fourth.widened(),
        ];
        let term = |sum: Wide<6>, binomial: i64, power: u32| {
            (0..power).fold(sum.times(binomial), |product, _| product.times(-centre))
        };
        let first = sums[0].plus(term(count, 1, 1));
        let second = sums[1].plus(term(sums[0], 2, 1)).plus(term(count, 1, 2));
        let third = sums[2]
            .plus(term(sums[1], 3, 1))
            .plus(term(sums[0], 3, 2))
            .plus(term(count, 1, 3));
        let fourth = sums[3]
            .plus(term(sums[2], 4, 1))
            .plus(term(sums[1], 6, 2))
            .plus(term(sums[0], 4, 3))
            .plus(term(count, 1, 4));
        let a = UNIT * (first.to_f64() / n);
        let b = UNIT.powi(2) * (second.to_f64() / n);
        let c = UNIT.powi(3) * (third.to_f64() / n);
        let d = UNIT.powi(4) * (fourth.to_f64() / n);
        // Central moments; the mean is less than one quantum away.
        let variance = (b - a * a).max(0.0);
        let third = c - a * (3.0 * b - 2.0 * a * a);
        let fourth = d - a * (4.0 * c - a * (6.0 * b - 3.0 * a * a));
        let or_nan = |x: f64| if number > 0 { x } else { f64::NAN };
        let spread = |x: f64| if variance > 0.0 { x } else { f64::NAN };
        Moments {
            mean: origin + (UNIT * centre as f64 + a),
            variance: or_nan(variance),
            skewness: spread(third / (variance * variance.sqrt())),
            kurtosis: spread(fourth / (variance * variance)),
            minimum: or_nan(self.minimum),
            maximum: or_nan(self.maximum),
        }
    }
}

fn words(x: u128) -> [u64; 2] {
    [x as u64, (x >> 64) as u64]
}

/// The words of x · 2^(64 · places).
fn shifted(x: u128, places: usize) -> [u64; 4] {
    let mut out = [0; 4];
    out[places] = x as u64;
    out[places + 1] = (x >> 64) as u64;
    out
}

/// Calls `visit` with the bits of a number.
pub(super) fn float(number: &mut f64, visit: &mut impl FnMut(&mut u64)) {
    let mut bits = number.to_bits();
    visit(&mut bits);
    *number = f64::from_bits(bits);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One offset q beside its negative, and beside two zeros, of every size, and just where its square no longer fits into a word:
    /// variances q² and 2q²/9, skewnesses 0 and ±1/√2, kurtoses 1 and 3/2.
    #[test]
    fn offsets_of_every_size_are_summed_alike() {
        for size in [
            1,
            3,
            (1 << 32) - 1,
            1 << 32,
            (1 << 32) + 1,
            1 << 40,
            1 << 56,
        ] {
            for q in [size, -size] {
                let moments = |values: &[i64]| {
                    let mut sums = Sums::EMPTY;
                    values.iter().for_each(|&value| sums.add(value));
                    sums.moments(values.len() as u64, 0.0)
                };
                let near = |found: f64, expected: f64| {
                    assert!((found - expected).abs() <= 1e-13, "{found} {expected} {q}");
                };
                let square = (q as f64 / QUANTA).powi(2);
                let pair = moments(&[q, -q]);
                assert_eq!((pair.mean, pair.skewness), (0.0, 0.0));
                near(pair.variance / square, 1.0);
                near(pair.kurtosis, 1.0);
                let alone = moments(&[q, 0, 0]);
                near(alone.mean * QUANTA / q as f64, 1.0 / 3.0);
                near(alone.variance / square, 2.0 / 9.0);
                near(alone.skewness, q.signum() as f64 * 0.5_f64.sqrt());
                near(alone.kurtosis, 1.5);
            }
        }
    }
}
