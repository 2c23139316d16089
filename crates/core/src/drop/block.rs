//! A block of particles, and the choice of the bounce loop for their motion, hull and law.

use super::lanes::{
    Advance, Dimension, GROUPS, General, ImpactSink, Inlined, Lost, Planar, Release, Spatial,
    bounce,
};
use super::{JoinedRuns, rigid};
use crate::Error;
use crate::motion::State;
use crate::random::of_impact;
use crate::shape::{AnyBody, Body, Rigid, Surface};
use crate::simd::Level;
use crate::threads::Monitor;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Smallest number of particles in a block: large enough that scheduling costs nothing, small enough that all threads stay busy.
pub(crate) const BLOCK: usize = 96;
/// Largest number of particles in a block, at whose end some lanes have none left.
const LARGEST: usize = 960;

/// Number of particles in the next block, of those that are left to some threads: a multiple of [`BLOCK`], so that no lane is idle where
/// all particles live equally long.
pub(crate) fn share(left: usize, threads: usize) -> usize {
    // One thread has nobody to wait for it.
    let most = if threads > 1 {
        left / (3 * threads)
    } else {
        left
    };
    (most / BLOCK * BLOCK).clamp(BLOCK, LARGEST).min(left)
}

/// Number of particles in each of the blocks that some threads share evenly, all but the last.
pub(crate) fn even(particles: usize, threads: usize) -> usize {
    let blocks = particles.div_ceil(LARGEST).next_multiple_of(threads);
    particles.div_ceil(blocks)
}

/// Simulates a range of particles and hands their impacts to `sink`.
pub(crate) fn bounce_block(
    runs: &JoinedRuns<'_>,
    particles: Range<usize>,
    level: Level,
    monitor: &Monitor,
    sink: &mut impl ImpactSink,
) -> Result<(), Error> {
    let count = particles.len() as u64;
    let plan = runs.plan();
    // A law of one's own may take long: the fewer contacts it is asked about at a time, the sooner a run that is cancelled ends.
    let level = match plan.law.custom {
        Some(_) => Level::Scalar,
        None => level,
    };
    let block = Block {
        runs,
        particles,
        monitor,
        sink,
    };
    let ended = match &plan.run.body {
        AnyBody::Revolution(solid) => level.run(SymmetricBlock(block, &solid.scaled)),
        AnyBody::Rigid(body) => level.run_scalar_at(RigidBlock(block, body)),
    };
    // The other threads need not go on.
    ended.inspect_err(|_| monitor.cancel())?;
    monitor.add_finished(count);
    Ok(())
}

/// The particles of a block.
struct Block<'a, T> {
    runs: &'a JoinedRuns<'a>,
    particles: Range<usize>,
    monitor: &'a Monitor,
    sink: &'a mut T,
}

/// Bodies of revolution, one in each lane.
struct SymmetricBlock<'a, T>(Block<'a, T>, &'a Body);

/// Bodies of any shape, one after the other.
struct RigidBlock<'a, T>(Block<'a, T>, &'a Rigid);

impl<T: ImpactSink> WithSimd for SymmetricBlock<'_, T> {
    type Output = Result<(), Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self(block, body) = self;
        let plan = block.runs.plan();
        let (law, slope) = (&plan.law, plan.slope);
        // The paper's runs have a bounce loop of their own where they are not held up by memory.
        match (&body.hull, plan.at_rest, &plan.law.steady()) {
            (Surface::EqualBalls(hull), true, Some(law)) if T::INTERLEAVED => {
                let cycle = Inlined {
                    body,
                    hull,
                    law,
                    slope,
                };
                block.run::<S, Planar>(simd, body, &cycle)
            }
            (_, true, _) => block.run::<S, Planar>(simd, body, &General { body, law, slope }),
            (_, false, _) => block.run::<S, Spatial>(simd, body, &General { body, law, slope }),
        }
    }
}

impl<T: ImpactSink> Block<'_, T> {
    #[inline(always)]
    fn run<S: Simd, K: Dimension>(
        self,
        simd: S,
        body: &Body,
        cycle: &impl Advance<S, K>,
    ) -> Result<(), Error> {
        let runs = self.runs;
        bounce::<S, K, _, GROUPS>(
            simd,
            (body, runs.plan().limits()),
            cycle,
            (&Released { runs, body }, self.particles),
            self.sink,
            || !self.monitor.is_cancelled(),
        )
        .map_err(|lost| error(runs, lost))
    }
}

impl<T: ImpactSink> WithSimd for RigidBlock<'_, T> {
    type Output = Result<(), Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self(block, body) = self;
        let runs = block.runs;
        let plan = runs.plan();
        let bouncing = rigid::Bouncing { plan, body };
        block.sink.begin();
        for particle in block.particles {
            if block.monitor.is_cancelled() {
                break;
            }
            let (plan, number) = runs.origin(particle);
            let start = plan.rigid(body, number);
            let chance = |impact| of_impact(plan.run.seed, number as u64, impact);
            bouncing
                .bounce(simd, (particle, start), chance, block.sink, || {
                    !block.monitor.is_cancelled()
                })
                .map_err(|lost| error(runs, lost))?;
        }
        Ok(())
    }
}

/// The start of the particles of a body of revolution.
struct Released<'a> {
    runs: &'a JoinedRuns<'a>,
    body: &'a Body,
}

impl Release for Released<'_> {
    #[inline(always)]
    fn start(&self, particle: usize) -> State {
        let (plan, number) = self.runs.origin(particle);
        plan.state(self.body, number)
    }

    fn chance(&self, particle: usize, impact: usize) -> f64 {
        let (plan, number) = self.runs.origin(particle);
        of_impact(plan.run.seed, number as u64, impact as u64)
    }
}

/// The error that names the particle, its seed and the flight or the impact in question.
fn error(runs: &JoinedRuns<'_>, lost: Lost) -> Error {
    let (plan, number) = runs.origin(lost.particle);
    let (particle, seed) = (number as u64, plan.run.seed);
    let impact = lost.impacts as u64;
    match lost.fault {
        None => Error::Numerical {
            particle,
            seed,
            flight: impact,
        },
        Some(fault) => Error::Law {
            law: plan.law.custom.map_or("", |law| law.name()).to_owned(),
            particle,
            seed,
            impact,
            fault: *fault,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest number of whole vectors up to a third of what each thread has left, of all that is left to a single one; 96 and 960 are
    /// the least and the most.
    #[test]
    fn blocks_shrink_with_what_is_left() {
        for threads in 1..9 {
            for left in (1..2000).chain([10_000, 123_456]) {
                let waits = if threads > 1 { 3 * threads } else { 1 };
                let fits = |&size: &usize| size * waits <= left;
                let largest = (1..=10).map(|blocks| 96 * blocks).rfind(fits);
                assert_eq!(share(left, threads), largest.unwrap_or(96).min(left));
            }
        }
    }

    /// The smallest blocks of which no more are needed than threads can share evenly, of 960 particles at most.
    #[test]
    fn threads_have_equally_many_blocks() {
        for threads in 1..9 {
            for particles in (1..3000).chain([10_000, 123_456]) {
                let size = even(particles, threads);
                let mut shared = (threads..).step_by(threads);
                let blocks = shared.find(|blocks| 960 * blocks >= particles).unwrap();
                assert!(size <= 960 && blocks * size >= particles);
                assert!(blocks * (size - 1) < particles);
            }
        }
    }
}
