//! A normal coefficient that scatters from impact to impact: ball or plane are not the same everywhere.

use super::Material;
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};
use crate::simd::elementary::{exp_in_lanes, ln};
use crate::simd::{Pack, one};
use pulp::{Simd, WithSimd};

/// ε_n with the normal distribution of this deviation about another coefficient, truncated to [0, 1], and drawn anew for every impact.
#[derive(Debug, Clone, PartialEq)]
pub struct Scattered {
    around: Box<Material>,
    deviation: f64,
}

impl Scattered {
    /// Its entry in the table of materials.
    pub(crate) const KIND: Kind<Material> = Kind {
        name: "Scattered",
        text: "drawn anew for every impact, about a number or another material",
        parameters: &[
            Parameter::number(
                "normal",
                "normal coefficient of restitution about which it scatters",
                "1",
                Interval::from(0.0, 1.0),
                0.98,
            ),
            Parameter::number(
                "deviation",
                "standard deviation before truncation to [0, 1]",
                "1",
                Interval::from(0.0, 1.0),
                0.01,
            ),
        ],
        make: |given| {
            let around = super::Normal::Constant(given.number(0)).checked()?;
            let scattered = Self::new(Material::Closed(around), given.number(1))?;
            Ok(Material::Scattered(scattered))
        },
    };

    /// The coefficient that scatters about `around` with a standard deviation, which is that before the truncation.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a deviation outside [0, 1], or if `around` scatters itself.
    pub fn new(around: Material, deviation: f64) -> Result<Self, Error> {
        let nested = matches!(around, Material::Scattered(_));
        let allowed = "a coefficient that does not scatter itself";
        Error::unless(!nested, "normal", around.deviation(), allowed)?;
        let allowed = "in [0, 1]";
        Error::unless(
            (0.0..=1.0).contains(&deviation),
            "deviation",
            deviation,
            allowed,
        )?;
        Ok(Self {
            around: Box::new(around),
            deviation,
        })
    }

    /// The coefficient about which it scatters.
    pub fn around(&self) -> &Material {
        &self.around
    }

    /// The standard deviation before truncation.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }
}

/// The coefficients about these middles, drawn with numbers in (0, 1): quantiles of the truncated normal distribution. In a function of
/// its own, because it is rare.
#[inline(always)]
pub(crate) fn scattered<S: Simd>(
    middle: Pack<S, 1>,
    deviation: f64,
    chance: Pack<S, 1>,
) -> Pack<S, 1> {
    middle.simd().vectorize(Draw {
        middle,
        deviation,
        chance,
    })
}

struct Draw<S: Simd> {
    middle: Pack<S, 1>,
    deviation: f64,
    chance: Pack<S, 1>,
}

impl<S: Simd> WithSimd for Draw<S> {
    type Output = Pack<S, 1>;

    #[inline(always)]
    fn with_simd<T: Simd>(mut self, _: T) -> Self::Output {
        for (x, &u) in self
            .middle
            .as_mut_slice()
            .iter_mut()
            .zip(self.chance.as_slice())
        {
            *x = truncated(*x, self.deviation, u);
        }
        self.middle
    }
}

/// The quantile of u in (0, 1) of the normal distribution about a middle in [0, 1], truncated to [0, 1].
#[inline(always)]
fn truncated(middle: f64, deviation: f64, u: f64) -> f64 {
    let below = tail(middle / deviation);
    let above = tail((1.0 - middle) / deviation);
    let inside = 1.0 - below - above;
    // From the nearer end, so that the larger of the two shares is never subtracted from 1.
    let z = if u < 0.5 {
        quantile(u.mul_add(inside, below))
    } else {
        -quantile((1.0 - u).mul_add(inside, above))
    };
    z.mul_add(deviation, middle).clamp(0.0, 1.0)
}

/// The probability above x ≥ 0 of the standard normal distribution φ; 0 where it is below 10⁻¹⁶ of that below. NaN, which a lane without
/// a particle may hold, ends here too.
#[inline(always)]
fn tail(x: f64) -> f64 {
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
fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = q.mul_add(-q, 0.180_625);
        return q * ratio(&MIDDLE, r);
    }
    let r = (-ln(if q < 0.0 { p } else { 1.0 - p })).sqrt();
    let size = if r <= 5.0 {
        ratio(&NEAR, r - 1.6)
    } else {
        ratio(&FAR, r - 5.0)
    };
    size.copysign(q)
}

/// The quotient of two polynomials.
#[inline(always)]
fn ratio(coefficients: &[[f64; 8]; 2], x: f64) -> f64 {
    let [above, below] = coefficients.map(|c| {
        let highest_first = c.iter().rev();
        highest_first.fold(0.0_f64, |sum, &c| sum.mul_add(x, c))
    });
    above / below
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

    /// u is the share below, of what is between 0 and 1.
    #[test]
    fn the_share_below_a_quantile_is_its_number() {
        let below = |x: f64| if x < 0.0 { tail(-x) } else { 1.0 - tail(x) };
        for (middle, deviation) in [
            (0.93, 0.01),
            (0.98, 0.03),
            (1.0, 0.2),
            (0.0, 1.0),
            (0.5, 1.0),
        ] {
            let at = |x: f64| below((x - middle) / deviation);
            for u in [1e-9, 0.01, 0.3, 0.5, 0.77, 0.999] {
                let x = truncated(middle, deviation, u);
                let share = (at(x) - at(0.0)) / (at(1.0) - at(0.0));
                assert!((share - u).abs() < 1e-13, "{middle}, {deviation}, {u}");
            }
        }
        assert!((0.0..=1.0).contains(&truncated(0.9, 1.0, 2.0_f64.powi(-54))));
        assert!((0.0..=1.0).contains(&truncated(0.9, 1.0, 1.0 - f64::EPSILON / 4.0)));
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
