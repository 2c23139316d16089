//! All particles of a run, on all cores. Particles do not interact, so that the result does not depend on the schedule.

use crate::Error;
use crate::drop::{BLOCK, JoinedRuns, Records, Run, Table, bounce_block, even, share};
use crate::record::Columns;
use crate::statistics::{Bins, By, Histogram, HistogramSink, Rows, UNSPOILT};
use crate::threads::{Monitor, Resources};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

impl Run<'_> {
    /// Simulates every particle and records every impact, in SI units. A cancelled run returns the particles that were begun.
    ///
    /// # Errors
    /// [`Error::Parameter`] or [`Error::Magnitude`] for a parameter out of range, [`Error::Memory`], [`Error::Threads`], and
    /// [`Error::Numerical`] if a contact search does not converge.
    pub fn simulate(&self, resources: Resources, monitor: &Monitor) -> Result<Records, Error> {
        let usual = Columns::usual(self.body, &self.law, false);
        self.simulate_columns(0..self.particles, &usual, resources, monitor)
    }

    /// As [`Run::simulate`], for some of the particles of the run, recording the variables in `columns`.
    pub fn simulate_columns(
        &self,
        part: Range<usize>,
        columns: &Columns,
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<Records, Error> {
        let runs = JoinedRuns::of(self)?;
        runs.plan().check_part(&part)?;
        recorded(&runs, part, |_| BLOCK, columns, resources, monitor)
    }

    /// Simulates every particle and keeps only the statistics of the impacts, in memory that does not grow with the run.
    ///
    /// # Errors
    /// As [`Run::simulate`], and [`Error::Parameter`] for bins that do not fit the run.
    pub fn statistics(
        &self,
        bins: &Bins,
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<Histogram, Error> {
        self.statistics_of_part(0..self.particles, bins, resources, monitor)
    }

    /// As [`Run::statistics`], for some of the particles of the run. The histograms of all parts merge to the histogram of the run.
    pub fn statistics_of_part(
        &self,
        part: Range<usize>,
        bins: &Bins,
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<Histogram, Error> {
        self.statistics_of_parts(&[part], bins, resources, monitor, |_| Ok(()))
    }

    /// As [`Run::statistics_of_part`], for several parts, one after the other; `report` receives the sums by row of each that was begun.
    pub fn statistics_of_parts(
        &self,
        parts: &[Range<usize>],
        bins: &Bins,
        resources: Resources,
        monitor: &Monitor,
        mut report: impl FnMut(&Rows) -> Result<(), Error>,
    ) -> Result<Histogram, Error> {
        let runs = JoinedRuns::of(self)?;
        parts
            .iter()
            .try_for_each(|part| runs.plan().check_part(part))?;
        bins.check()?;
        if let By::Number(rows) = bins.by {
            let allowed = "at most the number of rows";
            Error::unless(self.impacts <= rows, "impacts", self.impacts, allowed)?;
        }
        let mut total = Histogram::new(bins, self.origin())?;
        for part in parts {
            let shared = Mutex::new(total);
            let rows = counted(&runs, part.clone(), bins, resources, monitor, &shared)?;
            total = shared.into_inner().expect(UNSPOILT);
            report(&rows)?;
            total.rows.merge(&rows);
            if monitor.is_cancelled() {
                break;
            }
        }
        Ok(total)
    }
}

/// Counts the impacts of some particles in the grids of a histogram, and returns what else is summed of them.
fn counted(
    runs: &JoinedRuns<'_>,
    part: Range<usize>,
    bins: &Bins,
    resources: Resources,
    monitor: &Monitor,
    shared: &Mutex<Histogram>,
) -> Result<Rows, Error> {
    let count = match (bins.are_even(), bins.fraction.is_some()) {
        (true, true) => each::<true, true>,
        (true, false) => each::<true, false>,
        (false, true) => each::<false, true>,
        (false, false) => each::<false, false>,
    };
    let mut sum = Rows::new(bins, runs.plan().run.origin())?;
    for rows in count(runs, part, bins, resources, monitor, shared)? {
        sum.merge(&rows?);
    }
    Ok(sum)
}

/// The sums of every thread. They do not depend on which thread takes which block, because integer sums do not depend on the
/// order.
fn each<const EVEN: bool, const MOMENTS: bool>(
    runs: &JoinedRuns<'_>,
    part: Range<usize>,
    bins: &Bins,
    resources: Resources,
    monitor: &Monitor,
    shared: &Mutex<Histogram>,
) -> Result<Vec<Result<Rows, Error>>, Error> {
    let plan = runs.plan();
    let units = (plan.scales.speed, plan.run.origin());
    let next = AtomicUsize::new(part.start);
    resources.each_thread(part.len().div_ceil(BLOCK), |threads| {
        let mut counter = HistogramSink::<EVEN, MOMENTS>::new(bins, units, shared)?;
        while !monitor.is_cancelled() {
            let next = next.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |first| {
                let left = part.end - first;
                (left > 0).then(|| first + share(left, threads))
            });
            let Ok(first) = next else { break };
            let particles = first..first + share(part.end - first, threads);
            bounce_block(runs, particles, resources.level, monitor, &mut counter)?;
        }
        Ok(counter.finish())
    })
}

/// Simulates parts of several runs, which may differ in seed, number of particles and release alone, as one: particles from all of them
/// are in the lanes at the same time. Records the variables in `columns` of every impact, part after part, and of the
/// release those that vary in the first run. The impacts have the same bits as in [`Run::simulate`].
///
/// # Errors
/// As [`Run::simulate`], and [`Error::Parameter`] for runs that differ in more.
pub fn simulate_series(
    runs: &[(Run<'_>, Range<usize>)],
    columns: &Columns,
    resources: Resources,
    monitor: &Monitor,
) -> Result<Records, Error> {
    let series = JoinedRuns::new(runs)?;
    let particles = series.particles();
    let block = |threads| even(particles, threads);
    recorded(&series, 0..particles, block, columns, resources, monitor)
}

/// The impacts of a range of particles, which threads take in blocks of as many as `block` says for their number.
fn recorded(
    runs: &JoinedRuns<'_>,
    part: Range<usize>,
    block: impl Fn(usize) -> usize + Sync,
    columns: &Columns,
    resources: Resources,
    monitor: &Monitor,
) -> Result<Records, Error> {
    let impacts = runs.plan().run.impacts;
    Error::unless(
        part.len().checked_mul(impacts).is_some(),
        "particles",
        part.len(),
        "such that particles × impacts can be counted",
    )?;
    let mut records = Records::new(runs.plan(), part.len(), columns)?;
    let started = AtomicUsize::new(part.start);
    let rows = Mutex::new(records.block());
    // Free threads take blocks in order, so that the particles begun before a cancellation are contiguous.
    let ended = resources.each_thread(part.len().div_ceil(BLOCK), |threads| {
        let size = block(threads);
        while !monitor.is_cancelled() {
            let mut rows = rows.lock().expect("no thread panics while it takes rows");
            let block = rows.split(size);
            let count = block.len();
            let first = started.fetch_add(count, Ordering::Relaxed);
            drop(rows);
            if count == 0 {
                break;
            }
            let particles = first..first + count;
            let mut table = Table::new(block, runs, first);
            bounce_block(runs, particles, resources.level, monitor, &mut table)?;
            table.finish(monitor);
        }
        Ok(())
    })?;
    ended.into_iter().collect::<Result<(), Error>>()?;
    records.truncate(started.into_inner() - part.start);
    if monitor.is_cancelled() {
        records.settle(part.start);
    }
    Ok(records)
}
