//! A cylinder with hemispherical caps: its contact is that of a dumbbell, but it has more mass in the middle.

use super::{
    Arc, INERTIA, Shape, Solid, WALL, check_density, check_distance, check_length, hollow, made,
    representable,
};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};
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
            Parameter::distance("separation", "length of the cylinder", 6e-3),
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
}

/// m/(πρR³), J_xx/(πρR⁵) and J_zz/(πρR⁵), L in R: of J_xx the cylinder gives L(1/4 + L²/12), and the hemispheres have their centres of mass at
/// ±(L/2 + 3/8).
const FACTORS: [fn(f64) -> f64; 3] = [
    |l| 4.0 / 3.0 + l,
    |l| 8.0 / 15.0 + l * (3.0 / 4.0 + l * (1.0 / 3.0 + l / 12.0)),
    |l| 8.0 / 15.0 + l / 2.0,
];

impl Shape for Spherocylinder {
    fn solid(&self) -> Solid {
        let half = 0.5 * self.separation;
        let outline = Arc::caps([half, -half], [self.radius; 2], [0.5 * PI; 2]);
        let given = [self.radius, self.separation, self.density];
        Solid {
            is_filled: true,
            ..hollow::of_equal_caps(given, self.wall, FACTORS, outline)
        }
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let wall = hollow::checked(wall, self.radius, (self.radius, "at most the radius (m)"))?;
        representable(Self { wall, ..self }, "radius")
    }
}
