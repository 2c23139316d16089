//! Counter-based random numbers: functions of (seed, particle, draw) alone, and thus independent of the order of evaluation.
//!
//! J. K. Salmon, M. A. Moraes, R. O. Dror and D. E. Shaw, *Parallel random numbers: as easy as 1, 2, 3*, Proc. SC11 (2011).

use crate::simd::elementary::{ln, sincos_in_lanes};
use crate::simd::{Level, Pack, one};
use pulp::{Simd, WithSimd};
use rand_philox::philox4x32_10;
use std::f64::consts::TAU;

/// A uniform number in [0, 1) with 53 random bits: Philox4x32-10, key = seed, counter = (particle, draw).
pub fn uniform(seed: u64, particle: u64, draw: u32) -> f64 {
    two(words(seed, particle, [draw, 0])).0
}

/// Two uniform numbers in [0, 1) with 53 random bits each, for draw `index` of a sampler: counter = (index, 0, 1), whose last
/// word is 0 for particles.
pub fn pair(seed: u64, index: u64) -> (f64, f64) {
    two(words(seed, index, [0, 1]))
}

/// A uniform number in (0, 1) for an impact of a particle, counted from 0: counter = (particle, impact, 2), whose last word is 0 or 1 for
/// the others.
#[inline(always)]
pub fn of_impact(seed: u64, particle: u64, impact: u64) -> f64 {
    two(words(seed, particle, [impact as u32, 2])).0 + 2.0_f64.powi(-54)
}

/// Two uniform numbers in [0, 1) for a draw of an asperity of a rough body: counter = (asperity, draw, 3).
pub fn of_asperity(seed: u64, asperity: u64, draw: u32) -> (f64, f64) {
    two(words(seed, asperity, [draw, 3]))
}

/// Two uniform numbers in [0, 1) for a draw of some encounters of two bodies, or particles of a gas: counter = (encounter, draw, 4).
pub fn of_encounters(seed: u64, first: u64, draw: u32, numbers: &mut [(f64, f64)]) {
    in_row(seed, first.., [draw, 4], numbers);
}

/// Two uniform numbers in [0, 1) for some candidates of a gas, draw 0, or for their encounters, draws from 1 on: counter = (candidate, draw, 5).
pub fn of_candidates(
    seed: u64,
    candidates: impl Iterator<Item = u64>,
    draw: u32,
    numbers: &mut [(f64, f64)],
) {
    in_row(seed, candidates, [draw, 5], numbers);
}

/// The same for one.
#[inline(always)]
pub fn of_candidate(seed: u64, candidate: u64, draw: u32) -> (f64, f64) {
    two(words(seed, candidate, [draw, 5]))
}

/// Two numbers each for counters that begin with these numbers and end with the same two words.
fn in_row(seed: u64, first: impl Iterator<Item = u64>, rest: [u32; 2], numbers: &mut [(f64, f64)]) {
    Level::best().run(Row {
        seed,
        first,
        rest,
        numbers,
    });
}

/// These numbers, for many counters at once.
struct Row<'a, I> {
    seed: u64,
    first: I,
    rest: [u32; 2],
    numbers: &'a mut [(f64, f64)],
}

impl<I: Iterator<Item = u64>> WithSimd for Row<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        const BLOCK: usize = 64;
        let (mut found, mut counters) = ([[0; 4]; BLOCK], [0; BLOCK]);
        let mut first = self.first;
        for some in self.numbers.chunks_mut(BLOCK) {
            for (counter, number) in counters[..some.len()].iter_mut().zip(&mut first) {
                *counter = number;
            }
            // By itself, this loop is compiled for vectors.
            for (found, &number) in found[..some.len()].iter_mut().zip(&counters) {
                *found = words(self.seed, number, self.rest);
            }
            for (pair, &found) in some.iter_mut().zip(&found) {
                *pair = two(found);
            }
        }
    }
}

/// The numbers that are made of two uniform ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberForm {
    /// Themselves.
    Uniform,
    /// The other one, and sine and cosine of so much of a turn as the one in this place says.
    Turn(usize),
    /// [`normal_pair`].
    Normal,
}

/// Pairs of uniform numbers in a form, as the first two numbers or as all three.
pub fn formed(form: NumberForm, pairs: &[(f64, f64)]) -> Vec<[f64; 3]> {
    let mut numbers: Vec<_> = pairs.iter().map(|&(a, b)| [a, b, 0.0]).collect();
    if form != NumberForm::Uniform {
        Level::best().run(Formed {
            form,
            numbers: &mut numbers,
        });
    }
    numbers
}

/// These forms, for many pairs at once.
struct Formed<'a> {
    form: NumberForm,
    numbers: &'a mut [[f64; 3]],
}

impl WithSimd for Formed<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let place = match self.form {
            NumberForm::Turn(place) => place,
            _ => 1,
        };
        for some in self.numbers.chunks_mut(Pack::<S>::WIDTH) {
            let (mut others, mut turns) = (Pack::splat(simd, 0.0), Pack::splat(simd, 0.0));
            for (lane, numbers) in some.iter().enumerate() {
                others.as_mut_slice()[lane] = numbers[1 - place];
                turns.as_mut_slice()[lane] = numbers[place];
            }
            let all = if self.form == NumberForm::Normal {
                let [first, second] = normals_in_lanes(others, turns);
                [first, second, turns]
            } else {
                let (sine, cosine) = sincos_in_lanes(TAU * turns);
                [others, sine, cosine]
            };
            for (lane, numbers) in some.iter_mut().enumerate() {
                for (number, pack) in numbers.iter_mut().zip(&all) {
                    *number = pack.as_slice()[lane];
                }
            }
        }
    }
}

/// Two normal numbers from two uniform ones in [0, 1), by G. E. P. Box and M. E. Muller (1958).
#[inline(always)]
pub fn normal_pair((size, turn): (f64, f64)) -> (f64, f64) {
    let [first, second] = normals_in_lanes(one(size), one(turn));
    (first.as_slice()[0], second.as_slice()[0])
}

#[inline(always)]
fn normals_in_lanes<S: Simd>(mut size: Pack<S>, turn: Pack<S>) -> [Pack<S>; 2] {
    let (sine, cosine) = sincos_in_lanes(TAU * turn);
    for number in size.as_mut_slice() {
        *number = ln(1.0 - *number);
    }
    let size = (-2.0 * size).sqrt();
    [size * sine, size * cosine]
}

/// The words for the counter of a number and two more words.
#[inline(always)]
fn words(seed: u64, number: u64, [third, last]: [u32; 2]) -> [u32; 4] {
    let halves = |x: u64| [x as u32, (x >> 32) as u32];
    let [low, high] = halves(number);
    philox4x32_10([low, high, third, last], halves(seed))
}

/// Two numbers in [0, 1) out of words.
#[inline(always)]
fn two([a, b, c, d]: [u32; 4]) -> (f64, f64) {
    let unit = |low, high| {
        let bits = u64::from(low) | u64::from(high) << 32;
        (bits >> 11) as f64 * 2.0_f64.powi(-53)
    };
    (unit(a, b), unit(c, d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::elementary::sincos;

    /// The first two words of the generator's authors for counter and key 0 (`kat_vectors` of Random123): the second one is the upper half.
    #[test]
    fn is_the_published_generator() {
        let bits = 0xe169_c58d_6627_e8d5_u64 >> 11;
        assert_eq!(uniform(0, 0, 0), bits as f64 / 2.0_f64.powi(53));
    }

    /// In rows as one by one, also where the lower half of the counter overflows.
    #[test]
    fn rows_are_what_each_is() {
        let first = (1 << 32) - 70;
        let mut numbers = [(0.0, 0.0); 150];
        of_candidates(7, first.., 0, &mut numbers);
        for (number, i) in numbers.into_iter().zip(first..) {
            assert_eq!(number, of_candidate(7, i, 0));
        }
        let some: Vec<_> = (0..150).map(|i| i * i).collect();
        of_candidates(7, some.iter().copied(), 3, &mut numbers);
        for (number, i) in numbers.into_iter().zip(some) {
            assert_eq!(number, of_candidate(7, i, 3));
        }
    }

    /// In every form many are what each is, and normal numbers those of Box and Muller.
    #[test]
    fn forms_are_what_each_is() {
        let pairs: Vec<_> = (0..29).map(|i| pair(7, i)).collect();
        let found = |form| formed(form, &pairs);
        let turns = [found(NumberForm::Turn(0)), found(NumberForm::Turn(1))];
        let (plain, normal) = (found(NumberForm::Uniform), found(NumberForm::Normal));
        for (i, &(a, b)) in pairs.iter().enumerate() {
            assert_eq!(plain[i], [a, b, 0.0]);
            for (turns, other, turn) in [(&turns[0], b, a), (&turns[1], a, b)] {
                let (sine, cosine) = sincos(TAU * turn);
                assert_eq!(turns[i], [other, sine, cosine]);
            }
            let (x, y) = normal_pair((a, b));
            assert_eq!(normal[i][..2], [x, y]);
            let size = (-2.0 * (1.0 - a).ln()).sqrt();
            let (sine, cosine) = (TAU * b).sin_cos();
            assert!((x - size * sine).abs() < 1e-14 && (y - size * cosine).abs() < 1e-14);
        }
    }

    /// 10⁵ numbers: mean and variance within five standard errors, neighbours in any argument uncorrelated.
    #[test]
    fn is_uniform_and_neighbours_are_independent() {
        let n = 100_000_u64;
        let stream = |f: &dyn Fn(u64) -> f64| {
            let x: Vec<f64> = (0..n).map(f).collect();
            let count = n as f64;
            let mean = x.iter().sum::<f64>() / count;
            let variance = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
            let lagged = x
                .windows(2)
                .map(|w| (w[0] - mean) * (w[1] - mean))
                .sum::<f64>()
                / count
                / variance;
            assert!((mean - 0.5).abs() < 5.0 * (1.0 / 12.0 / count).sqrt());
            assert!((variance - 1.0 / 12.0).abs() < 5.0 * (1.0 / 180.0 / count).sqrt());
            assert!(lagged.abs() < 5.0 / count.sqrt());
            assert!(x.iter().all(|x| (0.0..1.0).contains(x)));
        };
        stream(&|i| uniform(7, i, 0));
        stream(&|i| uniform(i, 3, 0));
        stream(&|i| uniform(7, 3, i as u32));
        stream(&|i| uniform(7, i << 32, 0));
        stream(&|i| pair(7, i).0);
        stream(&|i| pair(7, i).1);
        stream(&|i| of_impact(7, i, 0));
        stream(&|i| of_impact(7, 3, i));
        stream(&|i| of_asperity(7, i, 0).0);
        stream(&|i| of_asperity(7, 3, i as u32).1);
        stream(&|i| of_impact(i, 3, 0));
        let encounter = |i, draw| {
            let mut numbers = [(0.0, 0.0)];
            of_encounters(7, i, draw, &mut numbers);
            numbers[0]
        };
        stream(&|i| encounter(i, 0).0);
        stream(&|i| encounter(3, i as u32).1);
        stream(&|i| of_candidate(7, i, 0).0);
        stream(&|i| of_candidate(7, 3, i as u32).1);
        stream(&|i| {
            if i % 2 == 0 {
                pair(7, i / 2).0
            } else {
                pair(7, i / 2).1
            }
        });
    }
}
