//! A cylinder with hemispherical caps: its contact is that of a dumbbell, but it has more mass in the middle.

use super::{
    Arc, Body, EqualBalls, INERTIA, Shape, Solid, Surface, WALL, check_density, check_distance,
    check_length, hollow, made, representable, seen,
};
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};
use std::f64::consts::PI;

/// A homogeneous cylinder with hemispherical caps whose centres are `separation` apart, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spherocylinder {
    radius: f64,
    separation: f64,
    density: f64,
    wall: Option<f64>,
}

impl Spherocylinder {
    /// Its entry in the table of bodies.
    pub(crate) const KIND: Kind<Solid> = Kind {
        name: "Spherocylinder",
        text: "a cylinder with hemispherical caps",
        parameters: &[
            Parameter::length("radius", "radius of cylinder and caps", 3e-3),
            Parameter::number(
                "separation",
                "length of the cylinder",
                "m",
                Interval::NOT_NEGATIVE,
                6e-3,
            ),
            Parameter::density("density"),
            WALL,
            INERTIA,
        ],
        make: |given| {
            let [radius, separation, density] = std::array::from_fn(|i| given.number(i));
            made(Self::new(radius, separation, density)?, given, 3)
        },
    };

    /// A spherocylinder of `radius` (m) and `density` (kg/m³), the centres of its caps `separation` (m) apart.
    ///
    /// # Errors
    /// Unless all three are finite, `radius` and `density` positive, and `separation` not negative; and if mass or inertia
    /// overflows or underflows.
    pub fn new(radius: f64, separation: f64, density: f64) -> Result<Self, Error> {
        check_length("radius", radius)?;
        check_distance("separation", separation)?;
        check_density(density)?;
        let body = Self {
            radius,
            separation,
            density,
            wall: None,
        };
        representable(body, "radius")
    }

    /// L/R.
    fn elongation(&self) -> f64 {
        self.separation / self.radius
    }

    /// m/(πρR³).
    fn mass_factor(&self) -> f64 {
        self.of_wall(|l| 4.0 / 3.0 + l, 3)
    }

    /// J_xx/(πρR⁵), L in R: the cylinder gives L(1/4 + L²/12), the hemispheres have their centres of mass at ±(L/2 + 3/8).
    fn transverse_factor(&self) -> f64 {
        self.of_wall(
            |l| 8.0 / 15.0 + l * (3.0 / 4.0 + l * (1.0 / 3.0 + l / 12.0)),
            5,
        )
    }

    /// J_zz/(πρR⁵).
    fn axial_factor(&self) -> f64 {
        self.of_wall(|l| 8.0 / 15.0 + l / 2.0, 5)
    }

    fn of_wall(&self, factor: fn(f64) -> f64, power: i32) -> f64 {
        let wall = self.wall.map(|wall| wall / self.radius);
        hollow::of_wall(factor, power, self.elongation(), wall)
    }
}

impl Shape for Spherocylinder {
    fn unit(&self) -> f64 {
        self.radius
    }

    fn mass(&self) -> f64 {
        self.density * self.radius.powi(3) * PI * self.mass_factor()
    }

    fn transverse_inertia(&self) -> f64 {
        self.density * self.radius.powi(5) * PI * self.transverse_factor()
    }

    fn axial_inertia(&self) -> f64 {
        self.density * self.radius.powi(5) * PI * self.axial_factor()
    }

    fn is_filled(&self) -> bool {
        true
    }

    fn outline(&self) -> [Arc; 2] {
        let half = 0.5 * self.separation;
        Arc::caps([half, -half], [self.radius; 2], [0.5 * PI; 2])
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let wall = hollow::checked(wall, self.radius, (self.radius, "at most the radius (m)"))?;
        representable(Self { wall, ..self }, "radius")
    }

    fn scaled(&self) -> Body {
        let mass = self.mass_factor();
        let half_separation = 0.5 * seen(self.elongation());
        Body {
            hull: Surface::EqualBalls(EqualBalls::new(half_separation)),
            half_separation,
            transverse: self.transverse_factor() / mass,
            axial: self.axial_factor() / mass,
        }
    }
}
