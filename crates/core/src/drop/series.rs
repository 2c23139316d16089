//! A run, or several side by side: particles that differ only in how they are released.

use super::{Plan, Run};
use crate::Error;
use std::ops::Range;

/// Parts of one run or of several, whose particles are numbered from part to part.
pub(crate) struct JoinedRuns<'a>(Vec<RunPart<'a>>);

/// Some particles of a run.
struct RunPart<'a> {
    plan: Plan<'a>,
    /// Number in the run of the first of them.
    first: usize,
    /// Their numbers among those of all parts.
    numbers: Range<usize>,
}

impl<'a> JoinedRuns<'a> {
    /// # Errors
    /// As [`Plan::new`], [`Plan::check_part`], and [`Error::Parameter`] if there is no run, or runs differ in more than seed, number of
    /// particles and release.
    pub fn new(runs: &'a [(Run<'a>, Range<usize>)]) -> Result<Self, Error> {
        let allowed = "one or more that differ in seed, number of particles and release alone";
        let alike = runs.windows(2).all(|two| two[0].0.is_like(&two[1].0));
        Error::unless(!runs.is_empty() && alike, "runs", runs.len(), allowed)?;
        let mut start = 0;
        let parts = runs.iter().map(|(run, part)| {
            let plan = Plan::new(run)?;
            plan.check_part(part)?;
            let numbers = start..start + part.len();
            start = numbers.end;
            Ok(RunPart {
                plan,
                first: part.start,
                numbers,
            })
        });
        Ok(Self(parts.collect::<Result<_, Error>>()?))
    }

    /// All particles of a run.
    pub fn of(run: &'a Run<'a>) -> Result<Self, Error> {
        Ok(Self(vec![RunPart {
            plan: Plan::new(run)?,
            first: 0,
            numbers: 0..run.particles,
        }]))
    }

    /// Number of all particles.
    pub fn particles(&self) -> usize {
        self.0[self.0.len() - 1].numbers.end
    }

    /// What is the same for all particles.
    #[inline(always)]
    pub fn plan(&self) -> &Plan<'a> {
        &self.0[0].plan
    }

    /// The run of a particle, and its number there.
    #[inline(always)]
    pub fn origin(&self, particle: usize) -> (&Plan<'a>, usize) {
        let part = self.0.partition_point(|part| part.numbers.end <= particle);
        let part = &self.0[part];
        (&part.plan, part.first + (particle - part.numbers.start))
    }
}
