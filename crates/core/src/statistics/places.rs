//! The sites of a grid at which impacts are counted: integers in the low bits of doubles, to which [`ROUND`] was added.

use super::axis::Axis;
use super::whole::ROUND;
use crate::simd::{LANES, Mask, Pack};
use pulp::Simd;

/// The last sites, which are never read, plus [`ROUND`]: one for each lane, so that none waits for another.
#[inline(always)]
pub(super) fn nowhere<S: Simd, T>(simd: S, places: &[T]) -> Pack<S, 1> {
    let mut sites = Pack::splat(simd, last(places));
    for (lane, site) in sites.as_mut_slice().iter_mut().enumerate() {
        *site -= (lane % LANES) as f64;
    }
    sites
}

/// The last of them.
pub(super) fn last<T>(places: &[T]) -> f64 {
    (places.len() - 1) as f64 + ROUND
}

/// Numbers of the sites in `column` of row number `start`.
#[inline(always)]
pub(super) fn sites<S: Simd>(axis: &Axis, start: Pack<S, 1>, column: Pack<S, 1>) -> Pack<S, 1> {
    start.mul_add(axis.stride, column)
}

/// The same where values may be undefined, which are counted in the last column, or a lane may have no impact, which is counted at a
/// site that is never read.
#[inline(always)]
pub(super) fn all_sites<S: Simd>(
    (axis, counts): (&Axis, &[u32]),
    start: Pack<S, 1>,
    column: Pack<S, 1>,
    defined: Mask<S, 1>,
    active: Mask<S, 1>,
) -> Pack<S, 1> {
    let column = defined.select(column, axis.beyond() + ROUND);
    active.select(sites(axis, start, column), nowhere(start.simd(), counts))
}
