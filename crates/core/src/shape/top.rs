//! The principal moments of inertia of a body.

use crate::Error;
use crate::math::Vector;

/// Moments that differ by no more than this part are equal but for the rounding of what they are computed from.
const EQUAL: f64 = 16.0 * f64::EPSILON;

/// The principal moments of inertia of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Top {
    moments: [f64; 3],
    /// [`asymmetry`], at most 1.
    pub(crate) asymmetry: f64,
    pub(crate) symmetry: Symmetry,
    /// (J₂ − J₃)/J₁ and so on: by Euler's equations ω̇₁ is the first of them times ω₂ω₃.
    pub(crate) couplings: [f64; 3],
    /// The axes from the least moment to the largest.
    pub(crate) order: [usize; 3],
}

/// The moments that are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Symmetry {
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
        let allowed = "positive, and no larger than the sum of the other two moments";
        Error::unless(holds, "inertia", most, allowed)?;
        let (moments, symmetry) = without_rounding(moments);
        let asymmetry = asymmetry(moments).min(1.0);
        let [a, b, c] = moments;
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        Ok(Self {
            moments,
            asymmetry,
            symmetry,
            couplings: [(b - c) / a, (c - a) / b, (a - b) / c],
            order,
        })
    }

    /// The principal moments.
    #[inline(always)]
    pub fn moments(&self) -> [f64; 3] {
        self.moments
    }

    /// Twice the kinetic energy of rotation.
    #[inline(always)]
    pub fn twice_energy(&self, spin: Vector) -> f64 {
        let [a, b, c] = self.moments;
        a * spin.x * spin.x + b * spin.y * spin.y + c * spin.z * spin.z
    }
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

/// The largest |J_j − J_k|/J_i, in [0, 1] for the moments of any body. |ω̇| ≤ that times |ω|²/√3, for |ω̇_i| ≤ |J_j − J_k||ω_jω_k|/J_i by
/// Euler's equations, and ω₂²ω₃² + ω₃²ω₁² + ω₁²ω₂² ≤ |ω|⁴/3.
fn asymmetry([a, b, c]: [f64; 3]) -> f64 {
    ((b - c).abs() / a)
        .max((c - a).abs() / b)
        .max((a - b).abs() / c)
}
