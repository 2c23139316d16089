//! K vectors of doubles that are processed together, with one particle per lane.
//!
//! Every operation follows IEEE 754 in every lane, so that a formula gives the same bits for every width. With several vectors the
//! processor can work on the others while it waits for the result of one.
//!
//! Loops over the vectors are written without closures, because closures are not compiled for the SIMD level of their caller.

use pulp::Simd;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Largest number of lanes of a vector.
pub(crate) const LANES: usize = 8;

/// K vectors of doubles.
#[derive(Debug, Clone, Copy)]
pub struct Pack<S: Simd, const K: usize = 1> {
    simd: S,
    vectors: [S::f64s; K],
}

/// A truth value for each lane of a [`Pack`].
#[derive(Debug, Clone, Copy)]
pub struct Mask<S: Simd, const K: usize = 1> {
    simd: S,
    masks: [S::m64s; K],
}

/// An operand of a [`Pack`]: another pack, or one number for all lanes.
pub trait Operand<S: Simd, const K: usize = 1> {
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

/// A function of packs, vector by vector: `$result` starts as `$start`, and vector k of it becomes `$value`. Without a range, of which every operation of every
/// formula would have its iterator compiled.
macro_rules! each_vector {
    ($result:ident = $start:expr, $k:ident => $value:expr) => {{
        let mut $result = $start;
        let mut $k = 0;
        while $k < K {
            $result[$k] = $value;
            $k += 1;
        }
        $result
    }};
}

/// a·b + c rounded once, by an instruction where there is one.
#[inline(always)]
fn fused<S: Simd>(simd: S, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
    #[cfg(target_arch = "wasm32")]
    return super::fused::mul_add(simd, a, b, c);
    #[cfg(not(target_arch = "wasm32"))]
    simd.mul_add_f64s(a, b, c)
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
    fn with(self, vectors: [S::f64s; K]) -> Self {
        Self { vectors, ..self }
    }

    #[inline(always)]
    fn mask(self, masks: [S::m64s; K]) -> Mask<S, K> {
        Mask {
            simd: self.simd,
            masks,
        }
    }

    #[inline(always)]
    fn no_masks(self) -> [S::m64s; K] {
        let zero = self.simd.splat_f64s(0.0);
        [self.simd.less_than_f64s(zero, zero); K]
    }

    /// Vectors `first` to `first` + H.
    #[inline(always)]
    pub fn part<const H: usize>(&self, first: usize) -> Pack<S, H> {
        let mut part = Pack::splat(self.simd, 0.0);
        part.vectors
            .copy_from_slice(&self.vectors[first..first + H]);
        part
    }

    /// Replaces vectors `first` to `first` + H.
    #[inline(always)]
    pub fn set_part<const H: usize>(&mut self, first: usize, part: &Pack<S, H>) {
        self.vectors[first..first + H].copy_from_slice(&part.vectors);
    }

    /// Transposes four packs into records of four numbers, one for each lane. The order of the lanes is not that of the packs, but
    /// always the same.
    #[inline(always)]
    pub fn records(fields: [Self; 4]) -> [[S::f64s; 4]; K] {
        let simd = fields[0].simd;
        let [a, b, c, d] = fields.map(|field| field.vectors);
        each_vector!(records = [[a[0]; 4]; K], k => {
            simd.interleave_shfl_f64s([a[k], b[k], c[k], d[k]])
        })
    }

    /// self · factor + addend, rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: impl Operand<S, K>, addend: impl Operand<S, K>) -> Self {
        let (a, simd) = (self.vectors, self.simd);
        let (b, c) = (factor.in_lanes(simd).vectors, addend.in_lanes(simd).vectors);
        self.with(each_vector!(r = a, k => fused(simd, a[k], b[k], c[k])))
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let (a, simd) = (self.vectors, self.simd);
        self.with(each_vector!(r = a, k => simd.sqrt_f64s(a[k])))
    }

    /// Absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        let (a, simd) = (self.vectors, self.simd);
        self.with(each_vector!(r = a, k => simd.abs_f64s(a[k])))
    }

    /// self < other; false where either is NaN.
    #[inline(always)]
    pub fn lt(self, other: impl Operand<S, K>) -> Mask<S, K> {
        let (a, b, simd) = (self.vectors, other.in_lanes(self.simd).vectors, self.simd);
        self.mask(each_vector!(r = self.no_masks(), k => simd.less_than_f64s(a[k], b[k])))
    }

    /// self ≤ other; false where either is NaN.
    #[inline(always)]
    pub fn le(self, other: impl Operand<S, K>) -> Mask<S, K> {
        let (a, b, simd) = (self.vectors, other.in_lanes(self.simd).vectors, self.simd);
        self.mask(each_vector!(r = self.no_masks(), k => simd.less_than_or_equal_f64s(a[k], b[k])))
    }

    /// self = other; false where either is NaN.
    #[inline(always)]
    pub fn eq(self, other: impl Operand<S, K>) -> Mask<S, K> {
        let (a, b, simd) = (self.vectors, other.in_lanes(self.simd).vectors, self.simd);
        self.mask(each_vector!(r = self.no_masks(), k => simd.equal_f64s(a[k], b[k])))
    }

    /// The larger of the two; either where they are equal or one is NaN.
    #[inline(always)]
    pub fn max(self, other: impl Operand<S, K>) -> Self {
        let (a, b, simd) = (self.vectors, other.in_lanes(self.simd).vectors, self.simd);
        self.with(each_vector!(r = a, k => simd.max_f64s(a[k], b[k])))
    }

    /// The smaller of the two; either where they are equal or one is NaN.
    #[inline(always)]
    pub fn min(self, other: impl Operand<S, K>) -> Self {
        let (a, b, simd) = (self.vectors, other.in_lanes(self.simd).vectors, self.simd);
        self.with(each_vector!(r = a, k => simd.min_f64s(a[k], b[k])))
    }

    /// Bit `bit` of the binary representation, counted from the low end.
    #[inline(always)]
    pub fn bit(self, bit: u64) -> Mask<S, K> {
        let (a, simd) = (self.vectors, self.simd);
        let wanted = simd.splat_u64s(1 << bit);
        self.mask(each_vector!(r = self.no_masks(), k => {
            simd.equal_u64s(simd.and_u64s(simd.transmute_u64s_f64s(a[k]), wanted), wanted)
        }))
    }
}

impl<S: Simd> Pack<S> {
    /// The same vector N times.
    #[inline(always)]
    pub fn repeat<const N: usize>(self) -> Pack<S, N> {
        Pack {
            simd: self.simd,
            vectors: [self.vectors[0]; N],
        }
    }
}

impl<S: Simd> Mask<S> {
    /// The same truth values N times.
    #[inline(always)]
    pub fn repeat<const N: usize>(self) -> Mask<S, N> {
        Mask {
            simd: self.simd,
            masks: [self.masks[0]; N],
        }
    }
}

impl<S: Simd, const K: usize> Mask<S, K> {
    /// The SIMD level.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.simd
    }

    /// The same truth value in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: bool) -> Self {
        let zero = Pack::splat(simd, 0.0);
        zero.eq(if value { 0.0 } else { 1.0 })
    }

    #[inline(always)]
    fn with(self, masks: [S::m64s; K]) -> Self {
        Self { masks, ..self }
    }

    /// `if_true` in the lanes that are true, else `if_false`.
    #[inline(always)]
    pub fn select(self, if_true: impl Operand<S, K>, if_false: impl Operand<S, K>) -> Pack<S, K> {
        let (m, simd) = (self.masks, self.simd);
        let a = if_true.in_lanes(simd);
        let b = if_false.in_lanes(simd).vectors;
        a.with(each_vector!(r = b, k => simd.select_f64s(m[k], a.vectors[k], b[k])))
    }

    /// Returns whether any lane is true.
    #[inline(always)]
    pub fn any(self) -> bool {
        let simd = self.simd;
        let mut all = self.masks[0];
        for k in 1..K {
            all = simd.or_m64s(all, self.masks[k]);
        }
        simd.first_true_m64s(all) < size_of::<S::f64s>() / size_of::<f64>()
    }

    /// Returns whether all lanes are true.
    #[inline(always)]
    pub fn all(self) -> bool {
        !(!self).any()
    }

    /// Returns whether a lane is true.
    #[inline(always)]
    pub fn get(self, lane: usize) -> bool {
        self.select(1.0, 0.0).as_slice()[lane] == 1.0
    }

    /// Sets a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: bool) {
        let mut lanes = self.select(1.0, 0.0);
        lanes.as_mut_slice()[lane] = f64::from(value);
        *self = lanes.eq(1.0);
    }

    /// Calls `f` with every lane that is true, in order.
    #[inline(always)]
    pub fn each(self, mut f: impl FnMut(usize)) {
        let lanes = self.select(1.0, 0.0);
        for lane in 0..Pack::<S, K>::WIDTH {
            if lanes.as_slice()[lane] == 1.0 {
                f(lane);
            }
        }
    }
}

/// A logical operator between masks.
macro_rules! logical {
    ($trait:ident, $method:ident, $simd:ident) => {
        impl<S: Simd, const K: usize> $trait for Mask<S, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let (a, b, simd) = (self.masks, other.masks, self.simd);
                self.with(each_vector!(r = a, k => simd.$simd(a[k], b[k])))
            }
        }
    };
}

logical!(BitAnd, bitand, and_m64s);
logical!(BitOr, bitor, or_m64s);
logical!(BitXor, bitxor, xor_m64s);

impl<S: Simd, const K: usize> Not for Mask<S, K> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        let (a, simd) = (self.masks, self.simd);
        self.with(each_vector!(r = a, k => simd.not_m64s(a[k])))
    }
}

impl<S: Simd, const K: usize> Neg for Pack<S, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let (a, simd) = (self.vectors, self.simd);
        self.with(each_vector!(r = a, k => simd.neg_f64s(a[k])))
    }
}

/// An arithmetic operator between packs, between a pack and a number, and between a number and a pack.
macro_rules! operator {
    ($trait:ident, $method:ident, $simd:ident) => {
        impl<S: Simd, const K: usize, B: Operand<S, K>> $trait<B> for Pack<S, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: B) -> Self {
                let (a, b) = (self.vectors, other.in_lanes(self.simd).vectors);
                self.with(each_vector!(r = a, k => self.simd.$simd(a[k], b[k])))
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
