//! Initial conditions: the height of release.

use crate::Error;
use crate::random::uniform;
use crate::simd::elementary::sincos;
use std::f64::consts::TAU;

/// The distribution of the height of the centre of mass over the plane at release, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Height {
    /// The same height for every particle.
    Fixed(f64),
    /// Random heights with the density (1 − cos 2πs)/(highest − lowest), where s rises from 0 at the lowest to 1 at the highest: a
    /// raised cosine, which vanishes at both ends together with its slope.
    Random {
        /// Smallest height.
        lowest: f64,
        /// Largest height.
        highest: f64,
    },
}

/// Numbers of the random draws of a particle; the orientation has 0 and 1, the spin 2 to 4 and 7.
const PLACE: u32 = 5;
const MIRRORED: u32 = 6;

impl Height {
    /// The height of a particle.
    #[inline(always)]
    pub fn draw(&self, seed: u64, particle: u64) -> f64 {
        match *self {
            Self::Fixed(height) => height,
            Self::Random { lowest, highest } => {
                (highest - lowest).mul_add(raised_cosine(seed, particle), lowest)
            }
        }
    }

    /// The same distribution in another unit of length.
    pub(crate) fn scaled(&self, unit: f64) -> Self {
        match *self {
            Self::Fixed(height) => Self::Fixed(height / unit),
            Self::Random { lowest, highest } => Self::Random {
                lowest: lowest / unit,
                highest: highest / unit,
            },
        }
    }

    /// The smallest possible height.
    pub fn lowest(&self) -> f64 {
        match *self {
            Self::Fixed(height) => height,
            Self::Random { lowest, .. } => lowest,
        }
    }

    /// Mean and median of the heights.
    pub fn middle(&self) -> f64 {
        match *self {
            Self::Fixed(height) => height,
            Self::Random { lowest, highest } => 0.5 * lowest + 0.5 * highest,
        }
    }

    /// Checks that the heights are finite and in order.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match *self {
            Self::Fixed(_) => Ok(()),
            Self::Random { lowest, highest } => {
                let allowed = "finite, and not below the lowest (m)";
                let ordered = lowest <= highest && highest.is_finite();
                Error::unless(ordered, "release_height", highest, allowed)
            }
        }
    }
}

impl From<f64> for Height {
    fn from(height: f64) -> Self {
        Self::Fixed(height)
    }
}

/// A random number s in [0, 1) with the density 1 − cos 2πs. The densities at s and at s ± 1/2 add up to 2, so that a uniform number
/// s is kept with probability (1 − cos 2πs)/2, and otherwise shifted by 1/2.
#[inline(never)]
fn raised_cosine(seed: u64, particle: u64) -> f64 {
    let s = uniform(seed, particle, PLACE);
    let (_, cosine) = sincos(TAU * s);
    if 2.0 * uniform(seed, particle, MIRRORED) < 1.0 - cosine {
        s
    } else if s < 0.5 {
        s + 0.5
    } else {
        s - 0.5
    }
}
