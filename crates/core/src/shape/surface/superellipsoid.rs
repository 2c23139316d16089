//! The surfaces of superellipsoids, the superquadrics of discrete-element codes:
//!
//! (|x/a|^n₂ + |y/b|^n₂)^(n₁/n₂) + |z/c|^n₁ = 1.
//!
//! The surface is the unit sphere of a nested norm, so that its support function is the dual one (Hölder), with 1/p + 1/n = 1:
//! h(**u**) = (W^p₁ + |cu_z|^p₁)^(1/p₁), W = (|au_x|^p₂ + |bu_y|^p₂)^(1/p₂). Its gradient is the place that touches.

use super::support::{NormalMotion, Support};
use super::{Convex, ConvexSurface, Piece, RigidSurface};
use crate::math::{Quaternion, Vector};
use crate::simd::elementary::{exp_m1_in_lanes, ln};
use crate::simd::one;

/// Of the exponent 8: where the surface is flatter, a normal in double precision hardly tells where two of them touch.
const LEAST_DUAL: f64 = 1.142_857_142_857;

/// A superellipsoid about the origin, its axes those of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Superellipsoid {
    semi_axes: [f64; 3],
    /// p₁ and p₂.
    dual: [f64; 2],
}

/// xʸ for 0 ≤ x ≤ 2, y > 0; 0 where it is below 10⁻²⁷.
#[inline(always)]
pub(crate) fn power(x: f64, y: f64) -> f64 {
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
pub(crate) fn exp(x: f64) -> f64 {
    1.0 + exp_m1_in_lanes(one(x)).as_slice()[0]
}

impl Superellipsoid {
    pub fn new(semi_axes: [f64; 3], exponents: [f64; 2]) -> Self {
        Self {
            semi_axes,
            dual: exponents.map(|n| n / (n - 1.0)),
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

    /// The second derivatives of h(**u**) along two directions, and the mixed one in between.
    pub fn bends(&self, u: Vector, [v, w]: [Vector; 2]) -> [f64; 3] {
        let ([a, b, c], [p, q]) = (self.semi_axes, self.dual);
        let side = |axis: f64, u: f64, v: f64| (axis * v).copysign(u * v);
        let own = |axis: f64, u: f64, [v, w]: [f64; 2]| {
            ((axis * u).abs(), [side(axis, u, v), side(axis, u, w)])
        };
        // Of two numbers ≥ 0 with their derivatives: their norm N with its first one, and (p − 1)(xy)^(p−2) (x dy − y dx)² N^(1−2p), by which
        // the second one is larger than that of the numbers.
        let second = |p: f64, [(x, dx), (y, dy)]: [(f64, [f64; 2]); 2]| {
            let (size, [fx, fy]) = Self::norm(p, x, y);
            let cross = [x * dy[0] - y * dx[0], x * dy[1] - y * dx[1]];
            let part = |of: f64| match p - 2.0 {
                0.0 => 1.0,
                more if more > 0.0 => power(of / size, more),
                less => 1.0 / power(of / size, -less),
            };
            let curved = |i: usize, j: usize| {
                if cross[i] == 0.0 || cross[j] == 0.0 {
                    return 0.0;
                }
                (p - 1.0) * part(x) * part(y) * cross[i] * cross[j] / (size * size * size)
            };
            let slopes = [fx * dx[0] + fy * dy[0], fx * dx[1] + fy * dy[1]];
            (size, slopes, [curved(0, 0), curved(0, 1), curved(1, 1)], fx)
        };
        let (level, slopes, curved, _) =
            second(q, [own(a, u.x, [v.x, w.x]), own(b, u.y, [v.y, w.y])]);
        let (_, _, outer, across) = second(p, [(level, slopes), own(c, u.z, [v.z, w.z])]);
        [0, 1, 2].map(|i| outer[i] + across * curved[i])
    }
}

impl ConvexSurface for Superellipsoid {
    type Along<'a> = SuperellipsoidSupport<'a>;

    const OF: fn(Convex<Self>) -> RigidSurface = RigidSurface::Superellipsoid;
    const LOOKS_BACK: bool = false;

    /// The surface is outside of the ellipsoid, or of the octahedron, with the same semi-axes.
    fn inner(&self) -> f64 {
        let [a, b, c] = self.semi_axes;
        let least = a.min(b).min(c);
        if self.dual.iter().all(|&p| p <= 2.0) {
            least
        } else {
            least / 3.0_f64.sqrt()
        }
    }

    fn support(&self, up: Vector) -> f64 {
        self.farthest(up).0
    }

    #[inline(always)]
    fn nearest(&self, _: usize, up: Vector, _: Vector) -> Vector {
        self.farthest(up * -1.0).1
    }

    #[inline(always)]
    fn along<'a>(&'a self, _: usize, at: &'a NormalMotion) -> SuperellipsoidSupport<'a> {
        let (size, place) = self.farthest(at.up);
        SuperellipsoidSupport {
            body: self,
            at,
            size,
            slope: place.dot(at.turning),
        }
    }

    fn scaled(&self, part: f64, _: f64) -> Self {
        Self {
            semi_axes: self.semi_axes.map(|axis| axis / part),
            ..*self
        }
    }

    fn piece(&self, axes: Quaternion, centre: Vector, unit: f64) -> Option<Piece> {
        let surface = self.scaled(1.0 / unit, 0.0);
        let found = self.dual.iter().all(|&p| p >= LEAST_DUAL);
        found.then(|| Piece::superellipsoid(surface, axes, centre * unit, unit))
    }
}

/// The support of a superellipsoid.
pub(crate) struct SuperellipsoidSupport<'a> {
    body: &'a Superellipsoid,
    at: &'a NormalMotion,
    size: f64,
    slope: f64,
}

impl Support for SuperellipsoidSupport<'_> {
    #[inline(always)]
    fn tangent(&self) -> (f64, f64) {
        (self.size, self.slope)
    }

    #[inline(always)]
    fn second(&self) -> f64 {
        let Self { body, at, .. } = self;
        body.bends(at.up, [at.turning; 2])[0] + body.farthest(at.up).1.dot(at.bending)
    }

    #[inline(always)]
    fn beyond_tangent(&self, s: f64) -> f64 {
        let moved = self.at.turning.mul_add(s, self.at.up);
        self.body.farthest(moved).0 - s.mul_add(self.slope, self.size)
    }
}
