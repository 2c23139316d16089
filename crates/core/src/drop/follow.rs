//! One particle of a run, followed impact by impact, for a drawing of its motion.

use crate::Error;
use crate::drop::single::{Lone, trajectory_of};
use crate::drop::{NoConvergence, SingleImpact, StopReason};
use crate::drop::{Plan, Run, Scales};
use crate::motion::State;
use crate::shape::Body;

/// A particle of a run, ready to be released.
pub struct Followed<'a> {
    plan: Plan<'a>,
    particle: usize,
    body: Body,
    /// The core's units of length, time and speed, in SI units.
    pub scales: Scales,
    /// The state at release, in the core's units.
    pub release: State,
}

impl<'a> Followed<'a> {
    /// Particle number `particle` of a body of revolution, with the random numbers that it has in [`Run::simulate`].
    ///
    /// # Errors
    /// [`Error::Parameter`] or [`Error::Magnitude`] for a parameter of the run out of range, or a particle that it does not have.
    pub fn new(run: &'a Run<'a>, particle: usize) -> Result<Self, Error> {
        let plan = Plan::new(run)?;
        let body = run.body.revolution()?.scaled;
        let allowed = "less than the number of particles";
        Error::unless(particle < run.particles, "particle", particle, allowed)?;
        Ok(Self {
            particle,
            scales: plan.scales,
            release: plan.state(&body, particle),
            body,
            plan,
        })
    }

    /// Simulates the particle until it stops. `record` is called with every impact, in the core's units, and returns whether to
    /// continue. The impacts have the same bits as in [`Run::simulate`].
    ///
    /// # Errors
    /// [`Error::Numerical`] if a contact search does not converge.
    pub fn bounce(
        &self,
        mut record: impl FnMut(&SingleImpact) -> bool,
    ) -> Result<StopReason, Error> {
        let plan = &self.plan;
        let mut impacts = 0;
        let mut counted = |impact: &SingleImpact| {
            impacts += 1;
            record(impact)
        };
        let limits = plan.limits();
        let release = Lone {
            state: self.release,
            drawn: (plan.run.seed, self.particle as u64),
        };
        trajectory_of(
            &release,
            &self.body,
            &plan.law,
            plan.slope,
            limits,
            &mut counted,
        )
        .map_err(|NoConvergence| Error::Numerical {
            particle: self.particle as u64,
            seed: plan.run.seed,
            flight: impacts,
        })
    }
}
