//! What the hot loop adds to: the sums of a limited number of values, in eight words that fill a line of the cache.
//!
//! A whole number k that is added to 1.5·2⁵², or to a multiple of it, stands in the low bits of the result. Such bits are
//! added as they are, modulo 2⁶⁴, and what the 1.5·2⁵² contribute is taken off when the sums are read. Powers that have too many
//! digits for one word are in two parts, which a fused multiply-add separates without an error.

use super::axis::ROUND;
use super::moments::QUANTA;
use crate::lanes::Pack;
use pulp::Simd;

/// Largest offset of a value: its q has at most 25 bits, and its powers have at most 50, 75 and 100.
pub(super) const LARGEST: f64 = 2.0;
/// Quanta of E_rot/E_tot.
pub(super) const FRACTION_QUANTA: f64 = 4_398_046_511_104.0; // 2⁴²

/// Units of the high parts of q³ and q⁴.
const CUBIC: f64 = 33_554_432.0; // 2²⁵
const QUARTIC: f64 = 1_125_899_906_842_624.0; // 2⁵⁰
/// The last word adds this and the number of the row for each value, so that it tells how many they are.
const ONE: f64 = 274_877_906_944.0; // 2³⁸
/// Set in the last word when there are [`MOST`] values, each of at most 51 bits in every word.
const FULL: u64 = MOST * ONE as u64;
const MOST: u64 = 4096;

/// Half of a record: [q, q², q³ high, q³ low] or [q⁴ high, q⁴ low, E_rot/E_tot, row].
pub(super) type Half = [u64; 4];

/// What the lanes add to their rows.
pub(super) struct Addends<S: Simd, const K: usize> {
    low: [Pack<S, K>; 4],
    high: [Pack<S, K>; 4],
}

impl<S: Simd, const K: usize> Addends<S, K> {
    /// From the offset of ε from its origin and E_rot/E_tot; `row` is the number of the row plus [`ROUND`].
    #[inline(always)]
    pub fn new(offset: Pack<S, K>, fraction: Pack<S, K>, row: Pack<S, K>) -> Self {
        let first = offset.mul_add(QUANTA, ROUND);
        let q = first - ROUND;
        let square = q * q;
        let cube = square.mul_add(q, CUBIC * ROUND);
        let rest_of_cube = square.mul_add(q, CUBIC * ROUND - cube);
        let fourth = square.mul_add(square, QUARTIC * ROUND);
        let rest_of_fourth = square.mul_add(square, QUARTIC * ROUND - fourth);
        Self {
            low: [first, square + ROUND, cube, rest_of_cube + ROUND],
            high: [
                fourth,
                rest_of_fourth + ROUND,
                fraction.mul_add(FRACTION_QUANTA, ROUND),
                row + ONE,
            ],
        }
    }

    /// Calls `add` with the row and the halves of every lane's record, in an order of its own.
    #[inline(always)]
    pub fn each(self, mut add: impl FnMut(usize, &Half, &Half)) {
        let (low, high) = (Pack::records(self.low), Pack::records(self.high));
        for k in 0..K {
            let low: &[Half] = pulp::bytemuck::cast_slice(&low[k]);
            let high: &[Half] = pulp::bytemuck::cast_slice(&high[k]);
            for (low, high) in low.iter().zip(high) {
                add(high[3] as u32 as usize, low, high); // the low half of ROUND + ONE is empty
            }
        }
    }
}

/// Sums over up to [`MOST`] values of a row.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Recent([u64; 8]);

/// The same as plain numbers.
pub(super) struct Totals {
    /// Σq, Σq², Σq³, Σq⁴.
    pub first: i64,
    pub second: i64,
    pub third: i128,
    pub fourth: i128,
    /// Σ E_rot/E_tot.
    pub fractions: u64,
}

impl Recent {
    pub const EMPTY: Self = Self([0; 8]);

    /// Whether there is no room for another record.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.0[7] & FULL != 0
    }

    /// Adds a record.
    #[inline(always)]
    pub fn add(&mut self, low: &Half, high: &Half) {
        for i in 0..4 {
            self.0[i] = self.0[i].wrapping_add(low[i]);
        }
        for i in 0..4 {
            self.0[4 + i] = self.0[4 + i].wrapping_add(high[i]);
        }
    }

    /// The sums in row number `row`.
    pub fn totals(&self, row: usize) -> Totals {
        let round = ROUND.to_bits();
        let number = (self.0[7] % (2 * FULL)) / (ONE as u64 + row as u64);
        let sum = |word: usize, unit: f64| {
            let offset = (unit * ROUND).to_bits();
            self.0[word].wrapping_sub(offset.wrapping_mul(number)) as i64
        };
        let joined = |high: usize, unit: f64| {
            i128::from(sum(high, unit)) * unit as i128 + i128::from(sum(high + 1, 1.0))
        };
        debug_assert!(round.trailing_zeros() == 51, "the last word's count is clean");
        Totals {
            first: sum(0, 1.0),
            second: sum(1, 1.0),
            third: joined(2, CUBIC),
            fourth: joined(4, QUARTIC),
            fractions: sum(6, 1.0) as u64,
        }
    }
}
