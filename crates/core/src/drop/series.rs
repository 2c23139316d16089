//! Several runs side by side: particles that differ only in how they are released.

use super::{Bounces, Plan, Run};
use crate::Error;
use crate::record::Source;
use std::ops::Range;

impl Source for Plan<'_> {
    type Of = Bounces;

    #[inline(always)]
    fn plan(&self) -> &Plan<'_> {
        self
    }

    #[inline(always)]
    fn origin(&self, particle: usize) -> (&Plan<'_>, usize) {
        (self, particle)
    }
}

/// Parts of several runs, whose particles are numbered from part to part.
pub(crate) struct JoinedRuns<'a> {
    plans: Vec<Plan<'a>>,
    /// Number in its run of the first particle of each part.
    first: Vec<usize>,
    /// Number of the particles up to the end of each part.
    ends: Vec<usize>,
}

impl<'a> JoinedRuns<'a> {
    /// # Errors
    /// As [`Plan::new`], [`Plan::check_part`], and [`Error::Parameter`] if there is no run, or runs differ in more than seed, number of
    /// particles and release.
    pub fn new(runs: &'a [(Run<'a>, Range<usize>)]) -> Result<Self, Error> {
        let allowed = "one or more that differ in seed, number of particles and release alone";
        let alike = runs.windows(2).all(|two| two[0].0.is_like(&two[1].0));
        Error::unless(!runs.is_empty() && alike, "runs", runs.len(), allowed)?;
        let mut end = 0;
        let mut series = Self {
            plans: Vec::with_capacity(runs.len()),
            first: Vec::with_capacity(runs.len()),
            ends: Vec::with_capacity(runs.len()),
        };
        for (run, part) in runs {
            let plan = Plan::new(run)?;
            plan.check_part(part)?;
            end += part.len();
            series.plans.push(plan);
            series.first.push(part.start);
            series.ends.push(end);
        }
        Ok(series)
    }

    /// Number of all particles.
    pub fn particles(&self) -> usize {
        self.ends[self.ends.len() - 1]
    }
}

impl Source for JoinedRuns<'_> {
    type Of = Bounces;

    #[inline(always)]
    fn plan(&self) -> &Plan<'_> {
        &self.plans[0]
    }

    #[inline(always)]
    fn origin(&self, particle: usize) -> (&Plan<'_>, usize) {
        let part = self.ends.partition_point(|&end| end <= particle);
        let before = if part > 0 { self.ends[part - 1] } else { 0 };
        (&self.plans[part], self.first[part] + (particle - before))
    }
}
