//! Initial conditions: how a particle is let go.

use crate::random::uniform;
use crate::sincos::sincos;
use crate::state::State;
use crate::vector::Vector;
use std::f64::consts::PI;

/// The law of the angle θ between the symmetry axis and the plane normal at release.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation<'a> {
    /// θ uniform in [0, π), as the paper has it above (18).
    UniformAngle,
    /// All directions of the axis alike: cos θ uniform in [−1, 1].
    Isotropic,
    /// One angle for each particle.
    Given(&'a [f64]),
}

impl Orientation<'_> {
    /// The particle at rest with its centre of mass at `height` (in R). With no spin the direction of the tilt is of no
    /// consequence, and the axis is put into the x–z plane.
    pub fn release(&self, height: f64, seed: u64, particle: u64) -> State {
        let (sine, cosine) = match self {
            Self::UniformAngle => sincos(PI * uniform(seed, particle, 0)),
            Self::Isotropic => {
                let cosine = 2.0_f64.mul_add(uniform(seed, particle, 0), -1.0);
                (cosine.mul_add(-cosine, 1.0).sqrt(), cosine)
            }
            Self::Given(angles) => sincos(angles[particle as usize]),
        };
        State {
            height,
            velocity: Vector::default(),
            axis: Vector::new(sine, 0.0, cosine),
            precession: Vector::default(),
        }
    }
}
