//! A normal coefficient that is interpolated in a table, for example of measured values.

use super::Material;
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::memory::copied;
use crate::simd::Pack;
use pulp::Simd;

/// ε_n(v) by linear interpolation between points, and constant beyond the first and the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tabulated<'a> {
    speeds: &'a [f64],
    values: &'a [f64],
    /// Unit of the speeds at which the coefficient is evaluated, in m/s.
    unit: f64,
}

/// The points of a [`Tabulated`] coefficient, owned, and checked when they are made.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    speeds: Vec<f64>,
    values: Vec<f64>,
}

impl Points {
    /// Its entry in the table of materials.
    pub(crate) const KIND: Kind<Material> = Kind {
        name: "Tabulated",
        text: "interpolated in a table, for example of measured values",
        parameters: &[
            Parameter::new(
                "v",
                "normal speeds, increasing",
                Some("m s-1"),
                Allowed::Numbers(Interval::NOT_NEGATIVE),
                Argument::Numbers(&[0.1, 1.0]),
            ),
            Parameter::new(
                "e",
                "coefficients at these speeds",
                Some("1"),
                Allowed::Numbers(Interval::from(0.0, 1.0)),
                Argument::Numbers(&[0.97, 0.92]),
            ),
        ],
        make: |given| {
            Ok(Material::Measured(Self::new(
                given.numbers(0),
                given.numbers(1),
            )?))
        },
    };

    /// A copy of points; parameters and errors as for [`Tabulated::new`], and [`Error::Memory`].
    pub fn new(speeds: &[f64], values: &[f64]) -> Result<Self, Error> {
        Tabulated::new(speeds, values)?;
        Ok(Self {
            speeds: copied("v", speeds)?,
            values: copied("e", values)?,
        })
    }

    /// The coefficient through these points.
    pub fn coefficient(&self) -> Tabulated<'_> {
        Tabulated {
            speeds: &self.speeds,
            values: &self.values,
            unit: 1.0,
        }
    }
}

impl<'a> Tabulated<'a> {
    /// The coefficient with the given values at the given speeds, in m/s.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless there is at least one speed, the speeds are finite, ≥ 0 and increasing, and there are as many
    /// values, all in [0, 1].
    pub fn new(speeds: &'a [f64], values: &'a [f64]) -> Result<Self, Error> {
        Error::unless(!speeds.is_empty(), "v", 0.0, "at least one speed (m/s)")?;
        let mut last = None;
        for &speed in speeds {
            let increasing = speed.is_finite() && speed >= 0.0 && last.is_none_or(|v| v < speed);
            Error::unless(increasing, "v", speed, "finite, >= 0 and increasing (m/s)")?;
            last = Some(speed);
        }
        let same = values.len() == speeds.len();
        let count = values.len();
        Error::unless(same, "e", count, "as many coefficients as there are speeds")?;
        for &value in values {
            Error::unless((0.0..=1.0).contains(&value), "e", value, "in [0, 1]")?;
        }
        Ok(Self {
            speeds,
            values,
            unit: 1.0,
        })
    }

    pub(super) fn scaled(&self, unit: f64) -> Self {
        Self {
            unit: self.unit * unit,
            ..*self
        }
    }

    #[inline(always)]
    pub(super) fn in_lanes<S: Simd>(&self, speed: Pack<S>) -> Pack<S> {
        let mut lanes = speed * self.unit;
        for x in lanes.as_mut_slice() {
            *x = self.interpolated(*x);
        }
        lanes
    }

    /// Linear interpolation. NaN, which a lane without a particle may hold, must not panic.
    fn interpolated(&self, speed: f64) -> f64 {
        let (v, e) = (self.speeds, self.values);
        let next = v.partition_point(|&x| x <= speed);
        if next == 0 || next == v.len() {
            return e[next.saturating_sub(1)];
        }
        let share = (speed - v[next - 1]) / (v[next] - v[next - 1]);
        share.mul_add(e[next] - e[next - 1], e[next - 1]).min(1.0)
    }
}
