//! The table of all events of a run, filled block by block from many threads.

use super::column::{Columns, ROOM, TableColumns, TableRows, Values, first};
use super::event::{Described, Event, Meanwhile, Process, Sink, Source};
use super::variable::Elements;
use super::{Slices, Variable};
use crate::Error;
use crate::memory::zeros;
use crate::simd::LANES;
use crate::threads::Monitor;
use pulp::Simd;

/// Largest number of cells that are blanked after a cancellation, which takes some tenths of a second.
const MOST_BLANKED: usize = 1 << 22;
/// Number of cells that are blanked between two checks for a cancellation.
const STRIDE: usize = 1 << 16;

/// Every event of a run, in SI units: tables of shape (row, event), with NaN (0 in flags) where there was no event, and what is known of
/// each row.
#[derive(Debug, Clone)]
pub struct Records {
    events: TableColumns,
    rows: TableColumns,
    /// Number of columns that hold events: all, or the length of the longest row if the run was cancelled. Columns beyond
    /// it are undefined.
    pub reached: usize,
    /// Numbers of the rows, where some had to be left out; otherwise empty.
    pub particle: Vec<i64>,
    /// True if a row is blank where there was no event.
    settled: Vec<bool>,
    interrupted: i8,
}

impl Records {
    /// A table of zeros, whose pages are not touched yet: whoever fills a row blanks its end.
    pub(crate) fn new<P: Process>(
        plan: &P::Plan<'_>,
        rows: usize,
        chosen: &Columns,
    ) -> Result<Self, Error> {
        let most = P::most(plan);
        let known = Columns::chosen(P::ROWS, |about| P::has(plan, about));
        Ok(Self {
            events: TableColumns::new(P::EVENTS, chosen, rows, most)?,
            rows: TableColumns::new(P::ROWS, &known, rows, 1)?,
            reached: most,
            particle: Vec::new(),
            settled: zeros(ROOM, rows)?,
            interrupted: P::number(P::INTERRUPTED) as i8,
        })
    }

    /// Number of rows.
    pub fn particles(&self) -> usize {
        self.settled.len()
    }

    /// Number of events of a row.
    fn count(&self, row: usize) -> usize {
        match &self.rows.columns[0] {
            Some(Elements::Counts(counts)) => counts[row] as usize,
            _ => 0,
        }
    }

    /// A copy of the values of a variable of the events or rows as numbers, row by row; none if it was not recorded.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let grids = [&self.events, &self.rows].into_iter();
        let mut known = grids.flat_map(|grid| grid.all.iter().zip(&grid.columns));
        match known.find_map(|(about, values)| values.as_ref().filter(|_| about.name == name)) {
            Some(Elements::Numbers(values)) => values.clone(),
            Some(Elements::Flags(values)) => values.iter().copied().map(f64::from).collect(),
            Some(Elements::Parts(values)) => values.iter().copied().map(f64::from).collect(),
            Some(Elements::Counts(values)) => values.iter().map(|&count| count as f64).collect(),
            None => Vec::new(),
        }
    }

    /// The recorded variables of the events with their values, which are moved out.
    pub fn per_impact(&mut self) -> Vec<(Variable, Values)> {
        self.events.take()
    }

    /// The recorded variables of the rows with their values, which are moved out.
    pub fn per_particle(&mut self) -> Vec<(Variable, Values)> {
        self.rows.take()
    }

    /// Keeps the first rows, without touching memory that was not written to.
    pub(crate) fn truncate(&mut self, rows: usize) {
        self.events.truncate(rows);
        self.rows.truncate(rows);
        self.settled.truncate(rows);
    }

    /// All rows.
    pub(crate) fn block(&mut self) -> TableBlock<'_> {
        TableBlock {
            events: self.events.rows(),
            rows: self.rows.rows(),
            settled: &mut self.settled,
        }
    }

    /// Completes the table of a cancelled run quickly, however long the rows are: the columns end with the longest row, and where
    /// blanking the rest would take long, the rows that were interrupted are left out. The first row has the number `first`.
    pub(crate) fn settle(&mut self, first: usize) {
        self.reached = self.longest();
        if self.missing() > MOST_BLANKED {
            self.leave_out_cut_short(first);
            self.reached = self.longest();
        }
        for row in 0..self.particles() {
            if !self.settled[row] {
                let missing = self.count(row)..self.reached;
                self.events.rows().blank(row, missing);
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
        let finished = |&row: &usize| match &self.rows.columns[1] {
            Some(Elements::Flags(reasons)) => reasons[row] != self.interrupted,
            _ => true,
        };
        let kept: Vec<usize> = (0..self.particles()).filter(finished).collect();
        for (place, &row) in kept.iter().enumerate() {
            self.events.move_up(row, place, self.count(row));
            self.rows.move_up(row, place, 1);
            self.settled[place] = false;
        }
        self.truncate(kept.len());
        self.particle = kept.into_iter().map(|row| (first + row) as i64).collect();
    }
}

/// Some of the rows.
pub(crate) struct TableBlock<'a> {
    events: TableRows<'a>,
    rows: TableRows<'a>,
    settled: &'a mut [bool],
}

impl<'a> TableBlock<'a> {
    /// Splits off the first rows, or all if there are fewer.
    pub fn split(&mut self, rows: usize) -> Self {
        let rows = rows.min(self.settled.len());
        Self {
            events: self.events.split(rows),
            rows: self.rows.split(rows),
            settled: first(&mut self.settled, rows),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.settled.len()
    }
}

/// The sink that records the events of a block.
pub(crate) struct Table<'a, S: Source> {
    block: TableBlock<'a>,
    source: &'a S,
    /// The number of row 0.
    first: usize,
}

impl<'a, S: Source> Table<'a, S> {
    /// The rows from `first` on.
    pub fn new(mut block: TableBlock<'a>, source: &'a S, first: usize) -> Self {
        for row in 0..block.len() {
            let (plan, number) = source.origin(first + row);
            S::Of::row(number).write(plan, &mut block.rows.columns, &[(0, row)]);
        }
        Self {
            block,
            source,
            first,
        }
    }

    /// Blanks the cells after the last event of each row, unless the run is cancelled meanwhile.
    pub fn finish(mut self, monitor: &Monitor) {
        let end = self.block.events.per_row;
        for row in 0..self.block.len() {
            let Some(Elements::Counts(counts)) = &self.block.rows.columns[0] else {
                return;
            };
            let mut first = counts[row] as usize;
            while first < end {
                if monitor.is_cancelled() {
                    return;
                }
                let next = end.min(first + STRIDE);
                self.block.events.blank(row, first..next);
                first = next;
            }
            self.block.settled[row] = true;
        }
    }
}

impl<S: Source> Meanwhile for Table<'_, S> {
    const INTERLEAVED: bool = false;

    fn meanwhile(&mut self, _: usize) {}
}

impl<S: Source> Sink<S::Of> for Table<'_, S> {
    fn begin(&mut self) {}

    #[inline(always)]
    fn event<V: Simd, E: Event<V, K, Of = S::Of>, const K: usize>(&mut self, _: usize, event: &E) {
        // Lanes and cells, of which the lanes that have no event are left out.
        let mut cells = [(0, 0); LANES];
        let mut count = 0;
        let (row, number) = event.place();
        event.active().each(|lane| {
            let row = row.as_slice()[lane] as usize - self.first;
            let number = number.as_slice()[lane] as usize;
            cells[count] = (lane, row * self.block.events.per_row + number);
            count += 1;
        });
        event.write(
            self.source.plan(),
            &mut self.block.events.columns,
            &cells[..count],
        );
    }

    fn end(&mut self, row: usize, events: usize, reason: <S::Of as Process>::Reason) {
        let [
            Some(Slices::Counts(counts)),
            Some(Slices::Flags(reasons)),
            ..,
        ] = &mut self.block.rows.columns[..]
        else {
            return;
        };
        counts[row - self.first] = events as i64;
        reasons[row - self.first] = <S::Of as Process>::number(reason) as i8;
    }
}
