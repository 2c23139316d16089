//! The table of all impacts of a run, filled block by block from many threads.

use super::columns::{Block, ROOM, Records};
use crate::Error;
use crate::drop::{Height, Plan, Source};
use crate::drop::{Impact, Meanwhile, Pose, Sink, StopReason};
use crate::math::Quaternion;
use crate::memory::empty;
use crate::shape::AnyBody;
use crate::simd::elementary::angle;
use crate::threads::Monitor;
use pulp::Simd;

/// Largest number of cells that are blanked after a cancellation, which takes some tenths of a second.
const MOST_BLANKED: usize = 1 << 22;
/// Number of cells that are blanked between two checks for a cancellation.
const STRIDE: usize = 1 << 16;

impl Records {
    /// Completes the table of a cancelled run quickly, however long the rows are: the columns end with the longest row, and where
    /// blanking the rest would take long, the particles that were interrupted are left out. The first row is that of the particle
    /// `first`.
    pub(crate) fn settle(&mut self, first: usize) {
        self.reached = self.longest();
        if self.missing() > MOST_BLANKED {
            self.leave_out_cut_short(first);
            self.reached = self.longest();
        }
        let reached = self.reached;
        let mut rows = self.block();
        for row in 0..rows.impacts.len() {
            if !rows.settled[row] {
                rows.blank(row, rows.impacts[row] as usize..reached);
            }
        }
    }

    fn longest(&self) -> usize {
        self.impacts.iter().max().map_or(0, |&most| most as usize)
    }

    /// Number of cells that would have to be blanked.
    fn missing(&self) -> usize {
        let open = self.settled.iter().zip(&self.impacts);
        let open = open.filter(|(settled, _)| !**settled);
        open.map(|(_, &impacts)| self.reached - impacts as usize)
            .sum()
    }

    /// Keeps the rows of the particles that finished, and records their numbers.
    fn leave_out_cut_short(&mut self, first: usize) {
        let cut_short = |&row: &usize| self.stop_reason[row] == StopReason::Interrupted as i8;
        let kept: Vec<usize> = (0..self.particles())
            .filter(|row| !cut_short(row))
            .collect();
        for (place, &row) in kept.iter().enumerate() {
            self.move_up(row, place);
        }
        self.truncate(kept.len());
        self.particle = kept.into_iter().map(|row| (first + row) as i64).collect();
    }

    /// Adds the release of the particles from `first` on, where more than the angle varies.
    pub(crate) fn add_release(&mut self, plan: &Plan<'_>, first: usize) -> Result<(), Error> {
        let particle = |row: usize, this: &Self| {
            let known = this.particle.get(row);
            known.map_or(first + row, |&number| number as usize)
        };
        if let Height::Random { .. } = plan.run.release_height {
            self.release_height = empty(ROOM, self.particles())?;
            for row in 0..self.particles() {
                let height = plan.release_height(particle(row, self));
                self.release_height.push(height);
            }
        }
        if plan.at_rest {
            return Ok(());
        }
        self.release_spin = empty(ROOM, self.particles())?;
        match plan.run.body {
            AnyBody::Revolution(solid) => {
                self.release_azimuth = empty(ROOM, self.particles())?;
                for row in 0..self.particles() {
                    let (azimuth, spin) = plan.spinning(&solid.scaled, particle(row, self));
                    self.release_azimuth.push(azimuth);
                    self.release_spin.push([spin.x, spin.y, spin.z]);
                }
            }
            AnyBody::Rigid(body) => {
                self.release_attitude = empty(ROOM, self.particles())?;
                for row in 0..self.particles() {
                    let particle = particle(row, self);
                    let Quaternion { w, x, y, z } = plan.attitude(particle);
                    let spin = plan.spin(body, particle);
                    self.release_attitude.push([w, x, y, z]);
                    self.release_spin.push([spin.x, spin.y, spin.z]);
                }
            }
        }
        Ok(())
    }
}

/// The sink that records the impacts of a block of particles in its rows.
pub(crate) struct Table<'a> {
    block: Block<'a>,
    plan: &'a Plan<'a>,
    /// The particle of row 0.
    first: usize,
}

impl<'a> Table<'a> {
    /// The rows of the particles from `particle` on.
    pub fn new(block: Block<'a>, source: &'a impl Source, particle: usize) -> Self {
        for (i, release_angle) in block.release_angle.iter_mut().enumerate() {
            let (plan, number) = source.origin(particle + i);
            let (sine, cosine) = plan.release(number);
            *release_angle = angle(sine, cosine);
        }
        Self {
            block,
            plan: source.plan(),
            first: particle,
        }
    }

    /// Blanks the cells after the last impact of each particle, unless the run is cancelled meanwhile.
    pub fn finish(mut self, monitor: &Monitor) {
        let end = self.block.columns;
        for row in 0..self.block.impacts.len() {
            let mut first = self.block.impacts[row] as usize;
            while first < end {
                if monitor.is_cancelled() {
                    return;
                }
                let next = end.min(first + STRIDE);
                self.block.blank(row, first..next);
                first = next;
            }
            self.block.settled[row] = true;
        }
    }
}

impl Meanwhile for Table<'_> {
    const INTERLEAVED: bool = false;

    fn meanwhile(&mut self, _: usize) {}
}

impl Sink for Table<'_> {
    fn begin(&mut self) {}

    #[inline(always)]
    fn impact<S: Simd, P: Pose<S, K>, const K: usize>(
        &mut self,
        _: usize,
        impact: &Impact<S, P, K>,
    ) {
        self.block.record(self.first, impact, self.plan);
    }

    fn end(&mut self, particle: usize, impacts: usize, reason: StopReason) {
        let row = particle - self.first;
        self.block.impacts[row] = impacts as i64;
        self.block.stop_reason[row] = reason as i8;
    }
}
