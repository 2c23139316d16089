//! Moments as exact integer sums of a rounded quantity.
//!
//! The offset of each value from the origin is rounded once, to a multiple of 2⁻²⁴ ≈ 6·10⁻⁸, or of 2⁻²⁰ if it exceeds 2; its powers
//! are then summed without further rounding, in integers wide enough for 2⁶⁴ values. Merging is therefore associative and commutative
//! to the last bit.

use super::recent::{Extremes, QUANTA};

/// A two's-complement integer of five 64-bit words, low word first: wide enough for Σq⁴ and for what moments are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Wide([u64; 5]);

impl Wide {
    const ZERO: Self = Self([0; 5]);

    fn of(x: i128) -> Self {
        let sign = (x >> 127) as u64;
        Self([x as u64, (x >> 64) as u64, sign, sign, sign])
    }

    fn is_negative(self) -> bool {
        self.0[4] >> 63 == 1
    }

    fn plus(mut self, other: Self) -> Self {
        let mut carry = false;
        for (word, addend) in self.0.iter_mut().zip(other.0) {
            let (sum, first) = word.overflowing_add(addend);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            *word = sum;
            carry = first | second;
        }
        self
    }

    fn negated(self) -> Self {
        Self(self.0.map(|word| !word)).plus(Self::of(1))
    }

    /// The product with a factor, which must fit into the words.
    fn times(self, factor: i64) -> Self {
        let mut carry = 0_u64;
        // Modulo 2³²⁰ the product of the two's complements is the two's complement of the product.
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
        let magnitude = if self.is_negative() {
            self.negated()
        } else {
            self
        };
        let size = magnitude.0.iter().rev().fold(0.0, |sum, &word| {
            f64::mul_add(sum, 18_446_744_073_709_551_616.0, word as f64)
        });
        if self.is_negative() { -size } else { size }
    }
}

/// Σq, Σq², Σq³, Σq⁴ and the extremes of the values in one bin, where q is the offset of a value from an origin, in quanta of 2⁻²⁴.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sums {
    powers: [Wide; 4],
    extremes: Extremes,
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
        powers: [Wide::ZERO; 4],
        extremes: Extremes::EMPTY,
    };

    /// Upper bound on the magnitude of an offset that can be added.
    pub const LARGEST: f64 = 8_589_934_592.0; // 2³³

    /// Adds an offset, in quanta, of any size below [`Sums::LARGEST`].
    pub(super) fn add(&mut self, q: i64) {
        let mut power = Wide::of(1);
        for sum in &mut self.powers {
            power = power.times(q);
            *sum = sum.plus(power);
        }
    }

    /// Adds recent sums of the four powers of offsets that are in multiples of `unit` quanta.
    pub(super) fn absorb(&mut self, recent: [i128; 4], unit: i64) {
        for (power, (sum, recent)) in self.powers.iter_mut().zip(recent).enumerate() {
            let recent = (0..=power).fold(Wide::of(recent), |product, _| product.times(unit));
            *sum = sum.plus(recent);
        }
    }

    /// Adds the extremes of recent values.
    pub(super) fn widen(&mut self, extremes: &Extremes) {
        let own = &mut self.extremes;
        own.minimum = own.minimum.min(extremes.minimum);
        own.maximum = own.maximum.max(extremes.maximum);
    }

    /// Adds the sums of another set of values.
    pub fn merge(&mut self, other: &Self) {
        for (sum, other) in self.powers.iter_mut().zip(other.powers) {
            *sum = sum.plus(other);
        }
        self.widen(&other.extremes);
    }

    /// Calls `visit` with every word, which it may change. Words that the powers of 2⁶⁴ values do not need repeat the sign.
    pub(super) fn words(&mut self, visit: &mut impl FnMut(&mut u64)) {
        for (power, sum) in self.powers.iter_mut().enumerate() {
            let (words, rest) = sum.0.split_at_mut(power + 2);
            words.iter_mut().for_each(&mut *visit);
            rest.fill((words[power + 1] as i64 >> 63) as u64);
        }
        float(&mut self.extremes.minimum, visit);
        float(&mut self.extremes.maximum, visit);
    }

    /// Moments of `number` values whose offsets are relative to `origin`; NaN where there are none.
    pub fn moments(&self, number: u64, origin: f64) -> Moments {
        const UNIT: f64 = 1.0 / QUANTA;
        let n = number as f64;
        // Exact sums of powers about the multiple of a quantum next to the mean, so that no digits cancel afterwards.
        let sums = self.powers;
        let centre = (sums[0].to_f64() / n).round_ties_even() as i64;
        let count = Wide::of(number.into());
        let term = |sum: Wide, binomial: i64, power: u32| {
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
            minimum: or_nan(self.extremes.minimum),
            maximum: or_nan(self.extremes.maximum),
        }
    }
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

    /// One offset q beside its negative, and beside two zeros, of every size, and just where its square no longer fits into 64 bits:
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
