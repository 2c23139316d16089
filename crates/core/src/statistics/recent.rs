//! Sums of a limited number of values in words of 64 bits, to which the inner loop adds.
//!
//! An integer k that is added to 1.5·2⁵², or to that times a power of two, appears in the low bits of the result. These bits are
//! added as they are, modulo 2⁶⁴, and the contribution of 1.5·2⁵² is subtracted when the sums are read. Powers with too many digits
//! for one word are split into two parts, which a fused multiply-add separates exactly.

use super::whole::ROUND;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Number of quanta in a unit of ε.
pub(super) const QUANTA: f64 = 16_777_216.0; // 2²⁴
/// Largest offset that is rounded to single quanta: q has at most 25 bits, and its powers have at most 50, 75 and 100.
pub(super) const LARGEST: f64 = 2.0;
/// Number of quanta to which larger offsets are rounded. Offsets up to this many times [`LARGEST`] are summed in the same way, in
/// separate sums.
pub(super) const COARSE: i64 = 16;
/// Number of quanta in a unit of E_rot/E_tot.
pub(super) const FRACTION_QUANTA: f64 = 4_398_046_511_104.0; // 2⁴²
/// Largest number of values in a sum, to each word of which a value adds at most 2⁵⁰.
pub(super) const MOST: u64 = 4096;

/// Units of the high parts of q³ and q⁴.
const CUBIC: f64 = 33_554_432.0; // 2²⁵
const QUARTIC: f64 = 1_125_899_906_842_624.0; // 2⁵⁰

/// A binary 1 that counts a value with which energy was created.
const GAIN: u64 = 1 << 32;

/// Half of the contributions of a value: q, q², q³ high and low; or q⁴ high and low, E_rot/E_tot, and a binary number that counts
/// the value, and from bit 32 on counts it if energy was created.
pub(super) type Half = [f64; 4];

/// Both halves for an offset of ε from its origin, with `quanta` quanta in a unit, for E_rot/E_tot, and for whether energy was
/// created.
#[inline(always)]
pub(super) fn words<S: Simd>(
    offset: Pack<S>,
    quanta: Pack<S>,
    fraction: Pack<S>,
    gaining: Mask<S>,
) -> [[Pack<S>; 4]; 2] {
    let first = offset.mul_add(quanta, ROUND);
    let q = first - ROUND;
    let square = q * q;
    let cube = square.mul_add(q, CUBIC * ROUND);
    let rest_of_cube = square.mul_add(q, CUBIC * ROUND - cube);
    let fourth = square.mul_add(square, QUARTIC * ROUND);
    let rest_of_fourth = square.mul_add(square, QUARTIC * ROUND - fourth);
    [
        [first, square + ROUND, cube, rest_of_cube + ROUND],
        [
            fourth,
            rest_of_fourth + ROUND,
            fraction.mul_add(FRACTION_QUANTA, ROUND),
            gaining.select(f64::from_bits(1 | GAIN), f64::from_bits(1)),
        ],
    ]
}

/// An offset of ε from its origin, in quanta, that is too large to be summed like the others.
#[inline(always)]
pub(super) fn quanta(offset: f64) -> i64 {
    let q = offset * (QUANTA / COARSE as f64); // exact
    COARSE
        * if q.abs() < FEW {
            counted(q)
        } else {
            q.round_ties_even() as i64
        }
}

/// E_rot/E_tot in its quanta.
#[inline(always)]
pub(super) fn fraction_quanta(fraction: f64) -> i64 {
    counted(fraction * FRACTION_QUANTA)
}

/// Bound below which adding [`ROUND`] rounds a number to an integer.
const FEW: f64 = 1_125_899_906_842_624.0; // 2⁵⁰

/// A number below [`FEW`], rounded to an integer.
#[inline(always)]
fn counted(x: f64) -> i64 {
    (x + ROUND).to_bits() as i64 - ROUND.to_bits() as i64
}

/// Sums over up to [`MOST`] values.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Recent([u64; 8]);

/// The same as plain numbers.
pub(super) struct Totals {
    /// Σq, Σq², Σq³, Σq⁴.
    pub powers: [i128; 4],
    /// Σ E_rot/E_tot.
    pub fractions: u64,
    /// Number of values with which energy was created.
    pub gains: u64,
}

impl Recent {
    pub const EMPTY: Self = Self([0; 8]);

    /// Adds the contributions of a value, and returns whether it was the last for which there is room.
    #[inline(always)]
    pub fn add(&mut self, low: &Half, high: &Half) -> bool {
        // All words are read before any is written, so that they can be added as vectors.
        let sums: [u64; 8] = std::array::from_fn(|i| {
            self.0[i].wrapping_add(if i < 4 { low[i] } else { high[i - 4] }.to_bits())
        });
        self.0 = sums;
        sums[7] % GAIN == MOST
    }

    /// The sums.
    pub fn totals(&self) -> Totals {
        let (number, gains) = (self.0[7] % GAIN, self.0[7] / GAIN);
        let sum = |word: usize, unit: f64| {
            let offset = (unit * ROUND).to_bits();
            self.0[word].wrapping_sub(offset.wrapping_mul(number)) as i64
        };
        let joined = |high: usize, unit: f64| {
            i128::from(sum(high, unit)) * unit as i128 + i128::from(sum(high + 1, 1.0))
        };
        Totals {
            powers: [
                sum(0, 1.0).into(),
                (sum(1, 1.0) as u64).into(),
                joined(2, CUBIC),
                joined(4, QUARTIC),
            ],
            fractions: sum(6, 1.0) as u64,
            gains,
        }
    }
}

/// The smallest and the largest of the recent values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extremes {
    pub minimum: f64,
    pub maximum: f64,
}

impl Extremes {
    pub const EMPTY: Self = Self {
        minimum: f64::INFINITY,
        maximum: f64::NEG_INFINITY,
    };

    /// Updates the extremes. They are written only when they change, which is rare.
    #[inline(always)]
    pub fn add(&mut self, value: f64) {
        if value < self.minimum {
            self.minimum = value;
        }
        if value > self.maximum {
            self.maximum = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::one;

    /// Sums of the largest values there are, of either sign, with energy created or not, are exact until there is no room left, and
    /// the last value for which there is room says so.
    #[test]
    fn sums_are_exact_as_long_as_there_is_room() {
        for (offset, fraction, gaining) in [
            (LARGEST, 1.0, true),
            (-LARGEST, 1.0, false),
            (-1.25, 0.5, true),
        ] {
            let gains = one(if gaining { 1.0 } else { 0.0 }).eq(1.0);
            let halves = words(one(offset), one(QUANTA), one(fraction), gains);
            let [low, high] = halves.map(|half| half.map(|word| word.as_slice()[0]));
            let q = (offset * QUANTA) as i128;
            let mut sums = Recent::EMPTY;
            for number in 1..=MOST {
                assert_eq!(sums.add(&low, &high), number == MOST, "{number}");
                let count = i128::from(number);
                let totals = sums.totals();
                assert_eq!(
                    totals.powers,
                    [1, 2, 3, 4].map(|power| count * q.pow(power))
                );
                let quanta = count * (fraction * FRACTION_QUANTA) as i128;
                assert_eq!(i128::from(totals.fractions), quanta);
                assert_eq!(totals.gains, if gaining { number } else { 0 });
            }
        }
    }
}
