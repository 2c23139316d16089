//! The normal distribution: its tail and its quantiles.

use crate::simd::elementary::{exp_in_lanes, ln, polynomial};
use crate::simd::one;

/// The probability above x ≥ 0 of the standard normal distribution φ; 0 where it is below 10⁻¹⁶ of that below. NaN, which a lane without
/// a particle may hold, ends here too.
#[inline(always)]
pub(crate) fn tail(x: f64) -> f64 {
    if x >= 8.3 || x.is_nan() {
        return 0.0;
    }
    // e^{−x²/4} twice, because the exponential goes to −32.
    let half = exp_in_lanes(one(-0.25 * x * x)).as_slice()[0];
    let density = FRAC_1_SQRT_2PI * half * half;
    if x < 3.0 {
        // Φ(x) = 1/2 + φ(x) (x + x³/3 + x⁵/(3·5) + …).
        let (mut term, mut sum) = (x, x);
        for odd in 1..40 {
            term *= x * x / f64::from(2 * odd + 1);
            sum += term;
        }
        density.mul_add(-sum, 0.5)
    } else {
        // Laplace's continued fraction φ(x)/(x + 1/(x + 2/(x + …))).
        let mut fraction = x;
        for n in (1..=40).rev() {
            fraction = x + f64::from(n) / fraction;
        }
        density / fraction
    }
}

/// 1/√2π.
const FRAC_1_SQRT_2PI: f64 = 0.398_942_280_401_432_7;

/// The quantile of the standard normal distribution, relative error 10⁻¹⁶: M. J. Wichura, *Algorithm AS 241*, Appl. Stat. **37**, 477
/// (1988).
#[inline(always)]
pub(crate) fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = q.mul_add(-q, 0.180_625);
        return q * ratio(MIDDLE, r);
    }
    let r = (-ln(if q < 0.0 { p } else { 1.0 - p })).sqrt();
    let size = if r <= 5.0 {
        ratio(NEAR, r - 1.6)
    } else {
        ratio(FAR, r - 5.0)
    };
    size.copysign(q)
}

/// The quotient of two polynomials.
#[inline(always)]
fn ratio([above, below]: [[f64; 8]; 2], x: f64) -> f64 {
    let ratio = polynomial(above, one(x)) / polynomial(below, one(x));
    ratio.as_slice()[0]
}

/// Coefficients of x⁰, x¹, ... above and below, in the middle of the distribution, beyond, and far out.
const MIDDLE: [[f64; 8]; 2] = [
    [
        3.387_132_872_796_366_5,
        133.141_667_891_784_38,
        1_971.590_950_306_551_3,
        13_731.693_765_509_46,
        45_921.953_931_549_87,
        67_265.770_927_008_7,
        33_430.575_583_588_13,
        2_509.080_928_730_122_7,
    ],
    [
        1.0,
        42.313_330_701_600_91,
        687.187_007_492_057_9,
        5_394.196_021_424_751,
        21_213.794_301_586_597,
        39_307.895_800_092_71,
        28_729.085_735_721_943,
        5_226.495_278_852_854,
    ],
];
const NEAR: [[f64; 8]; 2] = [
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        0.241_780_725_177_450_6,
        0.022_723_844_989_269_184,
        7.745_450_142_783_414e-4,
    ],
    [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        0.689_767_334_985_1,
        0.148_103_976_427_480_08,
        0.015_198_666_563_616_457,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ],
];
const FAR: [[f64; 8]; 2] = [
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        0.296_560_571_828_504_87,
        0.026_532_189_526_576_124,
        0.001_242_660_947_388_078_4,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288e-7,
    ],
    [
        1.0,
        0.599_832_206_555_888,
        0.136_929_880_922_735_8,
        0.014_875_361_290_850_615,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of erfc(x/√2)/2 from a calculation with 40 digits, and their quantiles.
    #[test]
    fn the_normal_distribution_is_itself() {
        for (x, expected) in TAILS {
            assert!((tail(x) / expected - 1.0).abs() < 1e-12, "{x}");
            assert!((quantile(expected) / -x - 1.0).abs() < 1e-13, "{x}");
        }
        assert_eq!(quantile(0.5), 0.0);
        assert_eq!(tail(f64::NAN), 0.0);
        for p in [1e-16, 1e-3, 0.07, 0.3, 0.49] {
            assert!((tail(-quantile(p)) / p - 1.0).abs() < 1e-12, "{p}");
        }
    }

    const TAILS: [(f64, f64); 6] = [
        (0.1, 0.460_172_162_722_971),
        (0.674, 0.250_155_656_840_322_6),
        (1.5, 0.066_807_201_268_858_07),
        (2.9, 0.001_865_813_300_384_038_4),
        (3.1, 0.000_967_603_213_218_356_6),
        (8.0, 6.220_960_574_271_784e-16),
    ];
}
