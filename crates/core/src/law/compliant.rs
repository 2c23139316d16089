//! Operations of the laws on the matrix K (10), so that each formula stands once, for every K.

use crate::math::Vector;
use crate::simd::{Mask, Pack, one};
use pulp::{Scalar, Simd};

/// Components along **n**, **u** and **w**: numbers, or one in each lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Components<T = f64> {
    /// Along the plane normal.
    pub normal: T,
    /// Along the horizontal direction of the symmetry axis.
    pub along: T,
    /// Perpendicular to both.
    pub across: T,
}

impl<T: Copy> Components<T> {
    /// The same function of every component.
    #[inline(always)]
    pub(crate) fn map<U>(self, f: impl Fn(T) -> U) -> Components<U> {
        Components {
            normal: f(self.normal),
            along: f(self.along),
            across: f(self.across),
        }
    }
}

impl<S: Simd> Components<Pack<S, 1>> {
    /// The same number along every direction in every lane.
    #[inline(always)]
    pub(super) fn splat(simd: S, number: f64) -> Self {
        let pack = Pack::splat(simd, number);
        Self {
            normal: pack,
            along: pack,
            across: pack,
        }
    }

    /// The same, but those of `other` in the lanes of the mask.
    #[inline(always)]
    pub(super) fn or(self, mask: Mask<S, 1>, other: &Self) -> Self {
        Self {
            normal: mask.select(other.normal, self.normal),
            along: mask.select(other.along, self.along),
            across: mask.select(other.across, self.across),
        }
    }

    /// Puts components into a lane.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, of: Components) {
        self.normal.as_mut_slice()[lane] = of.normal;
        self.along.as_mut_slice()[lane] = of.along;
        self.across.as_mut_slice()[lane] = of.across;
    }
}

impl Components<Pack<Scalar, 1>> {
    /// These components, x along **u**, y along **w** and z along **n**, in a single lane.
    #[inline(always)]
    pub(super) fn in_lane(v: Vector) -> Self {
        Self {
            normal: one(v.z),
            along: one(v.x),
            across: one(v.y),
        }
    }

    /// The vector with these components.
    #[inline(always)]
    pub(super) fn in_axes(self) -> Vector {
        let Components {
            normal,
            along,
            across,
        } = self.map(|component| component.as_slice()[0]);
        Vector::new(along, across, normal)
    }
}

/// The matrix K of the contact in each lane: that of a body of revolution, or of any body.
pub(super) trait Compliant<S: Simd> {
    /// K_nn.
    fn nn(&self) -> Pack<S, 1>;

    /// The components of the contact velocity along **u** and **w** after an impulse along **n**.
    fn pushed(&self, normal: Pack<S, 1>, velocity: &Components<Pack<S, 1>>) -> [Pack<S, 1>; 2];

    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10). Without `SPACE` nothing happens along **w**.
    fn impulse<const SPACE: bool>(&self, change: Components<Pack<S, 1>>) -> Components<Pack<S, 1>>;
}
