//! The table of all impacts of a run, filled block by block from many threads.

use super::lanes::{Impact, ImpactSink, Meanwhile, Pose};
use super::recorded::{AtRelease, PER_IMPACT, PER_PARTICLE};
use super::{JoinedRuns, Plan, StopReason};
use crate::Error;
use crate::memory::zeros;
use crate::record::{Columns, Elements, Slices, TableColumns, TableRows, Values, Variable};
use crate::simd::LANES;
use crate::threads::Monitor;
use pulp::Simd;

/// The parameters that the size of a table follows from.
const ROOM: &str = "particles * impacts";
/// Largest number of cells that are blanked after a cancellation, which takes some tenths of a second.
const MOST_BLANKED: usize = 1 << 22;
/// Number of cells that are blanked between two checks for a cancellation.
const STRIDE: usize = 1 << 16;

/// Every impact of a run, in SI units: tables of shape (particle, impact), with NaN (0 in flags) where there was no impact, and what is known
/// of each particle.
#[derive(Debug, Clone)]
pub struct Records {
    impacts: TableColumns,
    particles: TableColumns,
    /// Number of columns that hold impacts: all, or the length of the longest row if the run was cancelled. Columns beyond
    /// it are undefined.
    pub reached: usize,
    /// Numbers of the particles, where some had to be left out; otherwise empty.
    pub particle: Vec<i64>,
    /// True if a row is blank where there was no impact.
    settled: Vec<bool>,
}

impl Records {
    /// A table of zeros, whose pages are not touched yet: whoever fills a row blanks its end.
    pub(crate) fn new(plan: &Plan<'_>, particles: usize, chosen: &Columns) -> Result<Self, Error> {
        let (most, known) = (plan.run.impacts, Columns::of_particles(plan));
        Ok(Self {
            impacts: TableColumns::new(ROOM, PER_IMPACT, chosen, particles, most)?,
            particles: TableColumns::new(ROOM, PER_PARTICLE, &known, particles, 1)?,
            reached: most,
            particle: Vec::new(),
            settled: zeros(ROOM, particles)?,
        })
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.settled.len()
    }

    /// Number of impacts of a particle.
    fn count(&self, row: usize) -> usize {
        match &self.particles.columns[0] {
            Some(Elements::Counts(counts)) => counts[row] as usize,
            _ => 0,
        }
    }

    /// A copy of the values of a variable as numbers, row by row; none if it was not recorded.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let impacts = self.impacts.numbers(name);
        impacts
            .or_else(|| self.particles.numbers(name))
            .unwrap_or_default()
    }

    /// The recorded variables of the impacts with their values, which are moved out.
    pub fn per_impact(&mut self) -> Vec<(Variable, Values)> {
        self.impacts.take()
    }

    /// The recorded variables of the particles with their values, which are moved out.
    pub fn per_particle(&mut self) -> Vec<(Variable, Values)> {
        self.particles.take()
    }

    /// Keeps the first rows, without touching memory that was not written to.
    pub(crate) fn truncate(&mut self, rows: usize) {
        self.impacts.truncate(rows);
        self.particles.truncate(rows);
        self.settled.truncate(rows);
    }

    /// All rows.
    pub(crate) fn block(&mut self) -> TableBlock<'_> {
        TableBlock {
            impacts: self.impacts.rows(),
            particles: self.particles.rows(),
            settled: &mut self.settled,
        }
    }

    /// Completes the table of a cancelled run quickly, however long the rows are: the columns end with the longest row, and where
    /// blanking the rest would take long, the rows that were interrupted are left out. The first row is particle `first`.
    pub(crate) fn settle(&mut self, first: usize) {
        self.reached = self.longest();
        if self.missing() > MOST_BLANKED {
            self.leave_out_cut_short(first);
            self.reached = self.longest();
        }
        for row in 0..self.particles() {
            if !self.settled[row] {
                let missing = self.count(row)..self.reached;
                self.impacts.rows().blank(row, missing);
            }
        }
    }

    fn longest(&self) -> usize {
        (0..self.particles())
            .map(|row| self.count(row))
            .max()
            .unwrap_or(0)
    }

    /// Number of cells that would have to be blanked.
    fn missing(&self) -> usize {
        let open = (0..self.particles()).filter(|&row| !self.settled[row]);
        open.map(|row| self.reached - self.count(row)).sum()
    }

    /// Keeps the rows that finished, and records their numbers.
    fn leave_out_cut_short(&mut self, first: usize) {
        let finished = |&row: &usize| match &self.particles.columns[1] {
            Some(Elements::Flags(reasons)) => reasons[row] != StopReason::Interrupted as i8,
            _ => true,
        };
        let kept: Vec<usize> = (0..self.particles()).filter(finished).collect();
        for (place, &row) in kept.iter().enumerate() {
            self.impacts.move_up(row, place, self.count(row));
            self.particles.move_up(row, place, 1);
            self.settled[place] = false;
        }
        self.truncate(kept.len());
        self.particle = kept.into_iter().map(|row| (first + row) as i64).collect();
    }
}

/// Some of the rows.
pub(crate) struct TableBlock<'a> {
    impacts: TableRows<'a>,
    particles: TableRows<'a>,
    settled: &'a mut [bool],
}

impl<'a> TableBlock<'a> {
    /// Splits off the first rows, or all if there are fewer.
    pub fn split(&mut self, rows: usize) -> Self {
        let rows = rows.min(self.settled.len());
        Self {
            impacts: self.impacts.split(rows),
            particles: self.particles.split(rows),
            settled: self.settled.split_off_mut(..rows).unwrap_or_default(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.settled.len()
    }
}

/// The sink that records the impacts of a block.
pub(crate) struct Table<'a> {
    block: TableBlock<'a>,
    plan: &'a Plan<'a>,
    /// The particle of row 0.
    first: usize,
}

impl<'a> Table<'a> {
    /// The particles from `first` on.
    pub fn new(mut block: TableBlock<'a>, runs: &'a JoinedRuns<'a>, first: usize) -> Self {
        for row in 0..block.len() {
            let (plan, number) = runs.origin(first + row);
            AtRelease(number).write(plan, &mut block.particles.columns, &[(0, row)]);
        }
        let plan = runs.plan();
        Self { block, plan, first }
    }

    /// Blanks the cells after the last impact of each row, unless the run is cancelled meanwhile.
    pub fn finish(mut self, monitor: &Monitor) {
        let end = self.block.impacts.per_row;
        for row in 0..self.block.len() {
            let Some(Elements::Counts(counts)) = &self.block.particles.columns[0] else {
                return;
            };
            for first in (counts[row] as usize..end).step_by(STRIDE) {
                if monitor.is_cancelled() {
                    return;
                }
                let next = end.min(first + STRIDE);
                self.block.impacts.blank(row, first..next);
            }
            self.block.settled[row] = true;
        }
    }
}

impl Meanwhile for Table<'_> {}

impl ImpactSink for Table<'_> {
    #[inline(always)]
    fn impact<S: Simd, P: Pose<S>>(&mut self, _: usize, impact: &Impact<S, P>) {
        // Lanes and cells, of which the lanes that have no impact are left out.
        let mut cells = [(0, 0); LANES];
        let mut count = 0;
        let (particle, number) = (impact.particle.as_slice(), impact.number.as_slice());
        impact.active.each(|lane| {
            let row = particle[lane] as usize - self.first;
            let cell = row * self.block.impacts.per_row + number[lane] as usize;
            cells[count] = (lane, cell);
            count += 1;
        });
        let columns = &mut self.block.impacts.columns;
        impact.write(self.plan, columns, &cells[..count]);
    }

    fn end(&mut self, particle: usize, impacts: usize, reason: StopReason) {
        let [
            Some(Slices::Counts(counts)),
            Some(Slices::Flags(reasons)),
            ..,
        ] = &mut self.block.particles.columns[..]
        else {
            return;
        };
        counts[particle - self.first] = impacts as i64;
        reasons[particle - self.first] = reason as i8;
    }
}
