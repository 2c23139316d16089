//! Initial conditions: the symmetry axis at release.

use crate::Error;
use crate::math::Quaternion;
use crate::random::uniform;
use crate::simd::elementary::{RANGE, sincos};
use std::f64::consts::{PI, TAU};

/// Number of the draw of the angle about the axis; the orientation has 0 and 1 as well, spin and height 2 to 7.
const TURN: u32 = 8;

/// The distribution of the angle θ between the symmetry axis and the plane normal at release, and of the azimuth φ of the axis, in
/// rad: the axis is (sin θ cos φ, sin θ sin φ, cos θ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation<'a> {
    /// θ uniform in [0, π), as the paper assumes above (18).
    UniformAngle,
    /// Isotropic: cos θ uniform in [−1, 1].
    Isotropic,
    /// One angle θ for each particle, in rad.
    Given(&'a [f64]),
    /// θ and φ for each particle, in rad.
    Directions(&'a [[f64; 2]]),
    /// For rigid bodies of any shape, the rotation of each particle from the axes of the body to those of space: a quaternion (w, x, y, z) of
    /// any length but 0.
    Attitudes(&'a [[f64; 4]]),
}

impl Orientation<'_> {
    /// The distributions that have a name.
    pub const NAMED: [(&'static str, Self); 2] = [
        ("uniform-angle", Self::UniformAngle),
        ("isotropic", Self::Isotropic),
    ];

    /// The distribution with this name.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an unknown name.
    pub fn named(name: &str) -> Result<Self, Error> {
        Error::chosen("orientation", name, &Self::NAMED)
    }

    /// (sin θ, cos θ) of a particle. Inlined with everything it calls, so that it is compiled for the SIMD level of its caller.
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
            Self::Attitudes(_) => (f64::NAN, f64::NAN),
        }
    }

    /// The attitude of a particle of any shape. A random one is uniform among all rotations: its z axis is that of [`Self::draw`] and
    /// [`Self::azimuth`], about which it is turned by an angle that is uniform as well.
    pub fn attitude(&self, seed: u64, particle: u64) -> Quaternion {
        if let Self::Attitudes(given) = self {
            let [w, x, y, z] = given[particle as usize];
            return Quaternion::new(w, x, y, z).normalized();
        }
        let (_, cosine) = self.draw(seed, particle);
        let azimuth = self.azimuth(seed, particle);
        let turn = TAU * uniform(seed, particle, TURN);
        let (c, s) = ((0.5 * (1.0 + cosine)).sqrt(), (0.5 * (1.0 - cosine)).sqrt());
        let (z, w) = sincos(0.5 * (azimuth + turn));
        let (x, y) = sincos(0.5 * (azimuth - turn));
        Quaternion::new(c * w, -s * x, s * y, c * z).normalized()
    }

    /// Azimuth φ of a particle in rad, uniform in [0, 2π) unless it is given. It matters only where spin, velocity or gravity single
    /// out a direction in the plane; the ensemble must then contain all azimuths.
    pub fn azimuth(&self, seed: u64, particle: u64) -> f64 {
        match self {
            Self::Directions(angles) => angles[particle as usize][1],
            _ => TAU * uniform(seed, particle, 1),
        }
    }

    /// Checks that there is an angle for each particle, in the range of sine and cosine.
    pub(crate) fn check(&self, particles: usize) -> Result<(), Error> {
        let (count, angles, attitudes): (_, &[f64], &[[f64; 4]]) = match *self {
            Self::UniformAngle | Self::Isotropic => return Ok(()),
            Self::Given(angles) => (angles.len(), angles, &[]),
            Self::Directions(angles) => (angles.len(), angles.as_flattened(), &[]),
            Self::Attitudes(attitudes) => (attitudes.len(), &[], attitudes),
        };
        let allowed = "the number of particles";
        Error::unless(count == particles, "number of angles", count, allowed)?;
        attitudes.iter().try_for_each(|parts| {
            let square: f64 = parts.iter().map(|x| x * x).sum();
            let allowed = "a quaternion of finite length > 0";
            Error::unless(square.is_normal(), "orientation", square, allowed)
        })?;
        angles.iter().try_for_each(|&angle| {
            let reduced = angle.abs() <= RANGE;
            Error::unless(reduced, "angle", angle, "finite, at most 2^20 rad")
        })
    }
}
