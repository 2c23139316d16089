//! ε_n of viscoelastic spheres: P. Müller and T. Pöschel, *Collision of viscoelastic spheres: Compact expressions for the
//! coefficient of normal restitution*, Phys. Rev. E **84**, 021302 (2011).

use super::Material;
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};
use crate::simd::Pack;
use crate::simd::elementary::{fifth_root, polynomial};
use pulp::Simd;
use std::f64::consts::PI;

/// A viscoelastic sphere on a rigid plane, ε_n(v) as the Padé approximant [3/6] in v* = β^{1/2}v^{1/10}.
///
/// The force at a compression ξ is ρ(ξ^{3/2} + (3/2) A ξ^{1/2} dξ/dt), with ρ = (4/3) √R Y/(1 − ν²) of Hertz for a sphere on a
/// rigid plane. The contact ends where the force would become attractive. With k = ρ/m, β = (3/2) A k^{2/5}.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscoelastic {
    /// β^{1/2}, in (s/m)^{1/10}, or in the core's units if it was scaled.
    scale: f64,
}

/// Coefficients of v*⁰, v*¹, ... in the numerator of ε_n(v*).
pub const PADE_ABOVE: [f64; 4] = [1.0, 1.072_32, 0.574_198, 0.141_552];
/// Coefficients of v*⁰, v*¹, ... in the denominator of ε_n(v*).
pub const PADE_BELOW: [f64; 7] = [
    1.0, 1.072_32, 1.727_65, 1.378_42, 1.194_49, 0.467_273, 0.235_585,
];

impl Viscoelastic {
    /// Its entry in the table of materials.
    pub(crate) const KIND: Kind<Material> = Kind {
        name: "Viscoelastic",
        text: "viscoelastic spheres",
        parameters: &[
            Parameter::number(
                "young_modulus",
                "Young modulus",
                "Pa",
                Interval::POSITIVE,
                6e10,
            ),
            Parameter::number(
                "poisson_ratio",
                "Poisson ratio",
                "1",
                Interval {
                    low: -1.0,
                    high: 0.5,
                    closed: false,
                },
                0.22,
            ),
            Parameter::number(
                "dissipation",
                "dissipative constant A",
                "s",
                Interval::NOT_NEGATIVE,
                1e-7,
            ),
            Parameter::number("density", "density", "kg m-3", Interval::POSITIVE, 2500.0),
            Parameter::length("radius", "radius", 3e-3),
        ],
        make: |given| {
            let [young, poisson, dissipation, density, radius] =
                std::array::from_fn(|i| given.number(i));
            Ok(Self::new(young, poisson, dissipation, density, radius)?.into())
        },
    };

    /// The coefficient from Young's modulus Y (Pa), Poisson's ratio ν, the dissipative constant A (s), and density (kg/m³) and
    /// radius R (m) of the sphere.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless all are finite, Y, density and R > 0, ν in (−1, ½] and A ≥ 0; [`Error::Magnitude`] if the ratio
    /// of stiffness and mass overflows or underflows.
    pub fn new(
        young_modulus: f64,
        poisson_ratio: f64,
        dissipation: f64,
        density: f64,
        radius: f64,
    ) -> Result<Self, Error> {
        Error::unless_positive("young_modulus", young_modulus, "finite and > 0 (Pa)")?;
        let holds = poisson_ratio > -1.0 && poisson_ratio <= 0.5;
        Error::unless(holds, "poisson_ratio", poisson_ratio, "in (-1, 0.5]")?;
        let holds = dissipation.is_finite() && dissipation >= 0.0;
        Error::unless(holds, "dissipation", dissipation, "finite and >= 0 (s)")?;
        Error::unless_positive("density", density, "finite and > 0 (kg/m^3)")?;
        Error::unless_positive("radius", radius, "finite and > 0 (m)")?;
        let stiffness = young_modulus
            / (PI
                * (1.0 - poisson_ratio * poisson_ratio)
                * density
                * radius
                * radius
                * radius.sqrt()); // ρ/m
        let scale = (1.5 * dissipation).sqrt() * fifth_root(stiffness);
        Error::unless_beyond(
            stiffness.is_normal() && scale < LARGEST,
            "young_modulus",
            young_modulus,
            "such that the ratio of stiffness and mass neither overflows nor underflows",
        )?;
        Ok(Self { scale })
    }

    /// The parameter β, in (s/m)^{1/5}.
    pub fn beta(&self) -> f64 {
        self.scale * self.scale
    }

    pub(super) fn scaled(&self, unit: f64) -> Self {
        Self {
            scale: self.scale * fifth_root(unit.sqrt()),
        }
    }

    #[inline(always)]
    pub(super) fn in_lanes<S: Simd>(&self, speed: Pack<S>) -> Pack<S> {
        let mut root = speed.sqrt();
        for x in root.as_mut_slice() {
            *x = fifth_root(*x); // v^{1/10}
        }
        let x = root * self.scale; // v*
        polynomial(PADE_ABOVE, x) / polynomial(PADE_BELOW, x)
    }
}

/// Largest β^{1/2}. The largest v* is this times 10³⁰·⁸, the tenth root of the largest double; its sixth power is still finite.
const LARGEST: f64 = 1e20;
