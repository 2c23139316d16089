//! The bounce loop: flight to the next contact, impact, and again, for several groups of particles in alternation.

use super::end::{Limits, StopReason};
use super::group::{Group, Release, Stuck};
use super::impact::Sink;
use super::leg::Legs;
use super::strike::Turn;
use crate::body::Body;
use crate::simd::Pack;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Simulates the `particles` of a release, at most as many as N groups hold. Calls `go_on` before every impact.
///
/// `legs` takes the groups from one impact to the next; this function passes the impacts on and ends the trajectories.
#[inline(always)]
pub(crate) fn bounce<S: Simd, T: Turn, const N: usize>(
    simd: S,
    (body, limits): (&Body, Limits),
    legs: &impl Legs<S, T>,
    (release, particles): (&impl Release, Range<usize>),
    sink: &mut impl Sink,
    go_on: impl Fn() -> bool,
) -> Result<(), Stuck> {
    let mut groups = legs.groups::<N>(simd, release, particles.clone());
    let groups = &mut groups[..particles.len().div_ceil(Pack::<S, 1>::WIDTH)];
    let mut number = 0;
    let last = loop {
        if number == limits.impacts {
            break StopReason::ImpactsReached;
        }
        if !go_on() {
            break StopReason::Interrupted;
        }
        legs.fly(simd, groups, number, sink)?;
        let active = simd.vectorize(Tell {
            groups: &mut *groups,
            body,
            limits,
            number,
            sink: &mut *sink,
        });
        number += 1;
        if !active {
            break StopReason::ImpactsReached;
        }
    };
    for group in groups {
        group.end(group.active, number, last);
        group.close(sink);
    }
    Ok(())
}

/// Hands an impact of all groups to the sink, and returns whether any particle continues. Compiled separately, because the rare
/// branches of the sinks would take registers from the other stages.
struct Tell<'a, S: Simd, T: Turn, K> {
    groups: &'a mut [Group<S, T>],
    body: &'a Body,
    limits: Limits,
    number: usize,
    sink: &'a mut K,
}

impl<S: Simd, T: Turn, K: Sink> WithSimd for Tell<'_, S, T, K> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> Self::Output {
        let mut active = false;
        for group in self.groups.iter_mut() {
            group.tell(self.body, self.limits, self.number, self.sink);
            active |= group.active.any();
        }
        active
    }
}
