//! An ellipsoid of revolution: prolate, oblate, or a sphere.

use super::{
    Arc, Body, Ellipsoid, Shape, Solid, Surface, check_density, check_length, representable,
};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};
use std::f64::consts::PI;

/// Largest ratio of the semi-axes; beyond it the relative rounding error of the contact exceeds 10⁻¹².
const MOST_ASPHERICAL: f64 = 1000.0;

/// A homogeneous ellipsoid of revolution, in SI units. The core's unit of length is the longer semi-axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spheroid {
    equatorial: f64,
    polar: f64,
    density: f64,
}

impl Spheroid {
    /// Its entry in the table of bodies.
    pub(crate) const KIND: Kind<Solid> = Kind {
        name: "Spheroid",
        text: "an ellipsoid of revolution",
        parameters: &[
            Parameter::length(
                "equatorial",
                "semi-axis across the axis of revolution",
                3e-3,
            ),
            Parameter::length(
                "polar",
                "semi-axis along the axis of revolution, between 1/1000 and 1000 times the other",
                3.15e-3,
            ),
            Parameter::density("density"),
        ],
        make: |given| Ok(Self::new(given.number(0), given.number(1), given.number(2))?.into()),
    };

    /// A spheroid with the semi-axes `equatorial` and `polar` (m), across and along the axis of revolution, and `density` (kg/m³).
    ///
    /// # Errors
    /// Unless all three are positive and the ratio of the semi-axes is between 1/1000 and 1000; and if mass or inertia overflows
    /// or underflows.
    pub fn new(equatorial: f64, polar: f64, density: f64) -> Result<Self, Error> {
        check_length("equatorial", equatorial)?;
        check_length("polar", polar)?;
        check_density(density)?;
        let body = Self {
            equatorial,
            polar,
            density,
        };
        let ratio = (polar / equatorial).max(equatorial / polar);
        Error::unless(
            ratio <= MOST_ASPHERICAL * (1.0 + 4.0 * f64::EPSILON),
            "polar",
            polar,
            "between 1/1000 and 1000 times the equatorial semi-axis",
        )?;
        representable(body, "equatorial")
    }

    /// Semi-axes a (equatorial) and c (polar) in the core's unit of length.
    fn axes(&self) -> (f64, f64) {
        (self.equatorial / self.unit(), self.polar / self.unit())
    }
}

impl Shape for Spheroid {
    fn unit(&self) -> f64 {
        self.equatorial.max(self.polar)
    }

    fn mass(&self) -> f64 {
        let (a, c) = self.axes();
        self.density * self.unit().powi(3) * (4.0 / 3.0 * PI) * (a * a * c)
    }

    fn transverse_inertia(&self) -> f64 {
        self.mass() * self.unit().powi(2) * self.scaled().transverse
    }

    fn axial_inertia(&self) -> f64 {
        self.mass() * self.unit().powi(2) * self.scaled().axial
    }

    fn outline(&self) -> [Arc; 2] {
        Arc::halves(0.0, self.polar, self.equatorial)
    }

    fn scaled(&self) -> Body {
        let (a, c) = self.axes();
        Body {
            hull: Surface::Ellipsoid(Ellipsoid::new(a, c)),
            half_separation: 0.0,
            transverse: (a * a + c * c) / 5.0,
            axial: 2.0 / 5.0 * (a * a),
        }
    }
}
