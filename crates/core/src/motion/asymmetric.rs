//! Rotation without torque of a body with any moments of inertia.
//!
//! In the principal axes Euler's equations give ω, and q′ = ½qω the attitude: both by one Taylor series, [`TERMS`] powers of time from
//! the beginning of a step.
//!
//! **Error of a step.** Let Ω be |ω| at its beginning and a the [`asymmetry`]. For complex times, too, |ω̇| ≤ a|ω|²/√3 and |q̇| ≤ |ω||q|/√2 with
//! the norms of complex vectors, so that with R = √3/(aΩ) |ω| ≤ Ω/(1 − |t|/R) and |q| ≤ (1 − |t|/R)⁻ᵖ, p = √(3/2)/a, for |t| < R. By Cauchy's
//! inequality on a circle of radius yR the powers of t from n on are together less than (1 − y)⁻ᵖ(t/yR)ⁿ/(1 − t/yR). A step is as
//! long as this allows with y = 1/(1 + p/n), which is best, to stay below 2⁻⁶³, so that rounding alone
//! is seen after many flights. It has 0.3 to 2.4 radians.

use super::bounds::{acceleration, asymmetry, largest_spin};
use crate::Error;
use crate::math::{Quaternion, Vector};
use crate::simd::{elementary, one};

/// Powers of a series.
const TERMS: usize = 28;
/// Logarithm of what a step may lose: 2⁻⁶⁴.
const LOST: f64 = -44.36;
/// Least asymmetry that the length of a step knows of.
const LEAST: f64 = 0.02;

/// The principal moments of inertia of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Top {
    moments: [f64; 3],
    asymmetry: f64,
    /// Ω times the length of a step.
    reach: f64,
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
        let asymmetry = asymmetry(moments).min(1.0);
        let a = asymmetry.max(LEAST);
        let power = 1.5_f64.sqrt() / a;
        let n = TERMS as f64;
        let y = n / (n + power);
        let logarithm = (LOST + power * elementary::ln(1.0 - y)) / n;
        let shrink = elementary::exp_in_lanes(one(logarithm)).as_slice()[0];
        Ok(Self {
            moments,
            asymmetry,
            reach: 2.0_f64.sqrt() * power * y * shrink,
        })
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

    /// (J₂ − J₃)/J₁ and so on: by Euler's equations ω̇₁ is the first of them times ω₂ω₃.
    fn couplings(&self) -> [f64; 3] {
        let [a, b, c] = self.moments;
        [(b - c) / a, (c - a) / b, (a - b) / c]
    }

    /// ω̇ of a free body.
    pub(crate) fn change(&self, spin: Vector) -> Vector {
        let [a, b, c] = self.couplings();
        let Vector { x, y, z } = spin;
        Vector::new(a * y * z, b * z * x, c * x * y)
    }

    /// The largest |ω|² of a flight.
    pub fn largest_spin(&self, spin: Vector) -> f64 {
        largest_spin(self.moments, [spin.x, spin.y, spin.z])
    }

    /// The largest acceleration of a point of the body in a flight, relative to the centre of mass and per distance from it.
    pub fn acceleration(&self, spin: Vector) -> f64 {
        acceleration(self.asymmetry, self.largest_spin(spin))
    }
}

/// The rotation of a body in flight, evaluated forward in time.
#[derive(Debug, Clone)]
pub struct Rotation {
    top: Top,
    /// Time at the beginning of the present step, and its length.
    start: f64,
    length: f64,
    /// The attitude, and ω in the axes of the body, as power series in time since the beginning over the length.
    attitude: [[f64; 4]; TERMS],
    spin: [[f64; 3]; TERMS],
}

impl Rotation {
    /// The rotation with this attitude and this ω, in the axes of the body, at the time 0.
    pub fn new(top: Top, attitude: Quaternion, spin: Vector) -> Self {
        let mut rotation = Self {
            top,
            start: 0.0,
            length: 0.0,
            attitude: [[0.0; 4]; TERMS],
            spin: [[0.0; 3]; TERMS],
        };
        rotation.expand(attitude, spin);
        rotation
    }

    /// The attitude at a time that is not before the step in which the last one lay.
    pub fn attitude(&mut self, time: f64) -> Quaternion {
        let part = self.part(time);
        self.attitude_after(part)
    }

    /// ω in the axes of the body, at such a time.
    pub fn spin(&mut self, time: f64) -> Vector {
        let part = self.part(time);
        self.spin_after(part)
    }

    /// Goes on to the step of a time, and gives the part of the step that has passed by then.
    fn part(&mut self, time: f64) -> f64 {
        if self.length == f64::INFINITY {
            return 0.0; // at rest
        }
        while time - self.start > self.length {
            self.start += self.length;
            self.expand(self.attitude_after(1.0), self.spin_after(1.0));
        }
        (time - self.start) / self.length
    }

    fn attitude_after(&self, part: f64) -> Quaternion {
        let [w, x, y, z] = value(&self.attitude, part);
        Quaternion::new(w, x, y, z).normalized()
    }

    fn spin_after(&self, part: f64) -> Vector {
        let [x, y, z] = value(&self.spin, part);
        Vector::new(x, y, z)
    }

    /// The series from an attitude and ω.
    fn expand(&mut self, attitude: Quaternion, spin: Vector) {
        let size = (spin.x * spin.x + spin.y * spin.y + spin.z * spin.z).sqrt();
        self.length = self.top.reach / size;
        let Quaternion { w, x, y, z } = attitude;
        self.attitude[0] = [w, x, y, z];
        self.spin[0] = [spin.x, spin.y, spin.z];
        if size == 0.0 {
            return;
        }
        let factors = self.top.couplings().map(|f| f * self.length);
        for n in 0..TERMS - 1 {
            let (mut turn, mut change) = ([0.0; 4], [0.0; 3]);
            for (q, (left, right)) in self.attitude[..=n]
                .iter()
                .zip(self.spin[..=n].iter().zip(self.spin[..=n].iter().rev()))
            {
                let [x, y, z] = *right;
                change[0] += left[1] * z;
                change[1] += left[2] * x;
                change[2] += left[0] * y;
                turn[0] -= q[1] * x + q[2] * y + q[3] * z;
                turn[1] += q[0] * x + q[2] * z - q[3] * y;
                turn[2] += q[0] * y + q[3] * x - q[1] * z;
                turn[3] += q[0] * z + q[1] * y - q[2] * x;
            }
            let part = 1.0 / (n + 1) as f64;
            self.attitude[n + 1] = turn.map(|sum| 0.5 * self.length * part * sum);
            self.spin[n + 1] = [0, 1, 2].map(|i| factors[i] * part * change[i]);
        }
    }
}

/// A vector of power series.
fn value<const N: usize>(terms: &[[f64; N]; TERMS], part: f64) -> [f64; N] {
    let mut sum = [0.0; N];
    for term in terms.iter().rev() {
        for i in 0..N {
            sum[i] = sum[i] * part + term[i];
        }
    }
    sum
}
