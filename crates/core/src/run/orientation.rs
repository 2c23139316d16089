//! Initial conditions: how the symmetry axis lies when a particle is released.

use crate::Error;
use crate::random::uniform;
use crate::simd::elementary::{RANGE, sincos};
use std::f64::consts::{PI, TAU};

/// The law of the angle θ between the symmetry axis and the plane normal at release, and of its azimuth φ: the axis is
/// (sin θ cos φ, sin θ sin φ, cos θ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation<'a> {
    /// θ uniform in [0, π), as the paper has it above (18).
    UniformAngle,
    /// Isotropic: cos θ uniform in [−1, 1].
    Isotropic,
    /// One angle θ for each particle.
    Given(&'a [f64]),
    /// θ and φ for each particle.
    Directions(&'a [[f64; 2]]),
}

impl Orientation<'_> {
    /// The laws that have a name.
    pub const NAMED: [(&'static str, Self); 2] = [
        ("uniform-angle", Self::UniformAngle),
        ("isotropic", Self::Isotropic),
    ];

    /// The law of that name.
    pub fn named(name: &str) -> Result<Self, Error> {
        Error::chosen("orientation", name, &Self::NAMED)
    }

    /// (sin θ, cos θ) of a particle. Inlined, with all it calls, to be compiled for the SIMD level of its caller.
    #[inline(always)]
    pub fn draw(&self, seed: u64, particle: u64) -> (f64, f64) {
        match self {
            Self::UniformAngle => sincos(PI * uniform(seed, particle, 0)),
            Self::Isotropic => {
                let cosine = 2.0_f64.mul_add(uniform(seed, particle, 0), -1.0);
                (cosine.mul_add(-cosine, 1.0).sqrt(), cosine)
            }
            Self::Given(angles) => sincos(angles[particle as usize]),
            Self::Directions(angles) => sincos(angles[particle as usize][0]),
        }
    }

    /// Azimuth φ of a particle: uniform in [0, 2π) unless it is given. It is of consequence only where spin, velocity or
    /// gravity single out a direction along the plane; were it always 0 there, the ensemble would be of a chosen few.
    pub fn azimuth(&self, seed: u64, particle: u64) -> f64 {
        match self {
            Self::Directions(angles) => angles[particle as usize][1],
            _ => TAU * uniform(seed, particle, 1),
        }
    }

    /// Whether given angles are one a particle and in the range of sine and cosine.
    pub(crate) fn check(&self, particles: usize) -> Result<(), Error> {
        let angles = match self {
            Self::UniformAngle | Self::Isotropic => return Ok(()),
            Self::Given(angles) => angles,
            Self::Directions(angles) => angles.as_flattened(),
        };
        let each = if let Self::Directions(_) = self { 2 } else { 1 };
        let count = angles.len() / each;
        let allowed = "the number of particles";
        Error::unless(count == particles, "number of angles", count, allowed)?;
        angles.iter().try_for_each(|&angle| {
            let reduced = angle.abs() <= RANGE;
            Error::unless(reduced, "angle", angle, "finite, at most 2^20 rad")
        })
    }
}
