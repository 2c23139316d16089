//! Sine and cosine without the platform's mathematics library, so that every machine computes the same bits.
//!
//! The argument is reduced to |r| ≤ π/4 by subtracting a multiple of π/2 held in two constants, then two minimax
//! polynomials (relative error 2⁻⁵⁸ for the sine, absolute error 2⁻⁶⁴ for the cosine) are summed with fused
//! multiply-adds. The error stays below 1.5 ulp for |x| ≤ [`RANGE`].

/// Largest |x| that [`sincos`] is made for.
pub const RANGE: f64 = 1_048_576.0;

const TWO_OVER_PI: f64 = std::f64::consts::FRAC_2_PI;
const HALF_PI_HIGH: f64 = std::f64::consts::FRAC_PI_2;
/// π/2 − HALF_PI_HIGH.
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

/// (sin x, cos x) for |x| ≤ [`RANGE`].
pub fn sincos(x: f64) -> (f64, f64) {
    debug_assert!(x.abs() <= RANGE, "sincos({x}) is out of range");
    let shifted = x.mul_add(TWO_OVER_PI, ROUND);
    let turns = shifted - ROUND; // quarter turns, a whole number
    let quadrant = shifted.to_bits();
    let r = (-turns).mul_add(HALF_PI_LOW, (-turns).mul_add(HALF_PI_HIGH, x));

    let r2 = r * r;
    let sine = (r * r2).mul_add(polynomial(SINE, r2), r);
    let cosine = (r2 * r2).mul_add(polynomial(COSINE, r2), r2.mul_add(-0.5, 1.0));

    let (sine, cosine) = if quadrant & 1 == 0 {
        (sine, cosine)
    } else {
        (cosine, -sine)
    };
    if quadrant & 2 == 0 {
        (sine, cosine)
    } else {
        (-sine, -cosine)
    }
}

fn polynomial(c: [f64; 6], x: f64) -> f64 {
    let high = x.mul_add(c[5], c[4]);
    x.mul_add(
        x.mul_add(x.mul_add(x.mul_add(high, c[3]), c[2]), c[1]),
        c[0],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The platform's functions are good to 1 ulp, ours to 1.5; the larger of the two results sets the ulp.
        #[test]
        fn agrees_with_the_platform(x in -RANGE..RANGE) {
            let (s, c) = sincos(x);
            let (s0, c0) = x.sin_cos();
            prop_assert!((s - s0).abs() <= 2.5 * f64::EPSILON * s0.abs());
            prop_assert!((c - c0).abs() <= 2.5 * f64::EPSILON * c0.abs());
        }

        /// A mirrored motion must have mirrored bits.
        #[test]
        fn is_odd_and_even_to_the_bit(x in -RANGE..RANGE) {
            let (s, c) = sincos(x);
            prop_assert_eq!(sincos(-x), (-s, c));
        }
    }

    #[test]
    fn is_exact_at_zero() {
        assert_eq!(sincos(0.0), (0.0, 1.0));
    }
}
