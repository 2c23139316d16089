//! Shapes: the mass and inertia of a homogeneous dumbbell (A1)–(A8), and the three numbers of it that the motion needs.

use crate::Error;
use std::f64::consts::PI;

/// L/R below which a dumbbell is a sphere: far below the last digit of anything that is computed.
const NEGLIGIBLE: f64 = 1e-75;

/// Two equal spheres whose centres are `separation` apart, of homogeneous density, in SI units.
///
/// For `separation < 2 radius` the spheres overlap and the body is their union; beyond that it is two full
/// spheres on a massless rod. Mass and inertia are continuous where the two meet, and `separation = 0` is a sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dumbbell {
    radius: f64,
    separation: f64,
    density: f64,
}

impl Dumbbell {
    /// Checks that all three are finite, `radius` and `density` positive, `separation` not negative.
    pub fn new(radius: f64, separation: f64, density: f64) -> Result<Self, Error> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        Error::unless(positive(radius), "radius", radius, "finite and > 0 (m)")?;
        Error::unless(
            separation.is_finite() && separation >= 0.0,
            "separation",
            separation,
            "finite and >= 0 (m)",
        )?;
        Error::unless(
            positive(density),
            "density",
            density,
            "finite and > 0 (kg/m^3)",
        )?;
        let body = Self {
            radius,
            separation,
            density,
        };
        let representable = [body.mass(), body.transverse_inertia(), body.axial_inertia()]
            .iter()
            .all(|x| x.is_normal())
            && body.scaled().transverse.is_normal();
        Error::unless(
            representable,
            "radius",
            radius,
            "such that mass and inertia neither overflow nor underflow",
        )?;
        Ok(body)
    }

    /// Radius R of either sphere, in m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Mass in kg (A3).
    pub fn mass(&self) -> f64 {
        self.density * self.radius.powi(3) * PI * self.mass_factor()
    }

    /// Moment of inertia J_xx about any axis through the centre and across the symmetry axis, in kg m² (A8).
    pub fn transverse_inertia(&self) -> f64 {
        self.density * self.radius.powi(5) * PI * self.transverse_factor()
    }

    /// Moment of inertia J_zz about the symmetry axis, in kg m² (A5).
    pub fn axial_inertia(&self) -> f64 {
        self.density * self.radius.powi(5) * PI * self.axial_factor()
    }

    /// The body in the core's units: lengths in R, masses in m.
    pub fn scaled(&self) -> Body {
        let mass = self.mass_factor();
        let elongation = self.elongation();
        Body {
            // What no digit of the motion can show is left out, lest its powers underflow.
            half_separation: if elongation < NEGLIGIBLE {
                0.0
            } else {
                0.5 * elongation
            },
            transverse: self.transverse_factor() / mass,
            axial: self.axial_factor() / mass,
        }
    }

    /// L/R.
    fn elongation(&self) -> f64 {
        self.separation / self.radius
    }

    /// m/(πρR³).
    fn mass_factor(&self) -> f64 {
        let l = self.elongation();
        if l < 2.0 {
            4.0 / 3.0 + l - l.powi(3) / 12.0 // (A3)
        } else {
            8.0 / 3.0 // two spheres
        }
    }

    /// J_xx/(πρR⁵).
    fn transverse_factor(&self) -> f64 {
        let l = self.elongation();
        if l < 2.0 {
            8.0 / 15.0 + 3.0 / 4.0 * l + l.powi(2) / 3.0 + l.powi(3) / 24.0 + l.powi(5) / 960.0 // (A8)
        } else {
            16.0 / 15.0 + 2.0 / 3.0 * l.powi(2) // two spheres, Steiner's theorem
        }
    }

    /// J_zz/(πρR⁵).
    fn axial_factor(&self) -> f64 {
        let l = self.elongation();
        if l < 2.0 {
            // (A5); its last term is printed as L⁵/180, but the integral gives L⁵/160, and so does L = 2R.
            8.0 / 15.0 + l / 2.0 - l.powi(3) / 12.0 + l.powi(5) / 160.0
        } else {
            16.0 / 15.0 // two spheres
        }
    }
}

/// A body of revolution in the core's units (lengths in R, masses in m): all that the motion depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// L/(2R): distance from the centre of mass to the centre of either sphere.
    pub half_separation: f64,
    /// J_xx/(mR²).
    pub transverse: f64,
    /// J_zz/(mR²).
    pub axial: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ over the slices of the upper half, (A3), (A5), (A6), by Gauss–Legendre: exact for these polynomials.
    fn by_quadrature(l: f64) -> [f64; 3] {
        // Five nodes integrate degree 9 exactly; the integrands have degree 4.
        let nodes = [
            (0.0, 128.0 / 225.0),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ];
        let half = 0.5 * (1.0 + l / 2.0);
        nodes.iter().fold([0.0; 3], |sum, &(x, w)| {
            let z = half * (1.0 + x);
            let r2 = 1.0 - (z - l / 2.0).powi(2); // (A2)
            let w = w * half;
            [
                sum[0] + 2.0 * w * r2,
                sum[1] + 2.0 * w * (r2 * r2 / 4.0 + z * z * r2),
                sum[2] + w * r2 * r2,
            ]
        })
    }

    #[test]
    fn inertia_is_the_integral_over_the_slices() {
        for l in [0.0, 0.01, 0.1, 0.5, 1.0, 1.7, 1.999_999] {
            let body = Dumbbell::new(1.0, l, 1.0).unwrap();
            let [m, jxx, jzz] = by_quadrature(l);
            assert!((body.mass_factor() - m).abs() < 1e-14 * m);
            assert!((body.transverse_factor() - jxx).abs() < 1e-14 * jxx);
            assert!((body.axial_factor() - jzz).abs() < 1e-14 * jzz);
        }
    }

    #[test]
    fn the_sphere_and_the_touching_spheres_are_limits() {
        let sphere = Dumbbell::new(2.0, 0.0, 3.0).unwrap();
        let m = 3.0 * 4.0 / 3.0 * PI * 8.0;
        assert!((sphere.mass() - m).abs() < 1e-13 * m);
        assert!((sphere.transverse_inertia() - 0.4 * m * 4.0).abs() < 1e-12 * m);
        assert!((sphere.axial_inertia() - 0.4 * m * 4.0).abs() < 1e-12 * m);
        let below = Dumbbell::new(1.0, 2.0 - 1e-12, 1.0).unwrap().scaled();
        let above = Dumbbell::new(1.0, 2.0, 1.0).unwrap().scaled();
        assert!((below.transverse - above.transverse).abs() < 1e-11);
        assert!((below.axial - above.axial).abs() < 1e-11);
    }
}
