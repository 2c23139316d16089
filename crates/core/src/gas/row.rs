//! Candidates of a gas, drawn a row at a time.

use crate::random::of_candidates;
use crate::simd::Level;
use pulp::{Simd, WithSimd};

/// Candidates of a row.
pub(super) const ROW: usize = 64;

/// Parts of the majorant of u.
const PARTS: f64 = 32768.0;
/// The bound of a particle that is of a candidate that waits.
pub(super) const WAITS: u16 = u16::MAX;

/// More than the speed of a particle, of which the square is given, in [`PARTS`] of the majorant of u; or more than all of them.
#[inline(always)]
pub(super) fn bound(square: f64, fastest: f64) -> u16 {
    const MOST: f32 = (WAITS - 3) as f32;
    // The reciprocal is the same for all, and is found once where this is in a loop.
    let share = square * (1.0 / (fastest * fastest));
    let part = (share as f32).sqrt() * (PARTS as f32 * (1.0 + 4.0 * f32::EPSILON));
    let part = if part < MOST { part } else { MOST };
    // Rounded to a whole number, the last bits of 2²³ + it.
    (part + 2.0_f32.powi(23)).to_bits() as u16 + 1
}

/// Successive candidates: of each the two particles, and what decides whether they meet.
pub(super) struct CandidateRow {
    /// The number of the first.
    number: u64,
    pairs: [[u32; ROW]; 2],
    chances: [f64; ROW],
    /// The number that decides, in [`PARTS`], rounded down.
    parts: [u32; ROW],
}

impl CandidateRow {
    /// That of no candidates.
    pub const NONE: Self = Self {
        number: u64::MAX,
        pairs: [[0; ROW]; 2],
        chances: [0.0; ROW],
        parts: [0; ROW],
    };

    /// The candidate in a place, with what decides it as it is, and in [`PARTS`], rounded down.
    #[inline(always)]
    pub fn get(&self, place: usize) -> ([usize; 2], f64, u32) {
        let [first, second] = &self.pairs;
        let pair = [first[place] as usize, second[place] as usize];
        (pair, self.chances[place], self.parts[place])
    }

    /// Draws the row that begins with this number, of so many particles, if it is not there.
    #[inline(always)]
    pub fn draw(&mut self, seed: u64, number: u64, particles: usize) {
        if self.number != number {
            self.number = number;
            let row = self;
            Level::best().run(DrawnCandidates {
                row,
                seed,
                particles,
            });
        }
    }
}

/// A whole number below 2³²: the last bits of 2⁵² + x are those of x.
#[inline(always)]
fn whole(x: f64) -> u32 {
    (x + 2.0_f64.powi(52)).to_bits() as u32
}

/// A row that is to be drawn.
struct DrawnCandidates<'a> {
    row: &'a mut CandidateRow,
    seed: u64,
    particles: usize,
}

impl WithSimd for DrawnCandidates<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut numbers = [(0.0, 0.0); ROW];
        of_candidates(self.seed, self.row.number.., 0, &mut numbers);
        let others = (self.particles - 1) as f64;
        let pairs = (others + 1.0) * others;
        let [first, second] = &mut self.row.pairs;
        // By itself, this loop is compiled for vectors. All are whole numbers, exact below 2⁵³.
        for (k, &(which, chance)) in numbers.iter().enumerate() {
            let place = (which * pairs).floor();
            let i = (place / others).floor();
            let i = if i * others > place { i - 1.0 } else { i };
            let j = place - i * others;
            let j = if j < i { j } else { j + 1.0 };
            first[k] = whole(i);
            second[k] = whole(j);
            self.row.chances[k] = chance;
            self.row.parts[k] = whole((PARTS * chance).floor());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::of_candidate;

    /// Of two particles as whole numbers say it, and no two of a pair are the same.
    #[test]
    fn a_row_is_of_pairs_in_their_order() {
        for particles in [2, 3, 1000, 50_000_000] {
            let mut row = CandidateRow::NONE;
            row.draw(7, 128, particles);
            for place in 0..ROW {
                let (which, chance) = of_candidate(7, 128 + place as u64, 0);
                let others = particles as u64 - 1;
                let pair = (which * (particles as u64 * others) as f64) as u64;
                let (i, j) = (pair / others, pair % others);
                let j = if j < i { j } else { j + 1 };
                let pair = [i as usize, j as usize];
                assert_eq!(row.get(place), (pair, chance, (PARTS * chance) as u32));
            }
        }
    }

    /// Bounds are more than speeds, by one and a half parts and rounding at most, and those of the fastest more than any part.
    #[test]
    fn bounds_are_more_than_speeds() {
        for i in 0..100_000 {
            let speed = 2.5 * crate::random::uniform(7, i, 0);
            let bound = f64::from(bound(speed * speed, 1.0));
            let exact = PARTS * speed;
            assert!(bound > exact.min(PARTS) && bound < f64::from(WAITS));
            assert!(bound < exact * 1.000_001 + 1.51);
        }
    }
}
