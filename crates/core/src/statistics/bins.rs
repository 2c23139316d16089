//! Rows and columns of the grids in which impacts are counted.

use super::axis::Axis;
use crate::Error;

/// The parameters that the size of a histogram follows from.
pub(super) const WHAT: &str = "velocity_bins or impacts, times restitution_bins and fraction_bins";

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

    /// Returns whether all bins of every axis have the same width.
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
