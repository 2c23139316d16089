//! The bounce loop: flight to the next contact, impact, and again, for several groups of particles in alternation.

use super::end::{Limits, StopReason};
use super::group::{Group, Release, Stuck};
use super::impact::Sink;
use super::leg::Legs;
use super::strike::Turn;
use crate::body::Body;
use crate::simd::Pack;
use pulp::{Simd, WithSimd};
use std::hint::black_box;
use std::ops::Range;

/// Simulates the `particles` of a release, as many at a time as N groups have lanes. Calls `go_on` before every impact.
///
/// `legs` takes the groups from one impact to the next; this function passes the impacts on and ends the trajectories.
#[inline(always)]
pub(crate) fn bounce<S: Simd, T: Turn, L: Legs<S, T>, const N: usize>(
    simd: S,
    (body, limits): (&Body, Limits),
    legs: &L,
    (release, mut particles): (&impl Release, Range<usize>),
    sink: &mut impl Sink,
    go_on: impl Fn() -> bool,
) -> Result<(), Stuck> {
    let mut groups = legs.groups::<N>(simd);
    let width = Pack::<S, 1>::WIDTH;
    let count = particles.len().div_ceil(width).min(N);
    // Of a slice that it knows to be short the compiler would write out every stage for each group, which then do not fit into the
    // instruction cache.
    let mut groups = black_box(&mut groups[..count]);
    let mut ended = true;
    sink.begin();
    loop {
        if ended {
            legs.occupy(groups, release, &mut particles);
            let before = groups.len();
            groups = in_use(groups);
            if L::TOGETHER {
                sink.settle(width * groups.len()..width * before);
            }
        }
        if groups.is_empty() {
            return Ok(());
        }
        if !go_on() {
            break;
        }
        legs.fly(groups, sink)?;
        ended = simd.vectorize(Tell {
            groups: &mut *groups,
            body,
            limits,
            sink: &mut *sink,
            settle: !L::TOGETHER,
        });
    }
    if L::TOGETHER {
        sink.settle(0..width * groups.len());
    }
    for group in groups {
        group.end(group.active, StopReason::Interrupted);
        group.close(sink);
    }
    Ok(())
}

/// The groups that have particles, which the others make way for.
fn in_use<S: Simd, T: Turn>(groups: &mut [Group<S, T>]) -> &mut [Group<S, T>] {
    let mut count = 0;
    for i in 0..groups.len() {
        if groups[i].active.any() {
            if i > count {
                groups.swap(i, count);
            }
            count += 1;
        }
    }
    &mut groups[..count]
}

/// Hands an impact of all groups to the sink, and returns whether some particle has ended. Compiled separately, because the rare
/// branches of the sinks would take registers from the other stages.
struct Tell<'a, S: Simd, T: Turn, K> {
    groups: &'a mut [Group<S, T>],
    body: &'a Body,
    limits: Limits,
    sink: &'a mut K,
    /// Whether the sink works the impacts up here.
    settle: bool,
}

impl<S: Simd, T: Turn, K: Sink> WithSimd for Tell<'_, S, T, K> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<U: Simd>(self, _: U) -> bool {
        let width = Pack::<S, 1>::WIDTH;
        let mut ended = false;
        for (i, group) in self.groups.iter_mut().enumerate() {
            ended |= group.tell(i, self.body, self.limits, self.sink);
        }
        if self.settle {
            self.sink.settle(0..width * self.groups.len());
        }
        ended
    }
}
