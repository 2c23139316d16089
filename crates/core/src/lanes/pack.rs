//! K vectors of doubles that are computed with side by side, one particle a lane.
//!
//! Every operation is the IEEE 754 one in every lane, so that a formula gives the same bits whatever the width. More
//! than one vector at a time keeps the processor busy while it waits for the results of the first.

use pulp::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// K vectors of doubles.
#[derive(Clone, Copy)]
pub struct Pack<S: Simd, const K: usize> {
    simd: S,
    vectors: [S::f64s; K],
}

/// A truth value for each lane of a [`Pack`].
#[derive(Clone, Copy)]
pub struct Mask<S: Simd, const K: usize> {
    simd: S,
    masks: [S::m64s; K],
}

/// What can stand in a formula beside a [`Pack`]: another one, or a number for all lanes.
pub trait Operand<S: Simd, const K: usize> {
    /// The operand in every lane.
    fn in_lanes(self, simd: S) -> Pack<S, K>;
}

impl<S: Simd, const K: usize> Operand<S, K> for Pack<S, K> {
    #[inline(always)]
    fn in_lanes(self, _: S) -> Self {
        self
    }
}

impl<S: Simd, const K: usize> Operand<S, K> for f64 {
    #[inline(always)]
    fn in_lanes(self, simd: S) -> Pack<S, K> {
        Pack::splat(simd, self)
    }
}

impl<S: Simd, const K: usize> Pack<S, K> {
    /// Number of lanes.
    pub const WIDTH: usize = K * size_of::<S::f64s>() / size_of::<f64>();

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self {
            simd,
            vectors: [simd.splat_f64s(value); K],
        }
    }

    /// The numbers in the lanes.
    #[inline(always)]
    pub fn as_slice(&self) -> &[f64] {
        pulp::bytemuck::cast_slice(&self.vectors)
    }

    /// The numbers in the lanes, to be changed.
    #[inline(always)]
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        pulp::bytemuck::cast_slice_mut(&mut self.vectors)
    }

    /// The SIMD level.
    #[inline(always)]
    pub fn simd(&self) -> S {
        self.simd
    }

    #[inline(always)]
    fn map(self, f: impl Fn(S::f64s) -> S::f64s) -> Self {
        Self {
            simd: self.simd,
            vectors: self.vectors.map(f),
        }
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(S::f64s, S::f64s) -> S::f64s) -> Self {
        Self {
            simd: self.simd,
            vectors: std::array::from_fn(|k| f(self.vectors[k], other.vectors[k])),
        }
    }

    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(S::f64s, S::f64s) -> S::m64s) -> Mask<S, K> {
        Mask {
            simd: self.simd,
            masks: std::array::from_fn(|k| f(self.vectors[k], other.vectors[k])),
        }
    }

    /// self · factor + addend, rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: impl Operand<S, K>, addend: impl Operand<S, K>) -> Self {
        let (b, c) = (factor.in_lanes(self.simd), addend.in_lanes(self.simd));
        Self {
            simd: self.simd,
            vectors: std::array::from_fn(|k| {
                self.simd
                    .mul_add_f64s(self.vectors[k], b.vectors[k], c.vectors[k])
            }),
        }
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(|a| self.simd.sqrt_f64s(a))
    }

    /// Absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(|a| self.simd.abs_f64s(a))
    }

    /// self < other; false where either is NaN.
    #[inline(always)]
    pub fn lt(self, other: impl Operand<S, K>) -> Mask<S, K> {
        self.compare(other.in_lanes(self.simd), |a, b| {
            self.simd.less_than_f64s(a, b)
        })
    }

    /// self ≤ other; false where either is NaN.
    #[inline(always)]
    pub fn le(self, other: impl Operand<S, K>) -> Mask<S, K> {
        self.compare(other.in_lanes(self.simd), |a, b| {
            self.simd.less_than_or_equal_f64s(a, b)
        })
    }

    /// self = other; false where either is NaN.
    #[inline(always)]
    pub fn eq(self, other: impl Operand<S, K>) -> Mask<S, K> {
        self.compare(other.in_lanes(self.simd), |a, b| self.simd.equal_f64s(a, b))
    }

    /// The larger of the two; `self` where that is not larger, and where either is NaN.
    #[inline(always)]
    pub fn max(self, other: impl Operand<S, K>) -> Self {
        let other = other.in_lanes(self.simd);
        self.lt(other).select(other, self)
    }

    /// The smaller of the two; `self` where that is not smaller, and where either is NaN.
    #[inline(always)]
    pub fn min(self, other: impl Operand<S, K>) -> Self {
        let other = other.in_lanes(self.simd);
        other.lt(self).select(other, self)
    }

    /// Bit `bit` of the binary representation, counted from the low end.
    #[inline(always)]
    pub fn bit(self, bit: u64) -> Mask<S, K> {
        let wanted = self.simd.splat_u64s(1 << bit);
        Mask {
            simd: self.simd,
            masks: self.vectors.map(|a| {
                let bits = self.simd.transmute_u64s_f64s(a);
                self.simd
                    .equal_u64s(self.simd.and_u64s(bits, wanted), wanted)
            }),
        }
    }
}

impl<S: Simd, const K: usize> Mask<S, K> {
    /// The same truth value in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: bool) -> Self {
        let zero = Pack::splat(simd, 0.0);
        zero.eq(if value { 0.0 } else { 1.0 })
    }

    /// Lane by lane one or the other.
    #[inline(always)]
    pub fn select(self, if_true: impl Operand<S, K>, if_false: impl Operand<S, K>) -> Pack<S, K> {
        let (a, b) = (if_true.in_lanes(self.simd), if_false.in_lanes(self.simd));
        Pack {
            simd: self.simd,
            vectors: std::array::from_fn(|k| {
                self.simd
                    .select_f64s(self.masks[k], a.vectors[k], b.vectors[k])
            }),
        }
    }

    /// Whether any lane is true.
    #[inline(always)]
    pub fn any(self) -> bool {
        let lanes = size_of::<S::f64s>() / size_of::<f64>();
        let all = self
            .masks
            .into_iter()
            .reduce(|a, b| self.simd.or_m64s(a, b))
            .expect("a mask has at least one vector");
        self.simd.first_true_m64s(all) < lanes
    }

    /// Calls `f` with every lane that is true, in order.
    #[inline(always)]
    pub fn each(self, mut f: impl FnMut(usize)) {
        for (lane, &here) in self.select(1.0, 0.0).as_slice().iter().enumerate() {
            if here == 1.0 {
                f(lane);
            }
        }
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(S::m64s, S::m64s) -> S::m64s) -> Self {
        Self {
            simd: self.simd,
            masks: std::array::from_fn(|k| f(self.masks[k], other.masks[k])),
        }
    }
}

impl<S: Simd, const K: usize> BitAnd for Mask<S, K> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.zip(other, |a, b| self.simd.and_m64s(a, b))
    }
}

impl<S: Simd, const K: usize> BitOr for Mask<S, K> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        self.zip(other, |a, b| self.simd.or_m64s(a, b))
    }
}

impl<S: Simd, const K: usize> Not for Mask<S, K> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self {
            simd: self.simd,
            masks: self.masks.map(|a| self.simd.not_m64s(a)),
        }
    }
}

impl<S: Simd, const K: usize> Neg for Pack<S, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| self.simd.neg_f64s(a))
    }
}

/// The arithmetic operators between packs, and between a pack and a number.
macro_rules! operator {
    ($trait:ident, $method:ident, $simd:ident) => {
        impl<S: Simd, const K: usize, B: Operand<S, K>> $trait<B> for Pack<S, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: B) -> Self {
                let other = other.in_lanes(self.simd);
                self.zip(other, |a, b| self.simd.$simd(a, b))
            }
        }

        impl<S: Simd, const K: usize> $trait<Pack<S, K>> for f64 {
            type Output = Pack<S, K>;
            #[inline(always)]
            fn $method(self, other: Pack<S, K>) -> Pack<S, K> {
                Pack::splat(other.simd, self).$method(other)
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);
