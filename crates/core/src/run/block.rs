//! A block of particles, and the choice of the bounce loop for their motion, hull and law.

use super::Plan;
use crate::Error;
use crate::body::Surface;
use crate::engine::{Apart, GROUPS, Legs, Planar, Sink, Spatial, Stuck, Together, Turn, bounce};
use crate::simd::{Level, Pack};
use crate::threads::Monitor;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Number of particles in a block: large enough that scheduling costs nothing, small enough that all threads stay busy.
pub(crate) const BLOCK: usize = 96;

impl Plan<'_> {
    /// Simulates a range of particles and hands their impacts to `sink`.
    pub fn bounce(
        &self,
        particles: Range<usize>,
        level: Level,
        monitor: &Monitor,
        sink: &mut impl Sink,
    ) -> Result<(), Error> {
        let count = particles.len() as u64;
        level.run(Block {
            plan: self,
            particles,
            monitor,
            sink,
        })?;
        monitor.add_finished(count);
        Ok(())
    }
}

/// The particles of a block, compiled for each SIMD level.
struct Block<'a, T> {
    plan: &'a Plan<'a>,
    particles: Range<usize>,
    monitor: &'a Monitor,
    sink: &'a mut T,
}

impl<T: Sink> WithSimd for Block<'_, T> {
    type Output = Result<(), Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let plan = self.plan;
        let (body, law, slope) = (&plan.body, &plan.law, plan.slope);
        if !plan.at_rest {
            return self.run::<S, Spatial>(simd, &Apart { body, law, slope });
        }
        match &body.hull {
            Surface::EqualPair(hull) if T::TOGETHER => match &plan.law.steady() {
                Some(law) => self.run::<S, Planar>(simd, &Together::new(body, hull, law, slope)),
                None => self.run::<S, Planar>(simd, &Together::new(body, hull, law, slope)),
            },
            _ => self.run::<S, Planar>(simd, &Apart { body, law, slope }),
        }
    }
}

impl<T: Sink> Block<'_, T> {
    /// Runs the particles, as many at a time as the groups hold.
    #[inline(always)]
    fn run<S: Simd, K: Turn>(self, simd: S, legs: &impl Legs<S, K>) -> Result<(), Error> {
        let Self {
            plan,
            particles,
            monitor,
            sink,
        } = self;
        let width = GROUPS * Pack::<S, 1>::WIDTH;
        for first in particles.clone().step_by(width) {
            sink.begin(first - particles.start);
            bounce::<S, K, GROUPS>(
                simd,
                (&plan.body, plan.limits()),
                legs,
                (plan, first..particles.end.min(first + width)),
                sink,
                || !monitor.is_cancelled(),
            )
            .map_err(|Stuck { lane, impacts }| Error::Numerical {
                particle: (first + lane) as u64,
                seed: plan.run.seed,
                flight: impacts as u64,
            })?;
        }
        Ok(())
    }
}
