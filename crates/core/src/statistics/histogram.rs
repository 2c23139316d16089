//! The statistics of a run: grids of counts, and sums, whose size depends on the bins alone.

use super::bins::{Bins, WHAT};
use super::moments::float;
use super::rows::Rows;
use crate::Error;
use crate::memory::{empty, zeros};
use bytemuck_alloc::allocation::cast_vec;

/// Why a lock on the histogram that threads share is never poisoned.
pub(crate) const UNSPOILT: &str = "no thread panics while it adds to the histogram";
/// Number of sites that are examined together when grids are merged: most sites of a fine grid are empty, and pages that are never
/// written to take no memory.
const PART: usize = 512;

/// Counts and sums of the impacts of any number of particles. Histograms with the same bins merge exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Impacts by row and bin of ε; the last column counts those for which ε is not finite or |ε| is at least 2³³.
    pub restitution: Grid,
    /// Impacts by row and bin of E_rot/E_tot; the last column as above. It has no columns if [`Bins::fraction`] is `None`.
    pub fraction: Grid,
    /// The other sums over the same impacts.
    pub rows: Rows,
}

/// A grid of counts.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    columns: usize,
    pub(super) counts: Vec<u64>,
}

impl Grid {
    fn new(rows: usize, columns: usize) -> Result<Self, Error> {
        let counts = zeros(WHAT, rows * columns)?;
        Ok(Self { columns, counts })
    }

    /// A copy, which takes no memory for parts without impacts.
    pub(super) fn copied(&self) -> Result<Self, Error> {
        let mut copy = Self {
            columns: self.columns,
            counts: zeros(WHAT, self.counts.len())?,
        };
        copy.merge(self);
        Ok(copy)
    }

    /// The counts, row by row, as signed integers for NumPy.
    pub fn into_counts(self) -> Vec<i64> {
        cast_vec(self.counts)
    }

    /// Number of columns: one below the bins, the bins, one above, and one for undefined values.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The counts, row by row.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Moves recent counts here, and reports how many of them have defined values, for each row that has any.
    pub(super) fn absorb(&mut self, recent: &mut [u32], mut report: impl FnMut(usize, u64)) {
        let columns = self.columns;
        let rows = self.counts.chunks_mut(columns);
        for (row, (counts, recent)) in rows.zip(recent.chunks_mut(columns)).enumerate() {
            let undefined = recent[columns - 1];
            let mut number = 0;
            let parts = counts.chunks_mut(PART).zip(recent.chunks_mut(PART));
            for (counts, recent) in
                parts.filter(|(_, recent)| recent.iter().any(|&count| count > 0))
            {
                for (count, recent) in counts.iter_mut().zip(recent) {
                    let recent = u64::from(std::mem::take(recent));
                    *count += recent;
                    number += recent;
                }
            }
            if number > 0 {
                report(row, number - u64::from(undefined));
            }
        }
    }

    fn merge(&mut self, other: &Self) {
        let parts = self.counts.chunks_mut(PART).zip(other.counts.chunks(PART));
        for (counts, others) in parts.filter(|(_, others)| others.iter().any(|&count| count > 0)) {
            for (count, other) in counts.iter_mut().zip(others) {
                *count += other;
            }
        }
    }

    /// Number of impacts with defined values in each row.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u64> {
        let defined = |row: &[u64]| {
            let counts = row[..row.len() - 1].iter();
            counts.fold(0_u64, |sum, &count| sum.wrapping_add(count))
        };
        self.counts.chunks(self.columns).map(defined)
    }
}

impl Histogram {
    /// A histogram of no impacts, whose sums are relative to `origin`.
    pub fn new(bins: &Bins, origin: f64) -> Result<Self, Error> {
        let rows = bins.rows();
        let columns = bins.fraction.as_ref().map_or(0, |axis| axis.bins() + 1);
        Ok(Self {
            restitution: Grid::new(rows, bins.restitution.bins() + 1)?,
            fraction: Grid::new(rows, columns)?,
            rows: Rows::new(bins, origin)?,
        })
    }

    /// A copy.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn copied(&self) -> Result<Self, Error> {
        Ok(Self {
            restitution: self.restitution.copied()?,
            fraction: self.fraction.copied()?,
            rows: self.rows.copied()?,
        })
    }

    /// Adds another histogram, which must have the same bins and origin.
    pub fn merge(&mut self, other: &Self) {
        self.restitution.merge(&other.restitution);
        self.fraction.merge(&other.fraction);
        self.rows.merge(&other.rows);
    }

    /// All numbers of the histogram as integers, in an order that depends on the bins alone: origin, grids, sums, created energy, pulls,
    /// particles by stop reason. Parts of a run that were counted at different times or places are stored in this form, and merge to the same
    /// bits as the whole run.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn to_words(&self) -> Result<Vec<u64>, Error> {
        let mut copy = self.copied()?;
        let mut words = empty(WHAT, copy.number_of_words())?;
        copy.visit(&mut |word| words.push(*word));
        Ok(words)
    }

    fn number_of_words(&mut self) -> usize {
        let mut number = 0;
        self.visit(&mut |_| number += 1);
        number
    }

    /// The histogram with these bins from its words.
    ///
    /// # Errors
    /// [`Error::Parameter`] for words that belong to another number of rows or columns, or to sums about another origin.
    pub fn from_words(bins: &Bins, origin: f64, words: &[u64]) -> Result<Self, Error> {
        let mut histogram = Self::new(bins, origin)?;
        let needed = histogram.number_of_words();
        let allowed = "as many as these bins have";
        Error::unless(words.len() == needed, "words", words.len() as f64, allowed)?;
        let mut words = words.iter();
        histogram.visit(&mut |word| {
            if let Some(&given) = words.next() {
                *word = given;
            }
        });
        let (allowed, found) = ("that of this run", histogram.rows.origin);
        let same = found.to_bits() == origin.to_bits();
        Error::unless(same, "origin of the words", found, allowed)?;
        let numbers = histogram.rows.numbers.iter_mut();
        for (number, counted) in numbers.zip(histogram.restitution.numbers()) {
            *number = counted;
        }
        Ok(histogram)
    }

    /// Calls `visit` with every word, which it may change.
    fn visit(&mut self, visit: &mut impl FnMut(&mut u64)) {
        let rows = &mut self.rows;
        float(&mut rows.origin, visit);
        self.restitution.counts.iter_mut().for_each(&mut *visit);
        self.fraction.counts.iter_mut().for_each(&mut *visit);
        for sums in &mut rows.sums {
            sums.words(visit);
        }
        for sum in &mut rows.fractions {
            let (mut low, mut high) = (*sum as u64, (*sum >> 64) as u64);
            visit(&mut low);
            visit(&mut high);
            *sum = u128::from(high) << 64 | u128::from(low);
        }
        for gains in &mut rows.gains {
            visit(&mut gains.count);
            float(&mut gains.largest, visit);
        }
        visit(&mut rows.pulls);
        rows.stops.iter_mut().for_each(visit);
    }
}
