//! Bounds on what a body that moves freely can do, for certified steps.

use std::ops::Mul;

/// [`SpinBounds::whole`], from a and the largest |ω|².
#[inline(always)]
pub(super) fn largest_acceleration<T: Mul<f64, Output = T>>(asymmetry: f64, square: T) -> T {
    square * (1.0 + asymmetry / 3.0_f64.sqrt())
}

/// Bounds on the rotation in a flight, where a is the asymmetry of the body ([`crate::shape::Top`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpinBounds {
    /// Ω, the largest |**ω**|.
    pub fastest: f64,
    /// 1/Ω.
    pub radian: f64,
    /// (1 + a/√3)Ω², the largest acceleration of a point of the body relative to the centre of mass, per distance from it: **ω̇** × **p** +
    /// **ω** × (**ω** × **p**) is no longer than (|**ω̇**| + |**ω**|²)|**p**|.
    pub whole: f64,
    /// (½ + a/√3)Ω², the largest part of **n**″ across **n**, a unit vector that does not move in space, in the axes of the body:
    /// **n**″ = (**n** × **ω**) × **ω** + **n** × **ω̇**, and the first is **n**·**ω** times the part of **ω** across **n**, less |**n**′|²**n**.
    pub across: f64,
}

impl SpinBounds {
    /// Of a body of this asymmetry, in a flight with this largest |ω|².
    #[inline(always)]
    pub fn new(asymmetry: f64, largest_spin: f64) -> Self {
        let change = asymmetry / 3.0_f64.sqrt();
        let fastest = largest_spin.sqrt();
        Self {
            fastest,
            radian: 1.0 / fastest,
            whole: largest_acceleration(asymmetry, largest_spin),
            across: (0.5 + change) * largest_spin,
        }
    }
}
