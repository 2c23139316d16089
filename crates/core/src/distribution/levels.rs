//! Quantile levels of impacts under a distribution, counted: they are uniform on [0, 1] if the distribution is the impacts' own.

use super::Mixture;
use super::batches::{Impacts, STRIDE};
use crate::memory::{empty, zeros};
use crate::random::pair;
use crate::{Error, Monitor, Resources};
use std::ops::Range;
use std::sync::Mutex;

/// Number of equal parts of [0, 1] in which the levels of all impacts are counted.
pub const FINE: usize = 4096;
/// Number of those in which they are counted batch by batch.
pub const COARSE: usize = 256;
/// The argument that determines the memory of the counts.
const ROOM: &str = "velocities";
/// Seed of the numbers that spread the levels of point masses.
const SEED: u64 = 1;

/// Counts of u = F(ε | v) in each interval between two nodes.
#[derive(Debug)]
pub struct Levels {
    intervals: usize,
    /// Counts in [`FINE`] parts of each interval, one for each thread that has counted; their sum does not depend on the order.
    fine: Mutex<Vec<Vec<u64>>>,
    batches: Vec<LevelBatch>,
}

#[derive(Debug)]
struct LevelBatch {
    number: u64,
    /// The number of levels that were spread.
    spread: u64,
    /// In [`COARSE`] parts of each interval.
    coarse: Vec<u64>,
}

impl Levels {
    /// No levels yet, between as many nodes as there are, in batches of particles.
    ///
    /// # Errors
    /// [`Error::Parameter`] for fewer than two nodes or no batch, and [`Error::Memory`].
    pub fn new(nodes: usize, batches: usize) -> Result<Self, Error> {
        Error::unless(nodes >= 2, "nodes", nodes, ">= 2")?;
        Error::unless(batches > 0, "batches", batches, "> 0")?;
        let intervals = nodes - 1;
        let batches = (0..batches as u64).map(|number| {
            Ok(LevelBatch {
                number,
                spread: 0,
                coarse: zeros(ROOM, intervals * COARSE)?,
            })
        });
        Ok(Self {
            intervals,
            fine: Mutex::default(),
            batches: batches.collect::<Result<_, Error>>()?,
        })
    }

    /// Counts the levels of the impacts from the first node up to, not including, the last; those with ε that is not finite do not
    /// count. Restitutions that differ by less than `point` are the same: the level of one that has a probability of its own is
    /// spread evenly between those on either side of it, by random numbers.
    ///
    /// # Errors
    /// [`Error::Parameter`] if the distribution has other nodes, and [`Error::Threads`].
    pub fn add(
        &mut self,
        mixture: &Mixture,
        point: f64,
        impacts: &Impacts<'_>,
        resources: Resources,
        monitor: &Monitor,
    ) -> Result<(), Error> {
        let nodes = &mixture.layout.nodes;
        let allowed = "as many as when the counts were made";
        let same = nodes.number() == self.intervals + 1;
        Error::unless(same, "nodes", nodes.number(), allowed)?;
        let has_points = mixture.has_points(point);
        let Self {
            intervals,
            fine,
            batches,
        } = self;
        let fine = &*fine;
        let own = || {
            let known = fine.lock().expect("nobody panics who holds it").pop();
            let fine = known.map_or_else(|| zeros(ROOM, *intervals * FINE), Ok)?;
            Ok((fine, empty(ROOM, STRIDE)?))
        };
        let give = |(counted, _)| {
            let mut known = fine.lock().expect("nobody panics who holds it");
            known.push(counted);
        };
        impacts.count_in(
            batches,
            (resources, monitor),
            own,
            give,
            |batch, (fine, places), cells| {
                for cell in cells {
                    let impact = impacts.at(cell);
                    if !nodes.counts(impact) {
                        continue;
                    }
                    let (v, e, z) = impact;
                    let around = nodes.around(v);
                    let parts = nodes.parts(around, z);
                    let mut u = mixture.below(&parts, e);
                    if has_points {
                        let below = mixture.below(&parts, e - point);
                        let above = mixture.below(&parts, e + point);
                        if above - below > 0.5 / FINE as f64 {
                            u = below + batch.even() * (above - below);
                        }
                    }
                    let place = ((u * FINE as f64) as usize).min(FINE - 1);
                    places.push(around.0 * FINE + place);
                }
                // Apart from the searches, which would wait for memory that is far away.
                for place in places.drain(..) {
                    fine[place] += 1;
                    batch.coarse[place / (FINE / COARSE)] += 1;
                }
            },
        )
    }

    /// The counts of all impacts in an interval, shape ([`FINE`],).
    ///
    /// # Errors
    /// [`Error::Parameter`] for an interval that there is not.
    pub fn fine(&self, interval: usize) -> Result<Vec<u64>, Error> {
        let levels = self.levels(interval, FINE)?;
        let mut sum = zeros(ROOM, FINE)?;
        for counted in &*self.fine.lock().expect("nobody panics who holds it") {
            for (sum, count) in sum.iter_mut().zip(&counted[levels.clone()]) {
                *sum += count;
            }
        }
        Ok(sum)
    }

    /// The counts of the batches in an interval, shape (batch, [`COARSE`]).
    ///
    /// # Errors
    /// As [`Levels::fine`].
    pub fn coarse(&self, interval: usize) -> Result<impl Iterator<Item = u64>, Error> {
        let levels = self.levels(interval, COARSE)?;
        let batches = self.batches.iter();
        Ok(batches.flat_map(move |b| b.coarse[levels.clone()].iter().copied()))
    }

    /// The places of the levels of an interval.
    fn levels(&self, interval: usize, number: usize) -> Result<Range<usize>, Error> {
        let allowed = "one of the intervals";
        Error::unless(interval < self.intervals, "interval", interval, allowed)?;
        Ok(interval * number..(interval + 1) * number)
    }
}

impl LevelBatch {
    /// The next number of this batch that is uniform on [0, 1).
    fn even(&mut self) -> f64 {
        let index = self.spread << 16 | self.number;
        self.spread += 1;
        pair(SEED, index).0
    }
}
