//! The sink that counts impacts by row and ε, without moments.

use super::HistogramSink;
use super::axis::{Axis, ROUND};
use super::histogram::{Bins, By, Histogram, UNSPOILT, WHAT};
use super::moments::Sums;
use super::narrow::Recently;
use super::places::{all_sites, last, sites, whole};
use super::rows::{CREATES_ENERGY, Rows};
use crate::Error;
use crate::drop::Plan;
use crate::drop::StopReason;
use crate::drop::{Impact, Meanwhile, PLACES, Pose, Sink, of_group};
use crate::memory::zeros;
use crate::simd::{LANES, Pack};
use pulp::Simd;
use std::sync::Mutex;

/// Counts impacts in the grid of ε, and those that create energy, as [`super::MomentSink`] does, and nothing else.
pub(crate) struct CountSink<'a, const EVEN: bool> {
    /// Whose grids this counter and others fill.
    shared: &'a Mutex<Histogram>,
    /// The other sums.
    own: Rows,
    bins: &'a Bins,
    plan: &'a Plan<'a>,
    restitution: Vec<u32>,
    recently: Recently,
    /// The sites at which impacts are to be counted, with [`ROUND`] added.
    queue: [f64; PLACES],
}

impl<'a, const EVEN: bool> CountSink<'a, EVEN> {
    pub fn new(
        bins: &'a Bins,
        plan: &'a Plan<'a>,
        shared: &'a Mutex<Histogram>,
    ) -> Result<Self, Error> {
        let sites = bins.rows() * (bins.restitution.bins() + 1);
        Ok(Self {
            shared,
            own: Rows::new(bins, plan.run.origin())?,
            bins,
            plan,
            restitution: zeros(WHAT, sites + LANES)?,
            recently: Recently::default(),
            queue: [0.0; PLACES],
        })
    }

    /// Counts the impact at place `i` of the queue.
    #[inline(always)]
    fn count(&mut self, i: usize) {
        self.restitution[whole(self.queue[i])] += 1;
    }

    fn empty(&mut self) {
        let numbers = &mut self.own.numbers;
        let report = |row: usize, number| numbers[row] += number;
        let mut shared = self.shared.lock().expect(UNSPOILT);
        shared.restitution.absorb(&mut self.restitution, report);
    }
}

impl<const EVEN: bool> Meanwhile for CountSink<'_, EVEN> {
    const INTERLEAVED: bool = true;

    #[inline(always)]
    fn meanwhile(&mut self, place: usize) {
        self.count(place);
    }
}

impl<const EVEN: bool> Sink for CountSink<'_, EVEN> {
    fn begin(&mut self) {
        self.queue.fill(last(&self.restitution));
    }

    #[inline(always)]
    fn impact<S: Simd, P: Pose<S, K>, const K: usize>(
        &mut self,
        group: usize,
        impact: &Impact<S, P, K>,
    ) {
        let width = Pack::<S, K>::WIDTH;
        if self.recently.add(width) {
            self.empty();
        }
        let lanes = of_group::<S, K>(group);
        let restitution = impact.restitution();
        let columns = &self.bins.restitution;
        let (row, column) = match &self.bins.by {
            By::Velocity(axis) => {
                let velocity = impact.fall * self.plan.scales.speed;
                let [row, column] =
                    Axis::locate::<S, K, _, EVEN>([axis, columns], [velocity, restitution]);
                (row, column)
            }
            By::Number(_) => {
                let [column] = Axis::locate::<S, K, _, EVEN>([columns], [restitution]);
                (impact.number + ROUND, column)
            }
        };
        let start = row - ROUND;
        let defined = restitution.abs().lt(Sums::LARGEST);
        let site = if (impact.active & defined).all() {
            sites(columns, start, column)
        } else {
            let grid = (columns, &self.restitution[..]);
            all_sites(grid, start, column, defined, impact.active)
        };
        self.queue[lanes].copy_from_slice(site.as_slice());
        let (before, after) = (impact.energy_before, impact.energy_after);
        let gaining = impact.active & (before * CREATES_ENERGY).lt(after);
        if gaining.any() {
            let ratio = impact.energy_ratio();
            gaining.each(|lane| {
                let row = whole(row.as_slice()[lane]);
                self.own.gains[row].add(ratio.as_slice()[lane]);
            });
        }
    }

    fn end(&mut self, _: usize, _: usize, reason: StopReason) {
        self.own.stops[reason as usize] += 1;
    }
}

impl<const EVEN: bool> HistogramSink for CountSink<'_, EVEN> {
    fn finish(mut self) -> Rows {
        self.empty();
        self.own
    }
}
