//! Structures of packs and masks, with a value in each lane as these have.

use super::{Mask, Pack};
use pulp::Simd;

/// A value in each lane.
pub(crate) trait Lanewise<S: Simd>: Copy {
    /// 0 and false in every lane: before anything is known.
    fn none(simd: S) -> Self;
    /// The same values, but those of `other` in the lanes of the mask.
    fn or(self, mask: Mask<S>, other: Self) -> Self;
}

impl<S: Simd> Lanewise<S> for Pack<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        Self::splat(simd, 0.0)
    }

    #[inline(always)]
    fn or(self, mask: Mask<S>, other: Self) -> Self {
        mask.select(other, self)
    }
}

impl<S: Simd> Lanewise<S> for Mask<S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        Self::splat(simd, false)
    }

    #[inline(always)]
    fn or(self, mask: Mask<S>, other: Self) -> Self {
        (other & mask) | (self & !mask)
    }
}

/// [`Lanewise`] of structures, from all of their fields.
macro_rules! lanewise {
    ($($type:ty { $($field:ident),+ })+) => { $(
        impl<S: Simd> crate::simd::Lanewise<S> for $type {
            #[inline(always)]
            fn none(simd: S) -> Self {
                Self { $($field: crate::simd::Lanewise::none(simd)),+ }
            }

            #[inline(always)]
            fn or(self, mask: crate::simd::Mask<S>, other: Self) -> Self {
                Self { $($field: crate::simd::Lanewise::or(self.$field, mask, other.$field)),+ }
            }
        }
    )+ };
}
pub(crate) use lanewise;
