//! An ellipsoid of revolution: prolate, oblate, or a sphere.

use super::{
    Arc, Body, Ellipsoid, INERTIA, Shape, Solid, Surface, WALL, check_density, check_length,
    hollow, made, representable,
};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};
use crate::math::{add_to, gauss};
use std::f64::consts::PI;

/// Largest ratio of the semi-axes; beyond it the relative rounding error of the contact exceeds 10⁻¹².
const MOST_ASPHERICAL: f64 = 1000.0;

/// A homogeneous ellipsoid of revolution, in SI units. The core's unit of length is the longer semi-axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spheroid {
    equatorial: f64,
    polar: f64,
    density: f64,
    /// Of the inside of a hollow one: its volume, and its moments of inertia across and about the axis at density 1, in the core's unit of length.
    cavity: Option<[f64; 3]>,
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
            WALL,
            INERTIA,
        ],
        make: |given| {
            let [equatorial, polar, density] = std::array::from_fn(|i| given.number(i));
            made(Self::new(equatorial, polar, density)?, given, 3)
        },
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
            cavity: None,
        };
        let ratio = (polar / equatorial).max(equatorial / polar);
        let allowed = "between 1/1000 and 1000 times the equatorial semi-axis";
        let holds = ratio <= MOST_ASPHERICAL * (1.0 + 4.0 * f64::EPSILON);
        Error::unless(holds, "polar", polar, allowed)?;
        representable(body, "equatorial")
    }

    /// The core's unit of length, and the semi-axes a (equatorial) and c (polar) in it.
    fn axes(&self) -> (f64, (f64, f64)) {
        let unit = self.equatorial.max(self.polar);
        (unit, (self.equatorial / unit, self.polar / unit))
    }
}

impl Shape for Spheroid {
    fn solid(&self) -> Solid {
        let (unit, (a, c)) = self.axes();
        let cube = self.density * unit.powi(3);
        let mut mass = cube * (4.0 / 3.0 * PI) * (a * a * c);
        let (mut transverse, mut axial) = ((a * a + c * c) / 5.0, 2.0 / 5.0 * (a * a));
        if let Some([inside, across, about]) = self.cavity {
            let volume = 4.0 / 3.0 * PI * (a * a * c);
            let rest = volume - inside;
            mass -= cube * inside;
            transverse = (volume * transverse - across) / rest;
            axial = (volume * axial - about) / rest;
        }
        let square = mass * unit.powi(2);
        Solid {
            unit,
            mass,
            transverse_inertia: square * transverse,
            axial_inertia: square * axial,
            centre_of_mass: 0.0,
            is_filled: true,
            outline: Arc::halves(0.0, self.polar, self.equatorial),
            scaled: Body {
                hull: Surface::Ellipsoid(Ellipsoid::new(a, c)),
                half_separation: 0.0,
                transverse,
                axial,
            },
        }
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let (unit, axes) = self.axes();
        let allowed = "at most the equatorial and the polar semi-axis (m)";
        let thickest = self.equatorial.min(self.polar);
        let wall = hollow::checked(wall, unit, (thickest, allowed))?;
        let cavity = wall.map(|wall| cavity(axes, wall / unit));
        representable(Self { cavity, ..self }, "equatorial")
    }
}

/// Volume and moments of inertia of the spheroid with semi-axes a and c, drawn in by `wall`: all points that are as far below the surface, or farther.
///
/// From the point (a√(1 − x²), cx) of the meridian the normal leads to ϱ = √(1 − x²)(a − w/(aN)), z = x(c − w/(cN)) with
/// N² = (1 − x²)/a² + x²/c² and dz/dx = c − w/(a²cN³). This curve ends where it meets the longer axis: at the pole or the equator, or before
/// if the wall is thicker than the least radius of curvature there, at N = w/min(a, c)². The integrals over the slices have no elementary
/// form that is short; Gauss's quadrature gives them to rounding.
fn cavity((a, c): (f64, f64), wall: f64) -> [f64; 3] {
    let short = a.min(c);
    // N² = 1/a² + slope x².
    let slope = (a - c) * (a + c) / (a * a * c * c);
    let meets = (wall / (short * short)).powi(2) - 1.0 / (a * a);
    let root = (meets / slope).max(0.0).sqrt().min(1.0);
    let ends = if a < c && root < 1.0 {
        [0.0, root]
    } else if a > c {
        [root, 1.0]
    } else {
        [0.0, 1.0]
    };
    let slices = |x: f64| {
        let n = (1.0 / (a * a) + slope * (x * x)).sqrt();
        let across = (1.0 - x) * (1.0 + x) * (a - wall / (a * n)).powi(2);
        let along = x * (c - wall / (c * n));
        let height = c - wall / (a * a * c * n.powi(3));
        let disc = 2.0 * PI * across * height;
        [
            disc,
            disc * (0.25 * across + along * along),
            disc * (0.5 * across),
        ]
    };
    let exact = 2.0 * f64::EPSILON * (a * a * c);
    let exact = [exact, exact, exact * (a * a)];
    let whole = integral(&slices, ends);
    halved(&slices, ends, whole, exact, DEPTH)
}

/// Largest number of halvings.
const DEPTH: u32 = 40;

/// An integral from `low` to `high`, of which `whole` is an approximation, by halves until both agree with it.
fn halved(
    f: &impl Fn(f64) -> [f64; 3],
    [low, high]: [f64; 2],
    whole: [f64; 3],
    exact: [f64; 3],
    depth: u32,
) -> [f64; 3] {
    let middle = 0.5 * (low + high);
    let parts = [[low, middle], [middle, high]];
    let [left, right] = parts.map(|part| integral(f, part));
    let both = std::array::from_fn(|i| left[i] + right[i]);
    let agrees = |i: usize| f64::abs(both[i] - whole[i]) <= exact[i];
    if depth == 0 || (0..3).all(agrees) {
        return both;
    }
    let [left, right] = [(parts[0], left), (parts[1], right)]
        .map(|(part, found)| halved(f, part, found, exact, depth - 1));
    std::array::from_fn(|i| left[i] + right[i])
}

/// An integral from `low` to `high` by Gauss's quadrature.
fn integral(f: &impl Fn(f64) -> [f64; 3], [low, high]: [f64; 2]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (node, weight) in gauss() {
        let values = f(0.5 * (low + high) + 0.5 * (high - low) * node);
        add_to(
            &mut sums,
            values.map(|value| 0.5 * (high - low) * weight * value),
        );
    }
    sums
}
