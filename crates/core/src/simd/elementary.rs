//! Sine, cosine, the angle of a unit vector and the fifth root without the platform's mathematics library, so that every
//! machine computes the same bits.
//!
//! The argument of sine and cosine is reduced to |r| ≤ π/4 by subtracting a multiple of π/2, which is represented by two constants;
//! then two minimax polynomials (relative error 2⁻⁵⁸ for the sine, absolute error 2⁻⁶⁴ for the cosine) are evaluated with fused
//! multiply-adds. The error is below 1.5 ulp for |x| ≤ [`RANGE`] (1.48 in three million trials), or, next to a multiple kπ/2, below
//! 1.5·10⁻³³k, the error of the two constants.

use super::{Pack, one};
use pulp::Simd;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LN_2, LOG2_E, PI};

/// Largest |x|, in rad, for which sine and cosine are accurate.
pub const RANGE: f64 = 1_048_576.0;

/// π/2 less its double.
const HALF_PI_LOW: f64 = 6.123_233_995_736_766e-17;
/// 1.5 · 2⁵²: adding it rounds to the nearest integer and leaves that integer in the low bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// (sin r − r)/r³ as a polynomial in r², |r| ≤ π/4.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666_3,
    0.008_333_333_333_322_108,
    -0.000_198_412_698_295_801_6,
    2.755_731_361_801_543e-6,
    -2.505_074_721_794_08e-8,
    1.589_619_762_296_309e-10,
];
/// (cos r − 1 + r²/2)/r⁴ as a polynomial in r², |r| ≤ π/4.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_412_5,
    2.480_158_728_948_217_8e-5,
    -2.755_731_435_233_002e-7,
    2.087_572_327_277_255e-9,
    -1.135_964_777_678_250_6e-11,
];

/// (sin x − x)/x³ as a polynomial in x²; the error of the sine is below 2·10⁻¹⁷ |x| for |x| ≤ ½.
const MODERATE_SINE: [f64; 5] = [
    -0.166_666_666_666_662_8,
    0.008_333_333_333_114_798,
    -0.000_198_412_694_388_044_73,
    2.755_699_571_075_892e-6,
    -2.493_401_965_198_418_5e-8,
];
/// (cos x − 1)/x² as a polynomial in x²; the error of the cosine is below 10⁻¹⁹ for |x| ≤ ½.
const MODERATE_COSINE: [f64; 6] = [
    -0.5,
    0.041_666_666_666_664_87,
    -0.001_388_888_888_842_341_3,
    2.480_158_674_731_553_4e-5,
    -2.755_698_550_351_582_5e-7,
    2.077_788_303_436_378_3e-9,
];

/// sin(π/8).
const SINE_PI_8: f64 = 0.382_683_432_365_089_8;
/// (asin x − x)/x³ as a polynomial in x², |x| ≤ sin(π/8); relative error 2⁻⁵⁷.
const ARCSINE: [f64; 10] = [
    0.166_666_666_666_660_94,
    0.075_000_000_001_881_06,
    0.044_642_856_929_283_75,
    0.030_381_956_426_919_432,
    0.022_371_773_992_678_604,
    0.017_360_383_646_243_337,
    0.013_869_196_407_709_604,
    0.012_310_930_198_600_92,
    0.006_123_478_299_975_783,
    0.017_596_519_728_901_87,
];

/// (sin x, cos x) for |x| ≤ [`RANGE`].
#[inline(always)]
pub fn sincos(x: f64) -> (f64, f64) {
    debug_assert!(x.abs() <= RANGE, "sincos({x}) is out of range");
    let (sine, cosine) = sincos_in_lanes(one(x));
    (sine.as_slice()[0], cosine.as_slice()[0])
}

/// (sin x, cos x) in every lane, for |x| ≤ [`RANGE`].
#[inline(always)]
pub(crate) fn sincos_in_lanes<S: Simd, const K: usize>(x: Pack<S, K>) -> (Pack<S, K>, Pack<S, K>) {
    let shifted = x.mul_add(FRAC_2_PI, ROUND);
    let turns = ROUND - shifted; // minus the number of quarter turns, an integer
    let r = turns.mul_add(HALF_PI_LOW, turns.mul_add(FRAC_PI_2, x));

    let r2 = r * r;
    let sine = (r * r2).mul_add(polynomial(SINE, r2), r);
    let most = r2.mul_add(-0.5, 1.0);
    let lost = r2.mul_add(-0.5, 1.0 - most); // rounding error of `most`
    let cosine = most + (r2 * r2).mul_add(polynomial(COSINE, r2), lost);

    // Quarter turn 1: (c, −s), 2: (−s, −c), 3: (−c, s).
    let (odd, half) = (shifted.bit(0), shifted.bit(1));
    let (sine, cosine) = (odd.select(cosine, sine), odd.select(sine, cosine));
    let other = odd ^ half;
    (half.select(-sine, sine), other.select(-cosine, cosine))
}

/// (sin x, cos x) in every lane, for |x| ≤ ½.
#[inline(always)]
pub(crate) fn moderate_sincos_in_lanes<S: Simd, const K: usize>(
    x: Pack<S, K>,
) -> (Pack<S, K>, Pack<S, K>) {
    let x2 = x * x;
    let sine = (x * x2).mul_add(polynomial(MODERATE_SINE, x2), x);
    let cosine = x2.mul_add(polynomial(MODERATE_COSINE, x2), 1.0);
    (sine, cosine)
}

/// Angle in [0, π] between the z axis and a unit vector with these horizontal and vertical components.
#[inline(always)]
pub fn angle(sine: f64, cosine: f64) -> f64 {
    angle_in_lanes(one(sine), one(cosine)).as_slice()[0]
}

/// [`angle`] in every lane.
#[inline(always)]
pub(crate) fn angle_in_lanes<S: Simd, const K: usize>(
    sine: Pack<S, K>,
    cosine: Pack<S, K>,
) -> Pack<S, K> {
    let (s, c) = (sine.abs(), cosine.abs());
    // φ ≤ π/4 is the angle to the nearer one of the z axis and the horizontal; above π/8, π/4 − φ is computed instead.
    let level = c.lt(s);
    let (near, far) = (level.select(c, s), level.select(s, c));
    let wide = !near.le(SINE_PI_8);
    let x = wide.select((far - near) * FRAC_1_SQRT_2, near); // sin(π/4 − φ) or sin φ
    let x2 = x * x;
    let arcsine = (x * x2).mul_add(polynomial(ARCSINE, x2), x);
    let phi = wide.select(FRAC_PI_4 - arcsine, arcsine);
    let theta = level.select(FRAC_PI_2 - phi, phi);
    cosine.lt(0.0).select(PI - theta, theta)
}

#[inline(always)]
pub(crate) fn polynomial<S: Simd, const K: usize, const N: usize>(
    c: [f64; N],
    x: Pack<S, K>,
) -> Pack<S, K> {
    let mut sum = Pack::splat(x.simd(), c[N - 1]);
    for i in (0..N - 1).rev() {
        sum = sum.mul_add(x, c[i]);
    }
    sum
}

/// eˣ on [−1, 1] as a polynomial in x; relative error 10⁻¹⁸.
const EXPONENTIAL: [f64; 16] = [
    1.0,
    1.0,
    0.500_000_000_000_000_2,
    0.166_666_666_666_666_69,
    0.041_666_666_666_662_695,
    0.008_333_333_333_333_1,
    0.001_388_888_888_920_654,
    0.000_198_412_698_414_564_46,
    2.480_158_717_684_911_7e-5,
    2.755_731_915_070_489_2e-6,
    2.755_734_581_622_287e-7,
    2.505_212_400_895_333_5e-8,
    2.087_361_813_361_095e-9,
    1.605_719_945_417_951_8e-10,
    1.166_341_573_342_601e-11,
    7.760_406_418_336_239e-13,
];

/// eˣ − 1 in every lane, for |x| ≤ 32, from y = e^{x/32} − 1 by (1 + y)² − 1 = y(y + 2) five times; accurate for small x as well.
#[inline(always)]
pub(crate) fn exp_m1_in_lanes<S: Simd, const K: usize>(x: Pack<S, K>) -> Pack<S, K> {
    let part = 0.03125 * x;
    let mut terms = [0.0; EXPONENTIAL.len() - 1];
    terms.copy_from_slice(&EXPONENTIAL[1..]);
    let mut y = part * polynomial(terms, part);
    for _ in 0..5 {
        y = y * (y + 2.0);
    }
    y
}

/// eˣ in every lane, for |x| ≤ 32, to within a few rounding errors, or 32 where eˣ is below 1/e.
#[inline(always)]
pub(crate) fn exp_in_lanes<S: Simd, const K: usize>(x: Pack<S, K>) -> Pack<S, K> {
    let mut small = polynomial(EXPONENTIAL, 0.03125 * x);
    for _ in 0..5 {
        small = small * small;
    }
    x.lt(-1.0).select(small, 1.0 + exp_m1_in_lanes(x))
}

/// ln x of a positive number that is not subnormal, to within 2 ulp of the larger of its two parts.
///
/// x = 2^k m with m in [√½, √2): ln m = 2 artanh s with s = (m − 1)/(m + 1), by the series of artanh; the first neglected term is
/// below 10⁻¹⁷ of the sum.
#[inline(always)]
pub(crate) fn ln(x: f64) -> f64 {
    let shifted = x.to_bits().wrapping_sub(FRAC_1_SQRT_2.to_bits());
    let exponent = (shifted as i64 >> 52) as f64;
    let m = f64::from_bits((shifted & (u64::MAX >> 12)) + FRAC_1_SQRT_2.to_bits());
    let s = (m - 1.0) / (m + 1.0);
    let square = s * s;
    let mut sum = 0.0_f64;
    for k in (1..12).rev() {
        sum = square.mul_add(sum, 1.0 / f64::from(2 * k + 1));
    }
    exponent.mul_add(LN_2, 2.0 * (s * square).mul_add(sum, s))
}

/// The fifth root of a positive number that is not subnormal, or of 0. The error stays below 1 ulp.
///
/// The first guess, a fifth of the exponent in the binary representation, has an error of 3.4 %. Each step of Halley's method cubes
/// the error and doubles it; a final step of Newton's method, whose residual is rounded once, leaves only the rounding error of the
/// result.
#[inline(always)]
pub fn fifth_root(x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let mut y = f64::from_bits(FIFTH_OF_BIAS + x.to_bits() / 5);
    for _ in 0..2 {
        let fifth = (y * y) * (y * y) * y;
        y *= 2.0_f64.mul_add(fifth, 3.0 * x) / 3.0_f64.mul_add(fifth, 2.0 * x);
    }
    let fourth = (y * y) * (y * y);
    y - fourth.mul_add(y, -x) / (5.0 * fourth)
}

/// Four fifths of the bits of 1, minus an offset that makes the error of the first guess symmetric.
const FIFTH_OF_BIAS: u64 = 0x3325_ce66_6666_6666;

/// eˣ for |x| < 700, to within 2 ulp, as 2ⁿeʸ with |y| ≤ ½ ln 2: by products and sums alone, for loops in which the compiler takes several
/// numbers at once also where multiply-adds are not fused.
#[inline(always)]
pub(crate) fn plain_exp(x: f64) -> f64 {
    /// ln 2 as a number of 32 bits and the rest.
    const HIGH: f64 = 0.693_147_180_369_123_8;
    const LOW: f64 = 1.908_214_929_270_587_7e-10;
    let shifted = x * LOG2_E + ROUND;
    let n = shifted - ROUND;
    let y = (x - n * HIGH) - n * LOW;
    let mut sum = EXPONENTIAL[14];
    for k in (0..14).rev() {
        sum = sum * y + EXPONENTIAL[k];
    }
    f64::from_bits(sum.to_bits().wrapping_add(shifted.to_bits() << 52))
}

/// The largest power of two that is not larger than a positive number.
pub(crate) fn power_of_two(x: f64) -> f64 {
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & (0x7ff << 52))
}

/// ln x of a positive number, to within 0.06, from its representation.
pub(crate) fn rough_ln(x: f64) -> f64 {
    ((x.to_bits() >> 20) as f64 / (1_u64 << 32) as f64 - 1022.957) * LN_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sincos_of_moderate(x: f64) -> (f64, f64) {
        let (sine, cosine) = moderate_sincos_in_lanes(one(x));
        (sine.as_slice()[0], cosine.as_slice()[0])
    }

    proptest! {
        /// The platform's functions are good to 1 ulp, ours to 1.5; the larger of the two results sets the ulp.
        #[test]
        fn agrees_with_the_platform(x in -RANGE..RANGE) {
            let (s, c) = sincos(x);
            let (s0, c0) = x.sin_cos();
            prop_assert!((s - s0).abs() <= 2.5 * f64::EPSILON * s0.abs());
            prop_assert!((c - c0).abs() <= 2.5 * f64::EPSILON * c0.abs());
        }

        /// Absolute errors count, for the results turn an axis: half a unit in the last place of 1, and the platform's own.
        #[test]
        fn moderate_angles_agree_with_the_platform(x in -0.5..0.5_f64) {
            let (s, c) = sincos_of_moderate(x);
            let (s0, c0) = x.sin_cos();
            prop_assert!((s - s0).abs() <= 0.5 * f64::EPSILON * 0.5 + 2.0 * f64::EPSILON * s0.abs());
            prop_assert!((c - c0).abs() <= f64::EPSILON);
            prop_assert_eq!(sincos_of_moderate(-x), (-s, c));
        }

        /// A mirrored motion must have mirrored bits.
        #[test]
        fn is_odd_and_even_to_the_bit(x in -RANGE..RANGE) {
            let (s, c) = sincos(x);
            prop_assert_eq!(sincos(-x), (-s, c));
        }
    }

    proptest! {
        /// Beside the platform's, which is good to 1 ulp: two ulp of the result and of its larger part, a multiple of ln 2.
        #[test]
        fn the_logarithm_is_that_of_the_platform(x in prop_oneof![1e-300..1.0_f64, 0.5..2.0_f64, 1.0..1e300_f64]) {
            let exact = x.ln();
            prop_assert!((ln(x) - exact).abs() <= 2.0 * f64::EPSILON * exact.abs());
        }
    }

    proptest! {
        /// A part in 10¹⁵ of a half turn, and back through sine and cosine.
        #[test]
        fn angle_undoes_sincos(x in 0.0..PI) {
            let (s, c) = sincos(x);
            prop_assert!((angle(s, c) - x).abs() <= 2.0 * f64::EPSILON);
            prop_assert_eq!(angle(-s, c), angle(s, c));
        }
    }

    proptest! {
        /// Beside the platform's power function, which is good to 1 ulp, at every magnitude; the larger result sets the ulp.
        #[test]
        fn the_fifth_root_agrees_with_the_platform(exponent in -300.0..300.0_f64) {
            let x = 10.0_f64.powf(exponent);
            let (y, y0) = (fifth_root(x), x.powf(0.2));
            // 0.2 is not a fifth: its rounding counts ln x times.
            let power = 1.0 + 0.06 * x.ln().abs();
            prop_assert!((y - y0).abs() <= (1.0 + power) * f64::EPSILON * y0, "{x:e} {y:e} {y0:e}");
        }

        /// Fifth powers that are doubles have their root exactly.
        #[test]
        fn the_fifth_root_of_a_fifth_power_is_exact(root in 1..1552_u32, scale in -60..60_i32) {
            let root = f64::from(root) * 2.0_f64.powi(scale);
            prop_assert_eq!(fifth_root(root.powi(5)), root);
        }
    }

    proptest! {
        /// A doubling of the exponent at most doubles a relative error and adds two roundings.
        #[test]
        fn the_exponential_agrees_with_the_platform(x in -32.0..32.0_f64) {
            let found = exp_m1_in_lanes(one(x)).as_slice()[0];
            prop_assert!((found - x.exp_m1()).abs() <= 64.0 * f64::EPSILON * x.exp_m1().abs());
            let found = exp_in_lanes(one(x)).as_slice()[0];
            prop_assert!((found - x.exp()).abs() <= 64.0 * f64::EPSILON * x.exp());
        }

        /// Where it is small a doubling adds its two roundings only, ten in all.
        #[test]
        fn a_small_exponent_keeps_its_digits(x in -1e-3..1e-3_f64) {
            let found = exp_m1_in_lanes(one(x)).as_slice()[0];
            prop_assert!((found - x.exp_m1()).abs() <= 6.0 * f64::EPSILON * x.abs());
        }
    }

    /// Beside Taylor's series in integers, units of 2⁻⁶²: up to π/4 the result is rounded once, and r² before it, which leaves a quarter
    /// of the last place at most; roundings of the small second part leave less than 0.03 of it.
    #[test]
    fn small_angles_are_rounded_once() {
        for k in (1_i128 << 51..7_074_237_752_028_440).step_by(200_000_000_003) {
            let angle = k << 9;
            let square = (angle * angle) >> 62;
            let series = |first: i128| {
                let terms = [0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24];
                terms.iter().rev().fold(1_i128 << 62, |sum, n| {
                    let n = first + n;
                    (1 << 62) - ((square * sum) >> 62) / (n * (n + 1))
                })
            };
            let (sine, cosine) = sincos(k as f64 * 2.0_f64.powi(-53));
            for (found, exact) in [(cosine, series(1)), (sine, (angle * series(2)) >> 62)] {
                let off = (found * 2.0_f64.powi(62)) as i128 - exact;
                let last = f64::EPSILON * found.log2().floor().exp2();
                let places = off as f64 * 2.0_f64.powi(-62) / last;
                assert!(places.abs() < 0.78, "{k} {places}");
            }
        }
    }

    #[test]
    fn is_exact_at_zero() {
        assert_eq!(fifth_root(0.0), 0.0);
        assert_eq!(sincos(0.0), (0.0, 1.0));
    }
}
