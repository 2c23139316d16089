//! A normal coefficient that scatters from impact to impact: ball or plane are not the same everywhere.

use super::Material;
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};
use crate::math::gaussian::{quantile, tail};

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
        let holds = (0.0..=1.0).contains(&deviation);
        Error::unless(holds, "deviation", deviation, "in [0, 1]")?;
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

/// The quantile of u in (0, 1) of the normal distribution about a middle in [0, 1], truncated to [0, 1].
#[inline(always)]
pub(super) fn truncated(middle: f64, deviation: f64, u: f64) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
