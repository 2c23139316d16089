//! Euler's equations of a free body.

use super::bounds::{SpinBounds, largest_acceleration};
use crate::math::{Part, Quaternion, Vector, Vectors};
use crate::shape::Top;
use crate::simd::Pack;
use pulp::Simd;
use std::ops::Mul;

impl Top {
    /// The angular momentum in the axes of space, from ω in those of the body.
    #[inline(always)]
    pub fn momentum(&self, attitude: Quaternion, spin: Vector) -> Vector {
        let [a, b, c] = self.moments();
        attitude.rotate(Vector::new(a * spin.x, b * spin.y, c * spin.z))
    }

    /// ω̇ of a free body.
    #[inline(always)]
    pub(crate) fn change(&self, spin: Vector) -> Vector {
        let [a, b, c] = self.couplings;
        let Vector { x, y, z } = spin;
        Vector::new(a * y * z, b * z * x, c * x * y)
    }

    /// Attitude and ω of a free body a short time later or before, by their series up to the third power: less than (Ωt)⁴/8 of them is left out.
    #[inline(always)]
    pub(crate) fn expanded(
        &self,
        attitude: Quaternion,
        spin: Vector,
        time: f64,
    ) -> (Quaternion, Vector) {
        let [a, b, c] = self.couplings;
        // Products of the components, by Euler's equations.
        let euler = |v: Vector, w: Vector| Vector::new(a * v.y * w.z, b * v.z * w.x, c * v.x * w.y);
        let both = |v: Vector, w: Vector| euler(v, w) + euler(w, v);
        let first = euler(spin, spin);
        let second = both(spin, first);
        let third = both(spin, second) + euler(first, first) * 2.0;
        // q(t) = q exp u by Magnus' expansion.
        let cubic = second * (1.0 / 12.0) + spin.cross(first) * (1.0 / 24.0);
        let u = ((cubic * time + first * 0.25) * time + spin * 0.5) * time;
        let square = u.x * u.x + u.y * u.y + u.z * u.z;
        let v = u * (1.0 - square * (1.0 / 6.0));
        let turn = Quaternion::new(1.0 - 0.5 * square, v.x, v.y, v.z);
        let later = ((third * (time / 3.0) + second) * (0.5 * time) + first) * time;
        (attitude.turned(turn), spin + later)
    }

    /// The largest |ω|² of a flight.
    ///
    /// With J₁ ≤ J₂ ≤ J₃, J₁J₃|ω|² − 2E(J₁ + J₃) + Λ² = Σω_i²(J_i − J₁)(J_i − J₃) = −ω₂²(J₂ − J₁)(J₃ − J₂) ≤ 0. The energy and Λ² are constant, so
    /// that |ω| is largest where ω₂ = 0: Ω² = |ω|² + ω₂²(J₂ − J₁)(J₃ − J₂)/(J₁J₃) with what it is now.
    #[inline(always)]
    pub fn largest_spin<T: Part + Mul<f64, Output = T>>(&self, spin: Vector<T>) -> T {
        let [x, y, z] = [spin.x * spin.x, spin.y * spin.y, spin.z * spin.z];
        let [a, b, c] = self.moments();
        let (squares, [least, middle, most]) = if (a - b) * (b - c) >= 0.0 {
            (y, [a, b, c])
        } else if (b - a) * (a - c) >= 0.0 {
            (x, [b, a, c])
        } else {
            (z, [a, c, b])
        };
        x + y + z + squares * ((middle - least) * (most - middle) / (least * most))
    }

    /// [`SpinBounds::whole`] in each lane.
    #[inline(always)]
    pub(crate) fn largest_acceleration<S: Simd>(&self, spin: Vectors<S>) -> Pack<S> {
        largest_acceleration(self.asymmetry, self.largest_spin(spin))
    }

    /// Bounds on the rotation in a flight.
    #[inline(always)]
    pub fn bounds(&self, spin: Vector) -> SpinBounds {
        SpinBounds::new(self.asymmetry, self.largest_spin(spin))
    }
}

/// Twice the energy by which a later ω is short of an earlier one, to rounding of the small difference.
#[inline(always)]
pub(super) fn energy_error<T: Part>(moments: [T; 3], before: [T; 3], later: [T; 3]) -> T {
    let part = |i: usize| moments[i] * ((before[i] - later[i]) * (before[i] + later[i]));
    part(0) + part(1) + part(2)
}
