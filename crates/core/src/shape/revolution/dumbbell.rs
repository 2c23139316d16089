//! Two spheres on an axis. Equal ones are the paper's homogeneous dumbbell (A1)–(A8).

use super::{
    Arc, Ball, Body, INERTIA, OneBall, Shape, Solid, Surface, TwoBalls, WALL, check_density,
    check_distance, check_length, hollow, made, representable, seen,
};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};
use crate::shape::mass::MassProperties;
use std::f64::consts::PI;

/// Two spheres whose centres are `separation` apart, in SI units. The axis points from sphere 2 to sphere 1.
///
/// If the spheres overlap, the body is their union, divided at the plane of their intersection; each side has the density of its
/// sphere. If they do not, it is two full spheres on a massless rod, and if one contains the other, it is that sphere alone. Mass
/// and inertia are continuous from case to case. Spheres of equal radius and different density at zero separation are two
/// hemispheres. A hollow one is this body less that of spheres whose radii are shorter by the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dumbbell {
    radius: [f64; 2],
    separation: f64,
    density: [f64; 2],
    wall: Option<f64>,
}

impl Dumbbell {
    /// Its entry in the table of bodies.
    pub(crate) const KIND: Kind<Solid> = Kind {
        name: "Dumbbell",
        text: "two spheres on an axis",
        parameters: &[
            Parameter::length("radius", "radius of either sphere, or of each", 3e-3).of_each(),
            Parameter::distance("separation", "distance between the centres", 3e-4),
            Parameter::density("density of both spheres, or of each").of_each(),
            WALL,
            INERTIA,
        ],
        make: |given| {
            let body = Self::unequal(given.pair(0), given.number(1), given.pair(2))?;
            made(body, given, 3)
        },
    };

    /// Equal spheres of `radius` (m) and `density` (kg/m³), their centres `separation` (m) apart.
    ///
    /// # Errors
    /// Unless all three are finite, `radius` and `density` positive, and `separation` not negative; and if mass or inertia
    /// overflows or underflows.
    pub fn new(radius: f64, separation: f64, density: f64) -> Result<Self, Error> {
        Self::unequal([radius; 2], separation, [density; 2])
    }

    /// Spheres 1 and 2, each with its own radius (m) and density (kg/m³). Errors as for [`Dumbbell::new`].
    pub fn unequal(radius: [f64; 2], separation: f64, density: [f64; 2]) -> Result<Self, Error> {
        for radius in radius {
            check_length("radius", radius)?;
        }
        check_distance("separation", separation)?;
        for density in density {
            check_density(density)?;
        }
        let body = Self {
            radius,
            separation,
            density,
            wall: None,
        };
        representable(body, "radius")
    }

    /// The core's unit of length: the radius of the larger sphere, relative to which rounding errors of positions are small.
    fn unit(&self) -> f64 {
        self.radius[0].max(self.radius[1])
    }

    /// Both radii in units of R.
    fn radii(&self) -> [f64; 2] {
        self.radius.map(|radius| radius / self.unit())
    }

    /// Mass, centre and inertia of unequal spheres, in units of R and of the density of sphere 1; the origin is the centre of
    /// sphere 1.
    fn whole(&self) -> MassProperties {
        let radii = self.radii();
        let outer = self.union(radii);
        self.wall.map_or(outer, |wall| {
            outer.less(self.union(radii.map(|radius| radius - wall / self.unit())))
        })
    }

    /// The same of spheres with these radii in the places of those of the body; one that is not positive is none.
    fn union(&self, [one, two]: [f64; 2]) -> MassProperties {
        let l = self.elongation();
        let density = self.density[1] / self.density[0];
        if two <= 0.0 || one > two && one - two >= l {
            return MassProperties::sphere(one, 1.0);
        }
        if one <= 0.0 || two > one && two - one >= l {
            return MassProperties::sphere(two, density).upside_down(-l);
        }
        // Height of a spherical segment above the plane of intersection.
        let height = |own: f64, other: f64| {
            let difference = own - other;
            let lean = if difference == 0.0 {
                0.0
            } else {
                difference / l
            };
            (0.5 * (1.0 + lean) * (own + other + l)).min(2.0 * own)
        };
        let upper = MassProperties::segment(one, height(one, two), 1.0);
        let lower = MassProperties::segment(two, height(two, one), density);
        upper.and(lower.upside_down(-l))
    }

    /// L/R.
    fn elongation(&self) -> f64 {
        self.separation / self.unit()
    }

    /// The outline about a centre of mass at this place.
    fn outline(&self, centre: f64) -> [Arc; 2] {
        let [one, two] = self.radius;
        let half = 0.5 * self.separation;
        let centres = [half, -half].map(|place| place - centre);
        if (one - two).abs() >= self.separation {
            let larger = usize::from(two > one);
            return Arc::halves(centres[larger], self.radius[larger], self.radius[larger]);
        }
        // The cosines of the angles at which the spheres meet, from the direction towards the other sphere.
        let lean = (one - two) / self.separation * (one + two);
        let meets = [(one, lean), (two, -lean)].map(|(radius, lean)| {
            (0.5 * (self.separation + lean) / radius)
                .clamp(-1.0, 1.0)
                .acos()
        });
        Arc::caps(centres, self.radius, [PI - meets[0], meets[1]])
    }
}

/// m/(πρR³) of full equal spheres.
fn mass_factor(l: f64) -> f64 {
    if l < 2.0 {
        4.0 / 3.0 + l - l.powi(3) / 12.0 // (A3)
    } else {
        8.0 / 3.0 // two spheres
    }
}

/// J_xx/(πρR⁵) of full equal spheres.
fn transverse_factor(l: f64) -> f64 {
    if l < 2.0 {
        8.0 / 15.0 + 3.0 / 4.0 * l + l.powi(2) / 3.0 + l.powi(3) / 24.0 + l.powi(5) / 960.0 // (A8)
    } else {
        16.0 / 15.0 + 2.0 / 3.0 * l.powi(2) // two spheres, parallel axis theorem
    }
}

/// J_zz/(πρR⁵) of full equal spheres.
fn axial_factor(l: f64) -> f64 {
    if l < 2.0 {
        // (A5). The last term is printed as L⁵/180, but the integral is L⁵/160; only then is J_zz at L = 2R that of two spheres.
        8.0 / 15.0 + l / 2.0 - l.powi(3) / 12.0 + l.powi(5) / 160.0
    } else {
        16.0 / 15.0 // two spheres
    }
}

impl Shape for Dumbbell {
    fn solid(&self) -> Solid {
        let density = self.density[0];
        if self.radius[0] == self.radius[1] && density == self.density[1] {
            let given = [self.radius[0], self.separation, density];
            let factors = [mass_factor, transverse_factor, axial_factor];
            return hollow::of_equal_caps(given, self.wall, factors, self.outline(0.0));
        }
        let (unit, elongation) = (self.unit(), seen(self.elongation()));
        let part = self.whole();
        let ball = |place: f64, radius| Ball {
            offset: place - part.centre,
            radius,
        };
        let [one, two] = self.radii();
        let balls = [ball(0.0, one), ball(-elongation, two)];
        let (hull, half_separation) = if one - two >= elongation {
            (Surface::OneBall(OneBall::new(balls[0], true)), 0.0)
        } else if two - one >= elongation {
            (Surface::OneBall(OneBall::new(balls[1], false)), 0.0)
        } else {
            let pair = TwoBalls::new(balls, elongation);
            (Surface::TwoBalls(pair), 0.5 * elongation)
        };
        let centre_of_mass = unit * (part.centre + 0.5 * self.elongation());
        Solid {
            unit,
            mass: density * unit.powi(3) * part.mass,
            transverse_inertia: density * unit.powi(5) * part.transverse,
            axial_inertia: density * unit.powi(5) * part.axial,
            centre_of_mass,
            is_filled: false,
            outline: self.outline(centre_of_mass),
            scaled: Body {
                hull,
                half_separation,
                transverse: part.transverse / part.mass,
                axial: part.axial / part.mass,
            },
        }
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let one_material = self.radius[0] == self.radius[1] || self.density[0] == self.density[1];
        let allowed = "left out where both radius and density differ";
        Error::unless(one_material, "wall", wall, allowed)?;
        let thickest = (self.unit(), "at most the larger radius (m)");
        let wall = hollow::checked(wall, self.unit(), thickest)?;
        representable(Self { wall, ..self }, "radius")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::gauss;

    /// The integrals over slices of the upper half, (A3), (A5), (A6), by Gauss's quadrature, exact for these polynomials.
    fn by_quadrature(l: f64) -> [f64; 3] {
        let half = 0.5 * (1.0 + l / 2.0);
        gauss().fold([0.0; 3], |sum, (x, w)| {
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
            let [m, jxx, jzz] = by_quadrature(l);
            assert!((mass_factor(l) - m).abs() < 1e-14 * m);
            assert!((transverse_factor(l) - jxx).abs() < 1e-14 * jxx);
            assert!((axial_factor(l) - jzz).abs() < 1e-14 * jzz);
        }
    }

    #[test]
    fn the_sphere_and_the_touching_spheres_are_limits() {
        let sphere = Dumbbell::new(2.0, 0.0, 3.0).unwrap().solid();
        let m = 3.0 * 4.0 / 3.0 * PI * 8.0;
        assert!((sphere.mass - m).abs() < 1e-13 * m);
        assert!((sphere.transverse_inertia - 0.4 * m * 4.0).abs() < 1e-12 * m);
        assert!((sphere.axial_inertia - 0.4 * m * 4.0).abs() < 1e-12 * m);
        let below = Dumbbell::new(1.0, 2.0 - 1e-12, 1.0).unwrap().solid().scaled;
        let above = Dumbbell::new(1.0, 2.0, 1.0).unwrap().solid().scaled;
        assert!((below.transverse - above.transverse).abs() < 1e-11);
        assert!((below.axial - above.axial).abs() < 1e-11);
    }
}
