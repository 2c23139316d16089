//! Supports of convex surfaces whose normal turns along its tangent, **n** + s**n**′.

use crate::math::Vector;

/// A body over the plane at one time of its flight.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NormalMotion {
    /// Height of the centre of mass, its rate and its acceleration.
    pub height: f64,
    pub rate: f64,
    pub acceleration: f64,
    /// **n**, **n**′ and **n**″, in the axes of the body.
    pub up: Vector,
    pub turning: Vector,
    pub bending: Vector,
}

/// A convex function h of s, the support of a part along the tangent of its normal.
pub(crate) trait Support {
    /// h and h′ at s = 0.
    fn tangent(&self) -> (f64, f64);

    /// h(s) − h(0) − s h′(0) ≥ 0, without cancellation where it can be, also for s < 0.
    fn beyond_tangent(&self, s: f64) -> f64;

    /// h″ at s = 0 where the normal has its second derivative, too.
    fn second(&self) -> f64;

    /// True if a whole rim is lowest: it has no single point whose speed is that of the part.
    #[inline(always)]
    fn is_flat(&self) -> bool {
        false
    }

    /// Gap and rate.
    #[inline(always)]
    fn opening(&self, at: &NormalMotion) -> (f64, f64) {
        let (size, slope) = self.tangent();
        (at.height - size, at.rate - slope)
    }
}

/// h = |**a** + s**b**|, where **a** also has the second derivative **c**.
pub(crate) struct Length {
    a: Vector,
    b: Vector,
    /// h and h′ at s = 0, where h = 0 behind it.
    pub size: f64,
    pub slope: f64,
    /// |**b**|² − h′².
    spread: f64,
    /// **a**·**c**.
    bent: f64,
}

impl Length {
    #[inline(always)]
    pub fn new([a, b, c]: [Vector; 3]) -> Self {
        let (size, across) = (a.norm(), a.cross(b));
        let (slope, spread) = if size > 0.0 {
            let part = 1.0 / size;
            (a.dot(b) * part, across.dot(across) * (part * part))
        } else {
            (b.norm(), 0.0)
        };
        Self {
            a,
            b,
            size,
            slope,
            spread,
            bent: a.dot(c),
        }
    }

    /// h(s), and what of it is beyond the tangent.
    #[inline(always)]
    pub fn along(&self, s: f64) -> (f64, f64) {
        let size = self.b.mul_add(s, self.a).norm();
        let tangent = s.mul_add(self.slope, self.size);
        let beyond = if tangent < 0.0 {
            size - tangent
        } else if self.spread > 0.0 {
            s * s * self.spread / (size + tangent)
        } else {
            0.0
        };
        (size, beyond)
    }
}

impl Support for Length {
    #[inline(always)]
    fn tangent(&self) -> (f64, f64) {
        (self.size, self.slope)
    }

    #[inline(always)]
    fn second(&self) -> f64 {
        (self.spread + self.bent) / self.size
    }

    #[inline(always)]
    fn beyond_tangent(&self, s: f64) -> f64 {
        self.along(s).1
    }
}
