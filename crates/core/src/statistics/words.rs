//! A histogram as a list of integers. Parts of a run that were counted at different times or places are stored in this form, and merge to
//! the same bits as the whole run.

use super::bins::{Bins, WHAT};
use super::histogram::Histogram;
use super::moments::float;
use crate::Error;
use crate::memory::empty;

impl Histogram {
    /// All numbers of the histogram, in an order that depends on the bins alone: origin, grids, sums, created energy, pulls, particles by
    /// stop reason.
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
