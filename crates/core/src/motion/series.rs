//! The rotation without torque of a body with three different moments of inertia.
//!
//! In the principal axes Euler's equations give ω, and q′ = ½qω the attitude: both by one Taylor series, [`TERMS`] powers of time from
//! the beginning of a step.
//!
//! **Error of a step.** Let Ω be |ω| at its beginning and a the asymmetry ([`Top`]). For complex times, too,
//! |ω̇| ≤ a|ω|²/√3 and |q̇| ≤ |ω||q|/√2 with the norms of complex vectors, so that with R = √3/(aΩ) |ω| ≤ Ω/(1 − |t|/R) and
//! |q| ≤ (1 − |t|/R)⁻ᵖ, p = √(3/2)/a, for |t| < R. By Cauchy's inequality on a circle of radius yR the powers of t from n on are together less
//! than (1 − y)⁻ᵖ(t/yR)ⁿ/(1 − t/yR). A step is as long as this allows with y = 1/(1 + p/n), which is best, to stay below 2⁻⁶³, so that
//! rounding alone is seen after many flights. It has 0.3 to 2.4 radians.

use crate::math::{Quaternion, Vector};
use crate::shape::Top;
use crate::simd::{elementary, one};

/// Powers of a series.
const TERMS: usize = 28;
/// Logarithm of what a step may lose: 2⁻⁶⁴.
const LOST: f64 = -44.36;
/// Least asymmetry that the length of a step knows of.
const LEAST: f64 = 0.02;

/// Ω times the length of a step, for a body of this asymmetry.
fn reach(asymmetry: f64) -> f64 {
    let a = asymmetry.max(LEAST);
    let power = 1.5_f64.sqrt() / a;
    let n = TERMS as f64;
    let y = n / (n + power);
    let logarithm = (LOST + power * elementary::ln(1.0 - y)) / n;
    let shrink = elementary::exp_in_lanes(one(logarithm)).as_slice()[0];
    2.0_f64.sqrt() * power * y * shrink
}

/// Attitude and ω in the axes of the body, (w, x, y, z) and (ω₁, ω₂, ω₃, 0), as power series in time since the beginning of the present
/// step, over its length.
#[derive(Debug, Clone)]
pub(super) struct Series {
    start: f64,
    length: f64,
    /// Ω times it.
    reach: f64,
    terms: [[f64; 8]; TERMS],
}

impl Series {
    #[inline(always)]
    pub fn new(top: &Top, attitude: Quaternion, spin: Vector) -> Self {
        let mut series = Self {
            start: 0.0,
            length: 0.0,
            reach: reach(top.asymmetry),
            terms: [[0.0; 8]; TERMS],
        };
        series.expand(top, attitude, spin);
        series
    }

    /// When the present step begins.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Attitude and ω at a time that is not before the present step.
    #[inline(always)]
    pub fn at(&mut self, top: &Top, time: f64) -> (Quaternion, Vector) {
        while time - self.start > self.length {
            self.start += self.length;
            let (attitude, spin) = self.after(1.0);
            self.expand(top, attitude, spin);
        }
        self.after((time - self.start) / self.length)
    }

    /// Attitude and ω after a part of the step.
    #[inline(always)]
    fn after(&self, part: f64) -> (Quaternion, Vector) {
        let mut sum = [0.0; 8];
        for term in self.terms.iter().rev() {
            for i in 0..8 {
                sum[i] = sum[i] * part + term[i];
            }
        }
        let [w, x, y, z, a, b, c, _] = sum;
        (
            Quaternion::new(w, x, y, z).normalized(),
            Vector::new(a, b, c),
        )
    }

    /// The series from an attitude and ω ≠ 0.
    #[inline(never)]
    fn expand(&mut self, top: &Top, attitude: Quaternion, spin: Vector) {
        let size = (spin.x * spin.x + spin.y * spin.y + spin.z * spin.z).sqrt();
        self.length = self.reach / size;
        let [a, b, c] = top.couplings.map(|f| f * self.length);
        let half = 0.5 * self.length;
        let mut q = attitude.parts();
        let mut turn = spin.parts();
        // Of each power of q the vectors by which it is multiplied with ω₁, ω₂ and ω₃, and of ω (ω₂, ω₃, ω₁, 0).
        let mut rows = [[[0.0; 4]; 4]; TERMS];
        let mut spins = [[0.0; 4]; TERMS];
        for n in 0..TERMS {
            let [w, x, y, z] = q;
            let [u, v, s] = turn;
            self.terms[n] = [w, x, y, z, u, v, s, 0.0];
            rows[n] = [
                [-x, w, z, -y],
                [-y, -z, w, x],
                [-z, y, -x, w],
                [v, s, u, 0.0],
            ];
            spins[TERMS - 1 - n] = [u, v, s, 0.0];
            // Sums of products whose powers are n together.
            let mut sums = [[0.0; 4]; 2];
            for (row, spin) in rows[..=n].iter().zip(&spins[TERMS - 1 - n..]) {
                let [u, v, s, _] = *spin;
                let crossed = [s, u, v, 0.0];
                for i in 0..4 {
                    sums[0][i] += row[0][i] * u + row[1][i] * v + row[2][i] * s;
                    sums[1][i] += row[3][i] * crossed[i];
                }
            }
            let part = 1.0 / (n + 1) as f64;
            q = sums[0].map(|sum| half * part * sum);
            turn = [
                a * part * sums[1][0],
                b * part * sums[1][1],
                c * part * sums[1][2],
            ];
        }
    }
}
