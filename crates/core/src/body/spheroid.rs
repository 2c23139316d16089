//! An ellipsoid of revolution: prolate, oblate, or a sphere.

use super::{Body, Ellipsoid, Hull, Shape, check_density, check_length, representable};
use crate::Error;
use std::f64::consts::PI;

/// Needles longer and discs flatter than this lose more than 10⁻¹² of the contact to rounding.
const MOST_ASPHERICAL: f64 = 1000.0;

/// A homogeneous ellipsoid of revolution, in SI units. The core's unit of length is the equatorial semi-axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spheroid {
    equatorial: f64,
    polar: f64,
    density: f64,
}

impl Spheroid {
    /// From the semi-axes across and along the axis of revolution, both positive, their ratio between 1/1000 and 1000.
    pub fn new(equatorial: f64, polar: f64, density: f64) -> Result<Self, Error> {
        check_length("equatorial", equatorial)?;
        check_length("polar", polar)?;
        check_density(density)?;
        let body = Self {
            equatorial,
            polar,
            density,
        };
        Error::unless(
            (1.0 / MOST_ASPHERICAL..=MOST_ASPHERICAL).contains(&body.aspect()),
            "polar",
            polar,
            "between 1/1000 and 1000 times the equatorial semi-axis",
        )?;
        representable(body, "equatorial")
    }

    /// c/a.
    fn aspect(&self) -> f64 {
        self.polar / self.equatorial
    }
}

impl Shape for Spheroid {
    fn unit(&self) -> f64 {
        self.equatorial
    }

    fn mass(&self) -> f64 {
        self.density * self.equatorial.powi(3) * (4.0 / 3.0 * PI) * self.aspect()
    }

    fn transverse_inertia(&self) -> f64 {
        self.mass() * self.equatorial.powi(2) * self.scaled().transverse
    }

    fn axial_inertia(&self) -> f64 {
        self.mass() * self.equatorial.powi(2) * self.scaled().axial
    }

    fn scaled(&self) -> Body {
        let aspect = self.aspect();
        Body {
            hull: Hull::Ellipsoid(Ellipsoid::new(aspect)),
            half_separation: 0.0,
            transverse: (1.0 + aspect * aspect) / 5.0,
            axial: 2.0 / 5.0,
        }
    }
}
