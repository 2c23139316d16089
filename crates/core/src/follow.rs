//! One particle of a run, followed impact by impact: for those who draw its motion.

use crate::Error;
use crate::engine::{NoConvergence, Release, SingleImpact, StopReason, trajectory};
use crate::flight::State;
use crate::run::{Plan, Run, Scales};

/// A particle of a run, ready to be released.
pub struct Followed<'a> {
    plan: Plan<'a>,
    particle: usize,
    /// The units of what is seen, in SI.
    pub scales: Scales,
    /// How it is released, in the core's units.
    pub release: State,
}

impl<'a> Followed<'a> {
    /// The particle of this number, with the random numbers that it has in [`Run::simulate`].
    pub fn new(run: &'a Run<'a>, particle: usize) -> Result<Self, Error> {
        let plan = Plan::new(run)?;
        let allowed = "less than the number of particles";
        Error::unless(particle < run.particles, "particle", particle, allowed)?;
        Ok(Self {
            particle,
            scales: plan.scales,
            release: plan.start(particle),
            plan,
        })
    }

    /// Bounces it to its end. `record` sees every impact, in the core's units, and says whether to go on. The impacts are
    /// those of [`Run::simulate`] to the last bit.
    pub fn bounce(
        &self,
        mut record: impl FnMut(&SingleImpact) -> bool,
    ) -> Result<StopReason, Error> {
        let plan = &self.plan;
        let mut impacts = 0;
        let counted = |impact: &SingleImpact| {
            impacts += 1;
            record(impact)
        };
        let limits = plan.limits();
        trajectory(
            &plan.body,
            &plan.law,
            plan.slope,
            self.release,
            limits,
            counted,
        )
        .map_err(|NoConvergence| Error::Numerical {
            particle: self.particle as u64,
            seed: plan.run.seed,
            flight: impacts,
        })
    }
}
