//! The normal coefficient of restitution: a constant, or a function of the speed at which the contact approaches the plane; it may
//! scatter.

mod plastic;
mod scattered;
mod tabulated;
mod viscoelastic;

pub use plastic::Plastic;
pub use scattered::Scattered;
use scattered::truncated;
pub use tabulated::{Points, Tabulated};
pub use viscoelastic::{PADE_ABOVE, PADE_BELOW, Viscoelastic};

use crate::Error;
use crate::describe::Kind;
use crate::simd::{Pack, one};
use pulp::{Simd, WithSimd};

/// The normal coefficient of restitution ε_n, in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Normal<'a> {
    /// A constant.
    Constant(f64),
    /// That of viscoelastic spheres.
    Viscoelastic(Viscoelastic),
    /// That of elastic–perfectly plastic spheres.
    Plastic(Plastic),
    /// Interpolated in a table, for example of measured values.
    Tabulated(Tabulated<'a>),
}

/// A normal coefficient, with the table that it may own, and how it scatters.
#[derive(Debug, Clone, PartialEq)]
pub enum Material {
    /// A function in closed form.
    Closed(Normal<'static>),
    /// Points of a table.
    Measured(Points),
    /// Another one with scatter.
    Scattered(Scattered),
}

impl Material {
    /// The normal coefficient, that about which it scatters if it does.
    pub fn normal(&self) -> Normal<'_> {
        match self {
            Self::Closed(normal) => *normal,
            Self::Measured(points) => points.coefficient().into(),
            Self::Scattered(scattered) => scattered.around().normal(),
        }
    }

    /// The standard deviation with which it scatters before truncation to [0, 1]; 0 if it does not.
    pub fn deviation(&self) -> f64 {
        match self {
            Self::Closed(_) | Self::Measured(_) => 0.0,
            Self::Scattered(scattered) => scattered.deviation(),
        }
    }
}

impl<T: Into<Normal<'static>>> From<T> for Material {
    fn from(normal: T) -> Self {
        Self::Closed(normal.into())
    }
}

/// Every material.
pub const MATERIALS: &[Kind<Material>] = &[
    Viscoelastic::KIND,
    Plastic::KIND,
    Points::KIND,
    Scattered::KIND,
];

impl Normal<'_> {
    /// The coefficient at a speed ≥ 0, in m/s, or in the core's unit of speed if it was scaled.
    #[inline(always)]
    pub fn at(&self, speed: f64) -> f64 {
        self.in_lanes(one(speed)).as_slice()[0]
    }

    /// [`Self::at`] in every lane.
    #[inline(always)]
    pub(crate) fn in_lanes<S: Simd>(&self, speed: Pack<S>) -> Pack<S> {
        match self {
            Self::Constant(value) => Pack::splat(speed.simd(), *value),
            Self::Viscoelastic(material) => material.in_lanes(speed),
            Self::Plastic(material) => material.in_lanes(speed),
            Self::Tabulated(table) => table.in_lanes(speed),
        }
    }

    /// [`Self::in_lanes`] in a function of its own: inlined, all coefficients together would use up the registers of the bounce loop. With
    /// a standard deviation and numbers in (0, 1) they scatter: they are quantiles of the normal distribution about it, truncated to [0, 1].
    #[inline(always)]
    pub(crate) fn apart<S: Simd>(
        &self,
        speed: Pack<S>,
        scatter: Option<(f64, Pack<S>)>,
    ) -> Pack<S> {
        speed.simd().vectorize(Coefficients {
            normal: self,
            speed,
            scatter,
        })
    }

    /// The same coefficient for speeds that are given in multiples of `unit` (in m/s) instead of m/s.
    pub(super) fn scaled(&self, unit: f64) -> Self {
        match self {
            Self::Constant(_) => *self,
            Self::Viscoelastic(material) => Self::Viscoelastic(material.scaled(unit)),
            Self::Plastic(material) => Self::Plastic(material.scaled(unit)),
            Self::Tabulated(table) => Self::Tabulated(table.scaled(unit)),
        }
    }

    /// The coefficient itself, or an error for a constant outside [0, 1].
    pub fn checked(self) -> Result<Self, Error> {
        if let Self::Constant(value) = self {
            Error::unless((0.0..=1.0).contains(&value), "normal", value, "in [0, 1]")?;
        }
        Ok(self)
    }
}

/// A coefficient and the speeds at which it is evaluated, compiled for each SIMD level.
struct Coefficients<'a, 'b, S: Simd> {
    normal: &'a Normal<'b>,
    speed: Pack<S>,
    scatter: Option<(f64, Pack<S>)>,
}

impl<S: Simd> WithSimd for Coefficients<'_, '_, S> {
    type Output = Pack<S>;

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) -> Self::Output {
        let mut normal = self.normal.in_lanes(self.speed);
        if let Some((deviation, chances)) = self.scatter {
            for (normal, &u) in normal.as_mut_slice().iter_mut().zip(chances.as_slice()) {
                *normal = truncated(*normal, deviation, u);
            }
        }
        normal
    }
}

/// A normal coefficient of each of the kinds that there are.
macro_rules! made_of {
    ($($kind:ty: $variant:ident),*) => {
        $(impl<'a> From<$kind> for Normal<'a> {
            fn from(given: $kind) -> Self {
                Self::$variant(given)
            }
        })*
    };
}

made_of!(f64: Constant, Viscoelastic: Viscoelastic, Plastic: Plastic, Tabulated<'a>: Tabulated);
