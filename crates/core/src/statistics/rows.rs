//! Sums over the impacts of each row: moments of ε and of E_rot/E_tot, created energy; those that pull; and how the particles ended.

use super::bins::{Bins, WHAT};
use super::moments::{Moments, Sums};
use super::recent::FRACTION_QUANTA;
use crate::memory::{copied, filled, zeros};
use crate::simd::{Mask, Pack};
use crate::{Error, StopReason};
use pulp::Simd;

/// Energy ratio above which an impact counts as creating kinetic energy. Rounding errors of the ratio are a few 10⁻¹⁵.
pub const CREATES_ENERGY: f64 = 1.0 + 1e-12;

/// The share of |v_n| + |v_n′| below which v_n′ − v_n = P_n/m, v_n upwards, may be below 0 because of rounding.
pub const PULLS: f64 = 1e-12;

/// The lanes with an impact in which the plane pulls at the body: P_n < 0.
#[inline(always)]
pub(super) fn pulling<S: Simd>(velocity: Pack<S>, restitution: Pack<S>) -> Mask<S> {
    let rebound = velocity * restitution;
    (velocity + rebound).lt((velocity.abs() + rebound.abs()) * -PULLS)
}

/// Sums of the impacts of any number of particles, by row. They merge exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// Origin of ε in the sums: ε_n, so that no digits are lost for nearly round bodies.
    pub(super) origin: f64,
    /// Number of impacts with a defined ε.
    pub(super) numbers: Vec<u64>,
    /// Sums of ε − origin; empty if impacts are only counted.
    pub(super) sums: Vec<Sums>,
    /// Σ E_rot/E_tot, in units of 2⁻⁴²; empty if impacts are only counted.
    pub(super) fractions: Vec<u128>,
    /// Impacts that create energy.
    pub gains: Vec<Gains>,
    /// Number of impacts in which the plane pulled.
    pub pulls: u64,
    /// Number of particles by the number of their stop reason.
    pub stops: Vec<u64>,
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

impl Rows {
    /// The sums of no impacts, relative to `origin`.
    pub(crate) fn new(bins: &Bins, origin: f64) -> Result<Self, Error> {
        let rows = bins.rows();
        let summed = bins.fraction.as_ref().map_or(0, |_| rows);
        Ok(Self {
            origin,
            numbers: zeros(WHAT, rows)?,
            sums: filled(WHAT, Sums::EMPTY, summed)?,
            fractions: zeros(WHAT, summed)?,
            gains: filled(WHAT, Gains::default(), rows)?,
            pulls: 0,
            stops: zeros(WHAT, StopReason::NAMES.len())?,
        })
    }

    pub(super) fn copied(&self) -> Result<Self, Error> {
        Ok(Self {
            origin: self.origin,
            numbers: copied(WHAT, &self.numbers)?,
            sums: copied(WHAT, &self.sums)?,
            fractions: copied(WHAT, &self.fractions)?,
            gains: copied(WHAT, &self.gains)?,
            pulls: self.pulls,
            stops: copied(WHAT, &self.stops)?,
        })
    }

    /// Adds the sums of other impacts, which must have the same rows and origin.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (number, other) in self.numbers.iter_mut().zip(&other.numbers) {
            *number += other;
        }
        for (sums, other) in self.sums.iter_mut().zip(&other.sums) {
            sums.merge(other);
        }
        for (sum, other) in self.fractions.iter_mut().zip(&other.fractions) {
            *sum += other;
        }
        for (gains, other) in self.gains.iter_mut().zip(&other.gains) {
            gains.merge(*other);
        }
        self.pulls += other.pulls;
        for (count, other) in self.stops.iter_mut().zip(&other.stops) {
            *count += other;
        }
    }

    /// Number of impacts in a row for which ε is defined.
    pub fn number(&self, row: usize) -> u64 {
        self.numbers[row]
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
