//! a·b + c rounded once, in every lane, on machines without an instruction for it (WebAssembly).
//!
//! Error-free transformations give the product and its rounding error (T. J. Dekker, Numer. Math. **18**, 224 (1971)), and then the
//! sum of these two and c as three numbers of decreasing magnitude. The rounded sum of the two smaller ones, added to the largest, is
//! the result unless that sum was rounded to a point half-way between two results; S. Boldo and G. Melquiond, IEEE Trans. Comput.
//! **57**, 462 (2008), round to odd for this reason. Half-way points have at most three significant bits here, so that the last bits
//! of the sum show whether the result is certain. Where it is not, and where a step may have over- or underflowed, the (slow)
//! function of the standard library computes the lane.

use pulp::Simd;
#[cfg(target_arch = "wasm32")]
use pulp::bytemuck::cast;
use pulp::bytemuck::{cast_slice, cast_slice_mut};
#[cfg(target_arch = "wasm32")]
use std::arch::wasm32::v128;
use std::slice::from_mut;

/// Bound below which the rounding error of a product may not be representable. A product of 0 is below it, although it is exact.
const SMALLEST: f64 = f64::from_bits((1023 - 900) << 52);
/// In the binary representation: half a unit of the upper half of a number, and the bits of that half.
const HALF: u64 = 1 << 26;
const UPPER: u64 = !((HALF << 1) - 1);
/// The last 48 of the 52 bits of a significand.
const LAST: u64 = (1 << 48) - 1;

/// a·b + c, rounded once.
#[cfg(target_arch = "wasm32")]
#[inline(always)]
pub(super) fn mul_add<S: Simd>(simd: S, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
    if S::IS_SCALAR {
        simd.mul_add_f64s(a, b, c)
    } else {
        cast(called(simd, cast(a), cast(b), cast(c)))
    }
}

/// [`composed`] as a function that is not inlined, with its arguments in registers: inlined in every formula, it would make the
/// module many times as large.
#[cfg(target_arch = "wasm32")]
#[inline(never)]
#[allow(improper_ctypes_definitions)] // only Rust calls it; by this convention vectors stay in registers
extern "C" fn called<S: Simd>(simd: S, a: v128, b: v128, c: v128) -> v128 {
    cast(composed::<S>(simd, cast(a), cast(b), cast(c)))
}

/// a·b + c, rounded once, by operations that every machine has.
#[inline(always)]
fn composed<S: Simd>(simd: S, a: S::f64s, b: S::f64s, c: S::f64s) -> S::f64s {
    let (sum, doubt) = quick(simd, a, b, c);
    if simd.first_true_m64s(doubt) < S::F64_LANES {
        by_library::<S>(a, b, c)
    } else {
        sum
    }
}

/// a·b + c, and the lanes in which it may be wrong.
///
/// Rounding errors are subtracted, not added: where they vanish their difference is +0, and subtracting it keeps the sign of a zero.
#[inline(always)]
fn quick<S: Simd>(simd: S, a: S::f64s, b: S::f64s, c: S::f64s) -> (S::f64s, S::m64s) {
    let (product, lost) = product(simd, a, b);
    let (middle, lower) = difference(simd, c, lost);
    let (upper, rest) = sum(simd, product, middle);
    let rest = simd.add_f64s(rest, lower);
    let result = simd.sub_f64s(upper, rest);

    let last = simd.and_u64s(simd.transmute_u64s_f64s(rest), simd.splat_u64s(LAST));
    let half_way = simd.equal_u64s(last, simd.splat_u64s(0));
    let rounded = simd.not_m64s(simd.equal_f64s(lower, simd.splat_f64s(0.0)));
    let tiny = simd.less_than_f64s(simd.abs_f64s(product), simd.splat_f64s(SMALLEST));
    // After an overflow the result is infinite or NaN.
    let finite = simd.less_than_f64s(simd.abs_f64s(result), simd.splat_f64s(f64::INFINITY));
    let doubt = simd.or_m64s(simd.and_m64s(half_way, rounded), tiny);
    (result, simd.or_m64s(doubt, simd.not_m64s(finite)))
}

/// a·b rounded, and its rounding error: the rounded minus the exact product.
#[inline(always)]
fn product<S: Simd>(simd: S, a: S::f64s, b: S::f64s) -> (S::f64s, S::f64s) {
    let [(a1, a2), (b1, b2)] = [halves(simd, a), halves(simd, b)];
    let product = simd.mul_f64s(a, b);
    let mut lost = simd.sub_f64s(product, simd.mul_f64s(a1, b1));
    lost = simd.sub_f64s(lost, simd.mul_f64s(a1, b2));
    lost = simd.sub_f64s(lost, simd.mul_f64s(a2, b1));
    (product, simd.sub_f64s(lost, simd.mul_f64s(a2, b2)))
}

/// x as the sum of two numbers of 26 bits.
#[inline(always)]
fn halves<S: Simd>(simd: S, x: S::f64s) -> (S::f64s, S::f64s) {
    let raised = simd.add_u64s(simd.transmute_u64s_f64s(x), simd.splat_u64s(HALF));
    let upper = simd.transmute_f64s_u64s(simd.and_u64s(raised, simd.splat_u64s(UPPER)));
    (upper, simd.sub_f64s(x, upper))
}

/// a + b rounded, and its rounding error (D. E. Knuth).
#[inline(always)]
fn sum<S: Simd>(simd: S, a: S::f64s, b: S::f64s) -> (S::f64s, S::f64s) {
    let sum = simd.add_f64s(a, b);
    let part = simd.sub_f64s(sum, a);
    let from_a = simd.sub_f64s(simd.sub_f64s(sum, part), a);
    (sum, simd.add_f64s(from_a, simd.sub_f64s(part, b)))
}

/// a − b rounded, and its rounding error.
#[inline(always)]
fn difference<S: Simd>(simd: S, a: S::f64s, b: S::f64s) -> (S::f64s, S::f64s) {
    let difference = simd.sub_f64s(a, b);
    let part = simd.sub_f64s(difference, a);
    let from_a = simd.sub_f64s(simd.sub_f64s(difference, part), a);
    (difference, simd.add_f64s(from_a, simd.add_f64s(part, b)))
}

/// a·b + c in every lane, by the function of the standard library.
#[cold]
#[inline(never)]
fn by_library<S: Simd>(a: S::f64s, b: S::f64s, mut c: S::f64s) -> S::f64s {
    let factors = [a, b];
    let factors: &[f64] = cast_slice(&factors);
    for (i, lane) in cast_slice_mut(from_mut(&mut c)).iter_mut().enumerate() {
        *lane = f64::mul_add(factors[i], factors[S::F64_LANES + i], *lane);
    }
    c
}

#[cfg(test)]
mod tests {
    use super::super::Level;
    use super::*;
    use pulp::WithSimd;

    /// Compares with the library's function, and counts the lanes that are certain without it.
    struct Compare<'a>(&'a [[f64; 3]]);

    impl WithSimd for Compare<'_> {
        type Output = usize;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> usize {
            let mut certain = 0;
            for triples in self.0.chunks_exact(S::F64_LANES) {
                let mut numbers = [simd.splat_f64s(0.0); 3];
                for (i, lane) in cast_slice_mut::<_, f64>(&mut numbers)
                    .iter_mut()
                    .enumerate()
                {
                    *lane = triples[i % S::F64_LANES][i / S::F64_LANES];
                }
                let [a, b, c] = numbers;
                let (sum, doubt) = quick(simd, a, b, c);
                let doubts = [simd.select_f64s(doubt, simd.splat_f64s(1.0), simd.splat_f64s(0.0))];
                let results = [sum, composed(simd, a, b, c)];
                let (doubts, results) = (cast_slice::<_, f64>(&doubts), cast_slice(&results));
                for (i, &[a, b, c]) in triples.iter().enumerate() {
                    let exact = f64::mul_add(a, b, c);
                    let agrees =
                        |x: f64| x.to_bits() == exact.to_bits() || (x.is_nan() && exact.is_nan());
                    assert!(agrees(results[S::F64_LANES + i]), "{a:e} {b:e} {c:e}");
                    if doubts[i] == 0.0 {
                        assert!(
                            agrees(results[i]),
                            "{a:e} * {b:e} + {c:e}: {exact:e}, not {:e}",
                            results[i]
                        );
                        certain += 1;
                    }
                }
            }
            certain
        }
    }

    /// Random bits (SplitMix64).
    struct Bits(u64);

    impl Bits {
        fn next(&mut self) -> u64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        }

        fn between(&mut self, least: i64, most: i64) -> i64 {
            least + (self.next() % (most - least + 1) as u64) as i64
        }

        /// A number of that exponent, either sign; few of its digits are 1 (or 0) in half of the cases.
        fn number(&mut self, exponent: i64) -> f64 {
            let dense = self.next();
            let digits = match self.next() % 6 {
                0 => dense & self.next() & self.next() & self.next(),
                1 => dense | self.next() | self.next() | self.next(),
                2 => dense & (u64::MAX << self.between(0, 52)),
                _ => dense,
            };
            let field = (exponent + 1023).clamp(0, 2047) as u64;
            f64::from_bits((self.next() << 63) | (field << 52) | (digits & (u64::MAX >> 12)))
        }

        /// Factors, and an addend that is unrelated, or that leaves little of their product, or half a unit in its last place.
        fn triple(&mut self, least: i64, most: i64) -> [f64; 3] {
            let a = {
                let e = self.between(least, most);
                self.number(e)
            };
            let b = {
                let e = self.between(least, most);
                self.number(e)
            };
            let product = a * b;
            let exponent = ((product.to_bits() >> 52) & 2047) as i64 - 1023;
            let c = match self.next() % 4 {
                0 => {
                    let e = self.between(exponent - 110, exponent + 110);
                    self.number(e)
                }
                1 => f64::from_bits(
                    (-product)
                        .to_bits()
                        .wrapping_add_signed(self.between(-4, 4)),
                ),
                2 => -product * f64::from_bits(((1023 + self.between(-60, 60)) as u64) << 52),
                _ => {
                    let e = exponent + self.between(-56, 56);
                    f64::from_bits(self.number(e).to_bits() & !LAST)
                }
            };
            [a, b, c]
        }
    }

    /// Number of triples of each kind; RESTITUTION_FUSED=100000000 asks for that many.
    fn count() -> usize {
        std::env::var("RESTITUTION_FUSED").map_or(1 << 20, |count| count.parse().expect("a number"))
    }

    fn compare(mut triple: impl FnMut() -> [f64; 3], count: usize) -> f64 {
        let levels: Vec<_> = Level::available().collect();
        let mut certain = 0;
        for _ in 0..count.div_ceil(1 << 16) {
            let triples: Vec<_> = (0..1 << 16).map(|_| triple()).collect();
            certain = levels
                .iter()
                .map(|level| level.run(Compare(&triples)))
                .min()
                .expect("a level");
        }
        certain as f64 / f64::from(1 << 16)
    }

    /// Of ordinary numbers nearly all are certain; else the library's function would be compared with itself.
    #[test]
    fn is_the_fused_one_of_ordinary_numbers() {
        let mut bits = Bits(1);
        let certain = compare(|| bits.triple(-40, 40), count());
        assert!(certain > 0.6, "{certain}");
        let mut bits = Bits(2);
        let certain = compare(
            || {
                [0; 3].map(|_| {
                    let e = bits.between(-10, 10);
                    f64::from_bits(bits.number(e).to_bits() | 1)
                })
            },
            count(),
        );
        assert!(certain > 0.99, "{certain}");
    }

    #[test]
    fn is_the_fused_one_where_results_over_and_underflow() {
        let mut bits = Bits(3);
        for (least, most) in [
            (-1023, -480),
            (-560, -430),
            (480, 512),
            (505, 1024),
            (-1023, 1024),
        ] {
            compare(|| bits.triple(least, most), count() / 4);
        }
        compare(|| [0; 3].map(|_| f64::from_bits(bits.next())), count());
    }

    #[test]
    fn is_the_fused_one_of_the_outermost_numbers() {
        let least = f64::from_bits(1);
        let numbers: Vec<f64> = [
            0.0,
            least,
            2.0 * least,
            f64::MIN_POSITIVE - least,
            f64::MIN_POSITIVE,
            SMALLEST,
            0.5,
            1.0 - f64::EPSILON / 2.0,
            1.0,
            1.0 + f64::EPSILON,
            1.5,
            2.0,
            1e154,
            1.4e154,
            f64::MAX / 2.0,
            f64::MAX,
            f64::INFINITY,
            f64::NAN,
        ]
        .into_iter()
        .flat_map(|x| [x, -x])
        .collect();
        let n = numbers.len();
        let mut index = 0;
        let all = || {
            index += 1;
            [index, index / n, index / (n * n)].map(|i| numbers[i % n])
        };
        compare(all, n * n * n);
    }
}
