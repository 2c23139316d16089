//! All particles of a run, on all cores. Particles do not interact, so that the result does not depend on the schedule.

use crate::Error;
use crate::columns::{Columns, Records};
use crate::records::Table;
use crate::run::{BLOCK, Plan, Run, share};
use crate::statistics::{Bins, By, Counter, Counts, Tally, Tallying};
use crate::threads::{Means, Monitor};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

impl Run<'_> {
    /// Simulates every particle and records every impact, in SI units. A cancelled run returns the particles that were begun.
    ///
    /// # Errors
    /// [`Error::Parameter`] or [`Error::Magnitude`] for a parameter out of range, [`Error::Memory`], [`Error::Threads`], and
    /// [`Error::Numerical`] if a contact search does not converge.
    pub fn simulate(&self, means: Means, monitor: &Monitor) -> Result<Records, Error> {
        self.simulate_part(0..self.particles, means, monitor)
    }

    /// As [`Run::simulate`], for some of the particles of the run.
    pub fn simulate_part(
        &self,
        part: Range<usize>,
        means: Means,
        monitor: &Monitor,
    ) -> Result<Records, Error> {
        self.simulate_columns(part, &Columns::usual(&self.law, false), means, monitor)
    }

    /// As [`Run::simulate_part`], recording the variables in `columns`.
    pub fn simulate_columns(
        &self,
        part: Range<usize>,
        columns: &Columns,
        means: Means,
        monitor: &Monitor,
    ) -> Result<Records, Error> {
        let plan = Plan::new(self)?;
        self.check_part(&part)?;
        Error::unless(
            part.len().checked_mul(self.impacts).is_some(),
            "particles",
            part.len(),
            "such that particles × impacts can be counted",
        )?;
        let mut records = Records::new(part.len(), self.impacts, columns)?;
        let started = AtomicUsize::new(part.start);
        let rows = Mutex::new(records.block());
        // Free threads take blocks in order, so that the particles begun before a cancellation are contiguous.
        let ended = means.each_thread(part.len().div_ceil(BLOCK), |_| {
            while !monitor.is_cancelled() {
                let mut rows = rows.lock().expect("no thread panics while it takes rows");
                let block = rows.split(BLOCK);
                let count = block.impacts.len();
                let first = started.fetch_add(count, Ordering::Relaxed);
                drop(rows);
                if count == 0 {
                    break;
                }
                let particles = first..first + count;
                let mut table = Table::new(block, &plan, first);
                plan.bounce(particles, means.level, monitor, &mut table)?;
                table.finish(monitor);
            }
            Ok(())
        })?;
        ended.into_iter().collect::<Result<(), Error>>()?;
        records.truncate(started.into_inner() - part.start);
        if monitor.is_cancelled() {
            records.settle(part.start);
        }
        records.add_release(&plan, part.start)?;
        Ok(records)
    }

    /// Simulates every particle and keeps only the statistics of the impacts, in memory that does not grow with the run.
    ///
    /// # Errors
    /// As [`Run::simulate`], and [`Error::Parameter`] for bins that do not fit the run.
    pub fn statistics(&self, bins: &Bins, means: Means, monitor: &Monitor) -> Result<Tally, Error> {
        self.statistics_of_part(0..self.particles, bins, means, monitor)
    }

    /// As [`Run::statistics`], for some of the particles of the run. The tallies of all parts merge to the tally of the run.
    pub fn statistics_of_part(
        &self,
        part: Range<usize>,
        bins: &Bins,
        means: Means,
        monitor: &Monitor,
    ) -> Result<Tally, Error> {
        let plan = Plan::new(self)?;
        self.check_part(&part)?;
        bins.check()?;
        if let By::Number(rows) = bins.by {
            let allowed = "at most the number of rows";
            Error::unless(self.impacts <= rows, "impacts", self.impacts, allowed)?;
        }
        let origin = self.origin();
        let even = bins.are_even();
        let tallies = match &bins.fraction {
            Some(fractions) if even => Self::tallies(&plan, part, means, monitor, || {
                Counter::<true>::new(bins, fractions, &plan, origin)
            }),
            Some(fractions) => Self::tallies(&plan, part, means, monitor, || {
                Counter::<false>::new(bins, fractions, &plan, origin)
            }),
            None if even => Self::tallies(&plan, part, means, monitor, || {
                Counts::<true>::new(bins, &plan, origin)
            }),
            None => Self::tallies(&plan, part, means, monitor, || {
                Counts::<false>::new(bins, &plan, origin)
            }),
        };
        let mut tallies = tallies?.into_iter();
        let mut total = tallies.next().expect("at least one thread counts")?;
        for tally in tallies {
            total.merge(&tally?);
        }
        Ok(total)
    }

    /// The tallies of all threads. Which thread takes which block does not matter, because integer sums do not depend on the
    /// order.
    fn tallies<T: Tallying>(
        plan: &Plan<'_>,
        part: Range<usize>,
        means: Means,
        monitor: &Monitor,
        counter: impl Fn() -> Result<T, Error> + Sync,
    ) -> Result<Vec<Result<Tally, Error>>, Error> {
        let next = AtomicUsize::new(part.start);
        means.each_thread(part.len().div_ceil(BLOCK), |threads| {
            let mut counter = counter()?;
            while !monitor.is_cancelled() {
                let next = next.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |first| {
                    let left = part.end - first;
                    (left > 0).then(|| first + share(left, threads))
                });
                let Ok(first) = next else { break };
                let particles = first..first + share(part.end - first, threads);
                plan.bounce(particles, means.level, monitor, &mut counter)?;
            }
            Ok(counter.finish())
        })
    }

    fn check_part(&self, part: &Range<usize>) -> Result<(), Error> {
        let allowed = "at least one of the particles of the run, from the first to before the last";
        let inside = part.start < part.end && part.end <= self.particles;
        Error::unless(inside, "part", part.end as f64, allowed)
    }
}
