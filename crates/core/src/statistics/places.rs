//! Where impacts are counted: whole numbers in the low bits of doubles, with [`ROUND`] added to them.

use super::axis::{Axis, ROUND};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// The whole number in the low bits of `x`, to which [`ROUND`] was added. All are below 2³², see [`super::Bins::check`].
#[inline(always)]
pub(super) fn whole(x: f64) -> usize {
    x.to_bits() as u32 as usize
}

/// The last place, which is not read, plus [`ROUND`].
#[inline(always)]
pub(super) fn nowhere<T>(places: &[T]) -> f64 {
    (places.len() - 1) as f64 + ROUND
}

/// Numbers in a grid: `column` of the row that is `start` rows from the first.
#[inline(always)]
pub(super) fn sites<S: Simd, const K: usize>(
    axis: &Axis,
    start: Pack<S, K>,
    column: Pack<S, K>,
) -> Pack<S, K> {
    start.mul_add(axis.stride, column)
}

/// The same where there may be impacts that are not defined, in the last column, or none, at a site that is not read.
#[inline(always)]
pub(super) fn all_sites<S: Simd, const K: usize>(
    (axis, counts): (&Axis, &[u32]),
    start: Pack<S, K>,
    column: Pack<S, K>,
    defined: Mask<S, K>,
    active: Mask<S, K>,
) -> Pack<S, K> {
    let column = defined.select(column, axis.beyond() + ROUND);
    active.select(sites(axis, start, column), nowhere(counts))
}
