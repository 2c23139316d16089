//! The statistics of a run: grids of counts, and sums, whose size depends on the bins alone.

use super::bins::{Bins, WHAT};
use super::rows::Rows;
use crate::Error;
use crate::memory::zeros;
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
}
