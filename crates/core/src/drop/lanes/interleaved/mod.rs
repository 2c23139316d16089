//! Counting that is interleaved with the bounce loop: what it is, where it is used, and all that the loop has to know of it.
//!
//! To count an impact takes some forty scalar instructions, which read and write memory: two grids, eight sums, two extremes. The stages of
//! the bounce loop are chains of vector arithmetic, in which one instruction waits for the result of another. A processor executes both at
//! once if they stand next to each other in the program. This folder arranges that; docs/performance.md has the time that it saves.
//!
//! * **A queue** has a place for each lane of every group ([`PLACES`]). [`ImpactSink::impact`](super::ImpactSink::impact) computes in all lanes at once
//!   what is to be counted and leaves it at the places of its group, [`of_group`].
//! * **Each stage works up one lane** ([`work_up`]). Eight stages take a group to its next impact, and a vector of AVX-512 has eight lanes, so
//!   that the places of the group are free when it reports that impact. A lane without an impact is worked up like the others, into sites
//!   that are never read: there is no branch.
//! * **The rest is settled** ([`Meanwhile::settle`]): the places of groups that have no particles any more, and all at the end of a run.
//!
//! It is used where it was measured to gain something: with vectors of eight lanes ([`is_interleaved`]), for the paper's runs, whose loop is
//! compiled for each sink that asks for it ([`Meanwhile::INTERLEAVED`], [`Inlined`](super::Inlined)). With four lanes it takes longer, and
//! sinks that write records are limited by memory. All other runs share one loop for every sink ([`General`](super::General)). Without
//! interleaving the impacts are settled as soon as all groups have reported them. Results do not depend on it, because integers are
//! summed, in any order.

use super::impact::Meanwhile;
use crate::law::MOST_CONTACTS;
use crate::simd::{LANES, Pack};
use pulp::Simd;
use std::ops::Range;

/// Number of groups that alternate: enough to keep the arithmetic units busy, few enough to leave room in the first-level cache.
pub(crate) const GROUPS: usize = 6;
const _: () = assert!(GROUPS <= MOST_CONTACTS);

/// Number of places.
pub(crate) const PLACES: usize = GROUPS * LANES;

/// The places of a group, one for each lane.
#[inline(always)]
pub(crate) fn of_group<S: Simd>(group: usize) -> Range<usize> {
    of_groups::<S>(group..group + 1)
}

/// The places of these groups.
#[inline(always)]
pub(super) fn of_groups<S: Simd>(groups: Range<usize>) -> Range<usize> {
    let width = Pack::<S>::WIDTH;
    groups.start * width..groups.end * width
}

/// Stages from one impact to the next.
const STAGES: usize = 8;

/// Returns whether work is interleaved at a SIMD level: only where a vector has a lane for each stage.
pub(super) const fn is_interleaved<S: Simd>() -> bool {
    Pack::<S>::WIDTH == STAGES
}

/// Works up the impact of a lane of a group, after the stage of the same number.
#[inline(always)]
pub(super) fn work_up<S: Simd>(work: &mut impl Meanwhile, group: usize, lane: usize) {
    if is_interleaved::<S>() {
        work.meanwhile(group * STAGES + lane);
    }
}

/// No work.
pub(crate) struct Idle;

impl Meanwhile for Idle {}
