//! ε_n of elastic–perfectly plastic spheres: C. Thornton, *Coefficient of restitution for collinear collisions of
//! elastic-perfectly plastic spheres*, J. Appl. Mech. **64**, 383 (1997).

use super::Material;
use crate::Error;
use crate::describe::{Arguments, Interval, Kind, Parameter};
use crate::simd::Pack;
use pulp::Simd;

/// ε_n(v) = √(6√3/5) √(1 − x²/6) (x/(x + 2√(6/5 − x²/5)))^{1/4}, x = v_y/v; 1 up to the yield speed v_y, and ∝ v^{−1/4} far
/// beyond it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plastic {
    yield_speed: f64,
}

impl Plastic {
    /// Its entry in the table of materials.
    pub(crate) const KIND: Kind<Material> = Kind {
        name: "Plastic",
        text: "elastic–perfectly plastic spheres",
        parameters: &[Parameter::number(
            "yield_speed",
            "speed at which yield begins",
            "m s-1",
            Interval::POSITIVE,
            0.01,
        )],
        make: |given| Ok(Self::new(given.number(0))?.into()),
    };

    /// The coefficient for a yield speed v_y, in m/s, below which the spheres remain elastic.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless v_y is finite and > 0.
    pub fn new(yield_speed: f64) -> Result<Self, Error> {
        Error::unless_positive("yield_speed", yield_speed, "finite and > 0 (m/s)")?;
        Ok(Self { yield_speed })
    }

    pub(super) fn scaled(&self, unit: f64) -> Self {
        Self {
            yield_speed: self.yield_speed / unit,
        }
    }

    #[inline(always)]
    pub(super) fn in_lanes<S: Simd>(&self, speed: Pack<S>) -> Pack<S> {
        let yielding = Pack::splat(speed.simd(), self.yield_speed);
        let x = yielding / speed.max(yielding);
        let square = x * x;
        let root = square.mul_add(-0.2, 1.2).sqrt();
        let ratio = x / root.mul_add(2.0, x);
        let value = square.mul_add(-1.0 / 6.0, 1.0).sqrt() * ratio.sqrt().sqrt() * FACTOR;
        yielding.lt(speed).select(value.min(1.0), 1.0)
    }
}

/// √(6√3/5).
const FACTOR: f64 = 1.441_686_848_480_852_7;
