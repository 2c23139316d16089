//! The sink that counts impacts by row and ε, without moments.

use super::HistogramSink;
use super::axis::Axis;
use super::bins::{Bins, By, WHAT};
use super::histogram::{Histogram, UNSPOILT};
use super::moments::Sums;
use super::narrow::Recently;
use super::places::{all_sites, last, sites};
use super::rows::{CREATES_ENERGY, Rows, pulling};
use super::whole::{ROUND, whole};
use crate::Error;
use crate::drop::{PLACES, of_group};
use crate::memory::zeros;
use crate::record::{Event, Meanwhile, Process, Sink};
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
    /// The unit of velocities, in m/s.
    speed: f64,
    restitution: Vec<u32>,
    recently: Recently,
    /// The sites at which impacts are to be counted, with [`ROUND`] added.
    queue: [f64; PLACES],
}

impl<'a, const EVEN: bool> CountSink<'a, EVEN> {
    pub fn new(
        bins: &'a Bins,
        (speed, origin): (f64, f64),
        reasons: usize,
        shared: &'a Mutex<Histogram>,
    ) -> Result<Self, Error> {
        let sites = bins.rows() * (bins.restitution.bins() + 1);
        Ok(Self {
            shared,
            own: Rows::new(bins, origin, reasons)?,
            bins,
            speed,
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

impl<P: Process, const EVEN: bool> Sink<P> for CountSink<'_, EVEN> {
    fn begin(&mut self) {
        self.queue.fill(last(&self.restitution));
    }

    #[inline(always)]
    fn event<S: Simd, E: Event<S, K, Of = P>, const K: usize>(&mut self, group: usize, event: &E) {
        let width = Pack::<S, K>::WIDTH;
        if self.recently.add(width) {
            self.empty();
        }
        let lanes = of_group::<S, K>(group);
        let ((_, number), active) = (event.place(), event.active());
        let restitution = event.restitution();
        let columns = &self.bins.restitution;
        let (row, column) = match &self.bins.by {
            By::Velocity(axis) => {
                let velocity = event.velocity() * self.speed;
                let [row, column] =
                    Axis::locate::<S, K, _, EVEN>([axis, columns], [velocity, restitution]);
                (row, column)
            }
            By::Number(_) => {
                let [column] = Axis::locate::<S, K, _, EVEN>([columns], [restitution]);
                (number + ROUND, column)
            }
        };
        let start = row - ROUND;
        let defined = restitution.abs().lt(Sums::LARGEST);
        let site = if (active & defined).all() {
            sites(columns, start, column)
        } else {
            let grid = (columns, &self.restitution[..]);
            all_sites(grid, start, column, defined, active)
        };
        self.queue[lanes].copy_from_slice(site.as_slice());
        let [before, after] = event.energies();
        let gaining = active & (before * CREATES_ENERGY).lt(after);
        let pulling = active & pulling(event.velocity(), restitution);
        if pulling.any() {
            pulling.each(|_| self.own.pulls += 1);
        }
        if gaining.any() {
            let ratio = event.energy_ratio();
            gaining.each(|lane| {
                let row = whole(row.as_slice()[lane]);
                self.own.gains[row].add(ratio.as_slice()[lane]);
            });
        }
    }

    fn end(&mut self, _: usize, _: usize, reason: P::Reason) {
        self.own.stops[P::number(reason)] += 1;
    }
}

impl<P: Process, const EVEN: bool> HistogramSink<P> for CountSink<'_, EVEN> {
    fn finish(mut self) -> Rows {
        self.empty();
        self.own
    }
}
