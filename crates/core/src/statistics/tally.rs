//! The statistics of a run: grids of counts, and sums, whose size depends on the bins alone.

use super::axis::Axis;
use super::moments::{Moments, Sums};
use super::recent::FRACTION_QUANTA;
use crate::Error;
use crate::memory::{copied, filled, zeros};

/// Energy ratio above which an impact counts as creating kinetic energy. Rounding errors of the ratio are a few 10⁻¹⁵.
pub const CREATES_ENERGY: f64 = 1.0 + 1e-12;

/// The parameters that the size of a tally follows from.
pub(super) const WHAT: &str = "velocity_bins or impacts, times restitution_bins and fraction_bins";
/// Number of sites that are examined together when grids are merged: most sites of a fine grid are empty, and pages that are never
/// written to take no memory.
const PART: usize = 512;

/// The quantity by which the rows of the grids are divided.
#[derive(Debug, Clone, PartialEq)]
pub enum By {
    /// Bins of the impact velocity, in m/s.
    Velocity(Axis),
    /// The number of the impact, from the first up to this one.
    Number(usize),
}

/// Rows and columns of the grids.
#[derive(Debug, Clone, PartialEq)]
pub struct Bins {
    /// Rows of both grids.
    pub by: By,
    /// Columns of the grid of ε.
    pub restitution: Axis,
    /// Columns of the grid of E_rot/E_tot. Without them impacts are only counted, by row and ε, and no moments are summed.
    pub fraction: Option<Axis>,
}

impl Bins {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        match &self.by {
            By::Velocity(axis) => axis.bins(),
            By::Number(impacts) => *impacts,
        }
    }

    /// Whether all bins of every axis have the same width.
    pub(crate) fn are_even(&self) -> bool {
        let rows = match &self.by {
            By::Velocity(axis) => axis.is_even(),
            By::Number(_) => true,
        };
        rows && self.restitution.is_even() && self.fraction.as_ref().is_none_or(Axis::is_even)
    }

    /// Checks that the sites of each grid, and one more, can be numbered with 32 bits.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let check = |name: &'static str, axis: &Axis| {
            let sites = self.rows().saturating_mul(axis.bins() + 1);
            let allowed = "at most 2^32 - 1: rows times (bins + 3)";
            Error::unless(sites <= u32::MAX as usize, name, sites, allowed)
        };
        check("sites of the grid of restitution_bins", &self.restitution)?;
        self.fraction.as_ref().map_or(Ok(()), |axis| {
            check("sites of the grid of fraction_bins", axis)
        })
    }
}

/// Counts and sums of the impacts of any number of particles. Tallies with the same bins merge exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Tally {
    /// Impacts by row and bin of ε; the last column counts those for which ε is not finite or |ε| is at least 2³³.
    pub restitution: Grid,
    /// Impacts by row and bin of E_rot/E_tot; the last column as above. It has no columns if [`Bins::fraction`] is `None`.
    pub fraction: Grid,
    /// Origin of ε in the sums: ε_n, so that no digits are lost for nearly round bodies.
    pub(super) origin: f64,
    /// Sums of ε − origin by row; empty if impacts are only counted.
    pub(super) sums: Vec<Sums>,
    /// Σ E_rot/E_tot by row, in units of 2⁻⁴²; empty if impacts are only counted.
    pub(super) fractions: Vec<u128>,
    /// Impacts that create energy, by row.
    pub gains: Vec<Gains>,
    /// Number of particles by [`crate::StopReason`].
    pub stops: [u64; 5],
}

/// The impacts whose energy ratio exceeds [`CREATES_ENERGY`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Gains {
    /// Their number.
    pub count: u64,
    /// Their largest energy ratio; 0 if there are none.
    pub largest: f64,
}

impl Gains {
    /// Adds an impact with this energy ratio.
    pub(super) fn add(&mut self, ratio: f64) {
        self.merge(Self {
            count: 1,
            largest: ratio,
        });
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.count += other.count;
        self.largest = self.largest.max(other.largest);
    }
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

    /// A copy of the counts, row by row, as signed integers for NumPy.
    pub fn to_counts(&self) -> Result<Vec<i64>, Error> {
        let mut copy = zeros(WHAT, self.counts.len())?;
        let parts = copy.chunks_mut(PART).zip(self.counts.chunks(PART));
        for (copies, counts) in parts.filter(|(_, counts)| counts.iter().any(|&count| count > 0)) {
            copies.copy_from_slice(pulp::bytemuck::cast_slice::<u64, i64>(counts));
        }
        Ok(copy)
    }

    fn copied(&self) -> Result<Self, Error> {
        Ok(Self {
            columns: self.columns,
            counts: copied(WHAT, &self.counts)?,
        })
    }

    /// Number of columns: one below the bins, the bins, one above, and one for undefined values.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The counts, row by row.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    pub(super) fn absorb(&mut self, recent: &mut [u32]) {
        let parts = self.counts.chunks_mut(PART).zip(recent.chunks_mut(PART));
        for (counts, recent) in parts.filter(|(_, recent)| recent.iter().any(|&count| count > 0)) {
            for (count, recent) in counts.iter_mut().zip(recent) {
                *count += u64::from(std::mem::take(recent));
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
}

impl Tally {
    /// A tally of no impacts, whose sums are relative to `origin`.
    pub fn new(bins: &Bins, origin: f64) -> Result<Self, Error> {
        let rows = bins.rows();
        let summed = bins.fraction.as_ref().map_or(0, |_| rows);
        let columns = bins.fraction.as_ref().map_or(0, |axis| axis.bins() + 1);
        Ok(Self {
            restitution: Grid::new(rows, bins.restitution.bins() + 1)?,
            fraction: Grid::new(rows, columns)?,
            origin,
            sums: filled(WHAT, Sums::EMPTY, summed)?,
            fractions: zeros(WHAT, summed)?,
            gains: filled(WHAT, Gains::default(), rows)?,
            stops: [0; 5],
        })
    }

    pub(super) fn copied(&self) -> Result<Self, Error> {
        Ok(Self {
            restitution: self.restitution.copied()?,
            fraction: self.fraction.copied()?,
            origin: self.origin,
            sums: copied(WHAT, &self.sums)?,
            fractions: copied(WHAT, &self.fractions)?,
            gains: copied(WHAT, &self.gains)?,
            stops: self.stops,
        })
    }

    /// Adds another tally, which must have the same bins and origin.
    pub fn merge(&mut self, other: &Self) {
        self.restitution.merge(&other.restitution);
        self.fraction.merge(&other.fraction);
        for (sums, other) in self.sums.iter_mut().zip(&other.sums) {
            sums.merge(other);
        }
        for (sum, other) in self.fractions.iter_mut().zip(&other.fractions) {
            *sum += other;
        }
        for (gains, other) in self.gains.iter_mut().zip(&other.gains) {
            gains.merge(*other);
        }
        for (count, other) in self.stops.iter_mut().zip(&other.stops) {
            *count += other;
        }
    }

    /// Number of impacts in a row for which ε is defined.
    pub fn number(&self, row: usize) -> u64 {
        let columns = self.restitution.columns;
        self.restitution.counts[row * columns..][..columns - 1]
            .iter()
            .sum()
    }

    /// Moments of ε in a row; `None` if impacts are only counted.
    pub fn moments(&self, row: usize) -> Option<Moments> {
        let sums = self.sums.get(row)?;
        Some(sums.moments(self.number(row), self.origin))
    }

    /// Mean of E_rot/E_tot in a row, NaN without impacts; `None` if impacts are only counted.
    pub fn mean_fraction(&self, row: usize) -> Option<f64> {
        let sum = *self.fractions.get(row)?;
        Some(sum as f64 / FRACTION_QUANTA / self.number(row) as f64)
    }
}
