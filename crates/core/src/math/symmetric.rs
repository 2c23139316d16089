//! Symmetric 3×3 matrices: tensors of inertia, and what an impulse does to a contact.

use super::{Quaternion, Vector};
use std::ops::{Add, Mul};

/// A symmetric 3×3 matrix.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Symmetric {
    /// Entry (x, x).
    pub xx: f64,
    /// Entry (y, y).
    pub yy: f64,
    /// Entry (z, z).
    pub zz: f64,
    /// Entries (x, y) and (y, x).
    pub xy: f64,
    /// Entries (x, z) and (z, x).
    pub xz: f64,
    /// Entries (y, z) and (z, y).
    pub yz: f64,
}

impl Mul<Vector> for Symmetric {
    type Output = Vector;

    #[inline(always)]
    fn mul(self, v: Vector) -> Vector {
        Vector::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }
}

impl Add for Symmetric {
    type Output = Self;

    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self {
            xx: self.xx + b.xx,
            yy: self.yy + b.yy,
            zz: self.zz + b.zz,
            xy: self.xy + b.xy,
            xz: self.xz + b.xz,
            yz: self.yz + b.yz,
        }
    }
}

impl Symmetric {
    /// The matrix with these rows, of which the upper triangle is read.
    #[inline(always)]
    pub const fn from_rows([[xx, xy, xz], [_, yy, yz], [_, _, zz]]: [[f64; 3]; 3]) -> Self {
        Self {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        }
    }

    /// Its rows.
    pub const fn rows(&self) -> [[f64; 3]; 3] {
        [
            [self.xx, self.xy, self.xz],
            [self.xy, self.yy, self.yz],
            [self.xz, self.yz, self.zz],
        ]
    }

    /// **v** ⊗ **v** times a factor.
    #[inline(always)]
    pub fn square(v: Vector, factor: f64) -> Self {
        Self {
            xx: factor * v.x * v.x,
            yy: factor * v.y * v.y,
            zz: factor * v.z * v.z,
            xy: factor * v.x * v.y,
            xz: factor * v.x * v.z,
            yz: factor * v.y * v.z,
        }
    }

    /// The diagonal matrix with these entries.
    #[inline(always)]
    pub const fn diagonal([xx, yy, zz]: [f64; 3]) -> Self {
        Self {
            xx,
            yy,
            zz,
            xy: 0.0,
            xz: 0.0,
            yz: 0.0,
        }
    }

    /// The matrix in the axes of space of an operation that is diagonal, with these entries, in those of the body.
    #[inline(always)]
    pub fn turned([x, y, z]: [f64; 3], attitude: Quaternion) -> Self {
        let [one, two, three] = UNITS;
        Self::square(attitude.rotate(one), x)
            + Self::square(attitude.rotate(two), y)
            + Self::square(attitude.rotate(three), z)
    }

    /// Eigenvalues, and the rotation from the eigenvectors' axes to those of the matrix: Jacobi's method, which finds even small
    /// eigenvalues to the last digits. The axes of a diagonal matrix are its own.
    pub fn principal(&self) -> ([f64; 3], Quaternion) {
        let mut m = self.rows();
        let mut axes = Quaternion::IDENTITY;
        for _ in 0..SWEEPS {
            let mut rests = true;
            for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                let off = m[i][j];
                // Smaller entries do not change the eigenvalues.
                if off.abs() <= 0.125 * f64::EPSILON * (m[i][i] * m[j][j]).abs().sqrt() {
                    continue;
                }
                rests = false;
                let tau = 0.5 * (m[j][j] - m[i][i]) / off;
                let tangent = 1.0_f64.copysign(tau) / (tau.abs() + (1.0 + tau * tau).sqrt());
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                let sine = tangent * cosine;
                m[i][i] -= tangent * off;
                m[j][j] += tangent * off;
                (m[i][j], m[j][i]) = (0.0, 0.0);
                let (a, b) = (m[i][k], m[j][k]);
                m[i][k] = cosine * a - sine * b;
                m[j][k] = sine * a + cosine * b;
                (m[k][i], m[k][j]) = (m[i][k], m[j][k]);
                // Half the angle about axis k.
                let half = (0.5 * (1.0 + cosine)).sqrt();
                let mut turn = [0.0; 3];
                turn[k] = -0.5 * sine / half;
                axes = (axes * Quaternion::new(half, turn[0], turn[1], turn[2])).normalized();
            }
            if rests {
                break;
            }
        }
        ([m[0][0], m[1][1], m[2][2]], axes)
    }
}

/// Rounds of Jacobi's method after which it has converged; it needs five or six.
const SWEEPS: usize = 30;
/// The unit vectors along the axes.
pub(crate) const UNITS: [Vector; 3] = [
    Vector::new(1.0, 0.0, 0.0),
    Vector::new(0.0, 1.0, 0.0),
    Vector::new(0.0, 0.0, 1.0),
];
