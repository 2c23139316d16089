//! Integers in the low bits of doubles.

/// 1.5 · 2⁵²: adding it to |x| < 2⁵¹ rounds to the nearest integer, which then stands in the low bits.
pub(super) const ROUND: f64 = 6_755_399_441_055_744.0;

/// The integer in the low bits of `x`, to which [`ROUND`] was added. It is below 2³², see [`super::Bins::check`].
#[inline(always)]
pub(super) fn whole(x: f64) -> usize {
    x.to_bits() as u32 as usize
}
