//! What `statistics` keeps of a run: grids of counts and sums, of a size that the bins alone decide.

use super::axis::{Axis, ROUND};
use super::moments::{Extremes, MOST_RECENT, Moments, NARROW, QUANTA, Recent, Sums};
use crate::lanes::{Impact, Mask, Pack, Sink};
use crate::plan::Plan;
use crate::trajectory::StopReason;
use pulp::Simd;

/// Quanta of E_rot/E_tot.
const FRACTION_QUANTA: f64 = 4_398_046_511_104.0; // 2⁴²

/// An impact creates energy where it multiplies the kinetic energy by more than this. Rounding makes a few 10⁻¹⁵ of it.
pub const CREATES_ENERGY: f64 = 1.0 + 1e-12;

/// What the rows of the grids stand for.
#[derive(Debug, Clone, PartialEq)]
pub enum By {
    /// Bins of the impact velocity, in m/s.
    Velocity(Axis),
    /// The number of the impact, from the first to this many.
    Number(usize),
}

/// The bins.
#[derive(Debug, Clone, PartialEq)]
pub struct Bins {
    /// Rows.
    pub by: By,
    /// Columns of the grid of ε.
    pub restitution: Axis,
    /// Columns of the grid of E_rot/E_tot.
    pub fraction: Axis,
}

impl Bins {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        match &self.by {
            By::Velocity(axis) => axis.bins(),
            By::Number(impacts) => *impacts,
        }
    }
}

/// Counts and sums of the impacts of any number of particles. Tallies with the same bins merge exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Tally {
    /// Impacts by row and bin of ε; the last column counts those whose ε is not finite or at least 2³³.
    pub restitution: Grid,
    /// Impacts by row and bin of E_rot/E_tot; the last column as above.
    pub fraction: Grid,
    /// What ε is measured from in the sums: ε^n, so that nearly round bodies lose no digits.
    origin: f64,
    /// Sums of ε − origin by row.
    sums: Vec<Sums>,
    /// Σ E_rot/E_tot by row, in units of 2⁻⁴².
    fractions: Vec<u128>,
    /// Impacts that create energy, by row.
    pub gains: Vec<Gains>,
    /// Number of particles by [`StopReason`].
    pub stops: [u64; 5],
}

/// The impacts by which kinetic energy grew by more than [`CREATES_ENERGY`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Gains {
    /// Their number.
    pub count: u64,
    /// Their largest factor; 0 without any.
    pub largest: f64,
}

impl Gains {
    /// Adds one impact, or none with a factor of 0. Stores a new largest factor only, which is rare.
    #[inline(always)]
    fn add(&mut self, count: i64, factor: f64) {
        self.count += count as u64;
        if factor > self.largest {
            self.largest = factor;
        }
    }

    fn merge(&mut self, other: Self) {
        self.count += other.count;
        self.largest = self.largest.max(other.largest);
    }
}

/// Counts in rows and columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    columns: usize,
    counts: Vec<u64>,
}

impl Grid {
    fn new(rows: usize, columns: usize) -> Self {
        Self {
            columns,
            counts: vec![0; rows * columns],
        }
    }

    /// Number of columns: one below the bins, the bins, one above, one for what has no place.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The counts, row by row.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    fn absorb(&mut self, recent: &mut [u32]) {
        for (count, recent) in self.counts.iter_mut().zip(recent) {
            *count += u64::from(std::mem::take(recent));
        }
    }

    fn merge(&mut self, other: &Self) {
        for (count, other) in self.counts.iter_mut().zip(&other.counts) {
            *count += other;
        }
    }
}

impl Tally {
    /// Of nothing; moments will be taken about `origin` first.
    pub fn new(bins: &Bins, origin: f64) -> Self {
        let rows = bins.rows();
        Self {
            restitution: Grid::new(rows, bins.restitution.bins() + 1),
            fraction: Grid::new(rows, bins.fraction.bins() + 1),
            origin,
            sums: vec![Sums::EMPTY; rows],
            fractions: vec![0; rows],
            gains: vec![Gains::default(); rows],
            stops: [0; 5],
        }
    }

    /// Adds what another tally with the same bins and origin has.
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

    /// Number of impacts of a row whose ε is defined.
    pub fn number(&self, row: usize) -> u64 {
        let columns = self.restitution.columns;
        self.restitution.counts[row * columns..][..columns - 1]
            .iter()
            .sum()
    }

    /// Moments of ε in a row.
    pub fn moments(&self, row: usize) -> Moments {
        self.sums[row].moments(self.number(row), self.origin)
    }

    /// Mean of E_rot/E_tot in a row; NaN where there are none.
    pub fn mean_fraction(&self, row: usize) -> f64 {
        self.fractions[row] as f64 / FRACTION_QUANTA / self.number(row) as f64
    }
}

/// Takes impacts into a [`Tally`], by way of narrow integers that are emptied before they can overflow. Lanes that hold no impact,
/// or none that can be summed there, go to a site or a row of their own that nobody reads, so that all lanes do the same.
pub(crate) struct Counter<'a> {
    tally: Tally,
    bins: &'a Bins,
    plan: &'a Plan<'a>,
    restitution: Vec<u32>,
    fraction: Vec<u32>,
    rows: Vec<Row>,
    /// Impacts since the last emptying.
    recent: u32,
}

/// What is recent in a row.
#[derive(Clone, Copy)]
struct Row {
    sums: Recent,
    fractions: u64,
    extremes: Extremes,
    gains: Gains,
}

impl Row {
    const EMPTY: Self = Self {
        sums: Recent::EMPTY,
        fractions: 0,
        extremes: Extremes::EMPTY,
        gains: Gains {
            count: 0,
            largest: 0.0,
        },
    };
}

impl<'a> Counter<'a> {
    pub fn new(bins: &'a Bins, plan: &'a Plan<'a>, origin: f64) -> Self {
        let tally = Tally::new(bins, origin);
        Self {
            bins,
            plan,
            restitution: vec![0; tally.restitution.counts.len() + 1],
            fraction: vec![0; tally.fraction.counts.len() + 1],
            rows: vec![Row::EMPTY; tally.sums.len() + 1],
            recent: 0,
            tally,
        }
    }

    fn empty(&mut self) {
        self.recent = 0;
        self.tally.restitution.absorb(&mut self.restitution);
        self.tally.fraction.absorb(&mut self.fraction);
        for (i, sums) in self.tally.sums.iter_mut().enumerate() {
            let row = self.rows[i];
            sums.absorb(&row.sums, &row.extremes);
            self.tally.fractions[i] += u128::from(row.fractions);
            self.tally.gains[i].merge(row.gains);
        }
        self.rows.fill(Row::EMPTY);
    }

    pub fn finish(mut self) -> Tally {
        self.empty();
        self.tally
    }
}

/// Index into a [`Grid`], plus [`ROUND`].
#[inline(always)]
fn site_of<S: Simd, const K: usize>(
    axis: &Axis,
    row: Pack<S, K>,
    x: Pack<S, K>,
    defined: Mask<S, K>,
) -> Pack<S, K> {
    let column = defined.select(axis.locate(x), axis.bins() as f64 + ROUND);
    row.mul_add((axis.bins() + 1) as f64, column)
}

/// The whole number in the low bits of a lane to which [`ROUND`] was added.
#[inline(always)]
fn whole<S: Simd, const K: usize>(pack: &Pack<S, K>, lane: usize) -> i64 {
    (pack.as_slice()[lane].to_bits() as i64).wrapping_sub(ROUND.to_bits() as i64)
}

impl Counter<'_> {
    /// Sums a value that is too far off for [`Recent`].
    #[cold]
    #[inline(never)]
    fn sum_large(&mut self, row: usize, restitution: f64, fraction: f64) {
        let quanta = (restitution - self.tally.origin) * QUANTA;
        self.tally.sums[row].add(quanta.round_ties_even() as i64);
        self.tally.fractions[row] += (fraction * FRACTION_QUANTA).round_ties_even() as u128;
        self.rows[row].extremes.add(restitution);
    }
}

impl Sink for Counter<'_> {
    fn begin(&mut self, _: usize) {}

    #[inline(always)]
    fn impact<S: Simd, const K: usize>(&mut self, number: usize, _: usize, impact: &Impact<S, K>) {
        let width = Pack::<S, K>::WIDTH;
        if self.recent + width as u32 > MOST_RECENT {
            self.empty();
        }
        self.recent += width as u32;

        let simd = impact.time.simd();
        let restitution = impact.restitution();
        let fraction = impact.rotational_fraction();
        let row = match &self.bins.by {
            By::Velocity(axis) => axis.locate(impact.fall * self.plan.scales.speed),
            By::Number(_) => Pack::splat(simd, number as f64 + ROUND),
        };
        let defined = restitution.abs().lt(Sums::LARGEST) & fraction.le(1.0);
        let offset = restitution - self.tally.origin;
        let summed = impact.active & defined;
        let plain = summed & offset.abs().le(NARROW as f64 / QUANTA);

        let (sites, fraction_sites) = (&mut self.restitution[..], &mut self.fraction[..]);
        let rows = &mut self.rows[..];
        let nowhere = |len: usize| (len - 1) as f64 + ROUND;
        let start = row - ROUND;
        let site = site_of(&self.bins.restitution, start, restitution, defined);
        let site = impact.active.select(site, nowhere(sites.len()));
        let fraction_site = site_of(&self.bins.fraction, start, fraction, defined);
        let fraction_site = impact
            .active
            .select(fraction_site, nowhere(fraction_sites.len()));
        let plain_row = plain.select(row, nowhere(rows.len()));
        let quanta = offset.mul_add(QUANTA, ROUND);
        let fraction_quanta = fraction.mul_add(FRACTION_QUANTA, ROUND);
        let (before, after) = (impact.energy_before, impact.energy_after);
        for lane in 0..width {
            sites[whole(&site, lane) as usize] += 1;
            fraction_sites[whole(&fraction_site, lane) as usize] += 1;
            let row = &mut rows[whole(&plain_row, lane) as usize];
            row.sums.add(whole(&quanta, lane));
            row.fractions = row
                .fractions
                .wrapping_add(whole(&fraction_quanta, lane) as u64);
            row.extremes.add(restitution.as_slice()[lane]);
        }
        let gaining = impact.active & (before * CREATES_ENERGY).lt(after);
        if gaining.any() {
            let factor = gaining.select(after / before, 0.0);
            let gain = gaining.select(ROUND + 1.0, ROUND);
            let row = gaining.select(row, nowhere(rows.len()));
            for lane in 0..width {
                let row = &mut rows[whole(&row, lane) as usize];
                row.gains.add(whole(&gain, lane), factor.as_slice()[lane]);
            }
        }
        let large = summed & !plain;
        if large.any() {
            large.each(|lane| {
                let (restitution, fraction) =
                    (restitution.as_slice()[lane], fraction.as_slice()[lane]);
                self.sum_large(whole(&row, lane) as usize, restitution, fraction);
            });
        }
    }

    fn end(&mut self, _: usize, _: usize, reason: StopReason) {
        self.tally.stops[reason as usize] += 1;
    }
}
