//! An ellipsoid of revolution: prolate, oblate, or a sphere.

use super::{
    Arc, Body, Ellipsoid, INERTIA, Shape, Solid, Surface, WALL, check_density, check_length,
    hollow, made, representable,
};
use crate::Error;
use crate::describe::{Arguments, Kind, Parameter};
use crate::math::GAUSS;
use std::f64::consts::PI;

/// Largest ratio of the semi-axes; beyond it the relative rounding error of the contact exceeds 10⁻¹².
const MOST_ASPHERICAL: f64 = 1000.0;

/// A homogeneous ellipsoid of revolution, in SI units. The core's unit of length is the longer semi-axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spheroid {
    equatorial: f64,
    polar: f64,
    density: f64,
    /// The inside of a hollow one.
    cavity: Option<Cavity>,
}

/// A spheroid drawn in by the wall: its volume, and its moments of inertia across and about the axis at density 1, in the core's unit of
/// length.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cavity {
    volume: f64,
    transverse: f64,
    axial: f64,
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
        let unit = self.density * self.unit().powi(3);
        let full = unit * (4.0 / 3.0 * PI) * (a * a * c);
        self.cavity
            .map_or(full, |inside| full - unit * inside.volume)
    }

    fn transverse_inertia(&self) -> f64 {
        self.mass() * self.unit().powi(2) * self.scaled().transverse
    }

    fn axial_inertia(&self) -> f64 {
        self.mass() * self.unit().powi(2) * self.scaled().axial
    }

    fn is_filled(&self) -> bool {
        true
    }

    fn outline(&self) -> [Arc; 2] {
        Arc::halves(0.0, self.polar, self.equatorial)
    }

    fn hollow(self, wall: f64) -> Result<Self, Error> {
        let thickest = self.equatorial.min(self.polar);
        let wall = hollow::checked(
            wall,
            self.unit(),
            (
                thickest,
                "at most the equatorial and the polar semi-axis (m)",
            ),
        )?;
        let cavity = wall.map(|wall| cavity(self.axes(), wall / self.unit()));
        representable(Self { cavity, ..self }, "equatorial")
    }

    fn scaled(&self) -> Body {
        let (a, c) = self.axes();
        let (transverse, axial) = ((a * a + c * c) / 5.0, 2.0 / 5.0 * (a * a));
        let full = Body {
            hull: Surface::Ellipsoid(Ellipsoid::new(a, c)),
            half_separation: 0.0,
            transverse,
            axial,
        };
        self.cavity.map_or(full, |inside| {
            let volume = 4.0 / 3.0 * PI * (a * a * c);
            let rest = volume - inside.volume;
            Body {
                transverse: (volume * transverse - inside.transverse) / rest,
                axial: (volume * axial - inside.axial) / rest,
                ..full
            }
        })
    }
}

/// The spheroid with semi-axes a and c, drawn in by `wall`: all points that are as far below the surface, or farther.
///
/// From the point (a√(1 − x²), cx) of the meridian the normal leads to ϱ = √(1 − x²)(a − w/(aN)), z = x(c − w/(cN)) with
/// N² = (1 − x²)/a² + x²/c² and dz/dx = c − w/(a²cN³). This curve ends where it meets the longer axis: at the pole or the equator, or before
/// if the wall is thicker than the least radius of curvature there, at N = w/min(a, c)². The integrals over the slices have no elementary
/// form that is short; Gauss's quadrature gives them to rounding.
fn cavity((a, c): (f64, f64), wall: f64) -> Cavity {
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
    let whole = gauss(&slices, ends);
    let [volume, transverse, axial] = halved(&slices, ends, whole, exact, DEPTH);
    Cavity {
        volume,
        transverse,
        axial,
    }
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
    let [left, right] = parts.map(|part| gauss(f, part));
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
fn gauss(f: &impl Fn(f64) -> [f64; 3], [low, high]: [f64; 2]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for [node, weight] in GAUSS {
        for node in [-node, node] {
            let values = f(0.5 * (low + high) + 0.5 * (high - low) * node);
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += 0.5 * (high - low) * weight * value;
            }
        }
    }
    sums
}
