//! Superellipsoids.
//!
//! Volume and second moments: A. Jaklič, A. Leonardis and F. Solina, *Segmentation and Recovery of Superquadrics* (Kluwer, 2000), Sec. 2.4, with
//! their ε₁ = 2/n₁ and ε₂ = 2/n₂.

use super::ellipsoid::SEMI_AXES;
use super::pieces::Extent;
use super::rigid::{Inertia, Rigid, homogeneous};
use super::surface::{Convex, Superellipsoid, exp, power};
use super::{BodyKind, Form, check_density};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{Symmetric, Vector};
use crate::simd::elementary::ln;
use std::f64::consts::TAU;

/// Least and largest exponent: below 2 a superellipsoid has edges, and towards 1 is an octahedron; towards infinity it is a box.
const EXPONENTS: [f64; 2] = [1.1, 100.0];

/// Its entry in the table of bodies.
pub(super) const SUPERELLIPSOID: BodyKind = BodyKind::Rigid(Kind {
    name: "Superellipsoid",
    text: "superellipsoid, the superquadric of DEM codes",
    parameters: homogeneous![
        SEMI_AXES,
        Parameter::new(
            "exponents",
            "exponents along z and across it",
            Some("1"),
            Allowed::Several(
                &[
                    ["exponent_1", "exponent along z"],
                    ["exponent_2", "exponent across z"],
                ],
                Interval::from(EXPONENTS[0], EXPONENTS[1]),
            ),
            Argument::Numbers(&[4.0, 3.0]),
        ),
    ],
    make: |given| {
        Rigid::superellipsoid(given.several(0), given.several(1), given.number(2)).map(Form::from)
    },
});

/// ln Γ(x) by Stirling's series, for x > 0.
fn ln_gamma(x: f64) -> f64 {
    let (mut shifted, mut product) = (x, 1.0);
    while shifted < 12.0 {
        product *= shifted;
        shifted += 1.0;
    }
    let inverse = 1.0 / (shifted * shifted);
    // B₂ₖ/(2k(2k − 1)).
    let terms = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let series = terms
        .iter()
        .rev()
        .fold(0.0, |sum, term| sum * inverse + term);
    (shifted - 0.5) * ln(shifted) - shifted + 0.5 * ln(TAU) + series / shifted - ln(product)
}

/// Euler's integral B(x, y), not below e⁻³².
fn beta(x: f64, y: f64) -> f64 {
    1.0 / exp(ln_gamma(x + y) - ln_gamma(x) - ln_gamma(y))
}

impl Rigid {
    /// A homogeneous superellipsoid with these semi-axes (m) along its own axes, and the exponents n₁, along z, and n₂, across.
    ///
    /// # Errors
    /// Unless semi-axes and density are positive, the largest at most 1000 times the smallest, and both exponents from 1.1 to 100.
    pub fn superellipsoid(
        semi_axes: [f64; 3],
        exponents: [f64; 2],
        density: f64,
    ) -> Result<Self, Error> {
        Self::check_semi_axes(semi_axes)?;
        check_density(density)?;
        let [least, most] = EXPONENTS;
        for n in exponents {
            let within = (least..=most).contains(&n);
            let allowed = "two numbers (n1, n2), each from 1.1 to 100";
            Error::unless(within, "exponents", n, allowed)?;
        }
        let [a, b, c] = semi_axes;
        let [e1, e2] = exponents.map(|n| 2.0 / n);
        let scale = density * a * b * c * e1 * e2;
        let mass = 2.0 * scale * beta(0.5 * e1 + 1.0, e1) * beta(0.5 * e2, 0.5 * e2);
        let across = 0.5 * scale * beta(1.5 * e2, 0.5 * e2) * beta(0.5 * e1, 2.0 * e1 + 1.0);
        let along = 2.0 * scale * beta(0.5 * e2, 0.5 * e2 + 1.0) * beta(1.5 * e1, e1 + 1.0);
        let [xx, yy, zz] = [across * a * a, across * b * b, along * c * c];
        let inertia = Inertia {
            mass,
            centre: Vector::default(),
            tensor: Symmetric::diagonal([yy + zz, zz + xx, xx + yy]),
        };
        // The largest |x|² of a norm (Hölder): of exponents up to 2 the larger square, else the norm of both with p′ = n/(n − 2).
        let reach = |n: f64, [x, y]: [f64; 2]| {
            let (most, least) = (x.max(y), x.min(y));
            let dual = n / (n - 2.0);
            if n <= 2.0 {
                most
            } else {
                most * power(1.0 + power(least / most, dual), 1.0 / dual)
            }
        };
        let [n1, n2] = exponents;
        let unit = reach(n1, [reach(n2, [a * a, b * b]), c * c]).sqrt() * (1.0 + 1e-15);
        let semi_axes = semi_axes.map(|axis| axis / unit);
        let surface = Convex::new(Superellipsoid::new(semi_axes, exponents));
        Self::new(inertia, unit, Extent::Hull, |_| Ok(surface.into()))
    }
}
