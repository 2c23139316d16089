//! The moments of inertia of a body, and what a free body does by Euler's equations.

use super::bounds::{Turn, asymmetry, largest_spin};
use super::series::reach;
use crate::Error;
use crate::math::{Quaternion, Vector};

/// Moments that differ by no more than this part are equal but for the rounding of what they are computed from.
const EQUAL: f64 = 16.0 * f64::EPSILON;

/// The principal moments of inertia of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Top {
    moments: [f64; 3],
    asymmetry: f64,
    symmetry: Symmetry,
    /// (J₂ − J₃)/J₁ and so on: by Euler's equations ω̇₁ is the first of them times ω₂ω₃.
    pub(super) couplings: [f64; 3],
    /// The axes from the least moment to the largest.
    order: [usize; 3],
    /// Ω times the length of a step of the series of an asymmetric top.
    pub(super) reach: f64,
}

/// The moments that are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Symmetry {
    /// All: **ω** is constant.
    Isotropic,
    /// The two across this axis.
    About(usize),
    /// None.
    Asymmetric,
}

impl Top {
    /// A body with these principal moments, in any unit.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless they are positive and none is larger than the sum of the others.
    pub fn new(moments: [f64; 3]) -> Result<Self, Error> {
        let [a, b, c] = moments;
        let most = a.max(b).max(c);
        // A flat plate has a = b + c, but for rounding.
        let holds = a > 0.0
            && b > 0.0
            && c > 0.0
            && most < f64::INFINITY
            && most <= (a + b + c - most) * (1.0 + 8.0 * f64::EPSILON);
        Error::unless(
            holds,
            "inertia",
            most,
            "positive, and no larger than the sum of the other two moments",
        )?;
        let (moments, symmetry) = without_rounding(moments);
        let asymmetry = asymmetry(moments).min(1.0);
        let [a, b, c] = moments;
        Ok(Self {
            moments,
            asymmetry,
            symmetry,
            couplings: [(b - c) / a, (c - a) / b, (a - b) / c],
            order: sorted(moments),
            reach: reach(asymmetry),
        })
    }

    pub(super) fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    pub(super) fn order(&self) -> [usize; 3] {
        self.order
    }

    /// The principal moments.
    pub fn moments(&self) -> [f64; 3] {
        self.moments
    }

    /// The angular momentum in the axes of space, from ω in those of the body.
    pub fn momentum(&self, attitude: Quaternion, spin: Vector) -> Vector {
        let [a, b, c] = self.moments;
        attitude.rotate(Vector::new(a * spin.x, b * spin.y, c * spin.z))
    }

    /// Twice the kinetic energy of rotation.
    pub fn twice_energy(&self, spin: Vector) -> f64 {
        let [a, b, c] = self.moments;
        a * spin.x * spin.x + b * spin.y * spin.y + c * spin.z * spin.z
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
    pub(crate) fn soon(
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
    pub fn largest_spin(&self, spin: Vector) -> f64 {
        largest_spin(self.moments, [spin.x, spin.y, spin.z])
    }

    /// Bounds on the rotation in a flight.
    pub fn turn(&self, spin: Vector) -> Turn {
        Turn::new(self.asymmetry, self.largest_spin(spin))
    }
}

/// Twice the energy by which a later ω is short of an earlier one, to rounding of the small difference.
#[inline(always)]
pub(super) fn lost(moments: [f64; 3], before: [f64; 3], later: [f64; 3]) -> f64 {
    let [a, b, c] =
        [0, 1, 2].map(|i| moments[i] * ((before[i] - later[i]) * (before[i] + later[i])));
    a + b + c
}

fn sorted(moments: [f64; 3]) -> [usize; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    order
}

/// The moments with those made equal that differ by rounding alone, and which these are.
fn without_rounding(moments: [f64; 3]) -> ([f64; 3], Symmetry) {
    let [a, b, c] = moments;
    let near = |x: f64, y: f64| (x - y).abs() <= EQUAL * x.max(y);
    if near(a, b) && near(b, c) && near(c, a) {
        return ([(a + b + c) / 3.0; 3], Symmetry::Isotropic);
    }
    for axis in 0..3 {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        if near(moments[i], moments[j]) {
            let mut equal = moments;
            equal[i] = 0.5 * (moments[i] + moments[j]);
            equal[j] = equal[i];
            return (equal, Symmetry::About(axis));
        }
    }
    (moments, Symmetry::Asymmetric)
}
