//! The sink that counts impacts for a [`Histogram`], and sums their moments unless they are only counted.

use super::axis::Axis;
use super::bins::{Bins, By, WHAT};
use super::histogram::{Histogram, UNSPOILT};
use super::moments::Sums;
use super::recent::{
    COARSE, Extremes, Half, LARGEST, QUANTA, Recent, fraction_quanta, quanta, words,
};
use super::rows::{CREATES_ENERGY, Rows, pulling};
use super::whole::{ROUND, whole};
use crate::drop::{Impact, ImpactSink, Meanwhile, PLACES, Pose, of_group};
use crate::memory::{filled, zeros};
use crate::simd::{LANES, Mask, Pack};
use crate::{Error, StopReason};
use pulp::Simd;
use std::ops::{IndexMut, Range};
use std::sync::Mutex;

/// Counts impacts in narrow integers, which are emptied before they can overflow. The bins of an impact are computed in all lanes at
/// once and queued; the queue is counted lane by lane while other arithmetic waits for its results. Lanes without an impact, or with
/// one that cannot be summed there, are counted in an additional site or row that is never read, so that no branch is needed.
///
/// EVEN: all bins of every axis have the same width. MOMENTS: there are columns for E_rot/E_tot, and moments are summed; otherwise what
/// is for them is empty, and only the impacts by row and ε are counted, and those that create energy.
pub(crate) struct HistogramSink<'a, const EVEN: bool, const MOMENTS: bool> {
    /// Whose grids this counter and others fill.
    shared: &'a Mutex<Histogram>,
    /// The other sums.
    own: Rows,
    by: &'a By,
    columns: &'a Axis,
    fractions: &'a Axis,
    /// The unit of velocities, in m/s.
    speed: f64,
    restitution: Vec<u32>,
    fraction: Vec<u32>,
    /// Sums since they were last moved to `own`: one for each row, one for the large values of each row, and some that are never
    /// read.
    rows: Vec<Recent>,
    /// Extremes of ε, for the same rows.
    extremes: Vec<Extremes>,
    /// The largest energy ratio above [`CREATES_ENERGY`], for the same rows.
    largest: Vec<f64>,
    recently: Recently,
    queue: Queue,
}

/// Impacts to be counted. Integers have [`ROUND`] added to them.
#[repr(align(64))]
struct Queue {
    /// Sites in the grid of ε, of impacts that are only counted.
    sites: [f64; PLACES],
    /// Sites in the grids of ε and of E_rot/E_tot, the row, and ε itself.
    places: [[f64; 4]; PLACES],
    /// Contributions to the sums, in halves.
    low: [Half; PLACES],
    high: [Half; PLACES],
}

impl Queue {
    /// Counts the impact at place `i` in the grids, in the recent sums and extremes of its row, and, if there is no room left
    /// there, in `own`.
    #[inline(always)]
    fn count<G, R, E>(
        &self,
        i: usize,
        (restitution, fraction): (&mut G, &mut G),
        (rows, extremes): (&mut R, &mut E),
        sums: &mut Rows,
    ) where
        G: IndexMut<usize, Output = u32> + ?Sized,
        R: IndexMut<usize, Output = Recent> + ?Sized,
        E: IndexMut<usize, Output = Extremes> + ?Sized,
    {
        let [site, fraction_site, number, value] = self.places[i];
        restitution[whole(site)] += 1;
        fraction[whole(fraction_site)] += 1;
        let number = whole(number);
        extremes[number].add(value);
        let row = &mut rows[number];
        if row.add(&self.low[i], &self.high[i]) {
            empty_row(sums, row, number);
        }
    }
}

/// Number of impacts after which the narrow counters are emptied, before they can overflow.
const MOST: u32 = u32::MAX - 1024;

/// The number of impacts counted since they were last emptied.
#[derive(Default)]
struct Recently(u32);

impl Recently {
    /// Adds some impacts, fewer than 1024, and returns whether the counters must be emptied.
    #[inline(always)]
    fn add(&mut self, impacts: usize) -> bool {
        self.0 += impacts as u32;
        let full = self.0 > MOST;
        if full {
            self.0 = 0;
        }
        full
    }
}

/// Transposes four packs into one record of four numbers for each lane.
#[inline(always)]
fn put<S: Simd>(queue: &mut [[f64; 4]], packs: [Pack<S>; 4]) {
    let records = Pack::records(packs);
    queue.copy_from_slice(pulp::bytemuck::cast_slice(&records));
}

/// The last sites, which are never read, plus [`ROUND`]: one for each lane, so that none waits for another.
#[inline(always)]
fn nowhere<S: Simd, T>(simd: S, places: &[T]) -> Pack<S> {
    let mut sites = Pack::splat(simd, last(places));
    for (lane, site) in sites.as_mut_slice().iter_mut().enumerate() {
        *site -= (lane % LANES) as f64;
    }
    sites
}

/// The last of them.
fn last<T>(places: &[T]) -> f64 {
    (places.len() - 1) as f64 + ROUND
}

/// Numbers of the sites in `column`, to which [`ROUND`] was added, of row number `start`.
#[inline(always)]
fn sites<S: Simd>(axis: &Axis, start: Pack<S>, column: Pack<S>) -> Pack<S> {
    start.mul_add(axis.stride, column)
}

/// The same where values may be undefined, which are counted in the last column, or a lane may have no impact, which is counted at a
/// site that is never read.
#[inline(always)]
fn all_sites<S: Simd>(
    (axis, counts): (&Axis, &[u32]),
    start: Pack<S>,
    column: Pack<S>,
    defined: Mask<S>,
    active: Mask<S>,
) -> Pack<S> {
    let column = defined.select(column, axis.beyond + ROUND);
    active.select(sites(axis, start, column), nowhere(start.simd(), counts))
}

/// Moves the recent sums of a row to those of all rows.
#[cold]
#[inline(never)]
fn empty_row(all: &mut Rows, row: &mut Recent, number: usize) {
    let row = std::mem::replace(row, Recent::EMPTY);
    let rows = all.sums.len();
    let (number, unit) = if number < rows {
        (number, 1)
    } else {
        (number - rows, COARSE)
    };
    if let Some(sums) = all.sums.get_mut(number) {
        let totals = row.totals();
        sums.absorb(totals.powers, unit);
        all.fractions[number] += u128::from(totals.fractions);
        all.gains[number].count += totals.gains;
    }
}

impl<'a, const EVEN: bool, const MOMENTS: bool> HistogramSink<'a, EVEN, MOMENTS> {
    /// A counter without impacts, for a histogram with these bins; velocities are in units of `speed`, in m/s, and moments about `origin`.
    pub fn new(
        bins: &'a Bins,
        (speed, origin): (f64, f64),
        shared: &'a Mutex<Histogram>,
    ) -> Result<Self, Error> {
        let rows = bins.rows();
        let columns = &bins.restitution;
        // Impacts that are only counted have no bins of E_rot/E_tot, and nothing asks for any.
        let fractions = bins.fraction.as_ref().unwrap_or(columns);
        let summed = |size: usize| if MOMENTS { size + LANES } else { 0 };
        Ok(Self {
            shared,
            own: Rows::new(bins, origin)?,
            by: &bins.by,
            columns,
            fractions,
            speed,
            restitution: zeros(WHAT, rows * (columns.bins() + 1) + LANES)?,
            fraction: zeros(WHAT, summed(rows * (fractions.bins() + 1)))?,
            rows: filled(WHAT, Recent::EMPTY, summed(2 * rows))?,
            extremes: filled(WHAT, Extremes::EMPTY, summed(2 * rows))?,
            largest: zeros(WHAT, summed(2 * rows))?,
            recently: Recently::default(),
            queue: Queue {
                sites: [0.0; PLACES],
                places: [[0.0; 4]; PLACES],
                low: [[0.0; 4]; PLACES],
                high: [[0.0; 4]; PLACES],
            },
        })
    }

    /// Returns the other sums over the impacts, all of which are then in the grids.
    pub fn finish(mut self) -> Rows {
        self.empty();
        self.own
    }

    fn empty(&mut self) {
        let mut shared = self.shared.lock().expect(UNSPOILT);
        let numbers = &mut self.own.numbers;
        let report = |row: usize, number| numbers[row] += number;
        shared.restitution.absorb(&mut self.restitution, report);
        if !MOMENTS {
            return;
        }
        shared.fraction.absorb(&mut self.fraction, |_, _| {});
        drop(shared);
        for (number, row) in self.rows.iter_mut().enumerate() {
            empty_row(&mut self.own, row, number);
        }
        let rows = self.own.sums.len();
        for (number, extremes) in self.extremes[..2 * rows].iter_mut().enumerate() {
            self.own.sums[number % rows].widen(&std::mem::replace(extremes, Extremes::EMPTY));
        }
        for (gains, largest) in self.own.gains.iter_mut().zip(&mut self.largest) {
            gains.largest = gains.largest.max(std::mem::take(largest));
        }
    }

    /// Sums a value that is too far from the origin for [`Recent`].
    #[inline(never)]
    fn sum_large(&mut self, row: usize, restitution: f64, fraction: f64) {
        self.own.sums[row].add(quanta(restitution - self.own.origin));
        self.own.fractions[row] += fraction_quanta(fraction) as u128;
        self.extremes[row].add(restitution);
    }
}

impl<const EVEN: bool, const MOMENTS: bool> Meanwhile for HistogramSink<'_, EVEN, MOMENTS> {
    const INTERLEAVED: bool = true;

    #[inline(always)]
    fn meanwhile(&mut self, place: usize) {
        if !MOMENTS {
            self.restitution[whole(self.queue.sites[place])] += 1;
            return;
        }
        let (grids, rows) = (
            (&mut self.restitution, &mut self.fraction),
            (&mut self.rows, &mut self.extremes),
        );
        self.queue.count(place, grids, rows, &mut self.own);
    }

    #[inline(always)]
    fn settle(&mut self, places: Range<usize>) {
        // As vectors their addresses and lengths would be read again for every place.
        let (restitution, fraction) = (&mut self.restitution[..], &mut self.fraction[..]);
        let (rows, extremes) = (&mut self.rows[..], &mut self.extremes[..]);
        for place in places {
            if !MOMENTS {
                restitution[whole(self.queue.sites[place])] += 1;
                continue;
            }
            let (grids, rows) = (
                (&mut *restitution, &mut *fraction),
                (&mut *rows, &mut *extremes),
            );
            self.queue.count(place, grids, rows, &mut self.own);
        }
    }
}

impl<const EVEN: bool, const MOMENTS: bool> ImpactSink for HistogramSink<'_, EVEN, MOMENTS> {
    fn begin(&mut self) {
        self.queue.sites.fill(last(&self.restitution));
        if MOMENTS {
            let nowhere = [
                last(&self.restitution),
                last(&self.fraction),
                last(&self.rows),
                0.0,
            ];
            self.queue.places.fill(nowhere);
        }
    }

    #[inline(always)]
    fn impact<S: Simd, P: Pose<S>>(&mut self, group: usize, impact: &Impact<S, P>) {
        let width = Pack::<S>::WIDTH;
        if self.recently.add(width) {
            self.empty();
        }
        let lanes = of_group::<S>(group);
        let (number, active) = (impact.number, impact.active);
        let simd = number.simd();
        let restitution = impact.restitution();
        let fraction = impact.rotational_fraction();
        let (columns, fractions) = (self.columns, self.fractions);
        let [row, column, fraction_column] = match self.by {
            By::Velocity(axis) if MOMENTS => Axis::locate::<S, _, EVEN>(
                [axis, columns, fractions],
                [impact.fall * self.speed, restitution, fraction],
            ),
            By::Velocity(axis) => {
                let velocity = impact.fall * self.speed;
                let [row, column] =
                    Axis::locate::<S, _, EVEN>([axis, columns], [velocity, restitution]);
                [row, column, fraction]
            }
            By::Number(_) if MOMENTS => {
                let [column, fraction] =
                    Axis::locate::<S, _, EVEN>([columns, fractions], [restitution, fraction]);
                [number + ROUND, column, fraction]
            }
            By::Number(_) => {
                let [column] = Axis::locate::<S, _, EVEN>([columns], [restitution]);
                [number + ROUND, column, fraction]
            }
        };
        let gaining = active & (impact.energy_before * CREATES_ENERGY).lt(impact.energy_after);
        let pulling = active & pulling(impact.fall, restitution);
        if pulling.any() {
            pulling.each(|_| self.own.pulls += 1);
        }
        let start = row - ROUND;
        if !MOMENTS {
            let defined = restitution.abs().lt(Sums::LARGEST);
            let site = if (active & defined).all() {
                sites(columns, start, column)
            } else {
                let grid = (columns, &self.restitution[..]);
                all_sites(grid, start, column, defined, active)
            };
            self.queue.sites[lanes].copy_from_slice(site.as_slice());
            if gaining.any() {
                let ratio = impact.energy_ratio();
                gaining.each(|lane| {
                    let row = whole(row.as_slice()[lane]);
                    self.own.gains[row].add(ratio.as_slice()[lane]);
                });
            }
            return;
        }
        let offset = restitution - self.own.origin;
        let mut site = sites(columns, start, column);
        let mut fraction_site = sites(fractions, start, fraction_column);
        let (mut summed_row, mut unit) = (row, Pack::splat(simd, QUANTA));
        let plain = active & offset.abs().le(LARGEST) & fraction.le(1.0);
        if !plain.all() {
            let defined = restitution.abs().lt(Sums::LARGEST) & fraction.le(1.0);
            let grid = (columns, &self.restitution[..]);
            site = all_sites(grid, start, column, defined, active);
            let grid = (fractions, &self.fraction[..]);
            fraction_site = all_sites(grid, start, fraction_column, defined, active);
            let large = offset.abs().le(COARSE as f64 * LARGEST) & active & fraction.le(1.0);
            let coarse_row =
                large.select(row + self.own.sums.len() as f64, nowhere(simd, &self.rows));
            summed_row = plain.select(row, coarse_row);
            unit = plain.select(QUANTA, QUANTA / COARSE as f64);
            let aside = active & !large;
            (aside & defined).each(|lane| {
                let (restitution, fraction) =
                    (restitution.as_slice()[lane], fraction.as_slice()[lane]);
                self.sum_large(whole(row.as_slice()[lane]), restitution, fraction);
            });
            (aside & gaining).each(|lane| {
                self.own.gains[whole(row.as_slice()[lane])].count += 1;
            });
        }
        let queue = &mut self.queue;
        let places = [site, fraction_site, summed_row, restitution];
        put(&mut queue.places[lanes.clone()], places);
        let [low, high] = words(offset, unit, fraction, gaining);
        put(&mut queue.low[lanes.clone()], low);
        put(&mut queue.high[lanes], high);
        if gaining.any() {
            let ratio = gaining.select(impact.energy_ratio(), 0.0);
            let row = gaining.select(row, nowhere(simd, &self.largest));
            for lane in 0..width {
                let largest = &mut self.largest[whole(row.as_slice()[lane])];
                let ratio = ratio.as_slice()[lane];
                if ratio > *largest {
                    *largest = ratio;
                }
            }
        }
    }

    fn end(&mut self, _: usize, _: usize, reason: StopReason) {
        self.own.stops[reason as usize] += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between two emptyings no counter has more impacts than it has room for, even if all are in one bin.
    #[test]
    fn narrow_counters_are_emptied_in_time() {
        let mut recently = Recently::default();
        let mut since = 0_u64;
        let mut emptied = 0;
        while emptied < 2 {
            since += 512;
            assert!(since <= u64::from(u32::MAX));
            if recently.add(512) {
                assert!(since > u64::from(MOST));
                (since, emptied) = (0, emptied + 1);
            }
        }
    }
}
