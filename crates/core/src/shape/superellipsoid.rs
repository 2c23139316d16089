//! Superellipsoids, the superquadrics of discrete-element codes:
//!
//! (|x/a|^n₂ + |y/b|^n₂)^(n₁/n₂) + |z/c|^n₁ = 1.
//!
//! The surface is the unit sphere of a nested norm, so that its support function is the dual one (Hölder), with 1/p + 1/n = 1:
//! h(**u**) = (W^p₁ + |cu_z|^p₁)^(1/p₁), W = (|au_x|^p₂ + |bu_y|^p₂)^(1/p₂). Its gradient is the place that touches.
//!
//! Volume and second moments: A. Jaklič, A. Leonardis and F. Solina, *Segmentation and Recovery of Superquadrics* (Kluwer, 2000), Sec. 2.4, with
//! their ε₁ = 2/n₁ and ε₂ = 2/n₂.

use super::convex::{Convex, ConvexSurface};
use super::ellipsoid::SEMI_AXES;
use super::rigid::{CENTRE, Inertia, Rigid, RigidSurface, TENSOR};
use super::{BodyKind, Form, check_density};
use crate::Error;
use crate::describe::{Allowed, Argument, Arguments, Interval, Kind, Parameter};
use crate::math::{Symmetric, Vector};
use crate::simd::elementary::{exp_m1_in_lanes, ln};
use crate::simd::one;
use std::f64::consts::TAU;

/// Least and largest exponent: below 2 a superellipsoid has edges, and towards 1 is an octahedron; towards infinity it is a box.
const EXPONENTS: [f64; 2] = [1.1, 100.0];

/// Its entry in the table of bodies.
pub(super) const SUPERELLIPSOID: BodyKind = BodyKind::Rigid(Kind {
    name: "Superellipsoid",
    text: "superellipsoid, the superquadric of DEM codes",
    parameters: &[
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
        Parameter::density("density"),
        TENSOR,
        CENTRE,
    ],
    make: |given| {
        Rigid::superellipsoid(given.several(0), given.several(1), given.number(2)).map(Form::from)
    },
});

/// A superellipsoid about the origin, its axes those of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Superellipsoid {
    semi_axes: [f64; 3],
    /// p₁ and p₂.
    dual: [f64; 2],
}

/// xʸ for 0 ≤ x ≤ 2, y > 0; 0 where it is below 10⁻²⁷.
#[inline(always)]
fn power(x: f64, y: f64) -> f64 {
    let logarithm = y * ln(x.max(f64::MIN_POSITIVE));
    // Of a negative number the exponential has fewer digits.
    let root = exp(0.5 * logarithm.abs().min(64.0));
    let large = root * root;
    if logarithm >= 0.0 {
        large
    } else if logarithm < -62.0 {
        0.0
    } else {
        1.0 / large
    }
}

/// eˣ for 0 ≤ x ≤ 32.
#[inline(always)]
fn exp(x: f64) -> f64 {
    1.0 + exp_m1_in_lanes(one(x)).as_slice()[0]
}

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

impl Superellipsoid {
    pub fn new(semi_axes: [f64; 3], exponents: [f64; 2]) -> Self {
        Self {
            semi_axes,
            dual: exponents.map(|n| n / (n - 1.0)),
        }
    }

    pub fn scaled(self, part: f64) -> Self {
        Self {
            semi_axes: self.semi_axes.map(|axis| axis / part),
            ..self
        }
    }

    /// The norm of two numbers ≥ 0 with an exponent, and what it changes with each.
    #[inline(always)]
    fn norm(p: f64, x: f64, y: f64) -> (f64, [f64; 2]) {
        let (most, least) = (x.max(y), x.min(y));
        if most == 0.0 {
            return (0.0, [0.0, 0.0]);
        }
        // With t the smaller over the larger, N = most (1 + tᵖ)^(1/p), and dN/dmost = (1 + tᵖ)^(1/p − 1), dN/dleast = tᵖ⁻¹ as much.
        let ratio = least / most;
        let change = if ratio > 0.0 {
            power(ratio, p - 1.0)
        } else {
            0.0
        };
        let sum = ratio.mul_add(change, 1.0);
        let size = power(sum, 1.0 / p);
        let first = size / sum;
        let second = change * first;
        let changes = if x >= y {
            [first, second]
        } else {
            [second, first]
        };
        (most * size, changes)
    }

    /// h(**u**), and the place on the surface with that outward normal.
    #[inline(always)]
    pub fn farthest(&self, u: Vector) -> (f64, Vector) {
        let ([a, b, c], [p, q]) = (self.semi_axes, self.dual);
        let (level, [x, y]) = Self::norm(q, (a * u.x).abs(), (b * u.y).abs());
        let (size, [across, along]) = Self::norm(p, level, (c * u.z).abs());
        let side = |axis: f64, part: f64, u: f64| (axis * part).copysign(u);
        let place = Vector::new(
            side(a, across * x, u.x),
            side(b, across * y, u.y),
            side(c, along, u.z),
        );
        (size, place)
    }

    /// No more than the radius of the largest ball about the origin inside: the surface is outside of the ellipsoid, or of the octahedron, with
    /// the same semi-axes.
    pub fn inner(&self) -> f64 {
        let [a, b, c] = self.semi_axes;
        let least = a.min(b).min(c);
        if self.dual.iter().all(|&p| p <= 2.0) {
            least
        } else {
            least / 3.0_f64.sqrt()
        }
    }

    #[inline(always)]
    pub fn support(&self, u: Vector) -> f64 {
        self.farthest(u).0
    }

    /// h″ along a curve of directions **u** with **u**′ and **u**″; infinite where the surface is flat.
    pub fn bent(&self, u: Vector, turning: Vector, bending: Vector) -> f64 {
        let ([a, b, c], [p, q]) = (self.semi_axes, self.dual);
        let own = |axis: f64, u: f64, v: f64| ((axis * u).abs(), (axis * v).copysign(u * v));
        // Of two numbers ≥ 0 with their derivatives: their norm N with its first one, and (p − 1)(xy)^(p−2) (x dy − y dx)² N^(1−2p), by which
        // the second one is larger than that of the numbers.
        let second = |p: f64, [(x, dx), (y, dy)]: [(f64, f64); 2]| {
            let (size, [fx, fy]) = Self::norm(p, x, y);
            let cross = x * dy - y * dx;
            let curved = if cross == 0.0 {
                0.0
            } else {
                let part = |of: f64| match p - 2.0 {
                    0.0 => 1.0,
                    more if more > 0.0 => power(of / size, more),
                    less => 1.0 / power(of / size, -less),
                };
                (p - 1.0) * part(x) * part(y) * cross * cross / (size * size * size)
            };
            (size, fx * dx + fy * dy, curved, fx)
        };
        let (level, slope, curved, _) = second(q, [own(a, u.x, turning.x), own(b, u.y, turning.y)]);
        let (_, _, outer, across) = second(p, [(level, slope), own(c, u.z, turning.z)]);
        outer + across * curved + self.farthest(u).1.dot(bending)
    }
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
            Error::unless(
                within,
                "exponents",
                n,
                "two numbers (n1, n2), each from 1.1 to 100",
            )?;
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
        let body = Superellipsoid::new(semi_axes.map(|axis| axis / unit), exponents);
        let surface = Convex::new(ConvexSurface::Superellipsoid(body));
        Self::new(inertia, unit, |_| Ok(RigidSurface::Convex(surface)))
    }
}
