//! Initial conditions: the angular velocity at release.

use crate::math::{Quaternion, Vector};
use crate::random::{normal_pair, uniform};
use crate::simd::elementary::sincos;
use crate::{Error, Value};
use std::f64::consts::TAU;

/// The distribution of the angular velocity **ω** at release, in rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spin<'a> {
    /// The same **ω** for every particle.
    Fixed(Vector),
    /// One **ω** for each particle.
    Given(&'a [[f64; 3]]),
    /// Random: |**ω**| is uniform from `low` to `high`, and independent of the direction.
    Random {
        /// Smallest |**ω**|.
        low: f64,
        /// Largest |**ω**|; equal to `low` if all particles spin equally fast.
        high: f64,
        /// Distribution of the direction.
        about: About,
    },
    /// Maxwell distribution, ∝ exp(−E_rot/T): the components of **ω** along the axis and perpendicular to it are Gaussian, with the
    /// same mean energy for each of the three degrees of freedom.
    Thermal {
        /// √⟨ω²⟩.
        rate: f64,
    },
}

/// The distribution of the direction of a random spin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum About {
    /// Isotropic.
    Isotropic,
    /// Uniform over the directions in the plane.
    Horizontal,
    /// Uniform over the directions perpendicular to the symmetry axis: the body tumbles, and **ω** is constant in flight.
    Across,
}

impl About {
    /// All distributions of the direction with their names.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("isotropic", Self::Isotropic),
        ("horizontal", Self::Horizontal),
        ("across", Self::Across),
    ];

    /// The distribution with this name.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an unknown name.
    pub fn named(name: &str) -> Result<Self, Error> {
        Error::chosen("axis", name, &Self::NAMED)
    }
}

/// Numbers of the random draws of a particle; the orientation has 0 and 1.
const RATE: u32 = 2;
const AROUND: u32 = 3;
const UPWARD: u32 = 4;
const LENGTHWISE: u32 = 7;

impl Spin<'_> {
    /// No spin.
    pub const NONE: Self = Self::Fixed(Vector::new(0.0, 0.0, 0.0));

    /// Returns whether no particle spins.
    pub fn is_none(&self) -> bool {
        match self {
            Self::Fixed(spin) => *spin == Vector::default(),
            Self::Given(spins) => spins.iter().flatten().all(|&x| x == 0.0),
            Self::Random { high, .. } => *high == 0.0,
            Self::Thermal { rate } => *rate == 0.0,
        }
    }

    /// **ω** of a particle, in rad/s. The tuples are sine and cosine of the polar angle and of the azimuth of its symmetry axis;
    /// `ratio` is J_xx/J_zz.
    pub fn draw(
        &self,
        seed: u64,
        particle: u64,
        ((sine, cosine), (y, x)): ((f64, f64), (f64, f64)),
        ratio: f64,
    ) -> Vector {
        // Two directions perpendicular to the axis: in its vertical plane, and horizontal.
        let tilted = Vector::new(cosine * x, cosine * y, -sine);
        let level = Vector::new(-y, x, 0.0);
        match *self {
            Self::Fixed(spin) => spin,
            Self::Given(spins) => {
                let [x, y, z] = spins[particle as usize];
                Vector::new(x, y, z)
            }
            Self::Random { low, high, about } => {
                let rate = (high - low).mul_add(uniform(seed, particle, RATE), low);
                let (b, a) = sincos(TAU * uniform(seed, particle, AROUND));
                let direction = match about {
                    About::Isotropic => {
                        let up = 2.0_f64.mul_add(uniform(seed, particle, UPWARD), -1.0);
                        let level = up.mul_add(-up, 1.0).sqrt();
                        Vector::new(level * a, level * b, up)
                    }
                    About::Horizontal => Vector::new(a, b, 0.0),
                    About::Across => level.mul_add(b, tilted * a),
                };
                direction * rate
            }
            Self::Thermal { rate } => {
                let [first, second, third] = normals(seed, particle);
                let across = rate / (2.0 + ratio).sqrt();
                let axis = Vector::new(sine * x, sine * y, cosine);
                let turning = level.mul_add(second, tilted * first);
                axis.mul_add(third * ratio.sqrt(), turning) * across
            }
        }
    }

    /// **ω** of a particle of any shape, in rad/s, at an attitude of its principal axes, about which these are its moments of inertia.
    /// Directions that refer to an axis have been refused by then.
    pub fn draw_without_axis(
        &self,
        seed: u64,
        particle: u64,
        attitude: Quaternion,
        moments: [f64; 3],
    ) -> Vector {
        let Self::Thermal { rate } = *self else {
            let upright = ((0.0, 1.0), (0.0, 1.0));
            return self.draw(seed, particle, upright, 1.0);
        };
        let [a, b, c] = moments;
        let scale = rate / (1.0 / a + 1.0 / b + 1.0 / c).sqrt();
        let [x, y, z] = normals(seed, particle);
        let spin = Vector::new(x / a.sqrt(), y / b.sqrt(), z / c.sqrt());
        attitude.rotate(spin * scale)
    }

    /// Refuses directions that refer to an axis.
    pub(crate) fn check_without_axis(&self) -> Result<(), Error> {
        let across = matches!(
            self,
            Self::Random {
                about: About::Across,
                ..
            }
        );
        Error::unless(
            !across,
            "axis",
            Value::Name("across".into()),
            "'isotropic', 'horizontal' or 'thermal' for a rigid body of any shape",
        )
    }

    /// Checks that all components are at most `most` and that there is a spin for each particle.
    pub(crate) fn check(&self, particles: usize, most: f64) -> Result<(), Error> {
        let all = |spin: [f64; 3]| {
            spin.into_iter().try_for_each(|x| {
                let allowed = "finite, at most 1e100 sqrt(g/R) (rad/s) either way";
                Error::unless(x.abs() <= most, "spin", x, allowed)
            })
        };
        match *self {
            Self::Fixed(spin) => all(spin.parts()),
            Self::Given(spins) => {
                let count = spins.len();
                let allowed = "the number of particles";
                Error::unless(count == particles, "number of spins", count, allowed)?;
                spins.iter().copied().try_for_each(all)
            }
            Self::Random { low, high, .. } => {
                let allowed = "finite and >= 0 (rad/s), the lower first, at most 1e100 sqrt(g/R)";
                Error::unless(low >= 0.0, "rate", low, allowed)?;
                Error::unless((low..=most).contains(&high), "rate", high, allowed)
            }
            Self::Thermal { rate } => {
                let allowed = "finite and >= 0 (rad/s), at most 1e99 sqrt(g/R)";
                Error::unless((0.0..=0.1 * most).contains(&rate), "rate", rate, allowed)
            }
        }
    }
}

/// Three independent Gaussian numbers with mean 0 and variance 1.
fn normals(seed: u64, particle: u64) -> [f64; 3] {
    let uniform = |draw| uniform(seed, particle, draw);
    let normal = |size, direction| normal_pair((uniform(size), uniform(direction)));
    let (second, first) = normal(RATE, AROUND);
    let (_, third) = normal(UPWARD, LENGTHWISE);
    [first, second, third]
}
