//! Supports of convex hulls whose normal turns along its tangent, **n** + s**n**′, and the first root of the bound that they make.

use super::certify::SHORTEST;
use super::plane::first_root;
use crate::math::Vector;
use crate::shape::{Band, Instant};

/// Steps of Newton's method towards the root of the bound of a convex body.
const NEWTON: usize = 3;

/// A convex function h of s.
pub(super) trait Support {
    /// h′(s).
    fn slope(&self, s: f64) -> f64;
    /// h(s) − h(0) − s h′(0) ≥ 0, without cancellation.
    fn beyond(&self, s: f64) -> f64;
}

/// h = |**a** + s**b**|.
pub(super) struct Length {
    a: Vector,
    b: Vector,
    /// h and h′ at s = 0, where h = 0 behind it.
    pub size: f64,
    pub slope: f64,
    /// |**b**|² − h′².
    spread: f64,
}

impl Length {
    pub fn new(a: Vector, b: Vector) -> Self {
        let size = a.norm();
        let (slope, across) = if size > 0.0 {
            (a.dot(b) / size, a.cross(b).norm() / size)
        } else {
            (b.norm(), 0.0)
        };
        Self {
            a,
            b,
            size,
            slope,
            spread: across * across,
        }
    }

    /// |A**n**| of an ellipsoid with these semi-axes.
    pub fn of_ellipsoid([a, b, c]: [f64; 3], at: &Instant) -> Self {
        let stretched = |v: Vector| Vector::new(a * v.x, b * v.y, c * v.z);
        Self::new(stretched(at.up), stretched(at.turning))
    }

    fn at(&self, s: f64) -> f64 {
        self.b.mul_add(s, self.a).norm()
    }

    /// h″ at 0 where **a** also has the second derivative **c**, and `bent` is **a**·**c**.
    pub fn bent(&self, bent: f64) -> f64 {
        (self.spread + bent) / self.size
    }
}

impl Support for Length {
    fn slope(&self, s: f64) -> f64 {
        let moved = self.b.mul_add(s, self.a);
        let size = moved.norm();
        if size > 0.0 {
            moved.dot(self.b) / size
        } else {
            self.b.norm()
        }
    }

    fn beyond(&self, s: f64) -> f64 {
        let tangent = s.mul_add(self.slope, self.size);
        if tangent < 0.0 {
            self.at(s) - tangent
        } else if self.spread > 0.0 {
            s * s * self.spread / (self.at(s) + tangent)
        } else {
            0.0
        }
    }
}

/// The support of a band in the direction −**n**.
pub(super) struct BandSupport<'a> {
    band: &'a Band,
    /// Its parts along the axis, n_z and its rate, and across it.
    along: (f64, f64),
    across: Length,
    /// |**n**|.
    whole: Length,
    weights: [f64; 3],
    /// h and h′ at s = 0.
    pub size: f64,
    pub slope: f64,
}

impl<'a> BandSupport<'a> {
    pub fn new(band: &'a Band, at: &Instant) -> Self {
        let along = (-at.up.z, -at.turning.z);
        let level = |v: Vector| Vector::new(v.x, v.y, 0.0);
        let across = Length::new(level(at.up), level(at.turning));
        let weights = band.weights(along.0, across.size);
        let [z, r, radius] = weights;
        Self {
            band,
            size: z * along.0 + r * across.size + radius,
            slope: z * along.1 + r * across.slope,
            along,
            across,
            whole: Length::new(at.up, at.turning),
            weights,
        }
    }

    /// Returns whether a whole rim is lowest.
    pub fn is_flat(&self) -> bool {
        self.across.size == 0.0 && self.weights[1] != 0.0
    }

    fn weights_at(&self, s: f64) -> (f64, f64, [f64; 3]) {
        let (along, across) = (s.mul_add(self.along.1, self.along.0), self.across.at(s));
        (along, across, self.band.weights(along, across))
    }

    /// f″, with **n**″, but for gravity.
    pub fn curvature(&self, at: &Instant, bending: Vector) -> f64 {
        if self.is_flat() {
            return f64::NEG_INFINITY;
        }
        let [z, r, radius] = self.weights;
        let level = at.up.x * bending.x + at.up.y * bending.y;
        let across = if r == 0.0 {
            0.0
        } else {
            r * self.across.bent(level)
        };
        z * bending.z - across - radius * self.whole.bent(at.up.dot(bending))
    }
}

impl Support for BandSupport<'_> {
    fn slope(&self, s: f64) -> f64 {
        let [z, r, radius] = self.weights_at(s).2;
        z * self.along.1 + r * self.across.slope(s) + radius * self.whole.slope(s)
    }

    fn beyond(&self, s: f64) -> f64 {
        let (along, across, weights) = self.weights_at(s);
        let [z, r, radius] = weights;
        if weights == self.weights {
            return r * self.across.beyond(s) + radius * self.whole.beyond(s);
        }
        let support = z * along + r * across + radius * self.whole.at(s);
        support - s.mul_add(self.slope, self.size)
    }
}

/// A time no later than the first root of width + rate s − (h(s) − h(0) − s h′(0)) − Ms²/2, which is concave. Its tangents lie above it, so that
/// Newton's method comes from behind the root; the last chord, which lies below it, ends in front of it.
pub(super) fn convex_root(support: &impl Support, width: f64, rate: f64, bound: f64) -> f64 {
    let value = |s: f64| width + s * (rate - 0.5 * bound * s) - support.beyond(s);
    let mut after = first_root(width, rate, bound);
    if support.beyond(after) <= 0.0 {
        return after;
    }
    let begins = support.slope(0.0);
    let mut before = (0.0, width);
    for _ in 0..NEWTON {
        let found = value(after);
        if found >= 0.0 {
            return after;
        }
        let fall = rate - bound * after - (support.slope(after) - begins);
        let next = after - found / fall;
        if !(next > before.0 && next < after) {
            break;
        }
        after = next;
    }
    // Where the gap is 0 at the beginning and opens, a point between it and the root.
    let mut inside = 0.5 * after;
    while before.1 <= 0.0 && rate > 0.0 {
        let found = value(inside);
        if found > 0.0 {
            before = (inside, found);
        }
        inside *= 0.5;
        if bound * inside <= SHORTEST {
            return SHORTEST / bound;
        }
    }
    let found = value(after);
    if found >= 0.0 {
        return after;
    }
    let chord = before.0 + (after - before.0) * before.1 / (before.1 - found);
    if rate < 0.0 {
        chord
    } else {
        chord.max(SHORTEST / bound)
    }
}
